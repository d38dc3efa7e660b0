//! When a render looks at its own error, to stop where it is small enough.
//!
//! A look is taken when every pixel has the same number of samples, and at numbers that are fixed beforehand:
//! so where a render stops depends on its samples alone, never on how fast they came or how the work was
//! split. Few looks, each an eighth further, also keep small the bias that comes from stopping when an
//! estimate happens to be low.
//!
//! Where samples are cut into randomisations a look may fall into one: its open part counts as one more, which
//! makes the error too large rather than too small, and before the second no error is known. The length of a
//! randomisation comes from the samples that are planned, not from those that are taken.

use crate::pack::RUN_LENGTH;
use std::ops::Range;

/// Samples before the first look: an error that is estimated from fewer means little.
pub const FIRST: u64 = 64;

/// The number of samples after which the next look is taken: an eighth further, in whole runs.
pub fn further(count: u64) -> u64 {
    let run = u64::from(RUN_LENGTH);
    let step = (count / 8).next_multiple_of(run).max(run);
    count.saturating_add(step)
}

/// The index of the sample before which the first look after sample `index` of a range is taken.
pub fn next(samples: &Range<u64>, index: u64) -> u64 {
    let run = u64::from(RUN_LENGTH);
    let mut count = FIRST;
    loop {
        let look = samples
            .start
            .saturating_add(count)
            .checked_next_multiple_of(run)
            .unwrap_or(samples.end);
        if look > index || look >= samples.end {
            return look.min(samples.end);
        }
        count = further(count);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_are_an_eighth_apart() {
        let mut looks = vec![0];
        while looks.len() < 8 {
            looks.push(next(&(0..u64::MAX), *looks.last().unwrap()));
        }
        assert_eq!(looks, [0, 64, 80, 96, 112, 128, 144, 176]);
    }

    #[test]
    fn the_last_look_is_the_end() {
        assert_eq!(next(&(0..100), 96), 100);
        assert_eq!(next(&(0..10), 0), 10);
        assert_eq!(next(&(7..100), 7), 80);
        let far = u64::MAX - 20;
        assert_eq!(next(&(far..u64::MAX), far), u64::MAX);
    }
}
