//! The GPU's pictures against the twin's: equal in distribution on samples that they do not share,
//! and all but equal in what their rays meet first.

mod support;

use lampray::cpu::Cpu;
use lampray::device::Device;
use lampray::film::Film;
use lampray::knobs::{Choice, Preset};
use lampray::pack::{Feature, Packed};
use lampray::render::{Task, render, whole};
use lampray::scene::{Assignment, Scene};
use std::ops::{ControlFlow, Range};
use std::path::PathBuf;
use support::chance::binomial_at_least;

const SIDE: u32 = 24;
const SAMPLES: u64 = 1024;
/// Chance of a false alarm of one pooled test: 7e-6.
const POOLED: f64 = 4.5;
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

fn load(file: &std::path::Path, side: u32, preset: Preset, more: &[&str]) -> Scene {
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

fn take(device: &mut dyn Device, scene: &Scene, samples: Range<u64>) -> Film {
    let task = Task {
        samples,
        ..Task::new(scene)
    };
    let mut watch = |_| ControlFlow::Continue(());
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
        self.pooled.iter().all(|z| z.abs() <= POOLED) && self.pixels.iter().all(|p| *p >= COUNTED)
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
            let scene = load(&file, SIDE, preset, &[]);
            let ours = take(&mut *gpu, &scene, 0..SAMPLES);
            let theirs = take(&mut Cpu::new(), &scene, SAMPLES..2 * SAMPLES);
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
        "materials.white.albedo=[0.71, 0.70, 0.68]",
        "materials.lamp.emission=[54.0, 48.0, 39.5]",
        "interruption.weight=literal",
        "camera.fov=39.0",
    ] {
        let wrong = twin(&cornell(&[change]), SAMPLES..2 * SAMPLES);
        let verdict = compare(&right, &wrong);
        println!("{change}: {verdict:?}");
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
    let pooled = verdict.pooled.iter().all(|z| z.abs() <= POOLED);
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
