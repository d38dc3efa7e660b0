//! The scenes that are shipped: they load, render, and give the numbers that their comments state.

mod support;

use lampray::cpu::Cpu;
use lampray::device::Device;
use lampray::film::Film;
use lampray::pack::{Packed, Rect};
use lampray::render::{Task, render};
use lampray::scene::{Assignment, Scene};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use support::gate::MOST_ERRORS;

const SCENES: [&str; 12] = [
    "cornell",
    "cornell-large-lamp",
    "cornell-small-lamp",
    "furnace",
    "gloss",
    "integrating-sphere",
    "many-lamps",
    "montelight-complex",
    "montelight-simple",
    "one-lamp",
    "penumbra",
    "three-balls",
];

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name)
        .with_extension("toml")
}

fn load(name: &str, changes: &[&str]) -> Scene {
    let parse = |text: &&str| Assignment::parse(text).unwrap();
    let assignments: Vec<_> = changes.iter().map(parse).collect();
    Scene::load(&file(name), &assignments).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn take(scene: &Scene) -> Film {
    let mut watch = |_: &_| ControlFlow::Continue(());
    let mut cpu = Cpu::new();
    render(&mut cpu, &Task::new(scene), &mut watch)
        .unwrap()
        .film
}

#[test]
fn the_list_is_complete() {
    let folder = std::fs::read_dir(file("x").parent().unwrap()).unwrap();
    let paths = folder.map(|entry| entry.unwrap().path());
    let scenes = paths.filter(|path| path.extension().is_some_and(|end| end == "toml"));
    let mut names: Vec<_> = scenes
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_string())
        .collect();
    names.sort();
    assert_eq!(names, SCENES);
}

#[test]
fn every_scene_explains_itself() {
    for name in SCENES {
        let text = std::fs::read_to_string(file(name)).unwrap();
        let comment: String = text
            .lines()
            .take_while(|line| line.starts_with('#'))
            .collect();
        assert!(comment.len() > 200, "{name}");
        assert!(
            comment.contains(&format!("lampray render scenes/{name}.toml")),
            "{name}"
        );
        assert!(
            text.lines().all(|line| line.chars().count() <= 112),
            "{name}: long lines"
        );
    }
}

/// The integrating sphere alone has warnings: camera and lamp stand in a ball, and its comment says so.
#[test]
fn no_scene_is_suspect() {
    for name in SCENES {
        let warnings = load(name, &[]).warnings();
        let texts: Vec<_> = warnings
            .iter()
            .map(|warning| warning.message.clone())
            .collect();
        let expected: &[&str] = match name {
            "integrating-sphere" => &[
                "the light `spheres.1` stands inside `spheres.0`",
                "the camera stands inside `spheres.0`",
            ],
            _ => &[],
        };
        assert_eq!(texts, expected, "{name}");
    }
}

/// In every preset too: what is tried on a scene should not fall over.
#[test]
fn every_scene_renders() {
    for name in SCENES {
        for preset in ["montelight", "paper", "corrected", "reference"] {
            let preset = format!("render.preset={preset}");
            let small = [
                "image.width=24",
                "image.height=16",
                "render.samples=4",
                &preset,
            ];
            let film = take(&load(name, &small));
            assert_eq!(film.non_finite, 0, "{name}, {preset}");
            let mean = film.picture_mean();
            assert!(
                mean.iter().all(|m| *m > 0.01 && *m < 400.0),
                "{name}, {preset}: {mean:?}"
            );
        }
    }
}

#[test]
fn the_two_lamps_have_equal_power() {
    let power = |name| {
        let scene = load(name, &[]);
        let (_, lamp) = scene.lamps().next().unwrap();
        scene.materials[lamp.material].emission * lamp.radius * lamp.radius
    };
    let apart = (power("cornell-large-lamp") / power("cornell-small-lamp") - 1.0).abs();
    assert!(apart.max_element() < 1e-12, "{apart}");
}

/// They differ in the lamp's radius and emission, and in their comments, but in nothing else.
#[test]
fn the_two_lamps_hang_in_one_room() {
    let facts = |name| {
        let mut scene = load(name, &[]);
        let lamp = scene.lamps().next().unwrap().0;
        scene.spheres[lamp].radius = 0.0;
        let material = scene.spheres[lamp].material;
        scene.materials[material].emission = glam::DVec3::ZERO;
        (scene.camera, scene.materials, scene.spheres, scene.boxes)
    };
    assert_eq!(facts("cornell-small-lamp"), facts("cornell-large-lamp"));
}

