//! A difference with its standard error, wherever it comes from.

use super::normal::{FARTHEST, from_student, two_sided};
use serde::Serialize;

/// Test minus reference, in one channel of some pixels: means, not sums.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Estimate {
    /// Mean of the reference there.
    pub reference: f64,
    pub difference: f64,
    /// Standard error of `difference`.
    pub error: f64,
    /// How far from the tolerated difference, as a standard normal number; never negative.
    pub z: f64,
}

/// What an [`Estimate`] is made of.
#[derive(Clone, Copy, Debug, Default)]
pub struct Parts {
    pub reference: f64,
    pub difference: f64,
    /// Of `difference`.
    pub variance: f64,
    /// Degrees of freedom of that variance; infinite where it is known.
    pub freedom: f64,
}

impl Estimate {
    /// `tolerance` is the relative difference that does not count.
    pub fn new(parts: Parts, tolerance: f64) -> Self {
        let level = 0.5 * (2.0 * parts.reference + parts.difference).abs();
        let beyond = (parts.difference.abs() - tolerance * level).max(0.0);
        let error = parts.variance.max(0.0).sqrt();
        let z = if beyond == 0.0 {
            0.0
        } else if error == 0.0 {
            FARTHEST
        } else {
            from_student(beyond / error, parts.freedom)
        };
        Self {
            reference: parts.reference,
            difference: parts.difference,
            error,
            z,
        }
    }

    /// Chance of a difference at least this large where there is none.
    pub fn p(&self) -> f64 {
        two_sided(self.z)
    }

    /// The smallest difference, relative to the reference, that two one-sided tests exclude, each at
    /// the level of `z`; 0 where there is neither difference nor noise, infinite where there is some and
    /// the reference is black.
    pub fn margin(&self, z: f64) -> f64 {
        match self.difference.abs() + z * self.error {
            0.0 => 0.0,
            widest => widest / self.reference.abs(),
        }
    }
}
