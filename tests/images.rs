//! The GPU's pictures against the twin's: equal in distribution on samples that they do not share,
//! and all but equal in what their rays meet first.

mod support;

use lampray::cpu::Cpu;
use lampray::device::Device;
use lampray::film::Film;
use lampray::knobs::{Choice, LightSampler, Preset};
use lampray::pack::{Feature, Packed};
use lampray::render::{Task, render, whole};
use lampray::scene::{Assignment, Scene};
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};
use support::chance::binomial_at_least;
use support::gate::MOST_ERRORS;

const SIDE: u32 = 24;
const SAMPLES: u64 = 1024;
/// Chance of a false alarm of one count of pixels.
const COUNTED: f64 = 1e-5;

/// The scenes that are shipped.
fn scene_files() -> Vec<PathBuf> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
    let entries = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = entries
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    assert!(!files.is_empty());
    files
}

fn load(file: &Path, side: u32, preset: Preset, more: &[&str]) -> Scene {
    let size = [
        format!("image.width={side}"),
        format!("image.height={side}"),
    ];
    let preset = format!("render.preset={preset}");
    let all = size
        .iter()
        .map(String::as_str)
        .chain([preset.as_str()])
        .chain(more.iter().copied());
    let assignments: Vec<_> = all.map(|text| Assignment::parse(text).unwrap()).collect();
    Scene::load(file, &assignments).unwrap_or_else(|e| panic!("{e}"))
}

/// Samples a pixel that a scene's cost leaves room for: bodies, for each ray and shadow ray of a path.
fn affordable(scene: &Scene) -> u64 {
    let bodies = scene.spheres.len() + scene.boxes.len();
    let work = (bodies * (1 + scene.lamps().count())) as u64;
    (8000 / work.max(1)).clamp(32, SAMPLES)
}

fn take(device: &mut dyn Device, scene: &Scene, samples: Range<u64>) -> Film {
    let task = Task {
        samples,
        ..Task::new(scene)
    };
    let mut watch = |_: &_| ControlFlow::Continue(());
    render(device, &task, &mut watch).unwrap().film
}

/// How far apart two films are.
#[derive(Debug)]
struct Verdict {
    /// Difference of the picture's means in standard errors, by channel.
    pooled: [f64; 3],
    /// Chance of so many pixels beyond three standard errors, by channel; below 1 where a pixel
    /// differs that neither film says has any variance.
    pixels: [f64; 3],
}

impl Verdict {
    fn same(&self) -> bool {
        self.pooled.iter().all(|z| z.abs() <= MOST_ERRORS)
            && self.pixels.iter().all(|p| *p >= COUNTED)
    }
}

fn compare(a: &Film, b: &Film) -> Verdict {
    let (ours, theirs) = (a.picture_mean(), b.picture_mean());
    let (error, their_error) = (a.standard_error(), b.standard_error());
    let pooled = std::array::from_fn(|c| {
        score(
            ours[c] - theirs[c],
            error[c].powi(2) + their_error[c].powi(2),
        )
    });
    let pixels = std::array::from_fn(|c| {
        let far = (0..a.counts.len()).filter(|&pixel| {
            let variance = a.variance(pixel)[c] / a.counts[pixel] as f64
                + b.variance(pixel)[c] / b.counts[pixel] as f64;
            score(a.mean(pixel)[c] - b.mean(pixel)[c], variance).abs() > 3.0
        });
        // Two-sided three standard errors of a normal distribution.
        binomial_at_least(far.count() as u64, a.counts.len() as u64, 0.0027)
    });
    Verdict { pooled, pixels }
}

/// A difference in standard errors. Equal samples may differ by f32's rounding alone.
fn score(difference: f64, variance: f64) -> f64 {
    let floor = 1e-12 + 1e-10 * variance;
    if difference.abs() < 1e-6 {
        0.0
    } else {
        difference / (variance + floor).sqrt()
    }
}

