//! The values that go to and come from a device, laid out as WGSL lays out its structs of the same
//! names. A test compares the two field by field.

use bytemuck::{Pod, Zeroable};

/// A vector of a device: three 32-bit floats.
pub type Vec3 = [f32; 3];

/// `camera.wgsl`: the eye is at the origin.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Camera {
    pub forward: Vec3,
    pub aperture: f32,
    pub right: Vec3,
    pub focus: f32,
    pub down: Vec3,
    pub _pad0: f32,
    pub pixel: [f32; 2],
    pub _pad1: [f32; 2],
}

/// `maths.wgsl`: three perpendicular unit vectors.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Basis {
    pub x: Vec3,
    pub _pad0: f32,
    pub y: Vec3,
    pub _pad1: f32,
    pub z: Vec3,
    pub _pad2: f32,
}

/// `sphere.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Sphere {
    pub center: Vec3,
    pub radius: f32,
    pub material: u32,
    /// 1 + index among the lamps; 0 for a sphere that does not shine.
    pub lamp: u32,
    /// 1 + place among the packed bodies.
    pub body: u32,
    pub _pad0: u32,
}

/// `box.wgsl`; called `Box` there.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Cuboid {
    pub center: Vec3,
    pub material: u32,
    pub half_size: Vec3,
    /// Place in the scene file: spheres from 1 on, then boxes.
    pub id: u32,
    pub axis_x: Vec3,
    /// 1 + place among the packed bodies.
    pub body: u32,
    pub axis_y: Vec3,
    /// 1 + index among the lamps; 0 for a box that is none.
    pub lamp: u32,
    pub axis_z: Vec3,
    pub _pad1: u32,
}

/// `scatter.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Material {
    pub albedo: Vec3,
    pub scatter: u32,
    pub emission: Vec3,
    pub survival: f32,
    pub spread: f32,
    pub lobe_mass: f32,
    pub lobe_scale: f32,
    pub shape: f32,
}

/// `light.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Lamp {
    pub center: Vec3,
    pub radius: f32,
    pub emission: Vec3,
    /// 1 + place among the packed bodies.
    pub body: u32,
    pub weight_radius: f32,
    /// 0 for a sphere; 1 + index of a box, whose middle and half diagonal are above.
    pub shape: u32,
    pub _pad0: u32,
    pub _pad1: u32,
}

/// `efficiency.wgsl`: what the rays that leave a body are worth.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Worth {
    pub split: Vec3,
    pub _pad0: f32,
    pub keep: Vec3,
    pub _pad1: f32,
}

impl Worth {
    /// Of a body of which nothing is known: as many rays leave each hit as the mean square of the throughput's
    /// channels says, and never more than one.
    pub const UNKNOWN: Self = Self {
        split: [0.0; 3],
        _pad0: 0.0,
        keep: [1.0 / 3.0; 3],
        _pad1: 0.0,
    };
}

/// `trace.wgsl`: one dispatch.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Job {
    pub camera: Camera,
    pub pole: Basis,
    pub background: Vec3,
    pub clamp: f32,
    pub corner: [u32; 2],
    pub size: [u32; 2],
    pub seed: [u32; 2],
    pub first_sample: [u32; 2],
    pub samples: u32,
    pub max_bounces: u32,
    pub interruption_start: u32,
    pub steps: u32,
}

/// `features.wgsl`: one dispatch.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FeatureJob {
    pub camera: Camera,
    pub corner: [u32; 2],
    pub size: [u32; 2],
    pub iterations: u32,
    pub _pad0: [u32; 3],
}

/// `guides.wgsl`: one dispatch.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct GuideJob {
    pub camera: Camera,
    pub corner: [u32; 2],
    /// In lanes: `fineness` for each pixel.
    pub size: [u32; 2],
    pub fineness: u32,
    /// Most mirrors that a ray follows.
    pub mirrors: u32,
    pub iterations: u32,
    pub _pad0: u32,
}

/// `guides.wgsl`: the first surface that is no mirror.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Guide {
    /// Faces the arriving ray; zero where nothing is met.
    pub normal: Vec3,
    /// Of the whole way from the eye, scene units.
    pub distance: f32,
    /// Relative to the eye, scene units.
    pub position: Vec3,
    /// 0 where nothing is met, then the spheres from 1 on, then the boxes.
    pub id: u32,
    /// The share of its light that the mirrors on the way reflect.
    pub tint: Vec3,
    /// How many.
    pub mirrors: u32,
}

