//! The shaders' text: joined from `shaders/`, with constants printed from the Rust types that
//! define them, parsed and validated without a GPU.

mod join;
mod library;

pub use join::{Joined, join};
pub use library::LIBRARY;

use crate::error::{Error, Result};
use crate::knobs::*;
use crate::pack::{self, LastRay, Packed, RUN_LENGTH};
use naga::valid::{Capabilities, ValidationFlags, Validator};

choice! {
    /// The kernels: each a file of `shaders/` with one entry point, `main`.
    Kernel, "KERNEL" {
        Trace = "trace",
        Features = "features",
        Points = "points",
        Probe = "probe",
    }
}

choice! {
    /// The library functions that the probe kernel can run.
    Probe, "PROBE" {
        RandomBits = "random-bits",
        RandomUnit = "random-unit",
        SincosTurn = "sincos-turn",
        UnitSphere = "unit-sphere",
        AngleOfChord = "angle-of-chord",
        BasisAround = "basis-around",
        SampleFilm = "sample-film",
        IntersectSphere = "intersect-sphere",
        IntersectBox = "intersect-box",
        BoxFace = "box-face",
        SampleScatter = "sample-scatter",
        EvaluateScatter = "evaluate-scatter",
        SampleLight = "sample-light",
        LightDensity = "light-density",
        Survival = "survival",
        Finite = "finite",
    }
}

/// Uniform buffers of this many bytes work on every device; larger scenes go into storage buffers.
const UNIFORM_BYTES: usize = 16 * 1024;

/// Lengths of the scene's arrays on the device, which the shader's declarations depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SceneArrays {
    pub materials: usize,
    pub spheres: usize,
    pub boxes: usize,
    pub lamps: usize,
}

impl SceneArrays {
    /// The lengths that hold a scene. Uniform arrays grow in powers of two, so that scenes of
    /// nearly one size share a shader; none is empty, since WGSL has no empty arrays.
    pub fn new(packed: &Packed) -> Self {
        let room = |count: usize, bytes: usize| {
            let rounded = count.max(1).next_power_of_two();
            if rounded * bytes <= UNIFORM_BYTES {
                rounded
            } else {
                count
            }
        };
        Self {
            materials: room(packed.materials.len(), size_of::<pack::Material>()),
            spheres: room(packed.spheres.len(), size_of::<pack::Sphere>()),
            boxes: room(packed.boxes.len(), size_of::<pack::Cuboid>()),
            lamps: room(packed.lamps.len(), size_of::<pack::Lamp>()),
        }
    }

    /// Name, WGSL element type, length, element size in bytes, in the order of the bindings.
    pub fn list(&self) -> [(&'static str, &'static str, usize, usize); 4] {
        [
            (
                "materials",
                "Material",
                self.materials,
                size_of::<pack::Material>(),
            ),
            ("spheres", "Sphere", self.spheres, size_of::<pack::Sphere>()),
            ("boxes", "Box", self.boxes, size_of::<pack::Cuboid>()),
            ("lamps", "Lamp", self.lamps, size_of::<pack::Lamp>()),
        ]
    }

    /// Whether an array of this length and element size is a uniform buffer.
    pub fn is_uniform(length: usize, bytes: usize) -> bool {
        length * bytes <= UNIFORM_BYTES
    }

    /// What each binding of group 0 holds: an array, by its place in the list, or nothing.
    ///
    /// The fourth uniform buffer of a kernel is one that no shader declares. Mesa's software driver (22.3)
    /// notes which members of uniform buffer b, counted from 1, decide branches; it writes them at words
    /// 32 b of a table that has 4 words for each of 32 buffers. Those of the fourth land on the
    /// counts right behind the table, and the first dispatch crashes; those of the fifth and sixth land
    /// on fields that only graphics pipelines use.
    pub fn bindings(&self) -> Vec<Option<usize>> {
        let mut bindings = Vec::new();
        let mut uniforms = 0;
        for (place, (_, _, length, bytes)) in self.list().into_iter().enumerate() {
            bindings.push(Some(place));
            uniforms += usize::from(Self::is_uniform(length, bytes));
            if uniforms == 3 && !bindings.contains(&None) {
                bindings.push(None);
            }
        }
        bindings
    }

