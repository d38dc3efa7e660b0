//! What can trace: a GPU through wgpu, or the CPU twin. Both answer the same calls.

use crate::error::{Error, Result};
use crate::pack::{
    CanaryJob, CanaryScene, DenoiseJob, Draw, Estimate, Feature, Guide, Packed, PointsJob, Rect,
    Site, Strategy, Tally, Traversal,
};
use crate::shader::Library;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// What a device is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DeviceKind {
    /// A GPU.
    Hardware,
    /// A graphics driver that runs on the CPU, such as Mesa's lavapipe.
    Software,
    /// The built-in CPU twin.
    Cpu,
}

/// A device, as records name it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DeviceInfo {
    pub kind: DeviceKind,
    pub name: String,
    /// The driver's name and version.
    pub driver: String,
    /// The graphics interface: `vulkan`, `metal`, `dx12`; `none` for the CPU twin.
    pub backend: String,
    /// PCI address such as `0000:65:00.0`; empty where there is none.
    pub pci: String,
}

impl DeviceInfo {
    /// What a device traces by where `chosen` is wanted: the CPU twin has no compiler, and takes its loops
    /// for what would be baked.
    pub fn traversal(&self, chosen: Traversal) -> Traversal {
        match (self.kind, chosen) {
            (DeviceKind::Cpu, Traversal::Baked) => Traversal::General,
            _ => chosen,
        }
    }

    /// Whether two devices give the same pixels for the same samples: same kind, name, driver and
    /// backend, in whichever slot. The CPU twin's name counts its threads, which change no bit.
    pub fn is_like(&self, other: &Self) -> bool {
        if self.kind == DeviceKind::Cpu {
            return other.kind == DeviceKind::Cpu && other.driver == self.driver;
        }
        let pci = other.pci.clone();
        Self {
            pci,
            ..self.clone()
        } == *other
    }
}

/// What a driver gives room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Limits {
    /// Bytes of a storage buffer that a kernel sees at once.
    pub storage_binding: u64,
    /// Bytes of a buffer.
    pub buffer: u64,
    /// Groups of lanes along one axis of a dispatch.
    pub groups: u32,
    /// Lanes of a group.
    pub group_lanes: u32,
    /// Loop iterations that a lane is given where its driver is known to stop loops that go on for long.
    pub loop_iterations: Option<u32>,
}

/// What a user asks for with `--device`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DeviceRequest {
    /// The first GPU, else a software driver, else the CPU twin.
    Auto,
    /// The CPU twin.
    Cpu,
    /// A GPU.
    Hardware,
    /// A software driver.
    Software,
    /// A place in the list that `lampray devices` prints.
    Index(usize),
    /// Part of a device's name, whatever the case.
    Name(String),
    /// A PCI address.
    Pci(String),
}

impl std::str::FromStr for DeviceRequest {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let word = text.to_lowercase();
        if let Some(address) = word
            .strip_prefix("pci:")
            .filter(|address| !address.is_empty())
        {
            return Ok(Self::Pci(address.to_string()));
        }
        Ok(match word.as_str() {
            "auto" => Self::Auto,
            "cpu" => Self::Cpu,
            "gpu" | "hardware" => Self::Hardware,
            "software" => Self::Software,
            "" | "pci:" => {
                let message = "--device names nothing: see `lampray devices`";
                return Err(Error::Usage(message.into()));
            }
            _ => text
                .parse()
                .map_or_else(|_| Self::Name(text.to_string()), Self::Index),
        })
    }
}

/// A part of the work that a device does in one go: samples of the pixels of a rectangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    pub rect: Rect,
    pub first_sample: u64,
    pub samples: u32,
}

impl Block {
    /// Number of paths.
    pub fn paths(&self) -> u64 {
        self.rect.area() as u64 * u64::from(self.samples)
    }
}

/// What a device made of a block.
#[derive(Clone, Debug)]
pub struct Traced {
    /// Run by run, and in each run row by row; runs end where the sample index is a multiple of
    /// [`crate::pack::RUN_LENGTH`].
    pub tallies: Vec<Tally>,
    /// How long the device was at it, waiting for its turn left out.
    pub took: Duration,
}

/// Blocks that a device is given before the first of them is asked for: while one is traced the next waits
/// in the device's own queue, so that it is never idle.
pub const IN_FLIGHT: usize = 2;

/// Something that traces. A call may take as long as its block says; none of them writes files.
pub trait Device: Send {
    fn info(&self) -> &DeviceInfo;

    /// Traces by another build's shaders from the next scene on that is loaded.
    ///
    /// # Errors
    /// [`Error::Device`] for a device that has its own code. Faults of the shaders come with [`Device::load`].
    fn use_shaders(&mut self, _shaders: &Library) -> Result<()> {
        Err(Error::Device(format!(
            "{} traces by code of its own, not by shaders",
            self.info().name
        )))
    }

