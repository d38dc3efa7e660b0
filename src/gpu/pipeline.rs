//! Pipelines: a kernel, its bindings, and the strategy that its override constants spell.

use super::guard::Guard;
use crate::error::{Error, Result};
use crate::knobs::Choice;
use crate::pack::Strategy;
use crate::shader::{self, Baked, Joined, Kernel, Library, SceneArrays};
use std::borrow::Cow;

/// What a kernel binds in group 1, after the scene in group 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    Uniform,
    Read,
    Write,
}

/// The bindings of each kernel's group 1, in order.
pub fn bindings(kernel: Kernel) -> &'static [Binding] {
    match kernel {
        Kernel::Trace | Kernel::Features | Kernel::Guides | Kernel::Points => {
            &[Binding::Uniform, Binding::Write]
        }
        Kernel::Probe => &[Binding::Uniform, Binding::Read, Binding::Write],
        Kernel::Canary | Kernel::Denoise => &[
            Binding::Uniform,
            Binding::Read,
            Binding::Read,
            Binding::Write,
        ],
    }
}

/// Whether a kernel traces the scene, and so binds it in group 0.
pub fn binds_scene(kernel: Kernel) -> bool {
    matches!(kernel, Kernel::Trace | Kernel::Features | Kernel::Guides)
}

/// A kernel ready to run.
#[derive(Debug)]
pub struct Pipeline {
    pub pipeline: wgpu::ComputePipeline,
    pub scene_layout: wgpu::BindGroupLayout,
    pub pass_layout: wgpu::BindGroupLayout,
}

fn entry(binding: usize, kind: Binding) -> wgpu::BindGroupLayoutEntry {
    let ty = match kind {
        Binding::Uniform => wgpu::BufferBindingType::Uniform,
        Binding::Read => wgpu::BufferBindingType::Storage { read_only: true },
        Binding::Write => wgpu::BufferBindingType::Storage { read_only: false },
    };
    wgpu::BindGroupLayoutEntry {
        binding: binding as u32,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

fn layout(device: &wgpu::Device, kinds: impl Iterator<Item = Binding>) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = kinds
        .enumerate()
        .map(|(binding, kind)| entry(binding, kind))
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &entries,
    })
}

/// The bindings of group 0 in the kernels that trace: the scene, what is in one uniform buffer first.
pub fn scene_bindings(arrays: SceneArrays) -> Vec<Binding> {
    let uniform = (!arrays.uniform().is_empty()).then_some(Binding::Uniform);
    let storage = arrays.storage().into_iter().map(|_| Binding::Read);
    uniform.into_iter().chain(storage).collect()
}

impl Pipeline {
    /// Compiles a kernel for a strategy and for arrays of these lengths. What the driver made of kernels that
    /// serve many scenes is `kept`.
    ///
    /// # Errors
    /// [`Error::Internal`] with file and line where the shader is at fault; [`Error::Device`] where it is another
    /// build's and does not fit this one.
    pub fn new(
        guard: &Guard,
        library: &Library,
        (kernel, strategy, arrays): (Kernel, &Strategy, SceneArrays),
        baked: Option<&Baked>,
        kept: Option<&wgpu::PipelineCache>,
    ) -> Result<Self> {
        let text = |library: &Library| match baked {
            Some(baked) => shader::baked_source_of(library, baked),
            None => shader::source_of(library, kernel, arrays),
        };
        let module = match library.is_own() {
            true => shader::parse(&text(library)?)?,
            false => foreign(library, text)?,
        };
        let constants = constants(&module, strategy);
        let scene = if binds_scene(kernel) {
            scene_bindings(arrays)
        } else {
            Vec::new()
        };
        guard.scoped(|device| {
            let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(kernel.name()),
                source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
            });
            let scene_layout = layout(device, scene.into_iter());
            let pass_layout = layout(device, bindings(kernel).iter().copied());
            let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(kernel.name()),
                bind_group_layouts: &[Some(&scene_layout), Some(&pass_layout)],
                immediate_size: 0,
            });
            let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(kernel.name()),
                layout: Some(&pipeline_layout),
                module: &shader,
                entry_point: Some("main"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    zero_initialize_workgroup_memory: false,
                },
                cache: kept.filter(|_| baked.is_none()),
            });
            Self {
                pipeline,
                scene_layout,
                pass_layout,
            }
        })
    }
}

/// Another build's kernel, where it still fits this one's buffers and constants.
fn foreign(library: &Library, text: impl Fn(&Library) -> Result<Joined>) -> Result<naga::Module> {
    let own = shader::parse(&text(&Library::default())?)?;
    let module = text(library).and_then(|joined| {
        let module = shader::parse(&joined)?;
        shader::validate(&joined, &module).map(|()| module)
    });
    let unfit =
        |reason: String| Error::Device(format!("the other build's shaders do not fit: {reason}"));
    let module = module.map_err(|fault| match fault {
        // Of the other build, and no fault of this one's.
        Error::Internal(text) => unfit(text),
        other => other,
    })?;
    shader::same_interface(&module, &own).map_err(unfit)?;
    Ok(module)
}

/// The strategy's constants that this kernel has.
fn constants(module: &naga::Module, strategy: &Strategy) -> Vec<(&'static str, f64)> {
    let declared = |name: &str| {
        module
            .overrides
            .iter()
            .any(|(_, constant)| constant.name.as_deref() == Some(name))
    };
    let all = strategy.overrides().into_iter();
    all.filter(|(name, _)| declared(name))
        .map(|(name, value)| (name, f64::from(value)))
        .collect()
}
