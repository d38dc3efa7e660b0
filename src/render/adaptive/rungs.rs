//! The numbers of samples that a tile can have: a ladder, so that neighbours mostly have the same and few
//! dispatches do. Its rungs are the numbers at which even sampling looks at the error.

use super::super::look;
use crate::pack::RUN_LENGTH;
use std::ops::Range;

/// Fewest samples of a pixel of the picture: those that even sampling takes before it first looks.
pub const FIRST: u64 = look::FIRST;

/// Samples on a rung, counted from 0.
pub fn at(rung: u64) -> u64 {
    (0..rung).fold(FIRST, |count, _| look::further(count))
}

/// The lowest rung from `from` on with at least so many samples, or with all of them.
pub fn reach(from: u64, wanted: f64, all: u64) -> u64 {
    let (mut rung, mut count) = (from, at(from));
    while (count as f64) < wanted && count < all {
        (rung, count) = (rung + 1, look::further(count));
    }
    rung
}

/// So many samples from the start of a range on, and what is left of the last run: runs are never broken but at
/// the ends of the range.
pub fn whole(samples: &Range<u64>, count: u64) -> u64 {
    let end = samples.start.saturating_add(count);
    let end = end.checked_next_multiple_of(u64::from(RUN_LENGTH));
    end.unwrap_or(samples.end).min(samples.end) - samples.start
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rungs_are_where_even_sampling_looks() {
        let mut index = 0;
        for rung in 0..40 {
            index = look::next(&(0..u64::MAX), index);
            assert_eq!(at(rung), index);
        }
        assert_eq!([at(0), at(1), at(7), at(8)], [64, 80, 208, 240]);
    }

    #[test]
    fn a_rung_is_reached_from_below() {
        assert_eq!(reach(0, 0.0, 1000), 0);
        assert_eq!(reach(0, 64.5, 1000), 1);
        assert_eq!(reach(3, 64.5, 1000), 3);
        // Between 912 and 1040.
        assert_eq!(at(reach(0, 1e9, 1000)), 1040);
        assert_eq!(reach(0, f64::INFINITY, 40), 0);
    }

    #[test]
    fn ranges_end_whole_runs() {
        assert_eq!(whole(&(0..100), 32), 32);
        assert_eq!(whole(&(5..100), 32), 43);
        assert_eq!(whole(&(5..30), 32), 25);
        assert_eq!(whole(&(u64::MAX - 20..u64::MAX), 32), 20);
    }
}
