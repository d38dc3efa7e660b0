//! Whole pictures by both kernels on one device.

use crate::crowds::{KINDS, crowd_by, empty};
use crate::support::gpu;
use crate::support::same::{rendering, same};
use glam::DVec3;
use lampray::device::Device;
use lampray::pack::{Packed, Rect};
use lampray::scene::{Assignment, Cuboid, Material, Scene, Sphere};

const BOTH: [&str; 2] = ["general", "baked"];

/// Renders a pair of scenes on the graphics device; nothing where there is none.
fn compare(pair: [Scene; 2], what: &str) {
    if let Some(mut gpu) = gpu("a baked kernel's picture") {
        let [general, baked] = pair.map(|scene| rendering(&mut *gpu, &scene));
        assert!(general.film.rays > 0);
        same(&general, &baked, what);
    }
}

fn load(path: &str, sets: &[&str]) -> [Scene; 2] {
    BOTH.map(|kernel| {
        let kernel = format!("render.kernel={kernel}");
        let all = [sets, &["image.width=16", "image.height=16", &kernel]].concat();
        let parsed = all.iter().map(|set| Assignment::parse(set).unwrap());
        let sets: Vec<_> = parsed.collect();
        Scene::load(path.as_ref(), &sets).unwrap_or_else(|error| panic!("{error}"))
    })
}

#[test]
fn hostile_crowds_are_the_same() {
    for kind in KINDS {
        compare(crowd_by(BOTH, kind, 20, 50), kind);
    }
}

#[test]
fn the_ready_scenes_are_the_same() {
    let folder = std::fs::read_dir("scenes").unwrap();
    let paths = folder.map(|entry| entry.unwrap().path());
    let scenes: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .map(|path| path.to_str().unwrap().to_string())
        .collect();
    assert!(scenes.len() > 8);
    for path in scenes {
        compare(load(&path, &[]), &path);
    }
}

#[test]
fn presets_and_strategies_are_the_same() {
    for set in [
        "render.preset=paper",
        "render.preset=montelight",
        "light.strategy=sample",
        "light.strategy=hit",
    ] {
        compare(load("scenes/cornell.toml", &[set]), set);
    }
}

fn sphere(center: [f64; 3], radius: f64, material: usize) -> Sphere {
    Sphere {
        center: DVec3::from_array(center),
        radius,
        material,
    }
}

/// Numbers whose literals are hard to write or to read: signed zeros, what is too small for a normal
/// number, the smallest and the largest that scenes have, thin boxes.
fn awkward(kernel: &str) -> Scene {
    let mut scene = empty(kernel);
    scene.spheres = vec![
        sphere([0.4, 0.3, -3.0], 0.5, 2),
        sphere([-0.0, 0.0, -4.0], 1.0, 1),
        sphere([1e-40, -1e-45, -2.0], 1e-6, 0),
        sphere([-0.5, 1e-6, -3.0], 1.0 / 3.0, 0),
        // Where two are equally near, the first is what is seen.
        sphere([-0.5, 1e-6, -3.0], 1.0 / 3.0, 3),
        sphere([0.0, -1e5, -0.0], 1e5 - 1.0, 0),
        sphere([0.0, 1e6, 0.0], 1e6 - 20.0, 3),
    ];
    let mut thin = |center: [f64; 3], half: [f64; 3], rotation: [f64; 3]| {
        let (center, half) = (DVec3::from_array(center), DVec3::from_array(half));
        scene.boxes.push(Cuboid {
            min: center - half,
            max: center + half,
            rotation: DVec3::from_array(rotation),
            material: 0,
        });
    };
    thin([0.0, 0.0, -6.0], [1e5, 1.0, 1e-6], [0.0; 3]);
    thin([-0.0, -0.9, -3.0], [0.1, 1e-7, 3.0], [90.0, -180.0, 0.0]);
    thin([1.0, 0.1, -3.0], [0.2, 0.3, 0.1], [1e-9, 45.0, -0.0]);
    let tiny = Material {
        albedo: DVec3::new(1e-40, 1.0, 0.999_999_99),
        ..scene.materials[0].clone()
    };
    scene.materials.push(tiny);
    scene
}

#[test]
fn awkward_numbers_are_the_same() {
    compare(BOTH.map(awkward), "awkward numbers");
}

/// More materials than a tree of selects takes are read from their buffer; and none of a kind is no fault.
#[test]
fn many_materials_and_no_bodies_are_the_same() {
    let coloured = |kernel: &str| {
        let mut scene = awkward(kernel);
        for index in 0..90 {
            let mut material = scene.materials[0].clone();
            material.albedo.x = f64::from(index) / 100.0;
            scene.materials.push(material);
        }
        for (index, body) in scene.spheres.iter_mut().enumerate().skip(1) {
            body.material = 10 + 13 * index;
        }
        scene
    };
    compare(BOTH.map(coloured), "many materials");
    if let Some(mut gpu) = gpu("an empty scene by a baked kernel") {
        let [general, baked] = BOTH.map(|kernel| rendering(&mut *gpu, &empty(kernel)));
        same(&general, &baked, "no bodies");
    }
}

/// More steps in one call than old drivers let a loop take: what is baked needs fewer pieces, and they
/// are the same samples.
#[test]
fn long_work_is_the_same() {
    let Some(mut gpu) = gpu("long work by a baked kernel") else {
        return;
    };
    let small = Rect {
        x0: 7,
        y0: 7,
        x1: 9,
        y1: 9,
    };
    let [general, baked] = load("scenes/cornell.toml", &["render.max_bounces=64"])
        .map(|scene| Packed::new(&scene))
        .map(|packed| {
            gpu.load(&packed).unwrap();
            gpu.trace(small, 0, 4096).unwrap()
        });
    assert!(general == baked);
}
