//! One graphics device: its pipelines, its buffers, and the dispatches of the four kernels.

use super::adapter::Adapters;
use super::cache::{Cache, Key};
use super::disk_cache::Kept;
use super::fault::Fault;
use super::flight::{Flight, Pace, Rooms};
use super::guard::Guard;
use super::pieces::{Allowance, pieces};
use super::pipeline::Pipeline;
use super::trace::Queue;
use crate::device::{Block, Device, DeviceInfo, Limits, Traced};
use crate::error::{Error, Result};
use crate::pack::*;
use crate::panics::catch;
use crate::shader::{Baked, Kernel, Library, SceneArray, SceneArrays};
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The id of a feature whose ray was left before its end.
pub(super) const UNFINISHED: u32 = u32::MAX;

/// The scene on the device, with what traces it.
#[derive(Debug)]
pub(super) struct Loaded {
    pub(super) packed: Packed,
    pub(super) allowance: Allowance,
    pub(super) arrays: SceneArrays,
    /// The printed part of its tracing kernel; its features are found by the general one.
    pub(super) baked: Option<Arc<Baked>>,
    pub(super) buffers: Vec<wgpu::Buffer>,
}

/// A graphics device that traces.
#[derive(Debug)]
pub struct Gpu {
    pub(super) info: DeviceInfo,
    pub(super) guard: Guard,
    pipelines: Cache<Arc<Pipeline>>,
    pub(super) kept: Option<Kept>,
    rooms: Rooms,
    pace: Pace,
    loaded: Option<Loaded>,
    pub(super) queue: Queue,
    fault: Fault,
    shaders: Library,
}

