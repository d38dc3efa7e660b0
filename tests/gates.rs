//! What the other tests judge by: distributions, quadrature, and the level of the gates.

mod support;

use std::f64::consts::{PI, SQRT_2};
use support::chance::*;
use support::gate::{LEVEL, MOST_ERRORS};
use support::quadrature::{erf, integrate};

#[test]
fn the_gates_know_their_distributions() {
    // Percentage points from printed tables.
    for (statistic, freedom, p) in [
        (3.841_459, 1.0, 0.05),
        (18.307_04, 10.0, 0.05),
        (2.558_212, 10.0, 0.99),
        (135.806_7, 100.0, 0.01),
    ] {
        let above = chi_square_above(statistic, freedom);
        assert!((above - p).abs() < 1e-6, "{statistic} {freedom}: {above}");
    }
    assert!((sidak(0.01, 10) - 0.001_004_5).abs() < 1e-7);
    for (statistic, p) in [(1.358_1, 0.05), (1.627_6, 0.01), (0.827_6, 0.5)] {
        let above = kolmogorov_above(statistic);
        assert!((above - p).abs() < 1e-4, "{statistic}: {above}");
    }
    let apart = distance_of_sorted(&[1.0, 2.0, 2.0, 5.0], &[2.0, 3.0, 4.0, 6.0]);
    assert_eq!(apart, 0.5);
    // Of ten coins at least eight heads: 56 of 1024.
    let heads = binomial_at_least(8, 10, 0.5);
    assert!((heads - 56.0 / 1024.0).abs() < 1e-12, "{heads}");
}

#[test]
fn quadrature_is_good_to_ten_digits() {
    assert!((integrate(0.0, PI, 8, f64::sin) - 2.0).abs() < 1e-10);
    assert!((erf(1.0) - 0.842_700_792_949_714_9).abs() < 1e-12);
    assert!((erf(9.0) - 1.0).abs() < 1e-12);
}

#[test]
fn the_level_belongs_to_the_threshold() {
    let level = 1.0 - erf(MOST_ERRORS / SQRT_2);
    assert!((LEVEL / level - 1.0).abs() < 1e-3, "{level:e}");
}
