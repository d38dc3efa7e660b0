//! Numbers in sentences.

use crate::report::data::Interval;

/// As many decimals as three digits take; large numbers keep all before the point.
pub(crate) fn number(value: f64) -> String {
    let decimals = match value.abs() {
        0.0 => 0,
        size => (2 - size.log10().floor() as i32).clamp(0, 9) as usize,
    };
    format!("{value:.decimals$}")
}

/// 12.3 % (95 %: 11.9 to 12.7), of a share.
pub(crate) fn percent(share: Interval) -> String {
    let [value, low, high] = [share.value, share.low, share.high].map(|part| 100.0 * part);
    format!("{} % ({})", number(value), ends(low, high))
}

/// 1.47 (95 %: 1.40 to 1.54).
pub(crate) fn ranged(value: Interval) -> String {
    format!("{} ({})", number(value.value), ends(value.low, value.high))
}

fn ends(low: f64, high: f64) -> String {
    format!("95 %: {} to {}", number(low), number(high))
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
