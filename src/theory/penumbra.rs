//! A far lamp behind a straight edge: the share of it that is seen.

use super::quadrature::integrate;
use std::f64::consts::{FRAC_PI_2, PI};

/// Which points of the lamp stand for it.
///
/// The paper's weight with its test of the *object* takes each drawn point of the sphere for the
/// direction to it, so that the share is that of the drawn points, front and back, whose
/// directions are free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// The disc itself: the truth, and every estimator that divides by its density.
    Truth,
    /// Even by area: cases 2 and 3.
    Area,
    /// Case 1, the edge moving along the pole.
    Along,
    /// Case 1, the pole along the edge or toward the lit point.
    Across,
}

/// Share of a far lamp that is free, with the edge at `h` in [-1, 1] of its disc, free below it.
///
/// - truth: 1/2 + (h sqrt(1 - h^2) + asin h) / pi;
/// - even by area: (1 + h) / 2, for a sphere's area between two planes is that of its height (Archimedes);
/// - along the pole: 1/2 + asin(h) / pi;
/// - across it: 1/2 + the integral from 0 to h of (2 / pi^2) K(sqrt(1 - x^2)), K the complete elliptic
///   integral of the first kind.
pub fn share(drawn: Drawn, h: f64) -> f64 {
    let h = h.clamp(-1.0, 1.0);
    match drawn {
        Drawn::Truth => 0.5 + (h * (1.0 - h * h).sqrt() + h.asin()) / PI,
        Drawn::Area => 0.5 * (1.0 + h),
        Drawn::Along => 0.5 + h.asin() / PI,
        // x = y^4 tames the logarithm at 0; the modulus sqrt(1 - x^2) has the complement x.
        Drawn::Across => {
            let density = |y: f64| 4.0 * y.powi(3) * elliptic(y.powi(4));
            let half = integrate(0.0, h.abs().powf(0.25), 200, density);
            0.5 + h.signum() * 2.0 / (PI * PI) * half
        }
    }
}

/// K(k) by the arithmetic-geometric mean (Gauss), from the complement sqrt(1 - k^2):
/// pi / (2 agm(1, sqrt(1 - k^2))).
fn elliptic(complement: f64) -> f64 {
    let (mut a, mut b) = (1.0, complement);
    while (a - b).abs() > 1e-15 * a {
        (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
    }
    FRAC_PI_2 / a
}
