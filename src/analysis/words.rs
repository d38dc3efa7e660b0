//! Numbers and values in sentences.

use crate::report::data::Interval;
use crate::wording::unsigned_zero;
use serde_json::Value;

/// As many decimals as three digits take; large numbers keep all before the point.
pub(crate) fn number(value: f64) -> String {
    let decimals = decimals(value);
    unsigned_zero(format!("{value:.decimals$}"))
}

fn decimals(value: f64) -> usize {
    match value.abs() {
        0.0 => 0,
        size => (2 - size.log10().floor() as i32).clamp(0, 9) as usize,
    }
}

/// 12.3 % (95 %: 11.9 to 12.7), of a share.
pub(crate) fn percent(share: Interval) -> String {
    let [value, ends] = parts(Interval {
        value: 100.0 * share.value,
        low: 100.0 * share.low,
        high: 100.0 * share.high,
    });
    format!("{value} % ({ends})")
}

/// 1.47 (95 %: 1.40 to 1.54).
pub(crate) fn ranged(value: Interval) -> String {
    let [value, ends] = parts(value);
    format!("{value} ({ends})")
}

/// The value and its ends with as many decimals each, and as many more as tell the ends apart.
fn parts(of: Interval) -> [String; 2] {
    // More say nothing: an interval that is as narrow as that has no error.
    const MORE: usize = 3;
    let few = decimals(of.value);
    let differ = |decimals: &usize| {
        let [low, high] = [of.low, of.high].map(|end| format!("{end:.decimals$}"));
        low != high
    };
    let decimals = (few..=few + MORE).find(differ).unwrap_or(few);
    let shown = |part: f64| {
        let text = format!("{part:.decimals$}");
        match text.parse() {
            // What is not 0 is not called so.
            Ok(0.0) => number(part),
            _ => text,
        }
    };
    let ends = format!("95 %: {} to {}", shown(of.low), shown(of.high));
    [shown(of.value), ends]
}

/// The value of a knob: text without quotes, and whole numbers without decimals, however they were typed.
pub(crate) fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        // As `--set` has it.
        Value::Null => "off".into(),
        Value::Number(number) => match number.as_f64() {
            // Adding 0 takes the sign from a zero.
            Some(float) if number.is_f64() => format!("{}", float + 0.0),
            _ => number.to_string(),
        },
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(plain).collect();
            format!("[{}]", items.join(","))
        }
        other => other.to_string(),
    }
}

/// The same of a value as `--set` takes it.
pub(crate) fn plain_text(text: &str) -> String {
    serde_json::from_str(text).map_or_else(|_| text.into(), |value| plain(&value))
}

/// The same with the sign turned.
pub(crate) fn negated(value: Interval) -> Interval {
    Interval {
        value: -value.value,
        low: -value.high,
        high: -value.low,
    }
}

/// 1 / value.
pub(crate) fn inverted(value: Interval) -> Interval {
    Interval {
        value: 1.0 / value.value,
        low: 1.0 / value.high,
        high: 1.0 / value.low,
    }
}

/// a, b and c; names that have commas themselves are kept apart by semicolons.
pub(crate) fn list(names: &[&str]) -> String {
    let commas = names.iter().any(|name| name.contains(','));
    match names {
        [_, _, ..] if commas => names.join("; "),
        [] => String::new(),
        [one] => (*one).into(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_parts_of_an_interval_have_as_many_decimals() {
        let text = |value, low, high| ranged(Interval { value, low, high });
        assert_eq!(text(1.4321, 1.378, 1.4802), "1.43 (95 %: 1.38 to 1.48)");
        assert_eq!(text(99.98, 99.96, 100.01), "99.98 (95 %: 99.96 to 100.01)");
        assert_eq!(text(1.0, 1.0, 1.0), "1.00 (95 %: 1.00 to 1.00)");
        assert_eq!(text(512.3, 498.1, 1021.0), "512 (95 %: 498 to 1021)");
        assert_eq!(text(2.0, 0.001, 9.0), "2.00 (95 %: 0.00100 to 9.00)");
        assert_eq!(text(0.0, -0.02, 0.02), "0 (95 %: -0.0200 to 0.0200)");
        let share = Interval {
            value: 1.0,
            low: 0.99996,
            high: 1.00004,
        };
        assert_eq!(percent(share), "100.000 % (95 %: 99.996 to 100.004)");
    }

    #[test]
    fn a_value_has_one_form() {
        assert_eq!(plain(&json!([0.0, -0.0, 0.5])), "[0,0,0.5]");
        assert_eq!(plain_text("[0, 0.0, 0.50]"), "[0,0,0.5]");
        assert_eq!(plain_text("cone"), "cone");
        assert_eq!(plain(&json!(u64::MAX)), u64::MAX.to_string());
        assert_eq!(plain_text("1e-3"), "0.001");
        assert_eq!(plain(&Value::Null), plain_text("off"));
    }
}
