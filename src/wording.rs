//! Words for people: plurals, signs, and names that a terminal can show.

use std::fmt::Display;
use std::path::Path;

/// 1 run, 2 runs.
pub(crate) fn counted<N: Display + PartialEq + From<u8>>(count: N, what: &str) -> String {
    counted_as(count, what, &format!("{what}s"))
}

/// The same of a word whose plural has more than an s at its end.
pub(crate) fn counted_as<N: Display + PartialEq + From<u8>>(
    count: N,
    one: &str,
    many: &str,
) -> String {
    let word = if count == N::from(1) { one } else { many };
    format!("{count} {word}")
}

/// 1 was there, 2 were there.
pub(crate) fn were_there(count: usize) -> String {
    counted_as(count, "was there", "were there")
}

/// A number with its sign and so many decimals: +0.14, -0.02; what rounds to zero has no sign.
pub(crate) fn signed(value: f64, decimals: usize) -> String {
    unsigned_zero(format!("{value:+.decimals$}"))
}

/// Takes the sign from a zero.
pub(crate) fn unsigned_zero(number: String) -> String {
    match number.parse() {
        Ok(0.0) => number.trim_start_matches(['+', '-']).into(),
        _ => number,
    }
}

/// A file's name as it may be shown: one line, without codes that move a terminal's cursor, or worse.
pub(crate) fn named(path: impl AsRef<Path>) -> String {
    let clean = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let name = path.as_ref().to_string_lossy();
    name.chars().map(clean).collect()
}

/// Several, as [`named`].
pub(crate) fn all_named(paths: &[impl AsRef<Path>]) -> String {
    let names: Vec<_> = paths.iter().map(named).collect();
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_no_plural() {
        let of = |count: u64| counted_as(count, "sample a pixel", "samples a pixel");
        assert_eq!(of(0), "0 samples a pixel");
        assert_eq!(of(1), "1 sample a pixel");
        assert_eq!(counted(2_usize, "run"), "2 runs");
    }

    #[test]
    fn zero_has_no_sign() {
        let all = [0.14, -0.02, -0.004, 0.004, -0.0, 12.345].map(|value| signed(value, 2));
        assert_eq!(all, ["+0.14", "-0.02", "0.00", "0.00", "0.00", "+12.35"]);
    }

    #[test]
    fn names_keep_to_a_line_and_move_no_cursor() {
        assert_eq!(
            named("a\n\u{1b}[2J\u{9b}b.png"),
            "a\u{fffd}\u{fffd}[2J\u{fffd}b.png"
        );
        assert_eq!(all_named(&["röm.png", "b\t.exr"]), "röm.png, b\u{fffd}.exr");
    }
}
