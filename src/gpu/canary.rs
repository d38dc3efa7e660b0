//! What the doctor asks of a graphics device.

use super::device::Gpu;
use super::pieces::planned_iterations;
use crate::device::Limits;
use crate::error::Result;
use crate::pack::{CanaryJob, CanaryScene, Strategy};
use crate::shader::Kernel;

impl Gpu {
    /// The limits that the driver states, and the one that lampray knows of its loops.
    pub(super) fn stated_limits(&self) -> Result<Limits> {
        let limits = self.guard.scoped(wgpu::Device::limits)?;
        Ok(Limits {
            storage_binding: limits.max_storage_buffer_binding_size,
            buffer: limits.max_buffer_size,
            groups: limits.max_compute_workgroups_per_dimension,
            group_lanes: limits.max_compute_invocations_per_workgroup,
            loop_iterations: planned_iterations(&self.info),
        })
    }

    /// Runs the canary kernel: one lane an input.
    pub(super) fn answer(
        &mut self,
        strategy: &Strategy,
        job: &CanaryJob,
        scenes: &[CanaryScene],
        inputs: &[[u32; 4]],
    ) -> Result<Vec<[u32; 4]>> {
        let pipeline = self.pipeline(Kernel::Canary, strategy, None, None)?;
        let job = CanaryJob {
            count: inputs.len() as u32,
            ..*job
        };
        let buffers = [
            (bytemuck::bytes_of(&job), wgpu::BufferUsages::UNIFORM),
            (bytemuck::cast_slice(scenes), wgpu::BufferUsages::STORAGE),
            (bytemuck::cast_slice(inputs), wgpu::BufferUsages::STORAGE),
        ];
        let groups = [job.count.div_ceil(64), 1];
        self.dispatch(&pipeline, false, &buffers, groups, inputs.len())
    }
}
