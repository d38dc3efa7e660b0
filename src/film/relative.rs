//! How large a render's error still is beside its mean.

use super::Film;

/// The share of the mean of the whole picture that is added to a pixel's own mean: the error of a pixel that
/// is all but black would never be small beside its mean alone.
const FLOOR: f64 = 0.01;
/// The share of pixels whose error is below [`RelativeError::pixels`].
pub const QUANTILE: f64 = 0.95;

/// Standard errors beside means, of what is the mean over the channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelativeError {
    /// Of the mean of the whole picture.
    pub picture: f64,
    /// The 95th percentile of the pixels': each pixel's standard error over the sum of its mean and a hundredth
    /// of the picture's.
    pub pixels: f64,
}

impl RelativeError {
    /// Whether both are at most `target`.
    pub fn reaches(&self, target: f64) -> bool {
        self.picture <= target && self.pixels <= target
    }

    /// How many times `target` the larger of the two is.
    pub fn beside(&self, target: f64) -> f64 {
        self.picture.max(self.pixels) / target
    }
}

/// The root mean square of a standard error over the channels, which bounds that of the channels' mean.
fn error(variances: [f64; 3]) -> f64 {
    (variances.iter().sum::<f64>() / 3.0).sqrt()
}

fn average(channels: [f64; 3]) -> f64 {
    channels.iter().sum::<f64>() / 3.0
}

/// `error` over `mean`; nothing over nothing is no error.
fn ratio(error: f64, mean: f64) -> f64 {
    if error == 0.0 { 0.0 } else { error / mean }
}

impl Film {
    /// The error as the samples so far estimate it, by the variance between them. Infinite before every pixel
    /// has two samples, or two randomisations where those tell it: nothing is known then.
    pub fn relative_error(&self) -> RelativeError {
        if (0..self.counts.len()).any(|pixel| self.estimates(pixel) < 2) {
            return RelativeError {
                picture: f64::INFINITY,
                pixels: f64::INFINITY,
            };
        }
        let mean = self.brightness();
        let of_pixel = |pixel: usize| {
            let count = self.counts[pixel] as f64;
            let error = error(self.variance(pixel).map(|variance| variance / count));
            ratio(error, average(self.mean(pixel)) + FLOOR * mean)
        };
        let mut pixels: Vec<f64> = (0..self.counts.len()).map(of_pixel).collect();
        let place =
            ((pixels.len() as f64 * QUANTILE).ceil() as usize).clamp(1, pixels.len().max(1)) - 1;
        let percentile = match pixels.is_empty() {
            true => 0.0,
            false => *pixels.select_nth_unstable_by(place, f64::total_cmp).1,
        };
        RelativeError {
            picture: ratio(error(self.standard_error().map(|e| e * e)), mean),
            pixels: percentile,
        }
    }

    /// Mean of the picture over pixels and channels.
    pub fn brightness(&self) -> f64 {
        average(self.picture_mean())
    }

    /// Variance of one sample of each pixel, as [`RelativeError`] takes it: the mean over the channels.
    pub fn variances(&self) -> Vec<f64> {
        let pixels = 0..self.counts.len();
        pixels.map(|pixel| average(self.variance(pixel))).collect()
    }

    /// Mean of each pixel over the channels.
    pub fn means(&self) -> Vec<f64> {
        let pixels = 0..self.counts.len();
        pixels.map(|pixel| average(self.mean(pixel))).collect()
    }
}

/// The number of samples at which the error of a pixel of this mean and this variance of one sample, as
/// [`RelativeError::pixels`] has it, is expected to be `target` in a picture of this brightness.
pub fn needed_samples(mean: f64, variance: f64, brightness: f64, target: f64) -> f64 {
    ratio(variance.sqrt(), target * (mean + FLOOR * brightness)).powi(2)
}
