//! Runs any text of the tracing kernel: what `lampray::gpu` does for the texts that ship, with the
//! text in the caller's hands.

use lampray::gpu::{Binding, bindings, scene_bindings};
use lampray::pack::{Packed, Rect, Tally};
use lampray::shader::{self, Joined, Kernel, SceneArrays};
use std::borrow::Cow;

/// An open device.
pub struct Device {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pub name: String,
}

/// One text, ready to run on one scene.
pub struct Variant {
    pipeline: wgpu::ComputePipeline,
    scene: wgpu::BindGroup,
    pass: wgpu::BindGroupLayout,
}

impl Device {
    /// The first software device, or the first that is none.
    pub fn open(software: bool) -> Self {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.flags = wgpu::InstanceFlags::empty();
        let instance = wgpu::Instance::new(descriptor);
        let all = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
        let is_software =
            |adapter: &wgpu::Adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        let adapter = all.into_iter().find(|a| is_software(a) == software);
        let adapter = adapter.expect("no such device; see `lampray devices`");
        let limits = wgpu::DeviceDescriptor {
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&limits)).unwrap();
        let info = adapter.get_info();
        Self {
            device,
            queue,
            name: format!("{} ({} {})", info.name, info.driver, info.driver_info),
        }
    }

    fn layout(&self, kinds: &[Binding]) -> wgpu::BindGroupLayout {
        let entry = |(binding, kind): (usize, &Binding)| wgpu::BindGroupLayoutEntry {
            binding: binding as u32,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: match kind {
                    Binding::Uniform => wgpu::BufferBindingType::Uniform,
                    Binding::Read => wgpu::BufferBindingType::Storage { read_only: true },
                    Binding::Write => wgpu::BufferBindingType::Storage { read_only: false },
                },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let entries: Vec<_> = kinds.iter().enumerate().map(entry).collect();
        let descriptor = wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &entries,
        };
        self.device.create_bind_group_layout(&descriptor)
    }

    fn buffer(&self, bytes: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes,
            usage,
            mapped_at_creation: false,
        })
    }

    fn filled(&self, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let buffer = self.buffer(bytes.len() as u64, usage | wgpu::BufferUsages::COPY_DST);
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    fn bind(&self, layout: &wgpu::BindGroupLayout, buffers: &[&wgpu::Buffer]) -> wgpu::BindGroup {
        let entry = |(binding, buffer): (usize, &&wgpu::Buffer)| (binding, (*buffer).clone());
        let buffers: Vec<_> = buffers.iter().enumerate().map(entry).collect();
        let entries: Vec<_> = buffers
            .iter()
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding: *binding as u32,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        })
    }

    /// Compiles a text for a scene; the text must be a valid one.
    pub fn variant(&self, joined: &Joined, scene: &Packed) -> Variant {
        let module = shader::parse(joined).unwrap_or_else(|error| panic!("{error}"));
        shader::validate(joined, &module).unwrap_or_else(|error| panic!("{error}"));
        let overrides: Vec<_> = scene.strategy.overrides().into_iter().collect();
        let declared = |name: &str| {
            let mut all = module.overrides.iter();
            all.any(|(_, constant)| constant.name.as_deref() == Some(name))
        };
        let constants: Vec<_> = overrides
            .into_iter()
            .filter(|(name, _)| declared(name))
            .map(|(name, value)| (name, f64::from(value)))
            .collect();
        let arrays = SceneArrays::new(scene);
        let scene_layout = self.layout(&scene_bindings(arrays));
        let pass = self.layout(bindings(Kernel::Trace));
        let shader = self
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
            });
        let layout = self
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: &[Some(&scene_layout), Some(&pass)],
                immediate_size: 0,
            });
        let pipeline = self
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: None,
                layout: Some(&layout),
                module: &shader,
                entry_point: Some("main"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    zero_initialize_workgroup_memory: true,
                },
                cache: None,
            });
        let uniform: Vec<u8> = arrays
            .uniform()
            .iter()
            .flat_map(|array| bytes(array.name, array.bytes(), scene))
            .collect();
        assert!(
            arrays.storage().is_empty(),
            "the scene is too large for this bench"
        );
        let buffer = self.filled(&uniform, wgpu::BufferUsages::UNIFORM);
        Variant {
            scene: self.bind(&scene_layout, &[&buffer]),
            pipeline,
            pass,
        }
    }

    /// The first run of a pixel's samples on each pixel of `rect`.
    pub fn trace(
        &self,
        variant: &Variant,
        scene: &Packed,
        rect: Rect,
        first: u64,
        samples: u32,
    ) -> Vec<Tally> {
        let job = scene.job(rect, first, samples);
        let job = self.filled(bytemuck::bytes_of(&job), wgpu::BufferUsages::UNIFORM);
        let runs = lampray::device::runs(first, samples) as usize;
        let size = (rect.area() * runs * size_of::<Tally>()) as u64;
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let results = self.buffer(size, usage);
        let staging = self.buffer(
            size,
            wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        );
        let pass_group = self.bind(&variant.pass, &[&job, &results]);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&variant.pipeline);
            pass.set_bind_group(0, &variant.scene, &[]);
            pass.set_bind_group(1, &pass_group, &[]);
            pass.dispatch_workgroups(rect.width().div_ceil(8), rect.height().div_ceil(8), 1);
        }
        encoder.copy_buffer_to_buffer(&results, 0, &staging, 0, size);
        self.queue.submit([encoder.finish()]);
        staging
            .slice(..)
            .map_async(wgpu::MapMode::Read, |outcome| outcome.unwrap());
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .unwrap();
        let range = staging.slice(..).get_mapped_range().unwrap();
        bytemuck::cast_slice(&range).to_vec()
    }
}

/// The bytes of one of a scene's arrays, filled up with zeros to its declared length.
fn bytes(name: &str, length: usize, scene: &Packed) -> Vec<u8> {
    let mut bytes: Vec<u8> = match name {
        "material_at" => bytemuck::cast_slice(&scene.materials).to_vec(),
        "sphere_at" => bytemuck::cast_slice(&scene.spheres).to_vec(),
        "box_at" => bytemuck::cast_slice(&scene.boxes).to_vec(),
        "lamp_at" => bytemuck::cast_slice(&scene.lamps).to_vec(),
        name => panic!("no array is called {name}"),
    };
    bytes.resize(length, 0);
    bytes
}
