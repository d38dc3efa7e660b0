//! Blocks on a device: cut into the pieces that it can take, and submitted ahead of being asked for.

use super::device::{Gpu, Work, tiles};
use super::flight::Flight;
use super::pieces::{Gathered, pieces};
use crate::device::{Block, IN_FLIGHT, Traced, runs};
use crate::error::{Error, Result};
use crate::pack::Tally;
use crate::shader::Kernel;
use std::collections::VecDeque;
use std::time::Duration;

/// Blocks that were started, and what is left to do for them, in order.
#[derive(Debug, Default)]
pub(super) struct Queue {
    pub(super) blocks: VecDeque<Block>,
    /// Their pieces that were not yet submitted.
    pub(super) waiting: VecDeque<Block>,
    pub(super) flying: VecDeque<Flight>,
}

impl Gpu {
    /// Submits samples as one dispatch. Lanes that take too many steps write no tallies.
    fn launch_piece(&mut self, piece: Block) -> Result<Flight> {
        let loaded = self.scene()?;
        let rect = piece.rect;
        let mut job = loaded.packed.job(rect, piece.first_sample, piece.samples);
        job.steps = loaded.allowance.steps(job.steps, rect);
        let (strategy, arrays) = (loaded.packed.strategy, loaded.arrays);
        let baked = loaded.baked.clone();
        let pipeline = self.pipeline(Kernel::Trace, &strategy, Some(arrays), baked.as_deref())?;
        let count = rect.area() * runs(piece.first_sample, piece.samples) as usize;
        self.launch(&Work {
            pipeline: &pipeline,
            scene: true,
            inputs: &[(bytemuck::bytes_of(&job), wgpu::BufferUsages::UNIFORM)],
            groups: tiles(rect),
            bytes: (count * size_of::<Tally>()) as u64,
            paths: Some(piece.paths()),
        })
    }

    /// Submits what waits, as far as the device's own queue should be filled.
    pub(super) fn launch_waiting(&mut self) -> Result<()> {
        while self.queue.flying.len() < IN_FLIGHT
            && let Some(piece) = self.queue.waiting.pop_front()
        {
            let flight = self.launch_piece(piece)?;
            self.queue.flying.push_back(flight);
        }
        Ok(())
    }

    /// The tallies of the oldest block; later ones are submitted meanwhile.
    pub(super) fn finish_oldest(&mut self) -> Result<Traced> {
        let none = || Error::Internal("no block was started".into());
        let block = self.queue.blocks.pop_front().ok_or_else(none)?;
        let most = self.scene()?.allowance.samples;
        let mut gathered = Gathered::new(block.rect.area());
        let mut took = Duration::ZERO;
        for piece in pieces(block, most) {
            self.launch_waiting()?;
            let flight = self.queue.flying.pop_front().ok_or_else(none)?;
            let (tallies, time) = self.land(flight)?;
            self.launch_waiting()?;
            took += time;
            let tallies = self.mend(piece, tallies, &mut took)?;
            gathered.add(piece.first_sample, piece.samples, &tallies);
        }
        Ok(Traced {
            tallies: gathered.tallies,
            took,
        })
    }

    /// Forgets all that was started: after an error nobody will ask for it.
    pub(super) fn throw_away<T>(&mut self, error: Error) -> Result<T> {
        self.queue = Queue::default();
        Err(error)
    }

    /// Traces again what lanes left undone, pixels without tallies: first each alone, where it may take
    /// as many iterations as a group of lanes otherwise, then in halves. A run is broken only where it
    /// is too long for a lane alone, so that the picture does not depend on how the work was split.
    fn mend(
        &mut self,
        piece: Block,
        mut tallies: Vec<Tally>,
        took: &mut Duration,
    ) -> Result<Vec<Tally>> {
        let area = piece.rect.area();
        for pixel in 0..area {
            // Every sample takes a ray: a tally without one was never written.
            let mut of_pixel = tallies.iter().skip(pixel).step_by(area);
            if of_pixel.all(|tally| tally.rays > 0) {
                continue;
            }
            let alone = area == 1;
            if self.scene()?.packed.hierarchy.is_none() || (alone && piece.samples == 1) {
                return Err(self.cut_short("a path took too many steps"));
            }
            let most = match alone {
                true => piece.samples.next_power_of_two() / 2,
                false => 1 << 31,
            };
            let rect = piece.rect.pixel(pixel);
            let whole = self.trace_again(Block { rect, ..piece }, most, took)?;
            for (run, tally) in whole.into_iter().enumerate() {
                tallies[run * area + pixel] = tally;
            }
        }
        Ok(tallies)
    }

    pub(super) fn trace_again(
        &mut self,
        block: Block,
        most: u32,
        took: &mut Duration,
    ) -> Result<Vec<Tally>> {
        let mut gathered = Gathered::new(block.rect.area());
        for piece in pieces(block, most) {
            let flight = self.launch_piece(piece)?;
            let (tallies, time) = self.land(flight)?;
            *took += time;
            let tallies = self.mend(piece, tallies, took)?;
            gathered.add(piece.first_sample, piece.samples, &tallies);
        }
        Ok(gathered.tallies)
    }

    pub(super) fn cut_short(&self, what: &str) -> Error {
        Error::Device(format!(
            "the device {} stops a kernel after 65,535 loop iterations, and {what}; use --device cpu or a smaller scene or render.max_bounces",
            self.info.name
        ))
    }
}
