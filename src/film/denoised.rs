//! What a record says of a picture that was denoised.

use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// How to denoise. Widths are of Gaussian weights: at one of them a pixel counts 1/e.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Denoising {
    /// Passes, each with taps twice as far apart as the one before: the last looks 2^passes pixels far.
    pub passes: u32,
    /// Differences of light that the first pass takes for noise, in standard errors of that difference.
    pub light: f64,
    /// Differences of normals, as the distance between their tips.
    pub normal: f64,
    /// Distances from the other pixel's tangent plane, in widths of a pixel there.
    pub depth: f64,
}

impl Denoising {
    /// What is good for most pictures.
    pub const USUAL: Self = Self {
        passes: 5,
        light: 2.0,
        normal: 0.2,
        depth: 1.0,
    };
    /// What passes may be.
    pub const PASSES: RangeInclusive<u32> = 1..=8;
    /// What the three widths may be.
    pub const WIDTHS: RangeInclusive<f64> = 1e-3..=1e3;

    /// Whether it can be done: a record may say anything.
    pub fn is_sound(&self) -> bool {
        let widths = [self.light, self.normal, self.depth];
        Self::PASSES.contains(&self.passes)
            && widths.iter().all(|width| Self::WIDTHS.contains(width))
    }
}

/// A picture that was denoised is no mean of samples any more: it is less noisy, and biased.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Denoised {
    #[serde(flatten)]
    pub by: Denoising,
    /// Mean radiance of the picture before: how far the record's own mean is from it is the energy that was made or
    /// lost.
    pub mean_before: [f64; 3],
    /// How long it took.
    pub seconds: f64,
}
