//! One graphics device: buffers, dispatches, and every way in which it can fail.

use super::adapter::Adapters;
use super::pieces::{Allowance, Gathered, pieces};
use super::pipeline::Pipeline;
use crate::device::{Device, DeviceInfo, runs};
use crate::error::{Error, Result};
use crate::pack::*;
use crate::shader::{Kernel, SceneArrays};
use bytemuck::{Pod, Zeroable};
use std::cell::Cell;
use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// No dispatch is planned to take over half a second; one that takes this long has hung.
const TIMEOUT: Duration = Duration::from_secs(120);

thread_local! {
    /// Whether a panic of this thread would be caught and read as a lost device.
    static CATCHING: Cell<bool> = const { Cell::new(false) };
}

/// Whether this thread is in a call of wgpu's whose panic is caught: nobody need be told of it.
pub fn catching() -> bool {
    CATCHING.get()
}

/// Runs a call that wgpu may panic in.
fn catch<T>(call: impl FnOnce() -> T) -> std::thread::Result<T> {
    let outer = CATCHING.replace(true);
    let outcome = catch_unwind(AssertUnwindSafe(call));
    CATCHING.set(outer);
    outcome
}

/// A device whose every call is watched.
#[derive(Debug)]
pub struct Guard {
    device: wgpu::Device,
    queue: wgpu::Queue,
    name: String,
    lost: Arc<AtomicBool>,
    /// An error that no scope caught: the device cannot be trusted from then on.
    uncaught: Arc<Mutex<Option<String>>>,
}

impl Guard {
    fn new(device: wgpu::Device, queue: wgpu::Queue, name: &str) -> Self {
        let lost = Arc::new(AtomicBool::new(false));
        let uncaught = Arc::new(Mutex::new(None));
        let flag = lost.clone();
        device.set_device_lost_callback(move |_, _| flag.store(true, Ordering::SeqCst));
        let slot = uncaught.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if let Ok(mut slot) = slot.lock() {
                slot.get_or_insert_with(|| error.to_string());
            }
        }));
        Self {
            device,
            queue,
            name: name.into(),
            lost,
            uncaught,
        }
    }

    fn lost_error(&self, what: &str) -> Error {
        Error::DeviceLost(format!(
            "the device {} was lost ({what}); the same command may succeed later, or choose another with --device",
            self.name
        ))
    }

    /// Runs a call that wgpu may panic in.
    fn caught<T>(&self, what: &str, call: impl FnOnce() -> T) -> Result<T> {
        let outcome = catch(call).map_err(|_| self.lost_error(what))?;
        if self.lost.load(Ordering::SeqCst) {
            return Err(self.lost_error(what));
        }
        Ok(outcome)
    }

    /// Creates things on the device; what wgpu finds wrong with them becomes an error.
    pub fn scoped<T>(&self, create: impl FnOnce(&wgpu::Device) -> T) -> Result<T> {
        self.caught("while preparing", || {
            let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
            let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
            let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
            let made = create(&self.device);
            let faults = [validation, internal].map(|scope| pollster::block_on(scope.pop()));
            let full = pollster::block_on(memory.pop());
            if full.is_some() {
                let text = format!(
                    "the device {} has too little memory for this scene",
                    self.name
                );
                return Err(Error::Device(text + "; use a smaller one, or --device cpu"));
            }
            match faults.into_iter().flatten().next() {
                Some(fault) => Err(Error::Internal(format!("on {}: {fault}", self.name))),
                None => Ok(made),
            }
        })?
    }

    fn buffer(&self, size: u64, usage: wgpu::BufferUsages) -> Result<wgpu::Buffer> {
        let descriptor = wgpu::BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation: false,
        };
        self.scoped(|device| device.create_buffer(&descriptor))
    }

    fn filled(&self, bytes: &[u8], usage: wgpu::BufferUsages) -> Result<wgpu::Buffer> {
        let buffer = self.buffer(bytes.len() as u64, usage | wgpu::BufferUsages::COPY_DST)?;
        self.caught("while uploading", || {
            self.queue.write_buffer(&buffer, 0, bytes)
        })?;
        Ok(buffer)
    }

    fn bind(
        &self,
        layout: &wgpu::BindGroupLayout,
        buffers: &[&wgpu::Buffer],
    ) -> Result<wgpu::BindGroup> {
        let entries: Vec<_> = buffers
            .iter()
            .enumerate()
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding: binding as u32,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let descriptor = wgpu::BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        };
        self.scoped(|device| device.create_bind_group(&descriptor))
    }

    /// Waits for all that was submitted.
    fn wait(&self) -> Result<()> {
        let poll = wgpu::PollType::Wait {
            submission_index: None,
            timeout: Some(TIMEOUT),
        };
        match self.caught("while waiting", || self.device.poll(poll))? {
            Ok(_) => {}
            Err(_) => return Err(self.lost_error("it did not answer in time")),
        }
        let uncaught = self
            .uncaught
            .lock()
            .map(|slot| slot.clone())
            .unwrap_or_default();
        match uncaught {
            Some(text) => Err(Error::Internal(format!("on {}: {text}", self.name))),
            None => Ok(()),
        }
    }

    /// Reads a staging buffer that the device has written.
    fn read<T: Pod>(&self, staging: &wgpu::Buffer, bytes: u64) -> Result<Vec<T>> {
        let mapped = Arc::new(AtomicBool::new(false));
        let flag = mapped.clone();
        self.caught("while mapping", || {
            staging.map_async(wgpu::MapMode::Read, 0..bytes, move |outcome| {
                flag.store(outcome.is_ok(), Ordering::SeqCst);
            });
        })?;
        self.wait()?;
        if !mapped.load(Ordering::SeqCst) {
            return Err(self.lost_error("its memory could not be read"));
        }
        let items = self.caught("while reading", || {
            staging
                .get_mapped_range(0..bytes)
                .map(|view| bytemuck::pod_collect_to_vec(&view))
        })?;
        self.caught("while unmapping", || staging.unmap())?;
        items.map_err(|fault| Error::Internal(format!("on {}: {fault}", self.name)))
    }
}

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
        guard.caught("while submitting", || guard.queue.submit([commands]))?;
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
}