    /// Makes a scene the one that is traced, with everything compiled that tracing it needs. Blocks of another that
    /// were started and not finished are forgotten.
    ///
    /// # Errors
    /// [`Error::Device`] where the scene does not fit, [`Error::DeviceLost`], [`Error::Internal`].
    fn load(&mut self, scene: &Packed) -> Result<()>;

    /// Begins to trace a block of the loaded scene, and does not wait for it.
    ///
    /// # Errors
    /// [`Error::DeviceLost`] or [`Error::Internal`]. After an error nothing is in flight any more.
    fn start(&mut self, block: Block) -> Result<()>;

    /// Waits for the oldest block that was started and not yet finished.
    ///
    /// # Errors
    /// As [`Device::start`]; nothing of the block is returned then.
    fn finish(&mut self) -> Result<Traced>;

    /// Traces `samples` samples from `first_sample` on of each pixel of `rect`, and waits for them; only where
    /// no block is in flight. The tallies are in the order of [`Traced`].
    ///
    /// # Errors
    /// As [`Device::start`].
    fn trace(&mut self, rect: Rect, first_sample: u64, samples: u32) -> Result<Vec<Tally>> {
        self.start(Block {
            rect,
            first_sample,
            samples,
        })?;
        self.finish().map(|traced| traced.tallies)
    }

    /// What the rays through the centres of the pixels of `rect` meet first, row by row.
    ///
    /// # Errors
    /// As [`Device::start`].
    fn features(&mut self, rect: Rect) -> Result<Vec<Feature>>;

    /// What rays through a lattice of `fineness` by `fineness` places in each pixel of `rect` meet first that is no
    /// mirror; lattice row by lattice row.
    ///
    /// # Errors
    /// As [`Device::start`].
    fn guides(&mut self, rect: Rect, fineness: u32) -> Result<Vec<Guide>>;

    /// One pass of the denoiser over the pixels of a job, row by row; `sites` and `estimates` are of its window.
    ///
    /// # Errors
    /// As [`Device::start`].
    fn denoise(
        &mut self,
        job: &DenoiseJob,
        sites: &[Site],
        estimates: &[Estimate],
    ) -> Result<Vec<Estimate>>;

    /// Draws by the light or the scatter sampler.
    ///
    /// # Errors
    /// As [`Device::start`].
    fn points(&mut self, strategy: &Strategy, job: &PointsJob) -> Result<Vec<Draw>>;

    /// What the driver gives room for; none for the CPU twin, which has all of the memory.
    ///
    /// # Errors
    /// As [`Device::trace`].
    fn limits(&self) -> Result<Option<Limits>>;

    /// Answers one of the doctor's canaries, an answer an input; none where it says nothing of such a device.
    ///
    /// # Errors
    /// As [`Device::trace`].
    fn canary(
        &mut self,
        strategy: &Strategy,
        job: &CanaryJob,
        scenes: &[CanaryScene],
        inputs: &[[u32; 4]],
    ) -> Result<Option<Vec<[u32; 4]>>>;

    /// Time spent so far on copying results out of the device's memory: none where there is no copy.
    fn readback(&self) -> Duration {
        Duration::ZERO
    }
}

/// Number of runs that a range of samples falls into.
pub fn runs(first_sample: u64, samples: u32) -> u32 {
    let run = u64::from(crate::pack::RUN_LENGTH);
    let end = first_sample + u64::from(samples);
    (end.div_ceil(run) - first_sample / run) as u32
}

/// First sample and number of samples of each run of a range.
pub fn run_ranges(first_sample: u64, samples: u32) -> impl Iterator<Item = (u64, u32)> {
    let run = u64::from(crate::pack::RUN_LENGTH);
    let end = first_sample + u64::from(samples);
    let first_run = first_sample / run;
    (first_run..end.div_ceil(run)).map(move |index| {
        let start = (index * run).max(first_sample);
        let stop = ((index + 1) * run).min(end);
        (start, (stop - start) as u32)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_and_slots_change_no_pixel() {
        let twin = crate::cpu::info();
        let more_threads = DeviceInfo {
            name: "built-in CPU renderer, 99 threads".into(),
            ..twin.clone()
        };
        let older = DeviceInfo {
            driver: "lampray 0.0.1".into(),
            ..twin.clone()
        };
        assert!(twin.is_like(&more_threads) && !twin.is_like(&older));
        let gpu = DeviceInfo {
            kind: DeviceKind::Hardware,
            ..twin.clone()
        };
        let elsewhere = DeviceInfo {
            pci: "0000:65:00.0".into(),
            ..gpu.clone()
        };
        let another = DeviceInfo {
            name: "another".into(),
            ..gpu.clone()
        };
        assert!(gpu.is_like(&elsewhere) && !gpu.is_like(&another) && !gpu.is_like(&twin));
    }
}
