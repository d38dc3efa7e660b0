//! What the denoiser asks of a graphics device.

use super::device::{Gpu, UNFINISHED, tiles};
use crate::error::Result;
use crate::pack::{DenoiseJob, Estimate, Guide, GuideJob, Rect, Site};
use crate::shader::Kernel;
use wgpu::BufferUsages;

impl Gpu {
    /// Runs the guides kernel: `fineness` by `fineness` lanes a pixel.
    pub(super) fn guides_of(&mut self, rect: Rect, fineness: u32) -> Result<Vec<Guide>> {
        let loaded = self.scene()?;
        let all = GuideJob::new(&loaded.packed, rect, fineness);
        let job = GuideJob {
            // Each ray takes fewer iterations than a step of a path, of which a lane may make so many.
            mirrors: all.mirrors.min(loaded.allowance.steps - 1),
            iterations: loaded.allowance.iterations,
            ..all
        };
        let (strategy, arrays) = (loaded.packed.strategy, loaded.arrays);
        let pipeline = self.pipeline(Kernel::Guides, &strategy, Some(arrays), None)?;
        let inputs = [(bytemuck::bytes_of(&job), BufferUsages::UNIFORM)];
        let (lanes, count) = (tiles(job.lanes()), job.lanes().area());
        let guides: Vec<Guide> = self.dispatch(&pipeline, true, &inputs, lanes, count)?;
        match guides.iter().all(|guide| guide.id != UNFINISHED) {
            true => Ok(guides),
            false => Err(self.cut_short("a ray met too many bodies' bounds")),
        }
    }

    /// Runs the denoise kernel once.
    pub(super) fn denoise_pass(
        &mut self,
        job: &DenoiseJob,
        sites: &[Site],
        estimates: &[Estimate],
    ) -> Result<Vec<Estimate>> {
        let strategy = self.scene()?.packed.strategy;
        let pipeline = self.pipeline(Kernel::Denoise, &strategy, None, None)?;
        let inputs = [
            (bytemuck::bytes_of(job), BufferUsages::UNIFORM),
            (bytemuck::cast_slice(sites), BufferUsages::STORAGE),
            (bytemuck::cast_slice(estimates), BufferUsages::STORAGE),
        ];
        let [width, height] = job.size;
        let rect = Rect {
            x0: 0,
            y0: 0,
            x1: width,
            y1: height,
        };
        self.dispatch(&pipeline, false, &inputs, tiles(rect), rect.area())
    }
}
