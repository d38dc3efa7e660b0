//! One knob with the values that a sweep gives it.
//!
//! `PATH=1,2,3` is a list, `1..8` the whole numbers with both ends, `0..1+0.25` steps, `4..1024*2`
//! factors. Lists may hold ranges. Commas inside brackets and quotes belong to a value.

use crate::error::{Error, Result};
use crate::knobs::short;
use std::collections::HashSet;

/// More runs than this are a mistake; and so are more values, of all axes together.
pub const MOST_RUNS: usize = 1_000_000;

/// A knob and its values, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub path: String,
    /// Each as `--set` takes it.
    pub values: Vec<String>,
}

impl Axis {
    /// Reads `PATH=VALUES`.
    ///
    /// # Errors
    /// [`Error::Usage`] with the part that cannot be read.
    pub fn parse(text: &str) -> Result<Self> {
        Self::within(text, MOST_RUNS)
    }

    /// Reads all axes of a sweep.
    ///
    /// # Errors
    /// As [`Axis::parse`], and for more than [`MOST_RUNS`] values of all of them together, before there is
    /// memory for them: each axis alone may be small enough.
    pub fn parse_all<T: AsRef<str>>(texts: &[T]) -> Result<Vec<Self>> {
        let mut room = MOST_RUNS;
        let mut axes = Vec::new();
        for text in texts {
            let axis = Self::within(text.as_ref(), room)?;
            room -= axis.values.len();
            axes.push(axis);
        }
        Ok(axes)
    }

    /// With no more values than there is room for.
    fn within(text: &str, room: usize) -> Result<Self> {
        let fail = |reason: &str| Err(Error::Usage(format!("--set {}: {reason}", short(text))));
        let Some((path, values)) = text.split_once('=') else {
            return fail(
                "write PATH=VALUES, for example light.sampler=cone,gaussian or render.samples=4..64*2",
            );
        };
        let mut all = Vec::new();
        for part in split(values) {
            match expand(part.trim(), room - all.len()) {
                Ok(values) => all.extend(values),
                Err(reason) => return fail(&reason),
            }
        }
        Self::new(path.trim(), all).or_else(|error| fail(&error))
    }

    /// An axis from a scene's `[sweep]` table or from code.
    ///
    /// # Errors
    /// A reason, where there are no values or too many.
    pub fn new(path: &str, values: Vec<String>) -> std::result::Result<Self, String> {
        if values.is_empty() || values.iter().any(String::is_empty) {
            return Err("a value is missing".into());
        }
        if values.len() > MOST_RUNS {
            return Err(too_many());
        }
        Ok(Self {
            path: path.into(),
            values,
        })
    }

    /// A value that is there twice.
    pub(super) fn repeated(&self) -> Option<&str> {
        let mut seen = HashSet::with_capacity(self.values.len());
        let mut values = self.values.iter().map(String::as_str);
        values.find(|value| !seen.insert(*value))
    }
}

