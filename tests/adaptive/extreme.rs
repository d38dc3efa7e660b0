//! Pictures that leave nothing to share out, or one place to put it all.

use crate::support::bench::{Bench, benches};
use lampray::film::Stop;
use lampray::render::{Rendering, Task, render};
use lampray::scene::{Assignment, Scene};
use std::ops::{ControlFlow, Range};

/// Fewest samples of a pixel.
const LEAST: u64 = 64;

fn scene(text: &str, sets: &[&str]) -> Scene {
    let head = "version = 1\ncamera = { position = [0, 0, 0], look_at = [0, 0, -1] }\n";
    let knobs: Vec<_> = sets
        .iter()
        .map(|set| Assignment::parse(set).unwrap())
        .collect();
    Scene::parse("a.toml", &format!("{head}{text}"), &knobs)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn rendered(bench: Bench, scene: &Scene, target: f64, samples: Range<u64>) -> Rendering {
    let task = Task {
        target_error: Some(target),
        adaptive: true,
        samples,
        ..Task::new(scene)
    };
    let rendering = bench.with(|device| render(device, &task, &mut |_| ControlFlow::Continue(())));
    rendering.unwrap_or_else(|error| panic!("{error}"))
}

const SKY: &str = "background = { emission = [1, 2, 3] }\n";
const SIZE: [&str; 2] = ["image.width=37", "image.height=19"];

/// Without noise every pixel has the fewest samples, and the error is 0.
#[test]
fn pictures_without_noise() {
    for bench in benches() {
        for text in [SKY, ""] {
            let rendering = rendered(bench, &scene(text, &SIZE), 1e-6, 0..100_000);
            assert!(rendering.film.counts.iter().all(|count| *count == LEAST));
            assert_eq!(rendering.stopped, Some(Stop::TargetError));
            let error = rendering.film.relative_error();
            assert!(error.picture == 0.0 && error.pixels == 0.0);
        }
    }
}

/// Fewer samples than any pixel would otherwise get: all of them, and the render is complete.
#[test]
fn few_samples_are_all_taken() {
    let sky = scene(SKY, &SIZE);
    for samples in [
        0..1,
        0..2,
        5..21,
        (1 << 40) - 3..1 << 40,
        (1 << 63) - 30..1 << 63,
    ] {
        let rendering = rendered(Bench::Twin, &sky, 0.01, samples.clone());
        let all = samples.end - samples.start;
        assert!(
            rendering.film.counts.iter().all(|count| *count == all),
            "{samples:?}"
        );
        assert!(
            rendering.complete() && rendering.stopped.is_none(),
            "{samples:?}"
        );
    }
}

/// A small bright ball in the dark, in the pixel beside the middle: its rim is all the noise that there is.
const BALL: &str = "materials.lamp = { emission = [100, 100, 100] }\n\
    [[spheres]]\ncenter = [0.02, -0.02, -1]\nradius = 0.006\nmaterial = \"lamp\"\n";

/// The mean of the picture is to be within the target: the tile of the lit pixel gets as many samples as that
/// takes, and the dark ones get about a ninth of that, in case scouts missed something.
#[test]
fn one_lit_pixel_in_the_dark() {
    let sets = [
        "image.width=48",
        "image.height=48",
        "render.max_bounces=0",
        "camera.fov=90",
    ];
    let scene = scene(BALL, &sets);
    for bench in benches() {
        let rendering = rendered(bench, &scene, 0.05, 0..1_000_000);
        let film = &rendering.film;
        let lit: Vec<_> = (0..film.counts.len())
            .filter(|pixel| film.mean(*pixel)[0] > 0.0)
            .collect();
        assert_eq!(lit, [24 * 48 + 24], "{bench:?}");
        let error = film.relative_error();
        assert!(
            (0.8..=1.0).contains(&(error.picture / 0.05)),
            "{bench:?}: {error:?}"
        );
        let (x, y) = (24 / 16, 24 / 16);
        let most = film.counts[lit[0]];
        assert!(most > 20 * LEAST, "{bench:?}: {most}");
        for (pixel, count) in film.counts.iter().enumerate() {
            let own = pixel % 48 / 16 == x && pixel / 48 / 16 == y;
            let wanted = if own {
                most..=most
            } else {
                // Eighteen rungs, which are whole runs.
                most / 10..=most / 8
            };
            assert!(
                wanted.contains(count),
                "{bench:?}: pixel {pixel} has {count} of {most}"
            );
        }
    }
}

/// A picture of one pixel, half of which is lit: there is one tile, which gets what even sampling gives it.
#[test]
fn one_pixel() {
    let lamp = BALL
        .replace("0.006", "0.4")
        .replace("[0.02, -0.02, -1]", "[0, 0, -1]");
    let scene = scene(
        &lamp,
        &[
            "image.width=1",
            "image.height=1",
            "render.max_bounces=0",
            "camera.fov=60",
        ],
    );
    for bench in benches() {
        let rendering = rendered(bench, &scene, 0.01, 0..1_000_000);
        let error = rendering.film.relative_error();
        assert!(
            (0.9..=1.0).contains(&(error.picture / 0.01)),
            "{bench:?}: {error:?}"
        );
        let even = Task {
            target_error: Some(0.01),
            samples: 0..1_000_000,
            ..Task::new(&scene)
        };
        let even = bench.with(|device| render(device, &even, &mut |_| ControlFlow::Continue(())));
        let even = even.unwrap_or_else(|error| panic!("{error}")).film;
        assert!(rendering.film == even, "{bench:?}");
    }
}

/// A target that takes more samples than there are: tiles that have them all wait for the others, and the render
/// ends with all.
#[test]
fn where_samples_run_out_all_are_taken() {
    let sets = ["image.width=48", "image.height=48", "render.max_bounces=0"];
    let scene = scene(BALL, &sets);
    for bench in benches() {
        let rendering = rendered(bench, &scene, 1e-5, 0..1000);
        assert!(rendering.film.counts.iter().all(|count| *count == 1000));
        assert!(rendering.complete() && rendering.stopped.is_none());
        assert!(!rendering.film.relative_error().reaches(1e-5), "{bench:?}");
    }
}

/// Samples that are among the scouts would decide on their own number.
#[test]
fn ranges_that_reach_the_scouts_are_refused() {
    let sky = scene(SKY, &SIZE);
    let task = Task {
        target_error: Some(0.1),
        adaptive: true,
        samples: 0..(1 << 63) + 1,
        ..Task::new(&sky)
    };
    let outcome = render(&mut lampray::cpu::Cpu::new(), &task, &mut |_| {
        ControlFlow::Continue(())
    });
    let told = outcome.expect_err("it is refused").to_string();
    assert!(told.contains("2^63"), "{told}");
}