/// Whether every channel's mean over the picture is `truth`, by its standard error. What 32-bit
/// sums lose is allowed on top: a furnace has almost no noise.
fn assert_mean(name: &str, changes: &[&str], truth: f64) {
    let small = ["image.width=48", "image.height=48"];
    let film = take(&load(name, &[&small, changes].concat()));
    let means = film.picture_mean().into_iter().zip(film.standard_error());
    for (mean, error) in means {
        let apart = (mean - truth).abs();
        let allowed = MOST_ERRORS * error + 2e-6 * truth;
        assert!(
            apart <= allowed,
            "{name} {changes:?}: {mean} +- {error}, not {truth}"
        );
        assert!(
            error < 0.01 * truth,
            "{name} {changes:?}: {error} is too much noise to tell"
        );
    }
}

#[test]
fn the_furnace_gives_its_number() {
    assert_mean("furnace", &[], 0.5);
    assert_mean("furnace", &["render.preset=corrected"], 0.5);
    assert_mean("furnace", &["light.strategy=hit"], 0.5);
    assert_mean("furnace", &["light.strategy=sample"], 0.5);
    assert_mean(
        "furnace",
        &["render.max_bounces=3"],
        0.5 * (1.0 - 0.64_f64.powi(4)),
    );
}

/// Nothing can be seen in it: each block of 8 x 8 pixels by itself has the number too. (Single pixels
/// would need far more samples: a few rare paths carry much of their variance.)
#[test]
fn the_furnace_hides_what_stands_in_it() {
    const SIDE: usize = 48;
    const BLOCK: usize = 8;
    let size = ["image.width=48", "image.height=48", "render.samples=256"];
    let film = take(&load("furnace", &size));
    for block in 0..(SIDE / BLOCK).pow(2) {
        let (row, column) = (
            block / (SIDE / BLOCK) * BLOCK,
            block % (SIDE / BLOCK) * BLOCK,
        );
        let pixels = (0..BLOCK * BLOCK).map(|i| (row + i / BLOCK) * SIDE + column + i % BLOCK);
        let (mut mean, mut variance) = (0.0, 0.0);
        for pixel in pixels {
            mean += film.mean(pixel)[1];
            variance += film.variance(pixel)[1] / film.counts[pixel] as f64;
        }
        let count = (BLOCK * BLOCK) as f64;
        let (mean, error) = (mean / count, variance.sqrt() / count);
        assert!(
            (mean - 0.5).abs() <= MOST_ERRORS * error,
            "block {block}: {mean} +- {error}"
        );
    }
}

#[test]
fn the_integrating_sphere_gives_its_number() {
    let truth = 0.8 * 0.0625 * 2.5 / (1.0 - 0.8 * (1.0 - 0.0625));
    assert!((truth - 0.5_f64).abs() < 1e-12);
    assert_mean("integrating-sphere", &[], truth);
    assert_mean("integrating-sphere", &["render.preset=corrected"], truth);
    assert_mean(
        "integrating-sphere",
        &["light.strategy=hit", "render.samples=256"],
        truth,
    );
    assert_mean("integrating-sphere", &["render.max_bounces=1"], 0.125);
    assert_mean(
        "integrating-sphere",
        &["light.sampler=uniform-angles"],
        truth,
    );
}

/// Mesa's software driver leaves all loops of a shader after 65,535 iterations. With 48 lamps a few
/// samples reach them: unless dispatches stay below, pixels come back black or wrong.
#[test]
fn many_lamps_do_not_outrun_a_software_driver() {
    let Some(mut gpu) = support::gpu("many lamps in one dispatch") else {
        return;
    };
    let scene = load("many-lamps", &[]);
    let packed = Packed::new(&scene);
    let rect = Rect {
        x0: 100,
        y0: 100,
        x1: 108,
        y1: 108,
    };
    gpu.load(&packed).unwrap();
    let mut cpu = Cpu::new();
    cpu.load(&packed).unwrap();
    let sum = |device: &mut dyn Device| {
        let tallies = device.trace(rect, 0, 32).unwrap();
        let light: f64 = tallies.iter().map(|tally| f64::from(tally.mean[0])).sum();
        let rays: u64 = tallies.iter().map(|tally| u64::from(tally.rays)).sum();
        (light, rays)
    };
    let (ours, theirs) = (sum(&mut *gpu), sum(&mut cpu));
    assert!(
        (ours.0 / theirs.0 - 1.0).abs() < 0.01,
        "{ours:?} {theirs:?}"
    );
    assert!(
        (ours.1 as f64 / theirs.1 as f64 - 1.0).abs() < 0.001,
        "{ours:?} {theirs:?}"
    );
}
