//! Crowds of bodies that are hard on a tree, on its grid, or on 32-bit floats.

use crate::support::stream::Stream;
use glam::DVec3;
use lampray::pack::Packed;
use lampray::scene::{Assignment, Cuboid, Scene, Sphere};

const EMPTY: &str = r#"version = 1
camera = { position = [0, 0, 0], look_at = [0, 0, -1], fov = 60 }
image = { width = 24, height = 16 }
render = { max_bounces = 4 }
background = { emission = [0.3, 0.4, 0.5] }
[materials]
grey = { albedo = [0.7, 0.6, 0.5] }
mirror = { scatter = "mirror", albedo = [0.9, 0.9, 0.9] }
lamp = { albedo = [0.2, 0.2, 0.2], emission = [9.0, 8.0, 7.0] }
"#;

/// A scene without bodies, for a kernel.
pub fn empty(kernel: &str) -> Scene {
    let kernel = Assignment::parse(&format!("render.kernel={kernel}")).unwrap();
    Scene::parse("crowd.toml", EMPTY, &[kernel]).unwrap_or_else(|error| panic!("{error}"))
}

pub fn vector(stream: &mut Stream) -> DVec3 {
    DVec3::from_array(stream.direction())
}

fn inside(stream: &mut Stream, size: f64) -> DVec3 {
    let mut one = || stream.between(-size, size);
    DVec3::new(one(), one(), one())
}

fn sphere(center: DVec3, radius: f64, material: usize) -> Sphere {
    Sphere {
        center,
        radius,
        material,
    }
}

fn cuboid(stream: &mut Stream, center: DVec3, size: f64, turned: bool) -> Cuboid {
    let mut side = || size * stream.scale(0.05, 1.0);
    let half = DVec3::new(side(), side(), side());
    let rotation = match turned {
        true => inside(stream, 180.0),
        false => DVec3::ZERO,
    };
    Cuboid {
        min: center - half,
        max: center + half,
        rotation,
        material: 0,
    }
}

/// Kinds of crowds.
pub const KINDS: [&str; 9] = [
    "soup",
    "flat",
    "line",
    "one centre",
    "twins",
    "far",
    "dust",
    "all sizes",
    "walls",
];

/// The bodies of a crowd: spheres and boxes.
pub fn bodies(kind: &str, count: usize, stream: &mut Stream) -> (Vec<Sphere>, Vec<Cuboid>) {
    let (mut spheres, mut boxes) = (Vec::new(), Vec::new());
    for index in 0..count {
        let at = inside(stream, 4.0);
        let small = stream.between(0.02, 0.3);
        let material = [0, 0, 1][index % 3];
        match kind {
            "soup" if index % 3 == 0 => boxes.push(cuboid(stream, at, 0.4, index % 2 == 0)),
            "soup" => spheres.push(sphere(at, small, material)),
            "flat" => spheres.push(sphere(DVec3::new(at.x, at.y, -3.0), small, material)),
            "line" => {
                let along = 0.9_f64.powi(index as i32 % 200);
                spheres.push(sphere(DVec3::new(0.0, 0.0, -8.0 * along), 0.1 * along, 0));
            }
            "one centre" => {
                let radius = 0.3 + 0.01 * index as f64;
                spheres.push(sphere(DVec3::new(0.0, 0.0, -5.0), radius, material));
            }
            // Pairs of one place and one size: each ray meets two at the same distance.
            "twins" => {
                let other = spheres.len() / 2;
                let twin = (index % 2 == 1).then(|| spheres[2 * other].clone());
                spheres.push(twin.unwrap_or_else(|| sphere(at, small, material)));
            }
            "far" => spheres.push(sphere(at + DVec3::new(1e5, 3e4, -1e5), small, material)),
            "dust" => spheres.push(sphere(at, 1e-6 * stream.scale(1.0, 1e3), material)),
            "all sizes" => {
                let radius = stream.scale(1e-6, 1e3);
                let center = vector(stream) * radius * stream.scale(1.01, 30.0);
                spheres.push(sphere(center, radius, material));
            }
            _ => spheres.push(sphere(0.5 * at, 0.3 * small, material)),
        }
    }
    match kind {
        "dust" => spheres.push(sphere(DVec3::new(0.0, 1e6 + 5.0, 0.0), 1e6, 0)),
        // Walls that are spheres of radius 1e5, as in smallpt.
        "walls" => {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                spheres.push(sphere(axis * (1e5 + 3.0), 1e5, 0));
                spheres.push(sphere(-axis * (1e5 + 3.0), 1e5, 0));
            }
        }
        _ => {}
    }
    (spheres, boxes)
}

/// A crowd with a lamp, for the general kernel and the tree's.
pub fn crowd(kind: &str, count: usize, seed: u64) -> [Scene; 2] {
    crowd_by(["general", "bvh"], kind, count, seed)
}

/// A crowd with a lamp, for each of two kernels.
pub fn crowd_by(kernels: [&str; 2], kind: &str, count: usize, seed: u64) -> [Scene; 2] {
    kernels.map(|kernel| {
        let mut scene = empty(kernel);
        let (spheres, boxes) = bodies(kind, count, &mut Stream::new(seed));
        scene.spheres = spheres;
        scene.boxes = boxes;
        let middle = scene.spheres[0].center;
        scene.camera.look_at = middle;
        let away = middle.normalize() * 0.5;
        scene.spheres.push(sphere(middle - away + DVec3::Y, 0.2, 2));
        scene
    })
}

pub fn packed(kind: &str, count: usize, seed: u64) -> [Packed; 2] {
    crowd(kind, count, seed).map(|scene| Packed::new(&scene))
}
