//! What a record says of a picture that was denoised.

use crate::wording::{counted, signed};
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Denoised {
    #[serde(flatten)]
    pub by: Denoising,
    /// Mean radiance of the picture before: how far the record's own mean is from it is the energy that was made or
    /// lost.
    pub mean_before: [f64; 3],
    /// By what share of it each channel's mean changed: 0.01 is 1 % more.
    #[serde(default)]
    pub change: [f64; 3],
    /// Pixels of one sample, of whose variance nothing is known.
    #[serde(default)]
    pub unknown_variance: u64,
    /// What whoever looks at it should know.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// How long it took.
    pub seconds: f64,
}

impl Denoised {
    /// A channel's mean that changes by a larger share is warned of. That of a usual scene changes by a share of some
    /// hundredths at most.
    pub const LARGE_CHANGE: f64 = 0.05;

    /// Of a picture whose mean radiance was the first of `means` and is the second, with so many pixels of
    /// `unknown_variance`.
    pub fn new(
        by: Denoising,
        [before, after]: [[f64; 3]; 2],
        unknown_variance: u64,
        seconds: f64,
    ) -> Self {
        let change = std::array::from_fn(|channel| share(before[channel], after[channel]));
        let mut denoised = Self {
            by,
            mean_before: before,
            change,
            unknown_variance,
            warnings: Vec::new(),
            seconds,
        };
        denoised.warnings = denoised.warned().into_iter().flatten().collect();
        denoised
    }

    /// The channel whose mean changed by the largest share, and that share.
    pub fn largest_change(&self) -> (&'static str, f64) {
        let channels = ["red", "green", "blue"].into_iter().zip(self.change);
        let larger = |a: (&'static str, f64), b: (&'static str, f64)| {
            if b.1.abs() > a.1.abs() { b } else { a }
        };
        channels.reduce(larger).unwrap_or_default()
    }

    fn warned(&self) -> [Option<String>; 2] {
        let unknown = (self.unknown_variance > 0).then(|| {
            format!(
                "{} of one sample, of whose variance nothing is known: each counts as being as uncertain as it and the picture's mean are bright; give --spp 2 or more",
                counted(self.unknown_variance, "pixel")
            )
        });
        let (name, share) = self.largest_change();
        let large = (share.abs() > Self::LARGE_CHANGE).then(|| {
            format!(
                "denoising changed the mean of {name} by {} %: take the picture beside it for brightness, or more samples",
                signed(100.0 * share, 2)
            )
        });
        [unknown, large]
    }
}

/// By what share of it a mean changed; as far as can be told where it was nothing.
fn share(before: f64, after: f64) -> f64 {
    let share = (after - before) / before.abs().max(f64::MIN_POSITIVE);
    if share.is_nan() {
        0.0
    } else {
        share.clamp(f64::MIN, f64::MAX)
    }
}
