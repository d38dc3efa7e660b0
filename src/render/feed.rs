//! The thread that a device lives on while it renders: it alone calls the device, and keeps it busy.

use super::adaptive::Work;
use super::pace::Pace;
use super::{Plan, Task};
use crate::device::{Block, Device, IN_FLIGHT, Traced};
use crate::error::Result;
use crate::pack::{Feature, Rect};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender};
use std::time::{Duration, Instant};

/// First hits that one call asks for.
const MOST_FEATURES: u32 = 1 << 20;

/// What comes back.
pub(super) enum Fed {
    /// The scene is on the device, compiled, in this time; first hits, where they are wanted.
    Loaded {
        setup: Duration,
        features: Option<Vec<Feature>>,
    },
    Traced(Block, Traced),
    /// All work so far is done, and more may follow from it.
    Spent,
}

/// Where blocks come from.
pub(super) enum Supply {
    /// One plan, which is all.
    Plan(Plan),
    /// One piece of work after another, each after the last was said to be spent.
    Works(Pace, Receiver<Work>),
}

/// Blocks in their order, from either.
trait Blocks {
    fn next_block(&mut self) -> Option<Block>;
    fn learn(&mut self, block: &Block, took: Duration);
}

impl Blocks for Plan {
    fn next_block(&mut self) -> Option<Block> {
        self.next_block()
    }

    fn learn(&mut self, block: &Block, took: Duration) {
        self.learn(block, took);
    }
}

impl Blocks for Work {
    fn next_block(&mut self) -> Option<Block> {
        self.next_block()
    }

    fn learn(&mut self, block: &Block, took: Duration) {
        self.learn(block, took);
    }
}

/// Loads a task's scene and traces what is supplied, until nobody listens any more or there is enough.
pub(super) fn feed(
    device: &mut dyn Device,
    task: &Task,
    wants_features: bool,
    supply: Supply,
    send: SyncSender<Fed>,
    enough: &AtomicBool,
) -> Result<()> {
    let began = Instant::now();
    device.load(&task.packed())?;
    let features = wants_features
        .then(|| features(device, task.region))
        .transpose()?;
    let setup = began.elapsed();
    if send.send(Fed::Loaded { setup, features }).is_err() {
        return Ok(());
    }
    match supply {
        Supply::Plan(mut plan) => trace(device, &mut plan, &send, enough).map(|_| ()),
        Supply::Works(mut pace, works) => {
            while send.send(Fed::Spent).is_ok()
                && let Ok(mut work) = works.recv()
            {
                work.pace = pace;
                if !trace(device, &mut work, &send, enough)? {
                    break;
                }
                pace = work.pace;
            }
            Ok(())
        }
    }
}

/// Traces all blocks; whether anybody wanted them all. Blocks are started before the one in hand is done, so that
/// the device never waits.
fn trace(
    device: &mut dyn Device,
    blocks: &mut dyn Blocks,
    send: &SyncSender<Fed>,
    enough: &AtomicBool,
) -> Result<bool> {
    let mut started = VecDeque::new();
    while !enough.load(Ordering::SeqCst) {
        while started.len() < IN_FLIGHT
            && let Some(block) = blocks.next_block()
        {
            device.start(block)?;
            started.push_back(block);
        }
        let Some(block) = started.pop_front() else {
            return Ok(true);
        };
        let traced = device.finish()?;
        blocks.learn(&block, traced.took);
        if send.send(Fed::Traced(block, traced)).is_err() {
            break;
        }
    }
    Ok(false)
}

/// First hits of a rectangle, by strips that fit a device's buffers.
fn features(device: &mut dyn Device, rect: Rect) -> Result<Vec<Feature>> {
    let rows = (MOST_FEATURES / rect.width().max(1)).max(1);
    let mut all = Vec::with_capacity(rect.area());
    for y0 in (rect.y0..rect.y1).step_by(rows as usize) {
        let y1 = rect.y1.min(y0.saturating_add(rows));
        all.extend(device.features(Rect { y0, y1, ..rect })?);
    }
    Ok(all)
}
