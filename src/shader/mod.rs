//! The shaders' text: joined from `shaders/`, with constants printed from the Rust types that
//! define them, parsed and validated without a GPU.

mod arrays;
mod bake;
mod interface;
mod join;
mod library;

pub use arrays::{SceneArray, SceneArrays};
pub use bake::Baked;
pub use interface::same_interface;
pub use join::{Joined, join};
pub use library::{LIBRARY, Library};

use crate::error::{Error, Result};
use crate::knobs::*;
use crate::pack::{LastRay, RUN_LENGTH, Traversal};
use naga::valid::{Capabilities, ValidationFlags, Validator};

choice! {
    /// The kernels: each a file of `shaders/` with one entry point, `main`.
    Kernel, "KERNEL" {
        Trace = "trace",
        Features = "features",
        Guides = "guides",
        Denoise = "denoise",
        Points = "points",
        Probe = "probe",
        Canary = "canary",
    }
}

choice! {
    /// What the canary kernel can be asked; `doctor` knows the answers.
    Canary, "CANARY" {
        Loops = "loops",
        Integers = "integers",
        Random = "random",
        Layout = "layout",
        Finite = "finite",
        Denormals = "denormals",
        Bounds = "bounds",
        Floats = "floats",
        Conversion = "conversion",
    }
}

choice! {
    /// The library functions that the probe kernel can run.
    Probe, "PROBE" {
        RandomBits = "random-bits",
        RandomUnit = "random-unit",
        Sequence = "sequence",
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
        FirstShare = "first-share",
        SampleBox = "sample-box",
        BoxDensity = "box-density",
        Survival = "survival",
        Finite = "finite",
        Fresnel = "fresnel",
        Lens = "lens",
        Continuations = "continuations",
        BranchKey = "branch-key",
    }
}

/// The numbers behind every name that the shaders compare with.
fn constants() -> String {
    [
        Scatter::wgsl_constants(),
        Filter::wgsl_constants(),
        LightSampler::wgsl_constants(),
        LightWeight::wgsl_constants(),
        LightTest::wgsl_constants(),
        LightStrategy::wgsl_constants(),
        LightChoice::wgsl_constants(),
        LightDirect::wgsl_constants(),
        ScatterDiffuse::wgsl_constants(),
        ScatterBound::wgsl_constants(),
        InterruptionRule::wgsl_constants(),
        InterruptionWeight::wgsl_constants(),
        InterruptionOrder::wgsl_constants(),
        LastRay::wgsl_constants(),
        Sequence::wgsl_constants(),
        Probe::wgsl_constants(),
        Canary::wgsl_constants(),
        format!("const RUN_LENGTH: u32 = {RUN_LENGTH}u;\n"),
    ]
    .concat()
}

/// A kernel's whole text.
///
/// # Errors
/// Only where the files of `shaders/` contradict each other, which the tests rule out.
pub fn source(kernel: Kernel, arrays: SceneArrays) -> Result<Joined> {
    source_of(&Library::default(), kernel, arrays)
}

/// [`source`], of any build's files.
///
/// # Errors
/// [`Error::Internal`] where the files contradict each other.
pub fn source_of(library: &Library, kernel: Kernel, arrays: SceneArrays) -> Result<Joined> {
    let scene = match kernel {
        Kernel::Trace | Kernel::Features | Kernel::Guides => arrays.declarations(),
        Kernel::Points | Kernel::Probe | Kernel::Canary | Kernel::Denoise => String::new(),
    };
    let generated = constants() + &scene;
    join(library, kernel.name(), &generated, arrays.traversal())
}

/// The whole text of the tracing kernel for one scene.
///
/// # Errors
/// As [`source`].
pub fn baked_source(baked: &Baked) -> Result<Joined> {
    baked_source_of(&Library::default(), baked)
}

/// [`baked_source`], of any build's files.
///
/// # Errors
/// As [`source_of`].
pub fn baked_source_of(library: &Library, baked: &Baked) -> Result<Joined> {
    let generated = constants() + &baked.text;
    join(library, Kernel::Trace.name(), &generated, Traversal::Baked)
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
