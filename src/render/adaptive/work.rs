//! Which samples each dispatch of an adaptive render takes. As in a [`super::super::Plan`], the picture never
//! depends on it.

use super::super::pace::Pace;
use super::super::plan::{LONG, MOST_TALLIES};
use super::rungs;
use crate::device::Block;
use crate::film::Tiles;
use crate::pack::{RUN_LENGTH, Rect};
use std::ops::Range;
use std::time::Duration;

/// Fewest pixels of a block, where samples can be left for later.
const FEWEST: u64 = 64;

/// Samples that each pixel is to have.
#[derive(Clone, Debug)]
pub enum Goals {
    /// By tiles.
    Tiles(Tiles, Vec<u64>),
    /// Row by row.
    Pixels(Vec<u64>),
}

impl Goals {
    fn of(&self, pixel: usize) -> u64 {
        match self {
            Self::Tiles(tiles, counts) => counts[tiles.of_pixel(pixel)],
            Self::Pixels(counts) => counts[pixel],
        }
    }

    fn highest(&self) -> Option<u64> {
        let (Self::Tiles(_, counts) | Self::Pixels(counts)) = self;
        counts.iter().copied().max()
    }
}

/// Hands out blocks until every pixel has as many samples as it is to have.
///
/// The picture's pixels advance together, from one level to twice as many samples: a render that is stopped has no
/// part that lags far behind. On each level the pixels that are to go from the same count to the same count are
/// covered by rectangles, each as wide as it can be and then as high. So all tiles that go on to the next level
/// share dispatches with their neighbours, and each has a dispatch of its own, a long one, where it ends at most.
#[derive(Clone, Debug)]
pub struct Work {
    region: Rect,
    /// The samples that there are.
    samples: Range<u64>,
    wanted: Goals,
    /// Of each pixel, samples that were handed out.
    taken: Vec<u64>,
    /// Where pixels go now, samples.
    level: u64,
    /// The pixel from which on one is looked for.
    cursor: usize,
    pub(in super::super) pace: Pace,
}

impl Work {
    /// `taken` are the samples that pixels have already, `wanted` those that they are to have; `level` is the first.
    pub(in super::super) fn new(
        region: Rect,
        samples: Range<u64>,
        taken: Vec<u64>,
        wanted: Goals,
        level: u64,
    ) -> Self {
        Self {
            region,
            level,
            samples,
            wanted,
            taken,
            cursor: 0,
            pace: Pace::unknown(),
        }
    }

    /// Whether there is nothing to do.
    pub(in super::super) fn is_empty(&self) -> bool {
        let short = |(pixel, taken): (usize, &u64)| *taken < self.wanted.of(pixel);
        !self.taken.iter().enumerate().any(short)
    }

    /// Whether it can be the rest of such work: no pixel has more than it is to have, nor a part of a run.
    pub(in super::super) fn is_possible(&self) -> bool {
        let fits = |(pixel, count): (usize, &u64)| {
            *count <= self.wanted.of(pixel)
                && (*count == 0 || rungs::whole(&self.samples, *count) == *count)
        };
        self.taken.iter().enumerate().all(fits)
    }

    /// Learns how long a block took.
    pub(in super::super) fn learn(&mut self, block: &Block, took: Duration) {
        let is_first = block.first_sample == self.samples.start;
        self.pace.learn(block, took, is_first);
    }

    /// Samples that a pixel is to have on this level.
    fn goal(&self, pixel: usize) -> u64 {
        rungs::whole(&self.samples, self.level).min(self.wanted.of(pixel))
    }

    /// The next block, or nothing when all is done.
    pub(in super::super) fn next_block(&mut self) -> Option<Block> {
        let highest = self.wanted.highest()?;
        let first = loop {
            let found =
                (self.cursor..self.taken.len()).find(|&pixel| self.taken[pixel] < self.goal(pixel));
            if found.is_some() {
                break found?;
            }
            // What was cut short on this level is below the goal still.
            if self.cursor > 0 {
                self.cursor = 0;
            } else if self.level < highest {
                self.level = self.level.saturating_mul(2);
            } else {
                return None;
            }
        };
        self.cursor = first + 1;
        Some(self.take(first))
    }

