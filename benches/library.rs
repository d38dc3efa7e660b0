//! The library's parts around tracing: reading scenes, packing, adding up, files, metrics.
//!
//! `cargo bench --bench library` times them all; a name such as `-- film` picks some. Tracing itself is
//! what `lampray bench` measures. FLIP, SSIM and MS-SSIM of a made-up picture are in `flip.rs`, which
//! `flip_against_nvidia.py` drives.

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use lampray::bench::{room, room_text};
use lampray::compare::{Display, Pair, flip, survey};
use lampray::cpu::Cpu;
use lampray::device::{Device, run_ranges};
use lampray::film::{Film, Picture, RasterFile, Target, read_exr};
use lampray::pack::{Packed, Tally};
use lampray::render::{Task, picture, render, whole};
use lampray::scene::{Assignment, Scene};
use std::hint::black_box;
use std::ops::ControlFlow;
use std::path::Path;

const PRIMITIVES: usize = 100_000;
const PIXELS: u64 = 1920 * 1080;

fn scenes(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("scene");
    group
        .throughput(Throughput::Elements(PRIMITIVES as u64))
        .sample_size(10);
    let text = room_text(PRIMITIVES).expect("a room");
    group.bench_function("parse 100k spheres", |bencher| {
        bencher.iter(|| Scene::parse("room", black_box(&text), &[]).expect("a scene"));
    });
    let scene = room(PRIMITIVES, &[]).expect("a room");
    group.bench_function("pack 100k spheres", |bencher| {
        bencher.iter(|| Packed::new(black_box(&scene)));
    });
    group.finish();
}

/// What a dispatch brings back of every pixel, run by run.
fn film(criterion: &mut Criterion) {
    const SAMPLES: u32 = 64;
    let scene = cornell(1);
    let region = whole(&scene);
    let tally = Tally {
        mean: [0.5, 0.25, 0.125],
        rays: 100,
        squares: [1.0; 3],
        non_finite: 0,
    };
    let mut group = criterion.benchmark_group("film");
    let runs = run_ranges(0, SAMPLES).count() as u64;
    group
        .throughput(Throughput::Elements(runs * PIXELS))
        .sample_size(20);
    group.bench_function("add tallies at 1080p", |bencher| {
        let add = |mut film: Film| {
            for (first, samples) in run_ranges(0, SAMPLES) {
                for pixel in 0..region.area() {
                    film.add(pixel, first, samples, black_box(&tally));
                }
            }
            film
        };
        bencher.iter_batched(|| Film::new(region), add, BatchSize::LargeInput);
    });
    group.finish();
}

/// The Cornell box at 1080p with two samples a pixel.
fn cornell(seed: u64) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell.toml");
    let set = [
        ("image.width", "1920".to_string()),
        ("image.height", "1080".to_string()),
        ("render.samples", "2".to_string()),
        ("render.seed", seed.to_string()),
    ];
    let set = set.map(|(knob, value)| Assignment::new(knob, value, knob));
    Scene::load(&path, &set).expect("the scene that ships")
}

fn rendered(seed: u64) -> Picture {
    let scene = cornell(seed);
    let task = Task::new(&scene);
    let mut device = Cpu::new();
    let rendering = render(&mut device, &task, &mut |_| ControlFlow::Continue(()));
    picture(&task, device.info(), &rendering.expect("a render"), &[])
}

fn files(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = rendered(1);
    let mut group = criterion.benchmark_group("file");
    group
        .throughput(Throughput::Elements(PIXELS))
        .sample_size(10);
    for name in ["picture.exr", "picture.png"] {
        let path = folder.path().join(name);
        let write = || {
            let target = Target::prepare(&path).expect("a target");
            target.write(&picture).expect("a file");
        };
        write();
        group.bench_function(format!("write {name} at 1080p"), |bencher| {
            bencher.iter(write)
        });
        let read = || {
            let file = RasterFile::open(&path).expect("a file");
            file.read().expect("a raster")
        };
        group.bench_function(format!("read {name} at 1080p"), |bencher| {
            bencher.iter(read)
        });
    }
    let path = folder.path().join("picture.exr");
    group.bench_function("read a picture with its record", |bencher| {
        bencher.iter(|| read_exr(&path).expect("a picture"));
    });
    group.finish();
}

fn metrics(criterion: &mut Criterion) {
    let [reference, test] = [1, 2].map(|seed| rendered(seed).raster());
    let pair = Pair::new(reference, test, None).expect("one size");
    let mut group = criterion.benchmark_group("metric");
    group
        .throughput(Throughput::Elements(PIXELS))
        .sample_size(10);
    group.bench_function("MSE and its kin at 1080p", |bencher| {
        bencher.iter(|| survey(black_box(&pair)));
    });
    group.bench_function("FLIP at 1080p", |bencher| {
        let [first, second] =
            [&pair.reference, &pair.test].map(|image| Display { image, gain: 1.0 });
        bencher.iter(|| flip::ldr(&first, &second, flip::DEFAULT_PPD).expect("a map"));
    });
    group.finish();
}

criterion_group!(parts, scenes, film, files, metrics);
criterion_main!(parts);
