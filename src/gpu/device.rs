//! One graphics device: its pipelines, its buffers, and the dispatches of the four kernels.

use super::adapter::Adapters;
use super::guard::Guard;
use super::pieces::{Allowance, Gathered, pieces};
use super::pipeline::Pipeline;
use crate::device::{Device, DeviceInfo, runs};
use crate::error::{Error, Result};
use crate::pack::*;
use crate::panics::catch;
use crate::shader::{Kernel, SceneArrays};
use bytemuck::{Pod, Zeroable};
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

/// The buffers that results come back in; they grow with the largest block so far.
#[derive(Debug)]
struct Results {
    storage: wgpu::Buffer,
    staging: wgpu::Buffer,
    bytes: u64,
}

/// The scene on the device, with what traces it.
#[derive(Debug)]
struct Loaded {
    packed: Packed,
    allowance: Allowance,
    arrays: SceneArrays,
    buffers: Vec<wgpu::Buffer>,
}

/// A graphics device that traces.
#[derive(Debug)]
pub struct Gpu {
    info: DeviceInfo,
    guard: Guard,
    pipelines: HashMap<(u32, Option<SceneArrays>, Strategy), Arc<Pipeline>>,
    results: Option<Results>,
    loaded: Option<Loaded>,
}

impl Gpu {
    /// Opens the adapter at a place of the list.
    ///
    /// # Errors
    /// [`Error::Device`] where the driver refuses.
    pub fn open(adapters: &Adapters, index: usize) -> Result<Self> {
        let missing = || Error::Device(format!("there is no graphics device {index}"));
        let (adapter, info) = adapters.get(index).ok_or_else(missing)?;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("lampray"),
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let refused = |reason: String| {
            Error::Device(format!(
                "the device {} cannot be used: {reason}; choose another with --device",
                info.name
            ))
        };
        let opened = catch(|| pollster::block_on(adapter.request_device(&descriptor)));
        let (device, queue) = opened
            .map_err(|_| refused("its driver failed".into()))?
            .map_err(|error| refused(error.to_string()))?;
        Ok(Self {
            info: info.clone(),
            guard: Guard::new(device, queue, &info.name),
            pipelines: HashMap::new(),
            results: None,
            loaded: None,
        })
    }

    /// The pipeline of a kernel, compiled on first use. Kernels without a scene ignore its arrays.
    fn pipeline(
        &mut self,
        kernel: Kernel,
        strategy: &Strategy,
        arrays: Option<SceneArrays>,
    ) -> Result<Arc<Pipeline>> {
        let key = (kernel as u32, arrays, *strategy);
        if let Some(pipeline) = self.pipelines.get(&key) {
            return Ok(pipeline.clone());
        }
        let none = SceneArrays {
            materials: 1,
            spheres: 1,
            boxes: 1,
            lamps: 1,
        };
        let pipeline = Pipeline::new(&self.guard, kernel, strategy, arrays.unwrap_or(none))?;
        let pipeline = Arc::new(pipeline);
        self.pipelines.insert(key, pipeline.clone());
        Ok(pipeline)
    }

    /// Makes room for `bytes` of results.
    fn reserve(&mut self, bytes: u64) -> Result<()> {
        if self
            .results
            .as_ref()
            .is_none_or(|results| results.bytes < bytes)
        {
            self.results = None;
            let storage = wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_SRC
                | wgpu::BufferUsages::COPY_DST;
            let staging = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
            self.results = Some(Results {
                storage: self.guard.buffer(bytes, storage)?,
                staging: self.guard.buffer(bytes, staging)?,
                bytes,
            });
        }
        Ok(())
    }

