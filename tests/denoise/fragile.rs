//! Devices that fail.

use lampray::cpu::{Cpu, denoise::pass};
use lampray::device::{Block, Device, DeviceInfo, DeviceKind, Limits, Traced};
use lampray::pack::*;
use lampray::{Error, Result};
use std::cell::Cell;

/// What is wrong with a pass.
pub type Fault = fn(&mut DenoiseJob, &mut [Site], &mut [Estimate]);

/// Nothing.
pub const SOUND: Fault = |_, _, _| ();

/// The CPU twin, which is lost after some calls of the denoiser, or does something wrong in each pass.
pub struct Fragile {
    twin: Cpu,
    info: DeviceInfo,
    left: Cell<usize>,
    fault: Fault,
}

impl Fragile {
    pub fn new(left: usize, fault: Fault) -> Self {
        let info = DeviceInfo {
            kind: DeviceKind::Hardware,
            ..lampray::cpu::info()
        };
        Self {
            twin: Cpu::new(),
            info,
            left: left.into(),
            fault,
        }
    }

    fn strike(&self) -> Result<()> {
        let lost = || Error::DeviceLost("the device fragile was lost (on purpose)".into());
        self.left
            .set(self.left.get().checked_sub(1).ok_or_else(lost)?);
        Ok(())
    }
}

impl Device for Fragile {
    fn info(&self) -> &DeviceInfo {
        &self.info
    }

    fn load(&mut self, scene: &Packed) -> Result<()> {
        self.strike()?;
        self.twin.load(scene)
    }

    fn start(&mut self, block: Block) -> Result<()> {
        self.twin.start(block)
    }

    fn finish(&mut self) -> Result<Traced> {
        self.twin.finish()
    }

    fn features(&mut self, rect: Rect) -> Result<Vec<Feature>> {
        self.twin.features(rect)
    }

    fn guides(&mut self, rect: Rect, fineness: u32) -> Result<Vec<Guide>> {
        self.strike()?;
        self.twin.guides(rect, fineness)
    }

    fn denoise(
        &mut self,
        job: &DenoiseJob,
        sites: &[Site],
        estimates: &[Estimate],
    ) -> Result<Vec<Estimate>> {
        self.strike()?;
        let (mut job, mut sites, mut estimates) = (*job, sites.to_vec(), estimates.to_vec());
        (self.fault)(&mut job, &mut sites, &mut estimates);
        Ok(pass(&job, &sites, &estimates))
    }

    fn points(&mut self, strategy: &Strategy, job: &PointsJob) -> Result<Vec<Draw>> {
        self.twin.points(strategy, job)
    }

    fn limits(&self) -> Result<Option<Limits>> {
        self.twin.limits()
    }

    fn canary(
        &mut self,
        strategy: &Strategy,
        job: &CanaryJob,
        scenes: &[CanaryScene],
        inputs: &[[u32; 4]],
    ) -> Result<Option<Vec<[u32; 4]>>> {
        self.twin.canary(strategy, job, scenes, inputs)
    }
}
