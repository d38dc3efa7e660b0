//! Which samples of which pixels each dispatch takes. The picture never depends on it: a pixel's
//! samples are added in order, in runs that end at fixed indices.

use super::look;
use super::pace::Pace;
use crate::device::Block;
use crate::pack::{RUN_LENGTH, Rect};
use std::ops::Range;
use std::time::Duration;

/// Samples of a pixel that one dispatch takes where there is enough to do beside: long lanes keep
/// the device full.
pub(super) const LONG: u64 = 64;
/// Samples of a pixel that any dispatch takes.
const MOST_BAND: u64 = 64 * LONG;
/// Pixels that keep every lane of a small device busy.
const WIDE: u64 = 4096;
/// The most tallies that a dispatch brings back: 32 MiB of them.
pub(super) const MOST_TALLIES: u64 = 1 << 20;

/// The most tallies that a block of a task can bring back.
pub(super) fn most_tallies(region: Rect, samples: &Range<u64>) -> u64 {
    let runs = (samples.end - samples.start) / u64::from(RUN_LENGTH) + 2;
    (region.area() as u64)
        .saturating_mul(runs)
        .min(MOST_TALLIES)
}

/// Hands out blocks until every pixel of a region has every sample of a range.
///
/// Samples advance in bands: within a band the region is covered once, from the top.
#[derive(Clone, Debug)]
pub struct Plan {
    region: Rect,
    samples: Range<u64>,
    /// Samples of the band in hand; empty before the first.
    band: Range<u64>,
    /// The pixel at which the next block starts, counted row by row in the region.
    next_pixel: u64,
    pace: Pace,
    /// Whether bands end where somebody looks at the error.
    looks: bool,
}

impl Plan {
    pub fn new(region: Rect, samples: Range<u64>) -> Self {
        let band = samples.start..samples.start;
        Self {
            region,
            samples,
            band,
            next_pixel: 0,
            pace: Pace::unknown(),
            looks: false,
        }
    }

    /// What is left where some samples have been taken: `counts` are those of each pixel, row by row. None
    /// where no plan can have left them so.
    pub fn resume(region: Rect, samples: Range<u64>, counts: &[u64]) -> Option<Self> {
        let (low, high) = (*counts.iter().min()?, *counts.iter().max()?);
        let done = counts.iter().take_while(|count| **count == high).count();
        let in_order = counts[done..].iter().all(|count| *count == low);
        let [start, end] = [low, high].map(|count| samples.start.checked_add(count));
        let (start, end) = (start?, end?);
        let whole = |index: u64| {
            index == samples.start
                || index == samples.end
                || index.is_multiple_of(u64::from(RUN_LENGTH))
        };
        let fits = counts.len() == region.area() && end <= samples.end && end - start <= MOST_BAND;
        if !(in_order && fits && whole(start) && whole(end)) {
            return None;
        }
        let next_pixel = if low == high { 0 } else { done as u64 };
        // Where all have the same, the band in hand is done.
        let band = if low == high { end..end } else { start..end };
        Some(Self {
            band,
            next_pixel,
            ..Self::new(region, samples)
        })
    }

    /// The plan with bands that end wherever somebody looks at the error.
    pub fn with_looks(self) -> Self {
        Self {
            looks: true,
            ..self
        }
    }

    /// A plan whose blocks take at most `budget` samples (but at least one run of one pixel)
    /// however fast they are: for tests that the split does not matter.
    pub fn with_budget(region: Rect, samples: Range<u64>, budget: u64) -> Self {
        Self {
            pace: Pace::fixed(budget),
            ..Self::new(region, samples)
        }
    }

    /// Learns how long a block took.
    pub fn learn(&mut self, block: &Block, took: Duration) {
        let is_first = block.first_sample == self.samples.start;
        self.pace.learn(block, took, is_first);
    }

    /// What it knows of the device's speed.
    pub(super) fn pace(&self) -> Pace {
        self.pace
    }

    /// The next block, or nothing when all is done.
    pub fn next_block(&mut self) -> Option<Block> {
        if self.next_pixel == 0 {
            self.open_band()?;
        }
        let samples = self.band.end - self.band.start;
        let runs = samples.div_ceil(u64::from(RUN_LENGTH)).max(1) + 1;
        let most = (self.pace.budget / samples).clamp(1, MOST_TALLIES / runs);
        let rect = self.take_pixels(most);
        let block = Block {
            rect,
            first_sample: self.band.start,
            samples: samples as u32,
        };
        if self.next_pixel == self.region.area() as u64 {
            self.next_pixel = 0;
        }
        Some(block)
    }

