//! Dispatches on their way: submitted, and not yet read. While one is traced the next stands in the device's
//! queue, so that the device need not wait for the host.

use super::guard::Guard;
use crate::error::Result;
use std::time::{Duration, Instant};

/// Nothing is known of a scene's first dispatch, nor of one that does not trace: it includes compiling.
const UNKNOWN: Duration = Duration::from_secs(120);
/// A dispatch is given this many times what it is expected to take, but not less than [`LEAST`]: other
/// programs may have the device meanwhile.
const PATIENCE: f64 = 20.0;
const LEAST: Duration = Duration::from_secs(10);

/// The buffers that the results of one dispatch come back in.
#[derive(Debug)]
pub struct Room {
    pub storage: wgpu::Buffer,
    pub staging: wgpu::Buffer,
    bytes: u64,
}

/// Rooms that are free.
#[derive(Debug, Default)]
pub struct Rooms {
    free: Vec<Room>,
}

impl Rooms {
    /// A room for `bytes` of results; one that has become too small is given back.
    pub fn take(&mut self, guard: &Guard, bytes: u64) -> Result<Room> {
        if let Some(place) = self.free.iter().position(|room| room.bytes >= bytes) {
            return Ok(self.free.swap_remove(place));
        }
        self.free.pop();
        let storage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_SRC
            | wgpu::BufferUsages::COPY_DST;
        let staging = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        Ok(Room {
            storage: guard.buffer(bytes, storage)?,
            staging: guard.buffer(bytes, staging)?,
            bytes,
        })
    }

    pub fn give_back(&mut self, room: Room) {
        self.free.push(room);
    }
}

/// A dispatch that was submitted.
#[derive(Debug)]
pub struct Flight {
    pub room: Room,
    /// Of the results.
    pub bytes: u64,
    pub submission: wgpu::SubmissionIndex,
    pub started: Instant,
    /// Paths that it traces; none where that says nothing of its time.
    pub paths: Option<u64>,
}

/// How fast the device goes through the scene in hand: what its dispatches took, and so how long one more may.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pace {
    seconds_per_path: Option<f64>,
    /// When the last dispatch was done.
    last: Option<Instant>,
}

impl Pace {
    /// How long to wait for a dispatch before the device is taken for lost.
    pub fn patience(&self, flight: &Flight) -> Duration {
        match (self.seconds_per_path, flight.paths) {
            (Some(pace), Some(paths)) => {
                let expected =
                    (pace * paths as f64 * PATIENCE).min(UNKNOWN.as_secs_f64() * PATIENCE);
                LEAST.max(Duration::from_secs_f64(expected))
            }
            _ => UNKNOWN,
        }
    }

    /// The dispatch is done: how long the device was at it, its wait for the one before left out.
    pub fn landed(&mut self, started: Instant, paths: Option<u64>) -> Duration {
        let now = Instant::now();
        let began = self.last.map_or(started, |last| last.max(started));
        let took = now - began;
        self.last = Some(now);
        if let Some(paths) = paths.filter(|paths| *paths > 0) {
            let found = took.as_secs_f64() / paths as f64;
            // The slowest so far: parts of a picture differ in cost.
            self.seconds_per_path = Some(self.seconds_per_path.map_or(found, |old| old.max(found)));
        }
        took
    }

    /// Another scene is loaded: nothing is known of it.
    pub fn forget(&mut self) {
        self.seconds_per_path = None;
    }
}
