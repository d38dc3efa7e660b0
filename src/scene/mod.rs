//! The scene: what stands where, what it is made of, and how it is to be sampled.
//!
//! A file goes through `load` (bytes to text), `read` (TOML to a draft of what was written),
//! `assign` (the command line over it) and `build` (defaults, presets, checks). Whatever is wrong on
//! the way is gathered in `faults` and said at once. `lint` looks at a finished scene.

mod assign;
mod build;
mod draft;
mod faults;
mod finding;
mod idle;
mod lint;
mod load;
mod places;
mod read;
mod shapes;
mod solid;
mod sweep;
mod unbounded;

pub use assign::Assignment;
pub use build::MOST_BAKED;
pub use faults::Mistakes;
pub use finding::Finding;
pub use load::MOST_BYTES;
pub use read::{MOST_MATERIALS, MOST_PRIMITIVES};
pub use sweep::{Region, SweepTable};
pub use unbounded::Unbounded;

use crate::knobs::{Scatter, Settings};
use glam::DVec3;

/// A scene whose every value has been checked.
///
/// Lengths are in scene units, right-handed with y up; radiance and albedo are linear R, G, B.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Where it came from.
    pub source: Source,
    pub camera: Camera,
    /// Radiance of rays that leave the scene.
    pub background: DVec3,
    pub materials: Vec<Material>,
    pub spheres: Vec<Sphere>,
    pub boxes: Vec<Cuboid>,
    pub settings: Settings,
    /// Every knob with the value it has here, by path, as records carry them: all of them but
    /// `spheres.*` and `boxes.*`, of which only those that `--set` changed.
    pub knobs: serde_json::Map<String, serde_json::Value>,
    /// What `lampray sweep` is asked for; a single render has no use of it.
    pub sweep: SweepTable,
}

/// The text that a scene was read from.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// The path as given, or another name for messages and records.
    pub name: String,
    pub text: String,
}

/// A camera: a pinhole, or a thin lens.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    pub position: DVec3,
    pub look_at: DVec3,
    pub up: DVec3,
    /// Vertical field of view in degrees, between 0 and 180.
    pub fov: f64,
    /// Radius of the lens, scene units; 0 for a pinhole.
    pub aperture: f64,
    /// Distance along the view to the plane in focus, scene units; that of `look_at` if absent.
    pub focus: Option<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    pub name: String,
    pub scatter: Scatter,
    /// Reflectance per channel, 0 to 1.
    pub albedo: DVec3,
    /// Sigma of the half-normal angle of directional scattering, radians, > 0.
    pub spread: f64,
    /// GGX alpha of a rough mirror, 0 to 1.
    pub roughness: f64,
    /// Refractive index of glass, 1 to 4.
    pub index: f64,
    /// The paper's threshold t, 0 to 1.
    pub survival: f64,
    /// Radiance, >= 0.
    pub emission: DVec3,
}

/// Rough mirrors of a smaller alpha are mirrors. Their reflections are within 0.1 degrees of the mirror
/// direction, and a 32-bit float tells where in such a lobe a direction is to a few thousandths only.
const SMOOTH: f64 = 1e-3;

impl Material {
    /// How the devices treat it: rough mirrors that are all but smooth are mirrors.
    pub fn scattering(&self) -> Scatter {
        match self.scatter {
            Scatter::Rough if self.roughness < SMOOTH => Scatter::Mirror,
            other => other,
        }
    }

    pub fn emits(&self) -> bool {
        self.emission.max_element() > 0.0
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Sphere {
    pub center: DVec3,
    pub radius: f64,
    /// Index into the scene's materials.
    pub material: usize,
}

/// A box: `Box` is Rust's own.
#[derive(Clone, Debug, PartialEq)]
pub struct Cuboid {
    pub min: DVec3,
    pub max: DVec3,
    /// Degrees about the box's centre, applied about x, then y, then z.
    pub rotation: DVec3,
    /// Index into the scene's materials.
    pub material: usize,
}

impl Scene {
    /// The spheres that emit: the lamps that are sampled.
    pub fn lamps(&self) -> impl Iterator<Item = (usize, &Sphere)> {
        let emits = |(_, sphere): &(usize, &Sphere)| self.materials[sphere.material].emits();
        self.spheres.iter().enumerate().filter(emits)
    }
}
