//! One knob with the values that a sweep gives it.
//!
//! `PATH=1,2,3` is a list, `1..8` the whole numbers with both ends, `0..1+0.25` steps, `4..1024*2`
//! factors. Lists may hold ranges. Commas inside brackets and quotes belong to a value.

use crate::error::{Error, Result};

/// More runs than this are a mistake.
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
        let fail = |reason: &str| Err(Error::Usage(format!("--set {text}: {reason}")));
        let Some((path, values)) = text.split_once('=') else {
            return fail(
                "write PATH=VALUES, for example light.sampler=cone,gaussian or render.samples=4..64*2",
            );
        };
        let mut all = Vec::new();
        for part in split(values) {
            match expand(part.trim()) {
                Ok(values) => all.extend(values),
                Err(reason) => return fail(&reason),
            }
        }
        Self::new(path.trim(), all).or_else(|error| fail(&error))
    }

    /// An axis from a scene's `[sweep]` table or from code.
    ///
    /// # Errors
    /// A reason, where there are no values, too many, or the same one twice.
    pub fn new(path: &str, values: Vec<String>) -> std::result::Result<Self, String> {
        if values.is_empty() || values.iter().any(String::is_empty) {
            return Err("a value is missing".into());
        }
        if values.len() > MOST_RUNS {
            return Err(format!("over {MOST_RUNS} values"));
        }
        let mut seen = std::collections::HashSet::new();
        if let Some(twice) = values.iter().find(|value| !seen.insert(value.as_str())) {
            return Err(format!("{twice} is there twice"));
        }
        Ok(Self {
            path: path.into(),
            values,
        })
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

/// A range's values; anything else stands for itself.
fn expand(text: &str) -> std::result::Result<Vec<String>, String> {
    let Some((first, rest)) = text.split_once("..") else {
        return Ok(vec![text.into()]);
    };
    let number = |text: &str| {
        let text = text.trim();
        let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| format!("{text:?} is not a number"))
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
        Some(('*', factor)) => factors(first, last, factor)?,
        Some((_, step)) => steps(first, last, step)?,
        None if first.fract() == 0.0 && last.fract() == 0.0 => steps(first, last, 1.0)?,
        None => {
            return Err(format!(
                "{text} has no step: write {text}+STEP or {text}*FACTOR"
            ));
        }
    };
    Ok(values.into_iter().map(written).collect())
}

/// Whole numbers as knobs that take whole numbers want them.
fn written(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e15 {
        format!("{value:.0}")
    } else {
        // 0.1 + 0.2 is meant to be 0.3.
        let rounded: f64 = format!("{value:.12e}").parse().unwrap_or(value);
        format!("{rounded}")
    }
}

fn steps(first: f64, last: f64, step: f64) -> std::result::Result<Vec<f64>, String> {
    if step <= 0.0 || last < first {
        return Err("a range goes up, by a step above 0".into());
    }
    let count = ((last - first) / step * (1.0 + 1e-12) + 1e-9).floor();
    if count >= MOST_RUNS as f64 {
        return Err(format!("over {MOST_RUNS} values"));
    }
    Ok((0..=count as u64)
        .map(|index| first + index as f64 * step)
        .collect())
}

fn factors(first: f64, last: f64, factor: f64) -> std::result::Result<Vec<f64>, String> {
    if factor <= 1.0 || first <= 0.0 || last < first {
        return Err("a range of factors goes up from above 0, by a factor above 1".into());
    }
    let mut values = vec![first];
    // With a grain of tolerance: ten times 1.1 is to reach 1.1 to the tenth.
    for power in 1..=MOST_RUNS as i32 {
        let value = first * factor.powi(power);
        if value > last * (1.0 + 1e-9) {
            return Ok(values);
        }
        values.push(value);
    }
    Err(format!("over {MOST_RUNS} values"))
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
    fn mistakes() {
        for (text, reason) in [
            ("a", "PATH=VALUES"),
            ("a=", "missing"),
            ("a=1,,2", "missing"),
            ("a=1,1", "twice"),
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