/// `denoise.wgsl`: one dispatch.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DenoiseJob {
    /// The pixels that are made, within the window.
    pub corner: [u32; 2],
    pub size: [u32; 2],
    /// Width and height of what is bound: those pixels, and the ones around that they look at.
    pub window: [u32; 2],
    /// Pixels between two taps.
    pub step: u32,
    /// 1: the variance alone is spread, by the guides alone.
    pub only_variance: u32,
    /// What squared differences are multiplied by: of light, in variances.
    pub light: f32,
    /// Of normals.
    pub normal: f32,
    /// Of the distance from the other's tangent plane, in widths of a pixel there.
    pub depth: f32,
    pub _pad0: u32,
}

/// `denoise.wgsl`: what is known of a pixel without noise, means over the pixel.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Site {
    pub normal: Vec3,
    /// How wide a pixel is at its distance, scene units; 0 where nothing is met.
    pub footprint: f32,
    /// Relative to the eye.
    pub position: Vec3,
    /// How far the surfaces within the pixel are from their mean: an exponent, as `site_distance` gives it. Below 0
    /// where the light is not a number: then it takes part in nothing.
    pub spread: f32,
    /// Mirrors on the way, and the shares of what emits, scatters around the mirror direction and is black.
    pub kind: [f32; 4],
}

/// `denoise.wgsl`: light before the surfaces' albedo.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Estimate {
    pub light: Vec3,
    /// Mean of those of its channels.
    pub variance: f32,
}

/// `points.wgsl`: one dispatch.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PointsJob {
    pub lamp: Lamp,
    pub material: Material,
    pub pole: Basis,
    pub receiver: Vec3,
    pub inside: u32,
    pub normal: Vec3,
    pub count: u32,
    pub incoming: Vec3,
    pub scattering: u32,
    pub seed: [u32; 2],
    pub first: [u32; 2],
}

/// `points.wgsl`: one draw of a sampler.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Draw {
    /// A point of the lamp as a unit vector from its centre, or a scattered direction.
    pub point: Vec3,
    /// By solid angle; 0 where there is none.
    pub density: f32,
    /// 1 where the draw counts.
    pub useful: u32,
    pub _pad0: u32,
    pub _pad1: u32,
    pub _pad2: u32,
}

/// `probe.wgsl`: one dispatch.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ProbeJob {
    pub function: u32,
    pub count: u32,
}

/// `probe.wgsl`; called `Input` there.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ProbeInput {
    pub a: [f32; 4],
    pub b: [f32; 4],
    pub c: [f32; 4],
    pub d: [f32; 4],
}

/// `probe.wgsl`; called `Output` there.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ProbeOutput {
    pub a: [f32; 4],
    pub b: [f32; 4],
}

/// `canary.wgsl`: every struct that a scene's arrays hold.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CanaryScene {
    pub material: Material,
    pub lamp: Lamp,
    pub sphere: Sphere,
    /// A box; `box` is a word of Rust's.
    pub body: Cuboid,
}

/// `canary.wgsl`: one dispatch, with every kind of member that a job has.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CanaryJob {
    /// A [`crate::shader::Canary`]'s number.
    pub canary: u32,
    pub count: u32,
    pub corner: [u32; 2],
    pub seed: [u32; 2],
    pub _pad0: [u32; 2],
    pub camera: Camera,
    pub pole: Basis,
    pub scene: CanaryScene,
    pub background: Vec3,
    pub clamp: f32,
}

/// What a device measured of one pixel over one run of samples.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Tally {
    /// Mean radiance of the run's samples, R, G, B.
    pub mean: [f32; 3],
    /// Rays traced, shadow rays included.
    pub rays: u32,
    /// Sum over the run's samples of the squared distance from that mean, R, G, B.
    pub squares: [f32; 3],
    /// Samples of the run whose radiance was not finite; they count as black.
    /// Low 16 bits: how many. High 16 bits: the place in the run of the first of them.
    pub non_finite: u32,
}

/// What the ray through a pixel's centre meets first.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Feature {
    /// Unit normal facing the camera; zero where nothing is met.
    pub normal: [f32; 3],
    /// Distance in scene units; zero where nothing is met.
    pub depth: f32,
    /// Reflectance, R, G, B.
    pub albedo: [f32; 3],
    /// 0 where nothing is met, then the spheres from 1 on, then the boxes.
    pub id: u32,
}
