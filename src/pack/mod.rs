//! From a scene to flat buffers: what a device needs, with no device in it.

mod alias;
mod choice;
mod guides;
mod layout;
mod light_tree;
mod rect;
mod strategy;
mod traversal;
mod tree;

pub use choice::{ChoiceEntry, Choices};
pub use layout::*;
pub use rect::Rect;
pub use strategy::{LastRay, RUN_LENGTH, Strategy};
pub use traversal::Traversal;
pub use tree::Hierarchy;

use crate::knobs::{Choice, InterruptionRule, Pole, Scatter, ScatterBound, Settings};
use crate::scene::{self, Scene};
use glam::{DMat3, DVec3};
use std::sync::Arc;

/// A scene as a device sees it: in the eye's own place, so that what is near has small coordinates.
#[derive(Clone, Debug)]
pub struct Packed {
    pub camera: Camera,
    pub pole: Basis,
    pub background: Vec3,
    /// Largest radiance of a sample; huge where there is no clamp.
    pub clamp: f32,
    pub seed: u64,
    pub max_bounces: u32,
    pub interruption_start: u32,
    pub materials: Vec<Material>,
    pub spheres: Vec<Sphere>,
    /// Unrotated boxes first.
    pub boxes: Vec<Cuboid>,
    pub lamps: Vec<Lamp>,
    /// What one of the lamps is chosen by.
    pub choice: Arc<Choices>,
    /// What the rays that leave each body are worth; of no body but by the rule `efficiency`, and by that rule
    /// unknown until a pilot fills them in.
    pub worths: Vec<Worth>,
    /// The bodies once more where rays find them by a tree.
    pub hierarchy: Option<Arc<Hierarchy>>,
    pub strategy: Strategy,
    /// How rays find its bodies.
    pub traversal: Traversal,
}

impl Packed {
    pub fn new(scene: &Scene) -> Self {
        Self::by(scene, Traversal::of(scene))
    }

    /// For a traversal that is already chosen.
    pub fn by(scene: &Scene, traversal: Traversal) -> Self {
        let eye = scene.camera.position;
        let settings = &scene.settings;
        let (spheres, mut lamps) = pack_spheres(scene, eye);
        let (mut boxes, rotated) = pack_boxes(scene, eye);
        if strategy::samples_boxes(scene) {
            add_box_lamps(scene, &mut boxes, &mut lamps);
        }
        let straight = boxes.len() - rotated as usize;
        let mut strategy = Strategy::new(
            scene,
            spheres.len() as u32,
            straight as u32,
            rotated,
            lamps.len() as u32,
        );
        let choice = Choices::new(&settings.light, &lamps, &boxes);
        strategy.light_loops = choice.loops;
        let by_tree = traversal == Traversal::Bvh;
        let camera = pack_camera(&scene.camera, settings.image.width, settings.image.height);
        let view = camera.forward.into();
        let hierarchy = by_tree.then(|| Hierarchy::new(&spheres, &boxes, straight, view));
        if let Some(hierarchy) = &hierarchy {
            strategy.outside_sphere_count = hierarchy.spheres.len() as u32;
            strategy.outside_box_count = hierarchy.boxes.len() as u32 - hierarchy.rotated;
            strategy.outside_rotated_count = hierarchy.rotated;
        }
        let material = |material| pack_material(material, settings.scatter.bound);
        Self {
            camera,
            pole: pack_pole(settings.light.pole),
            background: single(scene.background),
            clamp: settings.render.clamp.map_or(f32::MAX, |clamp| clamp as f32),
            seed: settings.render.seed,
            max_bounces: settings.render.max_bounces,
            interruption_start: settings.interruption.start,
            materials: scene.materials.iter().map(material).collect(),
            spheres,
            worths: unknown_worths(scene),
            boxes,
            lamps,
            choice: Arc::new(choice),
            hierarchy: hierarchy.map(Arc::new),
            strategy,
            traversal,
        }
    }