#[test]
fn both_devices_make_the_same_pictures() {
    let Some(mut gpu) = support::gpu("pictures against the twin's") else {
        return;
    };
    for file in scene_files() {
        for &preset in Preset::ALL {
            // Longer paths cost much and add little that the first eight reflections have not.
            let scene = load(&file, SIDE, preset, &["render.max_bounces=8"]);
            let samples = affordable(&scene);
            let ours = take(&mut *gpu, &scene, 0..samples);
            let theirs = take(&mut Cpu::new(), &scene, samples..2 * samples);
            let verdict = compare(&ours, &theirs);
            println!("{} {preset}: {verdict:.2?}", file.display());
            assert!(
                ours.picture_mean().iter().any(|&mean| mean > 1e-3),
                "a black picture"
            );
            assert!(verdict.same(), "{} {preset}: {verdict:?}", file.display());
            assert_eq!((ours.non_finite, theirs.non_finite), (0, 0));
        }
    }
}

/// Spheres and boxes in a row, some of them rotated, under lamps.
fn made_of(spheres: usize, boxes: usize, rotated: usize, lamps: usize) -> String {
    let mut text = String::from(
        "version = 1\n[camera]\nposition = [0.0, 1.0, 3.5]\nlook_at = [0.0, 0.8, 0.0]\nfov = 50.0\n\
         [image]\nwidth = 24\nheight = 24\n[background]\nemission = [0.2, 0.3, 0.4]\n\
         [materials.white]\nalbedo = [0.7, 0.6, 0.5]\n\
         [materials.lamp]\nalbedo = [0.1, 0.1, 0.1]\nemission = [5.0, 6.0, 7.0]\n",
    );
    let mut sphere = |x: f64, y: f64, radius: f64, material: &str| {
        text += &format!(
            "[[spheres]]\ncenter = [{x:?}, {y:?}, 0.0]\nradius = {radius:?}\nmaterial = \"{material}\"\n"
        );
    };
    let row = |i: usize, count: usize| 2.0 * (i as f64 + 0.5) / count as f64 - 1.0;
    for i in 0..lamps {
        sphere(row(i, lamps), 1.7, 0.3 / lamps as f64, "lamp");
    }
    for i in 0..spheres {
        sphere(row(i, spheres), 0.6, 0.8 / spheres as f64, "white");
    }
    for i in 0..boxes + rotated {
        let (y, turn) = (-0.2 * i as f64, if i < boxes { 0.0 } else { 20.0 });
        let (low, high) = (y - 0.1, y);
        text += &format!(
            "[[boxes]]\nmin = [-2.0, {low:?}, -1.0]\nmax = [2.0, {high:?}, 1.0]\nrotation = [0.0, {turn:?}, 0.0]\nmaterial = \"white\"\n"
        );
    }
    text
}

/// Scenes of every make-up, from none of anything to arrays too large for a uniform buffer: drivers
/// unroll loops over few bodies, and one is known to have crashed on what came of it.
#[test]
fn both_devices_make_the_same_pictures_of_any_number_of_bodies() {
    let Some(mut gpu) = support::gpu("scenes of every make-up") else {
        return;
    };
    for bodies in [
        [0, 0, 0, 0],
        [0, 0, 0, 1],
        [1, 0, 0, 1],
        [0, 1, 0, 1],
        [0, 0, 1, 0],
        [1, 1, 1, 1],
        [2, 2, 1, 2],
        [3, 0, 4, 3],
        [600, 3, 2, 1],
        [2, 200, 1, 2],
    ] {
        for sampler in LightSampler::ALL {
            let [spheres, boxes, rotated, lamps] = bodies;
            let sampler = Assignment::parse(&format!("light.sampler={sampler}")).unwrap();
            let scene =
                Scene::parse("made", &made_of(spheres, boxes, rotated, lamps), &[sampler]).unwrap();
            let ours = take(&mut *gpu, &scene, 0..64);
            let theirs = take(&mut Cpu::new(), &scene, 64..128);
            let verdict = compare(&ours, &theirs);
            assert!(verdict.same(), "{bodies:?}: {verdict:?}");
            assert!(
                ours.picture_mean().iter().all(|&mean| mean > 0.05),
                "a black picture"
            );
        }
    }
}