/// At the commas that are in no brackets and no quotes.
fn split(text: &str) -> Vec<&str> {
    let (mut parts, mut start, mut depth, mut quote) = (Vec::new(), 0, 0i32, None);
    for (at, letter) in text.char_indices() {
        match (quote, letter) {
            (Some(open), _) if letter == open => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(letter),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            (None, ',') if depth == 0 => {
                parts.push(&text[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[start..]);
    parts
}

fn too_many() -> String {
    format!("over {MOST_RUNS} values")
}

/// A range's values, if there is room for them; anything else stands for itself.
fn expand(text: &str, room: usize) -> std::result::Result<Vec<String>, String> {
    if room == 0 {
        return Err(too_many());
    }
    let Some((first, rest)) = text.split_once("..") else {
        return Ok(vec![text.into()]);
    };
    let number = |text: &str| {
        let text = text.trim();
        let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| format!("{:?} is not a number", short(text)))
    };
    let first = number(first)?;
    // A sign right after the dots belongs to the end, as in -4..-1+1.
    let operator = rest
        .char_indices()
        .skip(1)
        .find(|(at, letter)| matches!(letter, '+' | '*') && !rest[..*at].ends_with(['e', 'E']));
    let (last, step) = match operator {
        Some((at, letter)) => (
            number(&rest[..at])?,
            Some((letter, number(&rest[at + 1..])?)),
        ),
        None => (number(rest)?, None),
    };
    let values = match step {
        Some(('*', factor)) => factors(first, last, factor, room)?,
        Some((_, step)) => steps(first, last, step, room)?,
        None if first.fract() == 0.0 && last.fract() == 0.0 => steps(first, last, 1.0, room)?,
        None => {
            let text = short(text);
            return Err(format!(
                "{text} has no step: write {text}+STEP or {text}*FACTOR"
            ));
        }
    };
    Ok(values.into_iter().map(written).collect())
}

/// Whole numbers as knobs that take whole numbers want them; those here fit.
fn written(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e15 {
        (value as i64).to_string()
    } else {
        // 0.1 + 0.2 is meant to be 0.3.
        let rounded: f64 = format!("{value:.12e}").parse().unwrap_or(value);
        format!("{rounded}")
    }
}

fn steps(first: f64, last: f64, step: f64, room: usize) -> std::result::Result<Vec<f64>, String> {
    if step <= 0.0 || last < first {
        return Err("a range goes up, by a step above 0".into());
    }
    let count = ((last - first) / step * (1.0 + 1e-12) + 1e-9).floor();
    // One more than whole steps: both ends count.
    if count >= room as f64 {
        return Err(too_many());
    }
    Ok((0..=count as u64)
        .map(|index| first + index as f64 * step)
        .collect())
}

fn factors(
    first: f64,
    last: f64,
    factor: f64,
    room: usize,
) -> std::result::Result<Vec<f64>, String> {
    if factor <= 1.0 || first <= 0.0 || last < first {
        return Err("a range of factors goes up from above 0, by a factor above 1".into());
    }
    let mut values = vec![first];
    // With a grain of tolerance: ten times 1.1 is to reach 1.1 to the tenth.
    // There is room for a million at most.
    for power in 1..=room as i32 {
        let value = first * factor.powi(power);
        if value > last * (1.0 + 1e-9) {
            return Ok(values);
        }
        values.push(value);
    }
    Err(too_many())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        Axis::parse(&format!("a={text}"))
            .unwrap_or_else(|error| panic!("{error}"))
            .values
    }

    #[test]
    fn lists_and_ranges() {
        assert_eq!(values("cone,gaussian"), ["cone", "gaussian"]);
        assert_eq!(values("1..4"), ["1", "2", "3", "4"]);
        assert_eq!(values("-2..1"), ["-2", "-1", "0", "1"]);
        assert_eq!(values("0..1+0.25"), ["0", "0.25", "0.5", "0.75", "1"]);
        assert_eq!(values("0..0.3+0.1"), ["0", "0.1", "0.2", "0.3"]);
        assert_eq!(values("4..64*2"), ["4", "8", "16", "32", "64"]);
        assert_eq!(values("1e-3..1*10"), ["0.001", "0.01", "0.1", "1"]);
        assert_eq!(values("0,8..10,off"), ["0", "8", "9", "10", "off"]);
        assert_eq!(values("[1,2,3],[4,5,6]"), ["[1,2,3]", "[4,5,6]"]);
        assert_eq!(values("\"a,b\",c"), ["\"a,b\"", "c"]);
    }

    #[test]
    fn values_are_counted_over_all_parts_and_all_axes() {
        let over = |texts: &[&str]| match Axis::parse_all(texts) {
            Err(error) => error.to_string().contains("over 1000000 values"),
            Ok(axes) => {
                assert_eq!(axes.len(), texts.len());
                false
            }
        };
        assert!(!over(&["a=1..1000000"]));
        assert!(!over(&["a=1..500000", "b=1..499999,x"]));
        assert!(over(&["a=1..1000001"]));
        assert!(over(&["a=1..1000000,x"]));
        assert!(over(&["a=1..500000", "b=1..500001"]));
        assert!(over(&["a=1..1000000", "b=x"]));
        // Read one by one these would need gigabytes.
        assert!(over(&["a=1..900000"; 10_000]));
        let list = format!("a={}", vec!["1..900000"; 10_000].join(","));
        assert!(over(&[&list]));
    }

    #[test]
    fn mistakes_are_said_on_one_short_line() {
        for text in [
            "\u{1b}[2J=1,,1".to_string(),
            format!("a={}..1", "x".repeat(1 << 20)),
            format!("a=0.5..1.{}1", "0".repeat(1000)),
        ] {
            let error = Axis::parse(&text).expect_err("a mistake").to_string();
            assert!(error.len() < 600, "{error}");
            assert!(!error.contains(char::is_control), "{error:?}");
        }
    }

    #[test]
    fn mistakes() {
        for (text, reason) in [
            ("a", "PATH=VALUES"),
            ("a=", "missing"),
            ("a=1,,2", "missing"),
            ("a=1..x", "not a number"),
            ("a=0..0.5", "no step"),
            ("a=2..1", "goes up"),
            ("a=1..8*1", "above 1"),
            ("a=0..8*2", "above 0"),
            ("a=0..1+0", "above 0"),
            ("a=0..1+1e-9", "over"),
            ("a=nan..1", "not a number"),
        ] {
            let error = Axis::parse(text).expect_err(text).to_string();
            assert!(error.contains(reason), "{text}: {error}");
        }
    }
}