    /// Hands out a rectangle of pixels from one on.
    fn take(&mut self, first: usize) -> Block {
        let samples = self.samples_of(first);
        let runs = samples.div_ceil(u64::from(RUN_LENGTH)) + 1;
        let most = (self.pace.budget / samples).clamp(1, MOST_TALLIES / runs) as usize;
        let alike = |pixel: &usize| {
            self.taken[*pixel] == self.taken[first] && self.goal(*pixel) == self.goal(first)
        };
        let width = self.region.width() as usize;
        let of_row = (first..first + width - first % width).take(most);
        let wide = of_row.take_while(alike).count();
        let rows = (first..self.taken.len()).step_by(width).take(most / wide);
        let high = rows
            .take_while(|start| (*start..start + wide).all(|pixel| alike(&pixel)))
            .count();
        let first_sample = self.samples.start + self.taken[first];
        for row in 0..high {
            let start = first + row * width;
            self.taken[start..start + wide]
                .iter_mut()
                .for_each(|taken| *taken += samples);
        }
        let (x0, y0) = (
            self.region.x0 + (first % width) as u32,
            self.region.y0 + (first / width) as u32,
        );
        let (x1, y1) = (x0 + wide as u32, y0 + high as u32);
        Block {
            rect: Rect { x0, y0, x1, y1 },
            first_sample,
            samples: samples as u32,
        }
    }

    /// Samples of each pixel that the next block takes: to the pixel's goal, or whole runs of what is affordable.
    fn samples_of(&self, pixel: usize) -> u64 {
        let run = u64::from(RUN_LENGTH);
        let from = self.samples.start + self.taken[pixel];
        let goal = self.samples.start + self.goal(pixel);
        let affordable = (self.pace.budget / FEWEST).clamp(run, LONG * LONG);
        let end = (from + affordable) / run * run;
        end.min(goal) - from
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REGION: Rect = Rect {
        x0: 5,
        y0: 7,
        x1: 261,
        y1: 253,
    };

    /// What tiles may want: anything up to a few thousand, in no order.
    fn wants(samples: &Range<u64>) -> Vec<u64> {
        let tiles = Tiles::of(REGION).count();
        let rung = |tile: usize| rungs::reach(0, (tile * 7919 % 1500) as f64, 1 << 40);
        (0..tiles)
            .map(|tile| rungs::whole(samples, rungs::at(rung(tile))))
            .collect()
    }

    /// Every sample of every pixel that is wanted is taken once, in order, and runs end where they should.
    #[test]
    fn every_sample_is_taken_once_and_in_order() {
        for (samples, budget) in [(0..1 << 40, 1 << 20), (5..1 << 40, 5000), (9..640, 70_000)] {
            let wanted = wants(&samples);
            let mut next = vec![0; REGION.area()];
            let tiles = Tiles::of(REGION);
            let goals = Goals::Tiles(tiles, wanted.clone());
            let mut work = Work::new(REGION, samples.clone(), next.clone(), goals, 32);
            work.pace = Pace::fixed(budget);
            while let Some(block) = work.next_block() {
                assert!(block.paths() <= budget.max(16 * 64), "{block:?}");
                for y in block.rect.y0..block.rect.y1 {
                    for x in block.rect.x0..block.rect.x1 {
                        let pixel = (y - REGION.y0) * REGION.width() + x - REGION.x0;
                        let count = &mut next[pixel as usize];
                        assert_eq!(samples.start + *count, block.first_sample);
                        *count += u64::from(block.samples);
                        assert_eq!(rungs::whole(&samples, *count), *count, "a broken run");
                    }
                }
            }
            assert!((0..next.len()).all(|pixel| next[pixel] == wanted[tiles.of_pixel(pixel)]));
            assert!(work.is_empty());
        }
    }

    /// Even where no two neighbours want the same there are only a few more blocks than tiles.
    #[test]
    fn blocks_are_few() {
        let samples = 0..1 << 40;
        let wanted = wants(&samples);
        let tiles = wanted.len();
        let goals = Goals::Tiles(Tiles::of(REGION), wanted);
        let mut work = Work::new(REGION, samples, vec![0; REGION.area()], goals, 32);
        work.pace = Pace::fixed(u64::MAX);
        let blocks = std::iter::from_fn(|| work.next_block()).count();
        assert!(blocks <= 5 * tiles / 2, "{blocks} blocks of {tiles} tiles");
    }
}
