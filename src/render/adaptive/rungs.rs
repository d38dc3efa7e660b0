//! The numbers of samples that a tile can have: a ladder, so that neighbours mostly have the same and few
//! dispatches do.

use crate::pack::RUN_LENGTH;
use std::ops::Range;

/// Fewest samples of a pixel of the picture. What scouts see may leave out what is rare: these bound how much a
/// part can be neglected, and its error is estimated from them.
pub const FIRST: u64 = 32;

/// The rung above one: an eighth further, a run at least.
pub fn next(rung: u64) -> u64 {
    let run = u64::from(RUN_LENGTH);
    let step = (rung / 8).next_multiple_of(run).max(run);
    rung.saturating_add(step)
}

/// The lowest rung with at least so many samples; none is above `most`.
pub fn reach(count: f64, most: u64) -> u64 {
    let mut rung = FIRST;
    while (rung as f64) < count && rung < most {
        rung = next(rung);
    }
    rung.min(most)
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
    fn rungs_are_whole_runs_an_eighth_apart() {
        let mut rungs = vec![FIRST];
        while rungs.len() < 12 {
            rungs.push(next(*rungs.last().unwrap()));
        }
        assert_eq!(
            rungs,
            [32, 48, 64, 80, 96, 112, 128, 144, 176, 208, 240, 272]
        );
        assert_eq!(reach(0.0, 1000), 32);
        assert_eq!(reach(32.0, 1000), 32);
        assert_eq!(reach(32.5, 1000), 48);
        assert_eq!(reach(1e9, 1000), 1000);
        assert_eq!(reach(f64::INFINITY, 40), 40);
        assert_eq!(reach(5.0, 10), 10);
    }

    #[test]
    fn ranges_end_whole_runs() {
        assert_eq!(whole(&(0..100), 32), 32);
        assert_eq!(whole(&(5..100), 32), 43);
        assert_eq!(whole(&(5..30), 32), 25);
        assert_eq!(whole(&(u64::MAX - 20..u64::MAX), 32), 20);
    }
}
