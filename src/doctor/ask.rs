//! How the device is asked.

use super::memory::{known_job, known_scenes};
use super::picture::furnace;
use crate::device::{Device, Limits};
use crate::error::Result;
use crate::knobs::Choice;
use crate::pack::{CanaryJob, CanaryScene, Packed, Tally};
use crate::shader::Canary;

/// A device that is asked, with all that asking takes.
pub struct Ask<'a> {
    device: &'a mut dyn Device,
    pub limits: Option<Limits>,
    job: CanaryJob,
    scenes: Vec<CanaryScene>,
    furnace: Packed,
}

impl<'a> Ask<'a> {
    pub fn new(device: &'a mut dyn Device) -> Result<Self> {
        Ok(Self {
            limits: device.limits()?,
            device,
            job: known_job(),
            scenes: known_scenes(),
            furnace: Packed::new(&furnace()?),
        })
    }

    /// A canary's answers, four words an input; none where it says nothing of this device.
    pub fn canary(&mut self, canary: Canary, inputs: &[[u32; 4]]) -> Result<Option<Vec<u32>>> {
        let job = CanaryJob {
            canary: canary.index(),
            ..self.job
        };
        let strategy = &self.furnace.strategy;
        let answers = self.device.canary(strategy, &job, &self.scenes, inputs)?;
        Ok(answers.map(|rows| rows.concat()))
    }

    /// The tiny picture, by the kernel that makes every other.
    pub fn furnace(&mut self, samples: u32) -> Result<Vec<Tally>> {
        let rect = super::picture::whole();
        self.device.load(&self.furnace)?;
        self.device.trace(rect, 0, samples)
    }
}
