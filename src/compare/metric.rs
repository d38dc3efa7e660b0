//! The metrics: what each is called, how it is defined, and which way is better.

use super::survey::{NEAR_BLACK, Sums};
use serde::Serialize;
use std::fmt;
use std::ops::RangeInclusive;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, clap::ValueEnum)]
pub enum Metric {
    /// Mean absolute error, linear light
    Mae,
    /// Mean squared error, linear light
    Mse,
    /// Root of the mean squared error, linear light
    Rmse,
    /// Mean of d^2 / (reference^2 + 0.01), linear light
    #[value(name = "relmse")]
    RelMse,
    /// Mean of (d / (reference + 0.01))^2, linear light, as pbrt has it
    Mrse,
    /// Peak signal to noise ratio, decibels, linear light, peak 1: larger is better
    Psnr,
    /// Structural similarity of the tone-mapped pictures, at most 1: larger is better
    Ssim,
    /// The same over five scales
    MsSsim,
    /// Perceived difference of the tone-mapped pictures, 0 to 1
    Flip,
    /// The same over a range of exposures; EXR only
    HdrFlip,
}

impl Metric {
    /// Those that one pass over linear light gives.
    pub const LINEAR: [Metric; 6] = [
        Metric::Mae,
        Metric::Mse,
        Metric::Rmse,
        Metric::RelMse,
        Metric::Mrse,
        Metric::Psnr,
    ];
    /// Those of the tone-mapped picture.
    pub const DISPLAY: [Metric; 3] = [Metric::Ssim, Metric::MsSsim, Metric::Flip];

    /// As `--metric` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Metric::Mae => "mae",
            Metric::Mse => "mse",
            Metric::Rmse => "rmse",
            Metric::RelMse => "relmse",
            Metric::Mrse => "mrse",
            Metric::Psnr => "psnr",
            Metric::Ssim => "ssim",
            Metric::MsSsim => "ms-ssim",
            Metric::Flip => "flip",
            Metric::HdrFlip => "hdr-flip",
        }
    }

    /// As people write it.
    pub fn title(self) -> &'static str {
        match self {
            Metric::Mae => "MAE",
            Metric::Mse => "MSE",
            Metric::Rmse => "RMSE",
            Metric::RelMse => "relMSE",
            Metric::Mrse => "MRSE",
            Metric::Psnr => "PSNR",
            Metric::Ssim => "SSIM",
            Metric::MsSsim => "MS-SSIM",
            Metric::Flip => "FLIP",
            Metric::HdrFlip => "HDR-FLIP",
        }
    }

    /// Whether larger is better, so that a limit is a least value.
    pub fn rises(self) -> bool {
        matches!(self, Metric::Psnr | Metric::Ssim | Metric::MsSsim)
    }

    /// The values that it can have.
    pub fn range(self) -> RangeInclusive<f64> {
        match self {
            Metric::Psnr => f64::NEG_INFINITY..=f64::INFINITY,
            Metric::Ssim => -1.0..=1.0,
            Metric::MsSsim | Metric::Flip | Metric::HdrFlip => 0.0..=1.0,
            _ => 0.0..=f64::INFINITY,
        }
    }

    /// Whether each pixel has a value of its own, which `--allow-pixels` and maps need.
    pub fn has_pixels(self) -> bool {
        !matches!(self, Metric::Psnr | Metric::MsSsim)
    }

    /// The value of the metrics of linear light; none for the others.
    pub fn of_sums(self, sums: &Sums) -> Option<f64> {
        let mean = |sum: f64| sum / sums.values.max(1) as f64;
        match self {
            Metric::Mae => Some(mean(sums.absolute)),
            Metric::Mse => Some(mean(sums.squared)),
            Metric::Rmse => Some(mean(sums.squared).sqrt()),
            Metric::RelMse => Some(mean(sums.relative)),
            Metric::Mrse => Some(mean(sums.mean_relative)),
            // Added to zero, for there is a zero below zero.
            Metric::Psnr => Some(0.0 - 10.0 * mean(sums.squared).log10()),
            _ => None,
        }
    }

    /// One pixel's part of the metric, averaged over its channels; none where a pixel alone has
    /// no value of linear light.
    pub fn of_pixel(self, reference: [f32; 3], test: [f32; 3]) -> Option<f32> {
        let error = |channel: usize| {
            let (a, b) = (f64::from(reference[channel]), f64::from(test[channel]));
            let d = b - a;
            match self {
                Metric::Mae => Some(d.abs()),
                Metric::Mse | Metric::Rmse => Some(d * d),
                Metric::RelMse => Some(d * d / (a * a + NEAR_BLACK)),
                Metric::Mrse => Some((d / (a + NEAR_BLACK)).powi(2)),
                _ => None,
            }
        };
        let mean = (error(0)? + error(1)? + error(2)?) / 3.0;
        let value = if self == Metric::Rmse {
            mean.sqrt()
        } else {
            mean
        };
        Some(value as f32)
    }
}

impl fmt::Display for Metric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Serialize for Metric {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// A metric's value and how it was found.
#[derive(Clone, Debug, Serialize)]
pub struct Figure {
    pub metric: Metric,
    /// Infinite for the PSNR of equal pictures, which JSON has no number for: it is null there.
    pub value: f64,
    /// Colour space and settings.
    pub settings: String,
}