/// What a kernel runs over.
pub(super) struct Work<'a> {
    pub(super) pipeline: &'a Pipeline,
    /// Whether it traces, and so binds the scene.
    pub(super) scene: bool,
    /// The buffers of its own, in order.
    pub(super) inputs: &'a [(&'a [u8], wgpu::BufferUsages)],
    pub(super) groups: [u32; 2],
    /// Of the results.
    pub(super) bytes: u64,
    /// Paths, where it traces them.
    pub(super) paths: Option<u64>,
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
            required_features: Kept::features(adapter),
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
        let guard = Guard::new(device, queue, &info.name);
        Ok(Self {
            info: info.clone(),
            kept: Kept::open(&guard, adapter, info),
            guard,
            pipelines: Cache::new(),
            rooms: Rooms::default(),
            pace: Pace::default(),
            loaded: None,
            queue: Queue::default(),
            fault: Fault::of_this_device()?,
            shaders: Library::default(),
        })
    }

    /// The pipeline of a kernel, compiled on first use. Kernels without a scene have no arrays, and one that
    /// is baked is for a single scene.
    pub(super) fn pipeline(
        &mut self,
        kernel: Kernel,
        strategy: &Strategy,
        arrays: Option<SceneArrays>,
        baked: Option<&Baked>,
    ) -> Result<Arc<Pipeline>> {
        let key = Key {
            kernel,
            strategy: *strategy,
            arrays,
            baked: baked.map(|baked| baked.hash),
        };
        if let Some(pipeline) = self.pipelines.get(&key) {
            return Ok(pipeline);
        }
        let none = SceneArrays {
            materials: 1,
            spheres: 1,
            boxes: 1,
            lamps: 1,
            ..SceneArrays::default()
        };
        let kept = self.kept.as_ref().map(Kept::pipelines);
        let arrays = arrays.unwrap_or(none);
        let wanted = (kernel, strategy, arrays);
        let pipeline = Pipeline::new(&self.guard, &self.shaders, wanted, baked, kept)?;
        let pipeline = Arc::new(pipeline);
        self.pipelines.insert(key, pipeline.clone());
        Ok(pipeline)
    }

    /// Submits a kernel's work.
    pub(super) fn launch(&mut self, work: &Work) -> Result<Flight> {
        let guard = &self.guard;
        let room = self.rooms.take(guard, work.bytes)?;
        let inputs: Vec<_> = work
            .inputs
            .iter()
            .map(|(bytes, usage)| guard.filled(bytes, *usage))
            .collect::<Result<_>>()?;
        let scene_buffers: Vec<_> = match &self.loaded {
            Some(loaded) if work.scene => loaded.buffers.iter().collect(),
            _ => Vec::new(),
        };
        let scene_group = guard.bind(&work.pipeline.scene_layout, &scene_buffers)?;
        let pass_buffers: Vec<_> = inputs.iter().chain([&room.storage]).collect();
        let pass_group = guard.bind(&work.pipeline.pass_layout, &pass_buffers)?;
        let commands = guard.scoped(|device| {
            let mut encoder = device.create_command_encoder(&Default::default());
            // What a lane does not write reads as zero, not as a result of another dispatch.
            encoder.clear_buffer(&room.storage, 0, Some(work.bytes));
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                pass.set_pipeline(&work.pipeline.pipeline);
                pass.set_bind_group(0, &scene_group, &[]);
                pass.set_bind_group(1, &pass_group, &[]);
                pass.dispatch_workgroups(work.groups[0], work.groups[1], 1);
            }
            encoder.copy_buffer_to_buffer(&room.storage, 0, &room.staging, 0, work.bytes);
            encoder.finish()
        })?;
        Ok(Flight {
            started: Instant::now(),
            submission: guard.submit(commands)?,
            room,
            bytes: work.bytes,
            paths: work.paths,
        })
    }

    /// Waits for what was submitted; its results, and how long the device took for them.
    pub(super) fn land<T: Pod>(&mut self, flight: Flight) -> Result<(Vec<T>, Duration)> {
        let patience = self.pace.patience(&flight);
        let Flight {
            room,
            bytes,
            submission,
            started,
            paths,
        } = flight;
        let items = self
            .guard
            .read(&room.staging, bytes, &submission, patience)?;
        self.rooms.give_back(room);
        Ok((items, self.pace.landed(started, paths)))
    }

    /// Runs a kernel over `groups` and returns its `count` results. `scene` is whether it traces.
    pub(super) fn dispatch<T: Pod + Zeroable>(
        &mut self,
        pipeline: &Pipeline,
        scene: bool,
        inputs: &[(&[u8], wgpu::BufferUsages)],
        groups: [u32; 2],
        count: usize,
    ) -> Result<Vec<T>> {
        let flight = self.launch(&Work {
            pipeline,
            scene,
            inputs,
            groups,
            bytes: (count * size_of::<T>()) as u64,
            paths: None,
        })?;
        self.land(flight).map(|(items, _)| items)
    }

    pub(super) fn scene(&self) -> Result<&Loaded> {
        self.loaded
            .as_ref()
            .ok_or_else(|| Error::Internal("no scene is loaded".into()))
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
        let pipeline = self.pipeline(Kernel::Probe, strategy, None, None)?;
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

/// The bytes of one of a scene's arrays.
fn array_bytes(array: &SceneArray, scene: &Packed) -> Vec<u8> {
    let length = array.length;
    let hierarchy = scene.hierarchy.as_deref();
    match (array.name, hierarchy) {
        ("material_at", _) => padded(&scene.materials, length),
        ("sphere_at", _) => padded(&scene.spheres, length),
        ("box_at", _) => padded(&scene.boxes, length),
        ("lamp_at", _) => padded(&scene.lamps, length),
        ("choice_at", _) => padded(&scene.choice.entries, length),
        ("worth_at", _) => padded(&scene.worths, length),
        ("outside_sphere_at", Some(all)) => padded(&all.spheres, length),
        ("outside_box_at", Some(all)) => padded(&all.boxes, length),
        ("node_at", Some(all)) => padded(&all.tree.nodes, length),
        ("node_body_at", Some(all)) => padded(&all.tree.bodies, length),
        (name, _) => unreachable!("no array is called {name}"),
    }
}

/// Groups of 8 x 8 lanes over a rectangle.
pub(super) fn tiles(rect: Rect) -> [u32; 2] {
    [rect.width().div_ceil(8), rect.height().div_ceil(8)]
}

impl Device for Gpu {
    fn info(&self) -> &DeviceInfo {
        &self.info
    }

    fn use_shaders(&mut self, shaders: &Library) -> Result<()> {
        self.shaders = shaders.clone();
        self.pipelines = Cache::new();
        Ok(())
    }

    fn load(&mut self, scene: &Packed) -> Result<()> {
        let allowance = Allowance::new(&self.info, scene).ok_or_else(|| {
            let bodies = scene.spheres.len() + scene.boxes.len();
            self.cut_short(&format!("{bodies} bodies are more than it goes through"))
        })?;
        let arrays = SceneArrays::new(scene);
        let is_baked = scene.traversal == Traversal::Baked;
        let baked = is_baked.then(|| Baked::new(scene, arrays)).transpose()?;
        let baked = baked.map(Arc::new);
        let guard = &self.guard;
        let bytes = |array: &SceneArray| array_bytes(array, scene);
        let uniform: Vec<u8> = arrays.uniform().iter().flat_map(bytes).collect();
        let mut buffers = Vec::new();
        if !uniform.is_empty() {
            buffers.push(guard.filled(&uniform, wgpu::BufferUsages::UNIFORM)?);
        }
        for array in arrays.storage() {
            buffers.push(guard.filled(&bytes(&array), wgpu::BufferUsages::STORAGE)?);
        }
        self.pace.forget();
        self.fault.begin();
        self.queue = Queue::default();
        self.loaded = Some(Loaded {
            packed: scene.clone(),
            allowance,
            arrays,
            baked,
            buffers,
        });
        // Drivers compile at the first dispatch: one sample of one pixel pays for it here.
        let first = Block {
            rect: Rect {
                x0: 0,
                y0: 0,
                x1: 1,
                y1: 1,
            },
            first_sample: 0,
            samples: 1,
        };
        let most = self.scene()?.allowance.samples;
        self.trace_again(first, most, &mut Duration::default())?;
        self.pace.forget();
        Ok(())
    }

    fn start(&mut self, block: Block) -> Result<()> {
        let most = self.scene()?.allowance.samples;
        self.queue.blocks.push_back(block);
        self.queue.waiting.extend(pieces(block, most));
        self.launch_waiting()
            .or_else(|error| self.throw_away(error))
    }

    fn finish(&mut self) -> Result<Traced> {
        if self.fault.strikes() {
            self.guard.destroy();
        }
        self.finish_oldest().or_else(|error| self.throw_away(error))
    }

    fn features(&mut self, rect: Rect) -> Result<Vec<Feature>> {
        let loaded = self.scene()?;
        let job = FeatureJob {
            camera: loaded.packed.camera,
            corner: [rect.x0, rect.y0],
            size: [rect.width(), rect.height()],
            iterations: loaded.allowance.iterations,
            ..FeatureJob::default()
        };
        let (strategy, arrays) = (loaded.packed.strategy, loaded.arrays);
        let pipeline = self.pipeline(Kernel::Features, &strategy, Some(arrays), None)?;
        let inputs = [(bytemuck::bytes_of(&job), wgpu::BufferUsages::UNIFORM)];
        let features: Vec<Feature> =
            self.dispatch(&pipeline, true, &inputs, tiles(rect), rect.area())?;
        match features.iter().all(|feature| feature.id != UNFINISHED) {
            true => Ok(features),
            false => Err(self.cut_short("a ray met too many bodies' bounds")),
        }
    }

    fn guides(&mut self, rect: Rect, fineness: u32) -> Result<Vec<Guide>> {
        self.guides_of(rect, fineness)
    }

    fn denoise(
        &mut self,
        job: &DenoiseJob,
        sites: &[Site],
        estimates: &[Estimate],
    ) -> Result<Vec<Estimate>> {
        self.denoise_pass(job, sites, estimates)
    }

    fn points(&mut self, strategy: &Strategy, job: &PointsJob) -> Result<Vec<Draw>> {
        let pipeline = self.pipeline(Kernel::Points, strategy, None, None)?;
        let inputs = [(bytemuck::bytes_of(job), wgpu::BufferUsages::UNIFORM)];
        let groups = [job.count.div_ceil(64), 1];
        self.dispatch(&pipeline, false, &inputs, groups, job.count as usize)
    }

    fn limits(&self) -> Result<Option<Limits>> {
        self.stated_limits().map(Some)
    }

    fn canary(
        &mut self,
        strategy: &Strategy,
        job: &CanaryJob,
        scenes: &[CanaryScene],
        inputs: &[[u32; 4]],
    ) -> Result<Option<Vec<[u32; 4]>>> {
        self.answer(strategy, job, scenes, inputs).map(Some)
    }

    fn readback(&self) -> Duration {
        self.guard.readback()
    }
}
