//! A render that stops when its error is as small as was asked for: where it stops, and whether what it says
//! of the error is so.

use lampray::cpu::Cpu;
use lampray::film::{Checkpoint, Film, Stop};
use lampray::render::{Plan, Rendering, Task, go_on, go_on_by, record, render};
use lampray::scene::{Assignment, Scene};
use std::ops::ControlFlow;
use std::path::Path;

const TARGET: f64 = 0.05;

/// The Cornell box without its directional ball, whose caustic takes its time; small.
fn scene(seed: u64) -> Scene {
    let sets = [
        "materials.satin.scatter=diffuse",
        "image.width=16",
        "image.height=16",
        "render.samples=100000",
        &format!("render.seed={seed}"),
    ];
    let knobs: Vec<_> = sets
        .iter()
        .map(|text| Assignment::parse(text).unwrap())
        .collect();
    Scene::load(Path::new("scenes/cornell.toml"), &knobs).unwrap()
}

fn task(scene: &Scene) -> Task<'_> {
    Task {
        target_error: Some(TARGET),
        ..Task::new(scene)
    }
}

fn stopped_at(scene: &Scene, target: f64) -> Rendering {
    let mut watch = |_: &_| ControlFlow::Continue(());
    let task = Task {
        target_error: Some(target),
        ..Task::new(scene)
    };
    render(&mut Cpu::new(), &task, &mut watch).unwrap()
}

fn stopped(scene: &Scene) -> Rendering {
    stopped_at(scene, TARGET)
}

/// The 95th percentile of the pixels' errors after `count` samples, as the means and variances of a film of
/// many more samples have it: standard error over the sum of the mean and a hundredth of the picture's.
fn error_after(count: u64, truth: &Film) -> f64 {
    let average = |channels: [f64; 3]| channels.iter().sum::<f64>() / 3.0;
    let floor = average(truth.picture_mean()) / 100.0;
    let mut errors: Vec<f64> = (0..truth.counts.len())
        .map(|pixel| {
            let error = (average(truth.variance(pixel)) / count as f64).sqrt();
            error / (average(truth.mean(pixel)) + floor)
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    errors[(errors.len() * 95).div_ceil(100) - 1]
}

#[test]
fn the_error_is_what_it_is_said_to_be() {
    let counts = |target| -> Vec<u64> {
        let count = |seed| stopped_at(&scene(seed), target).film.counts[0];
        (1..=6).map(count).collect()
    };
    let good = counts(TARGET);
    let mut long = scene(99);
    long.settings.render.samples = 16 * good[0];
    let mut watch = |_: &_| ControlFlow::Continue(());
    let truth = render(&mut Cpu::new(), &Task::new(&long), &mut watch);
    let truth = truth.unwrap().film;
    let keeps = |counts: &[u64]| {
        let errors = counts
            .iter()
            .map(|count| error_after(*count, &truth) / TARGET);
        let mean = errors.sum::<f64>() / counts.len() as f64;
        (0.85..1.1).contains(&mean)
    };
    assert!(keeps(&good), "{good:?}");
    // A render that takes its error for half of what it is stops as this one does, and is found out.
    assert!(!keeps(&counts(2.0 * TARGET)));
}

#[test]
fn it_stops_at_a_fixed_number_of_samples() {
    let scene = scene(1);
    let rendering = stopped(&scene);
    let count = rendering.film.counts[0];
    assert_eq!(rendering.stopped, Some(Stop::TargetError));
    assert!(rendering.film.counts.iter().all(|other| *other == count));
    assert!(rendering.film.relative_error().reaches(TARGET));
    let shorter = Task {
        samples: 0..count - 16,
        target_error: None,
        ..Task::new(&scene)
    };
    let mut watch = |_: &_| ControlFlow::Continue(());
    let before = render(&mut Cpu::new(), &shorter, &mut watch).unwrap();
    assert!(count <= 64 || !before.film.relative_error().reaches(TARGET) || !is_look(count - 16));
}

/// Whether somebody looks after so many samples: 64, and then an eighth more each time, in sixteens.
fn is_look(count: u64) -> bool {
    let mut look = 64;
    while look < count {
        look = (look + look / 8u64).next_multiple_of(16);
    }
    look == count
}

/// However the work is split, and wherever it is stopped and gone on with.
#[test]
fn where_it_stops_depends_on_its_samples_alone() {
    let scene = scene(2);
    let task = task(&scene);
    let whole = stopped(&scene).film;
    let mut watch = |_: &_| ControlFlow::Continue(());
    for budget in [700, 20_000, 1 << 22] {
        let plan = Plan::with_budget(task.region, task.samples.clone(), budget).with_looks();
        let mut rendering = Rendering::new(&task);
        go_on_by(&mut Cpu::new(), &task, plan, &mut rendering, &mut watch).unwrap();
        assert!(rendering.film == whole, "blocks of {budget}");
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("checkpoint");
    let mut rendering = Rendering::new(&task);
    for stop in 1..5 {
        let mut blocks = 0;
        let mut watch = |_: &_| {
            blocks += 1;
            if blocks > 3 * stop {
                ControlFlow::Break(Stop::Signal)
            } else {
                ControlFlow::Continue(())
            }
        };
        go_on(&mut Cpu::new(), &task, &mut rendering, &mut watch).unwrap();
        let mut saved = record(&task, &rendering.devices[0], &rendering);
        rendering.film.describe(&mut saved);
        Checkpoint::save(&file, &saved, [0, 100_000], &rendering.film, None).unwrap();
        let checkpoint = Checkpoint::read(&file).unwrap();
        assert!(checkpoint.film == rendering.film);
        rendering = Rendering::of_checkpoint(&task, checkpoint).unwrap();
    }
    go_on(&mut Cpu::new(), &task, &mut rendering, &mut watch).unwrap();
    assert!(rendering.film == whole);
    assert_eq!(rendering.stopped, Some(Stop::TargetError));
}