    /// Chooses how many samples the next band takes: whole runs, more of them where the region is
    /// small for the budget.
    fn open_band(&mut self) -> Option<()> {
        let start = self.band.end;
        if start >= self.samples.end || self.region.area() == 0 {
            return None;
        }
        let run = u64::from(RUN_LENGTH);
        let pixels = (self.region.area() as u64).min(WIDE);
        let affordable = self.pace.budget / pixels;
        let whole = self.pace.budget / self.region.area() as u64;
        let wanted = affordable.min(LONG).max(whole).clamp(run, MOST_BAND);
        let mut end = (start / run)
            .saturating_add(wanted / run)
            .saturating_mul(run);
        if self.looks {
            end = end.min(look::next(&self.samples, start));
        }
        self.band = start..end.min(self.samples.end);
        Some(())
    }

    /// A rectangle of at most `most` pixels from the next one on: whole rows where they fit, else
    /// part of a row.
    fn take_pixels(&mut self, most: u64) -> Rect {
        let width = u64::from(self.region.width());
        let (row, column) = (self.next_pixel / width, self.next_pixel % width);
        let (wide, high) = if column == 0 && most >= width {
            (
                width,
                (most / width).min(u64::from(self.region.height()) - row),
            )
        } else {
            (most.min(width - column), 1)
        };
        self.next_pixel += wide * high;
        let (x0, y0) = (self.region.x0 + column as u32, self.region.y0 + row as u32);
        Rect {
            x0,
            y0,
            x1: x0 + wide as u32,
            y1: y0 + high as u32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::pace::TARGET;
    use super::*;

    /// Every sample of every pixel is taken once, in order, however the plan is driven.
    fn covers(
        mut plan: Plan,
        region: Rect,
        samples: Range<u64>,
        took: impl Fn(&Block) -> Duration,
    ) {
        let mut next = vec![samples.start; region.area()];
        while let Some(block) = plan.next_block() {
            for y in block.rect.y0..block.rect.y1 {
                for x in block.rect.x0..block.rect.x1 {
                    let pixel = (y - region.y0) as usize * region.width() as usize
                        + (x - region.x0) as usize;
                    assert_eq!(next[pixel], block.first_sample, "pixel {x},{y}");
                    next[pixel] += u64::from(block.samples);
                    let end = next[pixel];
                    assert!(
                        end == samples.end || end.is_multiple_of(u64::from(RUN_LENGTH)),
                        "band ends at {end}"
                    );
                }
            }
            plan.learn(&block, took(&block));
        }
        assert!(next.iter().all(|end| *end == samples.end));
    }

    #[test]
    fn every_sample_is_taken_once_and_in_order() {
        let region = Rect {
            x0: 3,
            y0: 5,
            x1: 40,
            y1: 29,
        };
        for samples in [
            0..1,
            0..64,
            7..23,
            5..1000,
            u64::from(u32::MAX) - 9..u64::from(u32::MAX) + 40,
        ] {
            for budget in [1, 16, 17, 500, 100_000] {
                covers(
                    Plan::with_budget(region, samples.clone(), budget),
                    region,
                    samples.clone(),
                    |_| TARGET,
                );
            }
            for nanoseconds in [1, 100, 100_000] {
                let took = |block: &Block| Duration::from_nanos(block.paths() * nanoseconds);
                covers(
                    Plan::new(region, samples.clone()),
                    region,
                    samples.clone(),
                    took,
                );
            }
        }
    }

    /// Wherever a render stops, the rest of it takes every other sample once.
    #[test]
    fn a_plan_goes_on_where_another_stopped() {
        let region = Rect {
            x0: 3,
            y0: 5,
            x1: 14,
            y1: 12,
        };
        for samples in [0..1, 7..100, 0..64] {
            for blocks in 0.. {
                let mut plan = Plan::with_budget(region, samples.clone(), 500);
                let mut counts = vec![0; region.area()];
                let taken = (0..blocks)
                    .map_while(|_| plan.next_block())
                    .collect::<Vec<_>>();
                for block in &taken {
                    for y in block.rect.y0..block.rect.y1 {
                        for x in block.rect.x0..block.rect.x1 {
                            let place = (y - region.y0) * region.width() + (x - region.x0);
                            counts[place as usize] += u64::from(block.samples);
                        }
                    }
                }
                let mut rest = Plan::resume(region, samples.clone(), &counts).unwrap();
                let paths: u64 = std::iter::from_fn(|| rest.next_block())
                    .map(|block| block.paths())
                    .sum();
                let all = region.area() as u64 * (samples.end - samples.start);
                assert_eq!(paths + counts.iter().sum::<u64>(), all);
                let mut next = Plan::resume(region, samples.clone(), &counts).unwrap();
                if let Some(block) = next.next_block() {
                    let corner =
                        (block.rect.y0 - region.y0) * region.width() + block.rect.x0 - region.x0;
                    assert_eq!(samples.start + counts[corner as usize], block.first_sample);
                }
                if taken.len() < blocks {
                    break;
                }
            }
        }
    }

    #[test]
    fn what_no_plan_leaves_is_refused() {
        let region = Rect {
            x0: 0,
            y0: 0,
            x1: 2,
            y1: 2,
        };
        let resume = |counts: &[u64]| Plan::resume(region, 0..64, counts);
        assert!(resume(&[32, 16, 16, 16]).is_some());
        assert!(resume(&[16, 32, 16, 16]).is_none(), "out of order");
        assert!(resume(&[48, 32, 16, 16]).is_none(), "three counts");
        assert!(resume(&[16, 16, 16]).is_none(), "another size");
        assert!(resume(&[80, 80, 80, 80]).is_none(), "too many");
        assert!(resume(&[17, 17, 17, 17]).is_none(), "a broken run");
        assert!(resume(&[u64::MAX, 0, 0, 0]).is_none(), "beyond all numbers");
        assert!(resume(&[64; 4]).is_some_and(|mut plan| plan.next_block().is_none()));
    }

    #[test]
    fn bands_end_where_somebody_looks() {
        let region = Rect {
            x0: 0,
            y0: 0,
            x1: 8,
            y1: 8,
        };
        let mut plan = Plan::with_budget(region, 5..1000, 1 << 20).with_looks();
        let ends: Vec<u64> = std::iter::from_fn(|| plan.next_block())
            .map(|block| block.first_sample + u64::from(block.samples))
            .collect();
        assert_eq!(ends[..3], [80, 96, 112]);
        assert_eq!(ends.last(), Some(&1000));
    }

    #[test]
    fn blocks_stay_near_the_target_once_the_rate_is_known() {
        let region = Rect {
            x0: 0,
            y0: 0,
            x1: 1024,
            y1: 768,
        };
        let mut plan = Plan::new(region, 0..512);
        let mut longest = Duration::ZERO;
        while let Some(block) = plan.next_block() {
            let took = Duration::from_nanos(block.paths() * 300);
            longest = longest.max(took);
            plan.learn(&block, took);
        }
        assert!(longest <= TARGET + TARGET / 10, "{longest:?}");
    }

    /// A picture whose lower half is nine times as slow as the sky, with two blocks on their way.
    #[test]
    fn no_block_is_long_where_pixels_differ() {
        let region = Rect {
            x0: 0,
            y0: 0,
            x1: 640,
            y1: 480,
        };
        let cost = |y: u32| if y < 240 { 100 } else { 900 };
        let took = |block: &Block| {
            let row = u64::from(block.rect.width()) * u64::from(block.samples);
            let rows = block.rect.y0..block.rect.y1;
            Duration::from_nanos(rows.map(|y| row * cost(y)).sum())
        };
        let mut plan = Plan::new(region, 0..4096);
        let mut started = std::collections::VecDeque::new();
        let (mut first, mut later) = (Duration::ZERO, Vec::new());
        while let Some(block) = plan.next_block() {
            started.push_back(block);
            if started.len() < 2 {
                continue;
            }
            let done = started.pop_front().unwrap();
            let time = took(&done);
            if done.first_sample == 0 {
                first = first.max(time);
            } else {
                later.push(time);
            }
            plan.learn(&done, time);
        }
        assert!(first <= Duration::from_millis(500), "{first:?}");
        // Many fast blocks forget the slow ones: the picture comes round again before they quite have.
        let longest = later.iter().max().unwrap();
        assert!(*longest <= Duration::from_millis(500), "{longest:?}");
        let mean = later.iter().sum::<Duration>() / later.len() as u32;
        assert!(
            mean >= TARGET / 5,
            "dispatches are long enough to be worth it: {mean:?}"
        );
    }
}
