//! What the samples support, and how many would support more.

use super::Terms;
use super::estimate::Estimate;
use super::moments::{Side, Sides};
use super::normal::quantile;
use serde::Serialize;

/// The chance that so many samples are enough.
const POWER: f64 = 0.95;

/// How many samples a pixel would do.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Needed {
    /// In the reference, if both pictures get more.
    pub reference: u64,
    /// In the test, if both get more.
    pub test: u64,
    /// In the test if it alone gets more; absent where that cannot be enough.
    pub test_alone: Option<u64>,
}

/// The smallest relative margin that two one-sided tests at `alpha` exclude in every channel.
pub fn supported_margin(pooled: &[Estimate; 3], alpha: f64) -> f64 {
    let z = quantile(1.0 - alpha);
    pooled.iter().map(|mean| mean.margin(z)).fold(0.0, f64::max)
}

/// How many samples give an answer with probability [`POWER`] where the means are apart by half the
/// margin or less; a larger difference is found with them.
pub fn needed(sides: &Sides, pooled: &[Estimate; 3], terms: Terms) -> Needed {
    let quantiles = quantile(1.0 - terms.alpha) + quantile(POWER);
    let mut factor: f64 = 1.0;
    let mut alone = Some(1.0_f64);
    for (channel, mean) in pooled.iter().enumerate() {
        let allowed = (0.5 * terms.margin * mean.reference / quantiles).powi(2);
        if mean.error == 0.0 || allowed == 0.0 {
            continue;
        }
        factor = factor.max(mean.error.powi(2) / allowed);
        let [reference, test] = [sides.reference, sides.test].map(|side| of_mean(side, channel));
        let more =
            (!sides.relation.paired && allowed > reference).then(|| test / (allowed - reference));
        alone = alone.zip(more).map(|(most, more)| most.max(more));
    }
    let times = |side: Side, factor: f64| (even(side) * factor).ceil() as u64;
    Needed {
        reference: times(sides.reference, factor),
        test: times(sides.test, factor),
        test_alone: alone.map(|factor| times(sides.test, factor)),
    }
}

/// Samples a pixel: where pixels have not all the same, as many of each as would leave the mean of the picture the
/// variance that it has, in the channel that would take the most.
fn even(side: Side) -> f64 {
    let first = side.samples.first().copied().unwrap_or(0.0);
    if side.samples.iter().all(|n| *n == first) {
        return f64::from(first);
    }
    let pixels = side.mean.len() as f64;
    let of_channel = |channel: usize| {
        let of_one: f64 = side.variance.iter().map(|v| f64::from(v[channel])).sum();
        let of_mean = of_mean(side, channel) * pixels * pixels;
        if of_mean > 0.0 { of_one / of_mean } else { 0.0 }
    };
    let least = side.samples.iter().copied().fold(f32::INFINITY, f32::min);
    (0..3).map(of_channel).fold(f64::from(least), f64::max)
}

/// Variance of the mean of a picture.
fn of_mean(side: Side, channel: usize) -> f64 {
    let pixels = side.mean.len() as f64;
    let variances = side.variance.iter().zip(side.samples);
    let sum: f64 = variances
        .map(|(variance, n)| f64::from(variance[channel]) / f64::from(*n))
        .sum();
    sum / (pixels * pixels)
}