    /// The declarations of bind group 0.
    fn declarations(&self) -> String {
        let list = self.list();
        let line = |(binding, place): (usize, Option<usize>)| {
            let (name, element, length, bytes) = list[place?];
            let place = format!("@group(0) @binding({binding})");
            Some(if Self::is_uniform(length, bytes) {
                format!("{place} var<uniform> {name}: array<{element}, {length}>;\n")
            } else {
                format!("{place} var<storage, read> {name}: array<{element}>;\n")
            })
        };
        let bindings = self.bindings().into_iter().enumerate();
        bindings.filter_map(line).collect()
    }
}

/// The numbers behind every name that the shaders compare with.
fn constants() -> String {
    [
        Scatter::wgsl_constants(),
        Filter::wgsl_constants(),
        LightSampler::wgsl_constants(),
        LightWeight::wgsl_constants(),
        LightStrategy::wgsl_constants(),
        LightDirect::wgsl_constants(),
        ScatterDiffuse::wgsl_constants(),
        ScatterBound::wgsl_constants(),
        InterruptionRule::wgsl_constants(),
        InterruptionWeight::wgsl_constants(),
        InterruptionOrder::wgsl_constants(),
        LastRay::wgsl_constants(),
        Probe::wgsl_constants(),
        format!("const RUN_LENGTH: u32 = {RUN_LENGTH}u;\n"),
    ]
    .concat()
}

/// A kernel's whole text.
///
/// # Errors
/// Only where the files of `shaders/` contradict each other, which the tests rule out.
pub fn source(kernel: Kernel, arrays: SceneArrays) -> Result<Joined> {
    let scene = match kernel {
        Kernel::Trace | Kernel::Features => arrays.declarations(),
        Kernel::Points | Kernel::Probe => String::new(),
    };
    join(kernel.name(), &(constants() + &scene))
}

/// Parses a kernel's text; a fault is reported with the file and line it stands in.
///
/// # Errors
/// [`Error::Internal`] with every fault naga finds.
pub fn parse(joined: &Joined) -> Result<naga::Module> {
    naga::front::wgsl::parse_str(&joined.text).map_err(|error| {
        let place = error
            .location(&joined.text)
            .map(|at| joined.place(at.line_number as usize));
        Error::Internal(joined.fault(place, error.message()))
    })
}

/// Validates a parsed kernel as a browser would: with no extensions.
///
/// # Errors
/// [`Error::Internal`] with file and line where naga knows them, else with the kernel's files.
pub fn validate(joined: &Joined, module: &naga::Module) -> Result<()> {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(module).map(drop).map_err(|error| {
        let defined = error.spans().filter(|(span, _)| span.is_defined());
        let spot =
            defined.min_by_key(|(span, _)| span.to_range().map_or(usize::MAX, |range| range.len()));
        let place =
            spot.map(|(span, _)| joined.place(span.location(&joined.text).line_number as usize));
        let cause: &dyn std::error::Error = error.as_inner();
        let mut text = cause.to_string();
        let mut source = cause.source();
        while let Some(deeper) = source {
            text = format!("{text}: {deeper}");
            source = deeper.source();
        }
        Error::Internal(joined.fault(place, &text))
    })
}

/// A hash over every shader file, for records: two builds with the same value trace alike.
pub fn library_hash() -> String {
    let mut hasher = blake3::Hasher::new();
    for (name, text) in LIBRARY {
        hasher
            .update(name.as_bytes())
            .update(&[0])
            .update(text.as_bytes())
            .update(&[0]);
    }
    hasher.update(constants().as_bytes());
    hasher.finalize().to_hex()[..16].to_string()
}