    /// One dispatch of the tracing kernel: `samples` samples from `first_sample` on of each pixel of `rect`.
    pub fn job(&self, rect: Rect, first_sample: u64, samples: u32) -> Job {
        Job {
            camera: self.camera,
            pole: self.pole,
            background: self.background,
            clamp: self.clamp,
            corner: [rect.x0, rect.y0],
            size: [rect.width(), rect.height()],
            seed: words(self.seed),
            first_sample: words(first_sample),
            samples,
            max_bounces: self.max_bounces,
            interruption_start: self.interruption_start,
            steps: u32::try_from(self.longest_path().saturating_mul(samples.into()))
                .unwrap_or(u32::MAX),
        }
    }

    /// The most rays that all branches of a path may take, shadow rays left out.
    pub fn longest_path(&self) -> u64 {
        (u64::from(self.max_bounces) + 1) * u64::from(self.strategy.interruption_split)
    }
}

/// A 64-bit number as (low, high).
pub fn words(number: u64) -> [u32; 2] {
    [number as u32, (number >> 32) as u32]
}

fn unknown_worths(scene: &Scene) -> Vec<Worth> {
    match scene.settings.interruption.rule {
        InterruptionRule::Efficiency => {
            vec![Worth::UNKNOWN; scene.spheres.len() + scene.boxes.len()]
        }
        _ => Vec::new(),
    }
}

fn single(v: DVec3) -> Vec3 {
    v.as_vec3().to_array()
}

fn basis(axes: DMat3) -> Basis {
    Basis {
        x: single(axes.x_axis),
        y: single(axes.y_axis),
        z: single(axes.z_axis),
        ..Basis::default()
    }
}

fn pack_camera(camera: &scene::Camera, width: u32, height: u32) -> Camera {
    let view = camera.look_at - camera.position;
    let forward = view.normalize();
    let right = forward.cross(camera.up).normalize();
    let down = forward.cross(right);
    let half_height = (0.5 * camera.fov.to_radians()).tan();
    let half_width = half_height * f64::from(width) / f64::from(height);
    Camera {
        forward: single(forward),
        aperture: camera.aperture as f32,
        focus: camera.focus.unwrap_or(view.length()) as f32,
        right: single(right * half_width),
        down: single(down * half_height),
        pixel: [2.0 / width as f32, 2.0 / height as f32],
        ..Camera::default()
    }
}

/// The pole is the basis's z axis; which way x and y point does not matter to any sampler.
fn pack_pole(pole: Pole) -> Basis {
    let axis = match pole {
        Pole::Axis(axis) => axis.normalize(),
        Pole::Receiver => DVec3::Z,
    };
    if axis == DVec3::Z {
        return basis(DMat3::IDENTITY);
    }
    let (x, y) = axis.any_orthonormal_pair();
    basis(DMat3::from_cols(x, y, axis))
}

/// The narrowest and the widest lobe that f32 angles tell apart from a mirror and from an even angle.
const SPREAD_RANGE: (f64, f64) = (1e-5, 1e5);

/// Values that a random number of the shaders can have (`random_unit`).
const DRAWS: f64 = (1 << 24) as f64;

/// The threshold with which numbers on that lattice are compared as with this one, so that the weight of survivors
/// is over the probability that they have.
fn drawable(survival: f64) -> f32 {
    ((f64::from(survival as f32) * DRAWS).ceil() / DRAWS) as f32
}

fn pack_material(material: &scene::Material, bound: ScatterBound) -> Material {
    let spread = material.spread.clamp(SPREAD_RANGE.0, SPREAD_RANGE.1);
    let right_angle = std::f64::consts::FRAC_PI_2;
    let mass = match bound {
        ScatterBound::Truncate => libm::erf(right_angle / (std::f64::consts::SQRT_2 * spread)),
        ScatterBound::Clamp => 1.0,
    };
    let half_normal = std::f64::consts::FRAC_2_PI.sqrt() / (spread * mass);
    Material {
        albedo: single(material.albedo),
        scatter: material.scattering().index(),
        emission: single(material.emission),
        survival: drawable(material.survival),
        spread: spread as f32,
        lobe_mass: mass as f32,
        lobe_scale: (half_normal / std::f64::consts::TAU) as f32,
        shape: match material.scattering() {
            Scatter::Rough => material.roughness as f32,
            Scatter::Glass => material.index as f32,
            Scatter::Diffuse | Scatter::Directional | Scatter::Mirror => 0.0,
        },
    }
}