    /// Runs a kernel over `groups` and returns its `count` results. `scene` is whether it traces.
    fn dispatch<T: Pod + Zeroable>(
        &mut self,
        pipeline: &Pipeline,
        scene: bool,
        inputs: &[(&[u8], wgpu::BufferUsages)],
        groups: [u32; 2],
        count: usize,
    ) -> Result<Vec<T>> {
        let bytes = (count * size_of::<T>()) as u64;
        self.reserve(bytes)?;
        let (Some(results), guard) = (&self.results, &self.guard) else {
            return Err(Error::Internal("no room for results".into()));
        };
        let inputs: Vec<_> = inputs
            .iter()
            .map(|(bytes, usage)| guard.filled(bytes, *usage))
            .collect::<Result<_>>()?;
        let scene_buffers: Vec<_> = match &self.loaded {
            Some(loaded) if scene => loaded.buffers.iter().collect(),
            _ => Vec::new(),
        };
        let scene_group = guard.bind(&pipeline.scene_layout, &scene_buffers)?;
        let pass_buffers: Vec<_> = inputs.iter().chain([&results.storage]).collect();
        let pass_group = guard.bind(&pipeline.pass_layout, &pass_buffers)?;
        let commands = guard.scoped(|device| {
            let mut encoder = device.create_command_encoder(&Default::default());
            // What a lane does not write reads as zero, not as a result of another dispatch.
            encoder.clear_buffer(&results.storage, 0, Some(bytes));
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                pass.set_pipeline(&pipeline.pipeline);
                pass.set_bind_group(0, &scene_group, &[]);
                pass.set_bind_group(1, &pass_group, &[]);
                pass.dispatch_workgroups(groups[0], groups[1], 1);
            }
            encoder.copy_buffer_to_buffer(&results.storage, 0, &results.staging, 0, bytes);
            encoder.finish()
        })?;
        guard.submit(commands)?;
        guard.read(&results.staging, bytes)
    }

    fn scene(&self) -> Result<&Loaded> {
        self.loaded
            .as_ref()
            .ok_or_else(|| Error::Internal("no scene is loaded".into()))
    }

    /// Traces samples in one dispatch whose lanes take at most `steps` steps.
    fn trace_piece(
        &mut self,
        rect: Rect,
        first_sample: u64,
        samples: u32,
        steps: u32,
    ) -> Result<Vec<Tally>> {
        let loaded = self.scene()?;
        let mut job = loaded.packed.job(rect, first_sample, samples);
        job.steps = job.steps.min(steps);
        let (strategy, arrays) = (loaded.packed.strategy, loaded.arrays);
        let pipeline = self.pipeline(Kernel::Trace, &strategy, Some(arrays))?;
        let count = rect.area() * runs(first_sample, samples) as usize;
        let inputs = [(bytemuck::bytes_of(&job), wgpu::BufferUsages::UNIFORM)];
        let tallies: Vec<Tally> = self.dispatch(&pipeline, true, &inputs, tiles(rect), count)?;
        // Every sample takes a ray: a tally without one was never written.
        match tallies.iter().all(|tally| tally.rays > 0) {
            true => Ok(tallies),
            false => Err(self.cut_short("a path took too many steps")),
        }
    }

    fn cut_short(&self, what: &str) -> Error {
        Error::Device(format!(
            "the device {} stops a kernel after 65,535 loop iterations, and {what}; use --device cpu or a smaller scene or render.max_bounces",
            self.info.name
        ))
    }

    /// Runs a library function over a list of inputs, for tests.
    ///
    /// # Errors
    /// As [`Device::trace`].
    pub fn probe(
        &mut self,
        strategy: &Strategy,
        function: crate::shader::Probe,
        inputs: &[ProbeInput],
    ) -> Result<Vec<ProbeOutput>> {
        let pipeline = self.pipeline(Kernel::Probe, strategy, None)?;
        let job = ProbeJob {
            function: function as u32,
            count: inputs.len() as u32,
        };
        let buffers = [
            (bytemuck::bytes_of(&job), wgpu::BufferUsages::UNIFORM),
            (bytemuck::cast_slice(inputs), wgpu::BufferUsages::STORAGE),
        ];
        let groups = [(inputs.len() as u32).div_ceil(64), 1];
        self.dispatch(&pipeline, false, &buffers, groups, inputs.len())
    }
}

/// The bytes of a scene array, filled up with zeros to its declared length.
fn padded<T: Pod + Zeroable>(items: &[T], length: usize) -> Vec<u8> {
    let mut bytes = bytemuck::cast_slice(items).to_vec();
    bytes.resize(length * size_of::<T>(), 0);
    bytes
}

/// Groups of 8 x 8 lanes over a rectangle.
fn tiles(rect: Rect) -> [u32; 2] {
    [rect.width().div_ceil(8), rect.height().div_ceil(8)]
}

impl Device for Gpu {
    fn info(&self) -> &DeviceInfo {
        &self.info
    }

    fn load(&mut self, scene: &Packed) -> Result<()> {
        let allowance = Allowance::new(self.info.kind, scene).ok_or_else(|| {
            let bodies = scene.spheres.len() + scene.boxes.len();
            self.cut_short(&format!("{bodies} bodies are more than it goes through"))
        })?;
        let arrays = SceneArrays::new(scene);
        let bytes = [
            padded(&scene.materials, arrays.materials),
            padded(&scene.spheres, arrays.spheres),
            padded(&scene.boxes, arrays.boxes),
            padded(&scene.lamps, arrays.lamps),
        ];
        let guard = &self.guard;
        let buffers = if arrays.is_uniform() {
            vec![guard.filled(&bytes.concat(), wgpu::BufferUsages::UNIFORM)?]
        } else {
            let filled = bytes
                .iter()
                .map(|bytes| guard.filled(bytes, wgpu::BufferUsages::STORAGE));
            filled.collect::<Result<_>>()?
        };
        self.loaded = Some(Loaded {
            packed: scene.clone(),
            allowance,
            arrays,
            buffers,
        });
        // Drivers compile at the first dispatch: one sample of one pixel pays for it here.
        self.trace(
            Rect {
                x0: 0,
                y0: 0,
                x1: 1,
                y1: 1,
            },
            0,
            1,
        )
        .map(drop)
    }

    fn trace(&mut self, rect: Rect, first_sample: u64, samples: u32) -> Result<Vec<Tally>> {
        let allowance = self.scene()?.allowance;
        let mut gathered = Gathered::new(rect.area());
        for (first, count) in pieces(first_sample, samples, allowance.samples) {
            let tallies = self.trace_piece(rect, first, count, allowance.steps)?;
            gathered.add(first, count, &tallies);
        }
        Ok(gathered.tallies)
    }

    fn features(&mut self, rect: Rect) -> Result<Vec<Feature>> {
        let loaded = self.scene()?;
        let job = FeatureJob {
            camera: loaded.packed.camera,
            corner: [rect.x0, rect.y0],
            size: [rect.width(), rect.height()],
        };
        let (strategy, arrays) = (loaded.packed.strategy, loaded.arrays);
        let pipeline = self.pipeline(Kernel::Features, &strategy, Some(arrays))?;
        let inputs = [(bytemuck::bytes_of(&job), wgpu::BufferUsages::UNIFORM)];
        self.dispatch(&pipeline, true, &inputs, tiles(rect), rect.area())
    }

    fn points(&mut self, strategy: &Strategy, job: &PointsJob) -> Result<Vec<Draw>> {
        let pipeline = self.pipeline(Kernel::Points, strategy, None)?;
        let inputs = [(bytemuck::bytes_of(job), wgpu::BufferUsages::UNIFORM)];
        let groups = [job.count.div_ceil(64), 1];
        self.dispatch(&pipeline, false, &inputs, groups, job.count as usize)
    }

    fn readback(&self) -> Duration {
        self.guard.readback()
    }
}
