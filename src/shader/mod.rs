//! The shaders' text: joined from `shaders/`, with constants printed from the Rust types that
//! define them, parsed and validated without a GPU.

mod join;
mod library;

pub use join::{Joined, join};
pub use library::LIBRARY;

use crate::error::{Error, Result};
use crate::knobs::*;
use crate::bvh;
use crate::pack::{self, LastRay, Packed, RUN_LENGTH, Traversal};
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
    /// Entries of the tree; 0 where rays find bodies without one.
    pub nodes: usize,
}

/// One array of the scene: the name of its accessor, its WGSL element type, its length, and the
/// bytes of an element.
#[derive(Clone, Copy, Debug)]
pub struct SceneArray {
    pub name: &'static str,
    pub element: &'static str,
    pub length: usize,
    pub stride: usize,
}

impl SceneArrays {
    /// The lengths that hold a scene. Small ones grow in powers of two, so that scenes of nearly one
    /// size share a shader; none is empty, since WGSL has no empty arrays.
    pub fn new(packed: &Packed) -> Self {
        let lengths = |room: fn(usize) -> usize| Self {
            materials: room(packed.materials.len()),
            spheres: room(packed.spheres.len()),
            boxes: room(packed.boxes.len()),
            lamps: room(packed.lamps.len()),
            nodes: packed.tree.as_ref().map_or(0, |tree| tree.nodes.len()),
        };
        let rounded = lengths(|count| count.max(1).next_power_of_two());
        if rounded.is_uniform() {
            rounded
        } else {
            lengths(|count| count.max(1))
        }
    }

    /// The arrays in the order in which they are bound or lie in the uniform buffer.
    pub fn list(&self) -> Vec<SceneArray> {
        let array = |name, element, length, stride| SceneArray {
            name,
            element,
            length,
            stride,
        };
        let mut arrays = vec![
            array(
                "material_at",
                "Material",
                self.materials,
                size_of::<pack::Material>(),
            ),
            array(
                "sphere_at",
                "Sphere",
                self.spheres,
                size_of::<pack::Sphere>(),
            ),
            array("box_at", "Box", self.boxes, size_of::<pack::Cuboid>()),
            array("lamp_at", "Lamp", self.lamps, size_of::<pack::Lamp>()),
        ];
        if self.nodes > 0 {
            arrays.push(array("node_at", "vec4<u32>", self.nodes, size_of::<bvh::Encoded>()));
            arrays.push(array("node_body_at", "u32", self.nodes, size_of::<u32>()));
        }
        arrays
    }

    /// How rays find bodies in a scene of these arrays.
    pub fn traversal(&self) -> Traversal {
        match self.nodes {
            0 => Traversal::General,
            _ => Traversal::Bvh,
        }
    }

    /// Whether the whole scene is one uniform buffer. It is one and not four because lavapipe 22.3
    /// writes past a table of its own for a kernel's fourth uniform buffer, and crashes.
    ///
    /// A tree is never in one: an array of u32 would take four times its room there.
    pub fn is_uniform(&self) -> bool {
        if self.traversal() == Traversal::Bvh {
            return false;
        }
        let bytes: usize = self
            .list()
            .iter()
            .map(|array| array.length * array.stride)
            .sum();
        bytes <= UNIFORM_BYTES
    }

    /// Bind group 0 and the functions that read it: `sphere_at(i)` and the like.
    fn declarations(&self) -> String {
        let accessor = |array: &SceneArray, place: &str| {
            let SceneArray { name, element, .. } = array;
            format!("fn {name}(index: u32) -> {element} {{\n    return {place}[index];\n}}\n")
        };
        if self.is_uniform() {
            let member = |array: &SceneArray| {
                format!(
                    "    {}_: array<{}, {}>,\n",
                    array.name, array.element, array.length
                )
            };
            let members: String = self.list().iter().map(member).collect();
            let read = |array: &SceneArray| accessor(array, &format!("scene_data.{}_", array.name));
            let readers: String = self.list().iter().map(read).collect();
            return format!(
                "struct SceneData {{\n{members}}}\n@group(0) @binding(0) var<uniform> scene_data: SceneData;\n{readers}"
            );
        }
        let storage = |(binding, array): (usize, &SceneArray)| {
            let SceneArray { name, element, .. } = array;
            let variable = format!(
                "@group(0) @binding({binding}) var<storage, read> {name}_: array<{element}>;\n"
            );
            variable + &accessor(array, &format!("{name}_"))
        };
        self.list().iter().enumerate().map(storage).collect()
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
    join(kernel.name(), &(constants() + &scene), arrays.traversal())
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
