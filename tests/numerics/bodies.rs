//! Lone bodies of any size, and small renders of them.

use crate::support::stream::Stream;
use glam::{DMat3, DVec3};
use lampray::device::Device;
use lampray::pack::{Camera, Cuboid, Lamp, Material, Packed, Rect, Sphere, Tally};
use lampray::scene::Scene;
use std::f64::consts::TAU;

const HEAD: &str = r#"
version = 1
[camera]
position = [0.0, 0.0, 0.0]
look_at = [0.3, -0.2, -1.0]
fov = 120.0
[image]
width = 16
height = 16
[render]
samples = 16
max_bounces = 20
[interruption]
rule = "none"
[materials.white]
albedo = [1.0, 1.0, 1.0]
[materials.lamp]
albedo = [0.0, 0.0, 0.0]
emission = [1e6, 1e6, 1e6]
"#;

pub fn packed(text: &str) -> Packed {
    let scene = Scene::parse("test.toml", &(HEAD.to_string() + text), &[]);
    Packed::new(&scene.unwrap_or_else(|e| panic!("{e}")))
}

/// A scene of one body, to be put in by hand.
pub fn empty() -> Packed {
    packed("[background]\nemission = [1.0, 1.0, 1.0]\n")
}

pub fn one_sphere(center: DVec3, radius: f64) -> Packed {
    let mut scene = empty();
    scene.spheres = vec![Sphere {
        center: center.as_vec3().to_array(),
        radius: radius as f32,
        ..Sphere::default()
    }];
    scene.strategy.sphere_count = 1;
    scene
}

pub fn one_box(center: DVec3, half: DVec3, axes: DMat3) -> Packed {
    let mut scene = empty();
    scene.boxes = vec![Cuboid {
        center: center.as_vec3().to_array(),
        half_size: half.as_vec3().to_array(),
        id: 1,
        axis_x: axes.x_axis.as_vec3().to_array(),
        axis_y: axes.y_axis.as_vec3().to_array(),
        axis_z: axes.z_axis.as_vec3().to_array(),
        ..Cuboid::default()
    }];
    scene.strategy.rotated_box_count = 1;
    scene
}

pub fn vector(stream: &mut Stream) -> DVec3 {
    DVec3::from_array(stream.direction())
}

/// A body's shape and place.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    pub center: DVec3,
    /// Half sizes; of a sphere, its radius three times.
    pub half: DVec3,
    pub axes: DMat3,
    pub kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Sphere,
    Straight,
    Turned,
}

impl Body {
    /// Number `number` of many: of radius 1e-4 to 1e4, a sphere, a box and a turned box in turn. Its
    /// centre is for the caller to choose.
    pub fn any(number: usize, stream: &mut Stream) -> Self {
        let size = stream.scale(1e-4, 1e4);
        let kind = [Kind::Sphere, Kind::Straight, Kind::Turned][number % 3];
        let mut side = || size * stream.unit().max(0.05);
        let half = match kind {
            Kind::Sphere => DVec3::splat(size),
            _ => DVec3::new(size, side(), side()),
        };
        let (z, turn) = (vector(stream), stream.between(0.0, TAU));
        let (x, y) = z.any_orthonormal_pair();
        let (sine, cosine) = turn.sin_cos();
        let axes = match kind {
            Kind::Turned => DMat3::from_cols(cosine * x + sine * y, cosine * y - sine * x, z),
            _ => DMat3::IDENTITY,
        };
        let center = DVec3::ZERO;
        Self {
            center,
            half,
            axes,
            kind,
        }
    }

    /// Radius of the largest ball in it, and of the smallest around it.
    pub fn reach(&self) -> (f64, f64) {
        match self.kind {
            Kind::Sphere => (self.half.x, self.half.x),
            _ => (self.half.min_element(), self.half.length()),
        }
    }

    /// Its scene: white, under a sky of radiance 1.
    pub fn scene(&self) -> Packed {
        let mut scene = match self.kind {
            Kind::Sphere => one_sphere(self.center, self.half.x),
            _ => one_box(self.center, self.half, self.axes),
        };
        let white = |material: &Material| material.emission == [0.0; 3];
        scene.materials.retain(white);
        count_bodies(&mut scene, self.kind);
        scene
    }

    /// The body and one like it beside it, half in the first.
    pub fn scene_of_two(&self, beside: DVec3) -> Packed {
        let mut scene = self.scene();
        let other = Self {
            center: self.center + beside,
            ..*self
        };
        let other = other.scene();
        scene.spheres.extend(other.spheres);
        scene.boxes.extend(other.boxes);
        count_bodies(&mut scene, self.kind);
        scene
    }
}

/// Tells a scene of bodies of one kind how many it has.
fn count_bodies(scene: &mut Packed, kind: Kind) {
    let boxes = scene.boxes.len() as u32;
    let turned = kind == Kind::Turned;
    scene.strategy.sphere_count = scene.spheres.len() as u32;
    scene.strategy.box_count = if turned { 0 } else { boxes };
    scene.strategy.rotated_box_count = if turned { boxes } else { 0 };
}

/// Points the camera: half the picture's height is `slope` at distance 1.
pub fn look(scene: &mut Packed, forward: DVec3, slope: f64, side: u32) {
    let (right, down) = forward.any_orthonormal_pair();
    scene.camera = Camera {
        forward: forward.as_vec3().to_array(),
        right: (slope * right).as_vec3().to_array(),
        down: (slope * down).as_vec3().to_array(),
        pixel: [2.0 / side as f32; 2],
        ..Camera::default()
    };
}

/// Puts one more sphere into a scene, that shines.
pub fn add_lamp(scene: &mut Packed, center: DVec3, radius: f64, radiance: f32) {
    let mut shining = scene.materials[0];
    (shining.emission, shining.albedo) = ([radiance; 3], [0.0; 3]);
    scene.materials.push(shining);
    let (center, radius) = (center.as_vec3().to_array(), radius as f32);
    scene.spheres.push(Sphere {
        center,
        radius,
        material: scene.materials.len() as u32 - 1,
        lamp: 1,
        ..Sphere::default()
    });
    scene.lamps = vec![Lamp {
        center,
        radius,
        emission: [radiance; 3],
        body: scene.spheres.len() as u32,
        weight_radius: radius,
        ..Lamp::default()
    }];
    scene.strategy.sphere_count += 1;
    scene.strategy.lamp_count = 1;
}

/// The first `samples` samples of a picture of `side` by `side` pixels.
pub fn trace(device: &mut dyn Device, scene: &Packed, side: u32, samples: u32) -> Vec<Tally> {
    let all = Rect {
        x0: 0,
        y0: 0,
        x1: side,
        y1: side,
    };
    device.load(scene).unwrap();
    device.trace(all, 0, samples).unwrap()
}
