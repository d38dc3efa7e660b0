//! The sequences of `render.sequence`: the same expected picture as independent samples, with errors that are what
//! they are said to be, and under `blue-noise` an error that is blue.

use super::concentric::PLAIN;
use super::cross::covering;
use super::lamp::MIDDLING;
use crate::support::bench::{Bench, benches};
use crate::support::chance::binomial_at_least;
use crate::support::gate::{Case, Family, Form};
use lampray::compare::verdict::student;
use lampray::cpu::Cpu;
use lampray::film::Film;
use lampray::render::{Rendering, Task, go_on};
use std::ops::ControlFlow;

const SEQUENCES: [&str; 3] = ["stratified", "sobol", "blue-noise"];

/// 64 randomisations of 16 samples at least: four of their standard errors are passed by chance once in six thousand.
fn short(case: Case, sequence: &str) -> Case {
    case.set("render.sequence", sequence)
        .set("render.samples", 1024)
        .set("render.randomisations", 64)
        .set("image.width", 16)
        .set("image.height", 16)
}

/// The covering cross, sequences going round; each device has another sequence in a row.
#[test]
fn every_sequence_gives_the_closed_forms() {
    let mut family = Family::new("sequences", 60_000);
    for bench in benches() {
        for (place, row) in covering(bench).into_iter().enumerate() {
            let sequence = SEQUENCES[(place + bench as usize) % SEQUENCES.len()];
            family.check(bench, &row.apply(short(PLAIN.case(), sequence)));
        }
        for sequence in SEQUENCES {
            for row in &covering(bench)[..3] {
                family.check(bench, &row.apply(short(MIDDLING.case(), sequence)));
            }
        }
    }
    family.finish();
}

#[test]
fn the_gate_rejects_small_faults() {
    let mut family = Family::new("sequences, mutants", 61_000);
    for sequence in SEQUENCES {
        let case = short(PLAIN.case(), sequence);
        family.reject(
            Bench::Twin,
            &case.set("materials.inner.emission", "[1.01, 2.525, 4.04]"),
        );
    }
}

const SEEDS: u64 = 400;
const SAMPLES: u64 = 256;

/// A film of 4 x 4 pixels of one truth. With `as_independent`, its variances are those of independent samples.
fn film(case: &Case, seed: u64, as_independent: bool) -> Film {
    let scene = case.scene(seed);
    let task = Task::new(&scene);
    let mut rendering = Rendering::new(&task);
    if as_independent {
        rendering.film = Film::new(task.region);
    }
    go_on(&mut Cpu::new(), &task, &mut rendering, &mut |_| {
        ControlFlow::Continue(())
    })
    .unwrap();
    rendering.film
}

/// Of so many seeds, those whose 95 % interval holds the truth: of one pixel, and of the mean of the picture.
fn covered(case: &Case, freedoms: [f64; 2], as_independent: bool) -> [u64; 2] {
    let Form::Mean(truth) = case.form else {
        panic!("{} has no noise", case.name);
    };
    let mut held = [0, 0];
    for seed in 0..SEEDS {
        let film = film(case, 70_000 + seed, as_independent);
        let channel = seed as usize % 3;
        let pixel = (film.variance(5)[channel] / film.counts[5] as f64).sqrt();
        let found = [
            (film.mean(5)[channel], pixel),
            (film.picture_mean()[channel], film.standard_error()[channel]),
        ];
        for (which, (mean, error)) in found.into_iter().enumerate() {
            let allowed = student(0.975, freedoms[which]) * error;
            held[which] += u64::from((mean - truth[channel]).abs() <= allowed);
        }
    }
    held
}

fn small(case: Case, sequence: &str) -> Case {
    case.set("render.sequence", sequence)
        .set("render.samples", SAMPLES)
        .set("image.width", 4)
        .set("image.height", 4)
}

/// Neither too few nor too many, each at a level of 0.001.
fn is_honest(held: u64) -> bool {
    binomial_at_least(held, SEEDS, 0.95) > 0.001
        && binomial_at_least(SEEDS - held, SEEDS, 0.05) > 0.001
}

/// Eight randomisations of 32 samples: seven degrees of freedom a pixel, and as many for the mean of the picture
/// where its pixels share point sets, else sixteen times that.
#[test]
fn intervals_hold_the_truth_as_often_as_they_say() {
    for sequence in SEQUENCES {
        let of_picture = if sequence == "blue-noise" { 7.0 } else { 112.0 };
        for (name, case) in [("spheres", PLAIN.case()), ("lamp", MIDDLING.case())] {
            let held = covered(&small(case, sequence), [7.0, of_picture], false);
            println!("{sequence}, {name}: {held:?} of {SEEDS} intervals hold the truth");
            assert!(
                held.into_iter().all(is_honest),
                "{sequence}, {name}: {held:?}"
            );
        }
    }
}

#[test]
fn the_gate_rejects_the_formula_of_independent_samples() {
    let case = small(MIDDLING.case(), "sobol");
    let freedom = (SAMPLES - 1) as f64;
    let held = covered(&case, [freedom, 16.0 * freedom], true);
    println!("sobol by the formula of independent samples: {held:?} of {SEEDS}");
    assert!(!held.into_iter().any(is_honest), "{held:?}");
    // Of independent samples it is right.
    let plain = covered(
        &small(MIDDLING.case(), "independent"),
        [freedom, 16.0 * freedom],
        false,
    );
    assert!(plain.into_iter().all(is_honest), "{plain:?}");
}

/// Variance of the means of squares of 8 x 8 pixels, over what it is where pixels are independent.
fn low_frequencies(sequence: &str) -> f64 {
    const SIDE: usize = 32;
    let case = MIDDLING
        .case()
        .set("render.sequence", sequence)
        .set("render.samples", 128);
    let Form::Mean(truth) = case.form else {
        panic!("{} has no noise", case.name);
    };
    let (mut blocks, mut pixels) = (0.0, 0.0);
    for seed in 0..30 {
        let film = film(&case, 80_000 + seed, false);
        let error = |pixel| film.mean(pixel)[0] - truth[0];
        pixels += (0..SIDE * SIDE)
            .map(|pixel| error(pixel).powi(2))
            .sum::<f64>();
        for block in 0..16 {
            let corner = block / 4 * 8 * SIDE + block % 4 * 8;
            let inside = (0..64).map(|n| error(corner + n / 8 * SIDE + n % 8));
            blocks += inside.sum::<f64>().powi(2);
        }
    }
    blocks / pixels
}

/// 480 squares: the ratio of pixels that are independent is 1 within 0.2, three of its standard errors.
#[test]
fn the_error_of_neighbours_cancels_under_blue_noise_alone() {
    for sequence in ["independent", "stratified", "sobol"] {
        let ratio = low_frequencies(sequence);
        println!("{sequence}: {ratio:.3}");
        assert!((ratio - 1.0).abs() < 0.2, "{sequence}: {ratio}");
    }
    let ratio = low_frequencies("blue-noise");
    println!("blue-noise: {ratio:.3}");
    assert!(ratio < 0.25, "{ratio}");
}