fn pack_spheres(scene: &Scene, eye: DVec3) -> (Vec<Sphere>, Vec<Lamp>) {
    let mut lamps = Vec::new();
    let mut spheres = Vec::with_capacity(scene.spheres.len());
    for (index, sphere) in scene.spheres.iter().enumerate() {
        let material = &scene.materials[sphere.material];
        let center = single(sphere.center - eye);
        let radius = sphere.radius as f32;
        if material.emits() {
            lamps.push(Lamp {
                center,
                radius,
                emission: single(material.emission),
                body: index as u32 + 1,
                weight_radius: weight_radius(&scene.settings, sphere.radius),
                ..Lamp::default()
            });
        }
        spheres.push(Sphere {
            center,
            radius,
            material: sphere.material as u32,
            lamp: if material.emits() {
                lamps.len() as u32
            } else {
                0
            },
            body: index as u32 + 1,
            ..Sphere::default()
        });
    }
    (spheres, lamps)
}

fn weight_radius(settings: &Settings, own: f64) -> f32 {
    settings.light.weight_radius.unwrap_or(own) as f32
}

/// The boxes, unrotated ones first, and how many are rotated.
fn pack_boxes(scene: &Scene, eye: DVec3) -> (Vec<Cuboid>, u32) {
    let is_rotated = |shape: &scene::Cuboid| shape.rotation != DVec3::ZERO;
    let first_id = scene.spheres.len() as u32 + 1;
    let numbered = || scene.boxes.iter().zip(first_id..);
    let straight = numbered().filter(|(shape, _)| !is_rotated(shape));
    let rotated = numbered().filter(|(shape, _)| is_rotated(shape));
    let pack = |(shape, id)| pack_box(shape, eye, id);
    let mut boxes: Vec<_> = straight.chain(rotated).map(pack).collect();
    for (shape, body) in boxes.iter_mut().zip(first_id..) {
        shape.body = body;
    }
    let rotated = scene.boxes.iter().filter(|shape| is_rotated(shape)).count();
    (boxes, rotated as u32)
}

/// Makes lamps of the boxes that shine, behind those there are.
fn add_box_lamps(scene: &Scene, boxes: &mut [Cuboid], lamps: &mut Vec<Lamp>) {
    for (shape, number) in boxes.iter_mut().zip(1..) {
        let material = &scene.materials[shape.material as usize];
        if !material.emits() {
            continue;
        }
        let radius = glam::Vec3::from(shape.half_size).length();
        lamps.push(Lamp {
            center: shape.center,
            radius,
            emission: single(material.emission),
            body: shape.body,
            weight_radius: radius,
            shape: number,
            ..Lamp::default()
        });
        shape.lamp = lamps.len() as u32;
    }
}

fn pack_box(shape: &scene::Cuboid, eye: DVec3, id: u32) -> Cuboid {
    let angle = DVec3::from_array(shape.rotation.to_array().map(f64::to_radians));
    // Applied about x, then y, then z: the product stands in the opposite order.
    let rotation = DMat3::from_rotation_z(angle.z)
        * DMat3::from_rotation_y(angle.y)
        * DMat3::from_rotation_x(angle.x);
    Cuboid {
        center: single(0.5 * (shape.min + shape.max) - eye),
        material: shape.material as u32,
        half_size: single(0.5 * (shape.max - shape.min)),
        id,
        axis_x: single(rotation.x_axis),
        axis_y: single(rotation.y_axis),
        axis_z: single(rotation.z_axis),
        ..Cuboid::default()
    }
}
