//! A render on its way, and what it gave.

use super::adaptive::{self, Work};
use super::feed::Fed;
use super::{Task, look};
use crate::device::DeviceInfo;
use crate::film::{Checkpoint, Film, SCOUTS, Scouts, Stop};
use crate::pack::Feature;
use std::ops::Range;
use std::time::Duration;

/// A render that a checkpoint says took longer than three hundred years did not.
const LONGEST_EVER: Duration = Duration::from_secs(10_000_000_000);

/// What has been rendered of a task so far.
#[derive(Clone, Debug)]
pub struct Rendering {
    pub film: Film,
    /// What decides where samples go; none where all pixels get the same.
    pub scouts: Option<Scouts>,
    pub features: Option<Vec<Feature>>,
    /// Why it ended before its last sample, if it did.
    pub stopped: Option<Stop>,
    /// Everything that took part, the first first.
    pub devices: Vec<DeviceInfo>,
    /// Getting the scene onto the device and compiling.
    pub setup: Duration,
    /// Tracing alone.
    pub tracing: Duration,
    /// The longest that the device was at one block.
    pub longest: Duration,
    /// Paths of the whole task.
    pub total: u64,
    samples: Range<u64>,
}

impl Rendering {
    /// A rendering of which nothing is done.
    pub fn new(task: &Task) -> Self {
        Self {
            film: task.film(),
            scouts: task.terms().map(|terms| terms.scouts(task.region)),
            features: None,
            stopped: None,
            devices: Vec::new(),
            setup: Duration::ZERO,
            tracing: Duration::ZERO,
            longest: Duration::ZERO,
            total: task.paths(),
            samples: task.samples.clone(),
        }
    }

    /// What a checkpoint of this task holds; none where it cannot be one of this task.
    pub fn of_checkpoint(task: &Task, checkpoint: Checkpoint) -> Option<Self> {
        let Checkpoint {
            record,
            film,
            scouts,
            ..
        } = checkpoint;
        // Times are added to, which must not be more than a clock can hold.
        let possible = |time: &Duration| *time < LONGEST_EVER;
        let seconds = |value| {
            let time = Duration::try_from_secs_f64(value).ok();
            time.filter(possible)
        };
        let rendering = Self {
            devices: record.all_devices(),
            setup: seconds(record.seconds.setup)?,
            tracing: seconds(record.seconds.render)?,
            longest: seconds(record.seconds.longest_block)?,
            film,
            scouts,
            ..Self::new(task)
        };
        let sets = |film: &Film| {
            let all = film.randomisations.as_ref();
            all.map(|all| (all.length, all.pictures.is_some()))
        };
        let fits = sets(&rendering.film) == sets(&task.film());
        (fits && task.rest(&rendering).is_ok()).then_some(rendering)
    }

    /// Whether every sample that was asked for has been taken.
    pub fn complete(&self) -> bool {
        self.film.paths == self.total
    }

    /// Paths that were traced, those of scouts included.
    pub fn traced(&self) -> u64 {
        let scouts = self.scouts.as_ref().map_or(0, |scouts| scouts.film.paths);
        self.film.paths.saturating_add(scouts)
    }

    /// Paths that are to be traced at most, as far as it is known.
    pub fn length(&self) -> u64 {
        let pixels = self.film.counts.len() as u64;
        let asked = self.scouts.as_ref().map_or(0, |scouts| scouts.asked);
        self.total.saturating_add(asked.saturating_mul(pixels))
    }

    /// How much of it is done, 0 to 1.
    pub fn share(&self) -> f64 {
        self.traced() as f64 / self.length().max(1) as f64
    }

    /// Another device goes on with it.
    pub(super) fn begin(&mut self, device: &DeviceInfo) {
        if !self.devices.iter().any(|known| known.is_like(device)) {
            self.devices.push(device.clone());
        }
        self.stopped = None;
    }

    /// Adds what came from the device; whether it is time to look at the error.
    pub(super) fn add(&mut self, fed: Fed) -> bool {
        match fed {
            Fed::Loaded { setup, features } => {
                self.setup += setup;
                self.features = features.or(self.features.take());
                false
            }
            Fed::Spent => false,
            Fed::Traced(block, traced) => {
                self.tracing += traced.took;
                self.longest = self.longest.max(traced.took);
                if let Some(scouts) = &mut self.scouts {
                    let scouting = block.first_sample >= SCOUTS;
                    let film = if scouting {
                        &mut scouts.film
                    } else {
                        &mut self.film
                    };
                    film.add_block(&block, &traced.tallies);
                    return false;
                }
                self.film.add_block(&block, &traced.tallies);
                let end = block.first_sample + u64::from(block.samples);
                let pixels = self.film.region.area() as u64;
                let of_all = pixels.saturating_mul(end - self.samples.start);
                let all_have_it = self.film.paths == of_all;
                all_have_it && look::next(&self.samples, end - 1) == end
            }
        }
    }

    /// Whether the error is as small as the task wants it.
    pub(super) fn reached(&self, task: &Task) -> bool {
        task.target_error
            .is_some_and(|target| self.film.relative_error().reaches(target))
    }

    /// What a render that is given its work piece by piece does next, where all before is done; none where that was
    /// all.
    pub(super) fn next_work(&mut self, task: &Task) -> Option<Work> {
        if let Some(work) = task.counted(&self.film) {
            return (!work.is_empty()).then_some(work);
        }
        adaptive::next(&task.terms()?, &self.film, self.scouts.as_mut()?)
    }
}