fn cornell(more: &[&str]) -> Scene {
    let files = scene_files();
    let file = files
        .iter()
        .find(|path| path.ends_with("cornell.toml"))
        .unwrap();
    load(file, SIDE, Preset::Reference, more)
}

fn twin(scene: &Scene, samples: Range<u64>) -> Film {
    take(&mut Cpu::new(), scene, samples)
}

#[test]
fn a_picture_that_is_a_little_off_is_caught() {
    let right = twin(&cornell(&[]), 0..SAMPLES);
    assert!(compare(&right, &twin(&cornell(&[]), SAMPLES..2 * SAMPLES)).same());
    for change in [
        ["materials.white.albedo=[0.69, 0.68, 0.66]", "render.seed=0"],
        [
            "materials.lamp.emission=[54.0, 48.0, 39.5]",
            "render.seed=0",
        ],
        ["interruption.weight=literal", "interruption.start=1"],
        ["camera.fov=39.0", "render.seed=0"],
    ] {
        let wrong = twin(&cornell(&change), SAMPLES..2 * SAMPLES);
        let verdict = compare(&right, &wrong);
        assert!(!verdict.same(), "{change:?}: {verdict:?}");
    }
}

#[test]
fn pixels_in_the_wrong_place_are_caught() {
    let right = twin(&cornell(&[]), 0..SAMPLES);
    let mut wrong = twin(&cornell(&[]), SAMPLES..2 * SAMPLES);
    for row in wrong
        .sums
        .chunks_mut(SIDE as usize)
        .chain(wrong.squares.chunks_mut(SIDE as usize))
    {
        row.reverse();
    }
    let verdict = compare(&right, &wrong);
    let pooled = verdict.pooled.iter().all(|z| z.abs() <= MOST_ERRORS);
    assert!(pooled && !verdict.same(), "{verdict:?}");
}

fn features(device: &mut dyn Device, scene: &Scene) -> Vec<Feature> {
    device.load(&Packed::new(scene)).unwrap();
    device.features(whole(scene)).unwrap()
}

fn alike(a: &Feature, b: &Feature) -> bool {
    let apart = a.normal.iter().zip(b.normal).map(|(x, y)| (x - y).abs());
    let deep = (a.depth - b.depth).abs() <= 1e-4 * a.depth.abs();
    a.id == b.id && a.albedo == b.albedo && deep && apart.fold(0.0, f32::max) <= 1e-4
}

fn share_alike(a: &[Feature], b: &[Feature]) -> f64 {
    assert_eq!(a.len(), b.len());
    let same = a.iter().zip(b).filter(|(a, b)| alike(a, b)).count();
    same as f64 / a.len() as f64
}

#[test]
fn both_devices_meet_the_same_surfaces() {
    let Some(mut gpu) = support::gpu("first hits against the twin's") else {
        return;
    };
    for file in scene_files() {
        let scene = load(&file, 128, Preset::Reference, &[]);
        let (ours, theirs) = (
            features(&mut *gpu, &scene),
            features(&mut Cpu::new(), &scene),
        );
        let share = share_alike(&ours, &theirs);
        println!(
            "{}: {:.3} % of first hits alike",
            file.display(),
            100.0 * share
        );
        assert!(share >= 0.999, "{}: {share}", file.display());
        assert!(ours.iter().any(|feature| feature.id != 0), "nothing is met");
    }
}

#[test]
fn a_scene_that_is_turned_a_little_is_caught() {
    let file = &scene_files()[0];
    let meet = |more: &[&str]| features(&mut Cpu::new(), &load(file, 128, Preset::Reference, more));
    let (right, wrong) = (meet(&[]), meet(&["camera.look_at=[0.002, 1.0, 0.0]"]));
    assert!(share_alike(&right, &right) == 1.0 && share_alike(&right, &wrong) < 0.999);
}
