//! Integrals in f64, for truths that are not elementary.

use std::f64::consts::PI;

pub use lampray::theory::integrate;

/// The error function: 2 / sqrt(pi) times the integral of exp(-t^2) from 0 to x.
pub fn erf(x: f64) -> f64 {
    2.0 / PI.sqrt() * integrate(0.0, x.min(7.0), 64, |t| (-t * t).exp())
}
