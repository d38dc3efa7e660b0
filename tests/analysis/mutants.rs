//! Wrong formulas, which the gate on coverage rejects.

use super::coverage::{RIGHT, USUAL, share, sweeps};
use super::figures::{FIGURES, Figure};
use super::worlds::{Change, World};

/// Where the reference's noise counts.
const POOR: World = World {
    reference_samples: 64,
    ..USUAL
};

fn named(name: &str) -> Figure {
    *FIGURES
        .iter()
        .find(|figure| figure.0 == name)
        .expect("a figure of that name")
}

/// What the mutants do is far from any chance.
const SWEEPS: u64 = 400;

/// Each figure of the unbiased group misses the truth too often.
fn rejected(figures: &[Figure], changes: [Change; 2]) {
    let sweeps = sweeps(&POOR, 50_001, SWEEPS, changes);
    for figure in figures {
        let (share, _) = share(&sweeps, &POOR, 0, figure);
        println!("{:14}: {:.2} %", figure.0, 100.0 * share);
        assert!(share < *RIGHT.start(), "{}: {share}", figure.0);
    }
}

/// A reference that is taken for the truth.
#[test]
fn forgotten_noise_of_the_reference() {
    let changes: [Change; 2] = [|reference| reference.variance.fill([0.0; 3]), |_| {}];
    let names = [
        "bias",
        "relative bias",
        "bias^2",
        "MSE",
        "relMSE",
        "efficiency",
    ];
    rejected(&names.map(named), changes);
}

/// A standard deviation where a variance belongs.
#[test]
fn deviation_for_variance() {
    let root: Change = |run| {
        for variance in run.variance.as_flattened_mut() {
            *variance = variance.sqrt();
        }
    };
    let names = ["variance", "MSE", "agreement"];
    rejected(&names.map(named), [|_| {}, root]);
}

/// The squared mean difference as it is: it holds the noise of the runs, 1 / K of that of one.
#[test]
fn bias_squared_not_corrected() {
    let (name, _, truth) = named("bias^2");
    let plain: Figure = (
        name,
        |analysis, group| {
            let energy = &analysis.groups[group].regions[0].energy;
            let runs = analysis.groups[group].runs as f64;
            Some(energy.at(1.0 / runs).interval())
        },
        truth,
    );
    rejected(&[plain], [|_| {}, |_| {}]);
}

/// A variance of the mean where one of a sample belongs.
#[test]
fn variance_of_the_mean() {
    let divided: Change = |run| {
        let samples = run.samples[0];
        for variance in run.variance.as_flattened_mut() {
            *variance /= samples;
        }
    };
    let names = ["variance", "mean", "bias", "MSE", "agreement"];
    rejected(&names.map(named), [|_| {}, divided]);
}
