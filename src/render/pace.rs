//! How many samples a block may take, so that it takes about as long as it should.

use crate::device::Block;
use std::time::Duration;

/// How long a dispatch should take.
pub(super) const TARGET: Duration = Duration::from_millis(150);
/// Samples of the first dispatch, before anything is known of the scene's cost: a scene would have to
/// be a hundred thousand times as slow as a Cornell box on a software driver to make it take half a
/// second.
const FIRST_BUDGET: u64 = 64;
/// From one dispatch to the next the plan grows at most by this factor: pixels differ in cost.
const GROWTH: u64 = 16;
/// How long a dispatch should take in the first band, where some pixels' cost is not known yet: those of a ball
/// of mirrors may be ten times that of the sky over it.
const FIRST_TARGET: Duration = Duration::from_millis(50);
/// A block that takes less says more of the host than of its pixels.
const TELLING: Duration = Duration::from_millis(20);
/// The slowest pixels so far set the pace; how much of that is left after each block, in case something else
/// held the machine up.
const MEMORY: f64 = 0.9;

/// What is known of a device's speed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// Samples that the next block may take.
    pub budget: u64,
    /// Seconds a path of the slowest blocks, forgetting.
    slowest: f64,
    /// Blocks of exactly this many samples, whatever time they take.
    fixed: bool,
}

impl Pace {
    /// Nothing is known yet.
    pub fn unknown() -> Self {
        Self {
            budget: FIRST_BUDGET,
            slowest: 0.0,
            fixed: false,
        }
    }

    /// Always this many samples, at least one.
    pub fn fixed(budget: u64) -> Self {
        Self {
            budget: budget.max(1),
            fixed: true,
            ..Self::unknown()
        }
    }

    /// Learns how long a block took. `is_first` is whether its pixels' cost was not known before.
    pub fn learn(&mut self, block: &Block, took: Duration, is_first: bool) {
        if self.fixed {
            return;
        }
        let pace = took.as_secs_f64().max(1e-6) / block.paths() as f64;
        if took >= TELLING {
            self.slowest = pace.max(self.slowest * MEMORY);
        }
        let target = if is_first { FIRST_TARGET } else { TARGET };
        let wanted = (target.as_secs_f64() / pace.max(self.slowest)) as u64;
        self.budget = wanted.clamp(1, block.paths().saturating_mul(GROWTH));
    }
}
