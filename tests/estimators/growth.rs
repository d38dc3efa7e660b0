//! Interruption that is too frequent: below the squared albedo the variance has no bound.

use super::roulette::{EMISSION, PLAIN, Walls, compensated};
use super::spread::{measure, variance};
use crate::support::bench::{Bench, benches};

/// Variances at limits of 2, 4, 6, 8 and 10 reflections.
fn growth(bench: Bench, walls: Walls, seed: u64) -> Vec<f64> {
    let limits = (2..=10).step_by(2);
    let at = |max_bounces| {
        let walls = Walls {
            max_bounces,
            ..walls
        };
        let case = walls.case();
        let (film, distances) = measure(bench, &case, seed + u64::from(max_bounces), walls.laws());
        assert!(distances[0].passes(), "{}: {distances:?}", case.name);
        variance(&film, 0)
    };
    limits.map(at).collect()
}

/// Whether the variance grows from limit to limit like the terms of a series without a bound: what two
/// more reflections add is more than what the two before them added.
fn has_no_bound(variances: &[f64]) -> bool {
    let added: Vec<_> = variances.windows(2).map(|pair| pair[1] - pair[0]).collect();
    added.windows(2).all(|pair| pair[1] > pair[0])
}

/// The part of the variance that the limit N lets in grows as (rho^2 / t)^N. Every limit's variance
/// is measured within 5 % of its sum, and with t < rho^2 the steps between them grow, so
/// that no limit bounds them; with t > rho^2 they shrink. At t = rho^2 they tend to a constant.
#[test]
fn below_the_squared_albedo_the_variance_has_no_bound() {
    let walls = |albedo: f64, survival| Walls {
        albedo: [albedo; 3],
        survival,
        ..PLAIN
    };
    let (without, with) = (walls(0.9, 0.6), walls(0.7, 0.8));
    for (n, bench) in benches().into_iter().enumerate() {
        let seed = 33_000 + 100 * n as u64;
        let (grown, bound) = (growth(bench, without, seed), growth(bench, with, seed + 50));
        println!("{bench:?}: t < rho^2: {grown:.3?}; t > rho^2: {bound:.3?}");
        assert!(has_no_bound(&grown), "{grown:?}");
        assert!(!has_no_bound(&bound), "{bound:?}");
        let limit = compensated(0.7, 0.8).1 * EMISSION[0].powi(2);
        assert!(
            bound.iter().all(|v| *v < 1.05 * limit),
            "{bound:?}, {limit}"
        );
    }
}
