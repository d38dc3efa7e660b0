//! One channel of one pixel of a group: its squared difference, its noise, and how far both may be off.

use super::reference::Reference;
use super::runs::Runs;
use crate::compare::NEAR_BLACK;

/// How a pixel's squares count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Even,
    /// 1 / (reference^2 + 0.01).
    Relative,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// Mean of all runs minus the reference, 0 without one.
    difference: f64,
    /// Variance of the mean of all runs, and of the reference's; 0 without a reference.
    own: f64,
    reference: f64,
    /// Of one sample.
    variance: f64,
    /// 1 / N.
    inverse: f64,
    /// Variance of `variance`, and its covariance with the mean, for the mean of all runs.
    spread: [f64; 2],
    /// The weight at the reference, and its first two derivatives by it.
    weight: [f64; 3],
    /// Independent estimates that `variance` is made of, of all runs.
    pub samples: f64,
}

impl Cell {
    pub fn new(
        runs: &Runs,
        reference: Option<&Reference>,
        pixel: usize,
        channel: usize,
        weight: Weight,
    ) -> Self {
        let of = &runs.pixels[pixel];
        let variance = of.variance[channel];
        let count = runs.len() as f64;
        let spread = if runs.len() > 1 {
            let [_, variances, mixed] = of.spread(channel, runs.len());
            [variances / count, mixed / count]
        } else {
            // Of normal samples; only read where there is no neighbour to tell more.
            [2.0 * variance * variance / runs.freedom(of.samples), 0.0]
        };
        let mean = reference.map(|reference| reference.mean(pixel, channel));
        Self {
            difference: mean.map_or(0.0, |mean| of.mean[channel] - mean),
            own: mean.map_or(0.0, |_| runs.noise(pixel, channel)),
            reference: reference.map_or(0.0, |reference| reference.noise(pixel, channel)),
            variance,
            inverse: of.inverse,
            spread,
            weight: weight.at(mean.unwrap_or(0.0)),
            samples: runs.freedom(of.samples) + 1.0,
        }
    }

    /// With the variance of one sample as its noise, and no reference.
    pub fn of_one_sample(runs: &Runs, pixel: usize, channel: usize) -> Self {
        Self {
            inverse: 1.0,
            ..Self::new(runs, None, pixel, channel, Weight::Even)
        }
    }

    /// D^2 less what the reference's noise adds to it, weighted.
    ///
    /// With a reference r = t + e the weight g(r) is off too, and together with D: to second order in e the
    /// mean of D^2 g(r) is g D^2 + s (g - 2 D g' + D^2 g'' / 2), s the variance of e. What D, g and g' at r instead
    /// of t leave of that is 1.5 s^2 g'' too little. For references whose noise s is below 1 / 200 of r^2 + 0.01;
    /// with poorer ones intervals become too wide.
    pub fn square(&self) -> f64 {
        let [weight, slope, bend] = self.weight;
        let (difference, s) = (self.difference, self.reference);
        difference * difference * self.mean_weight() - s * (weight - 2.0 * difference * slope)
            + 1.5 * s * s * bend
    }

    /// Variance over N, weighted.
    pub fn noise(&self) -> f64 {
        self.mean_weight() * self.plain_noise()
    }

    /// V0, V1 and V2 of [`super::Energy`], from the spread over the runs.
    ///
    /// In the relative square one unit of e changes a = -2 D g + (D^2 - s) g', and D itself is off by w, which
    /// a^2 has (2 g - 2 D g')^2 w too much of; in the noise u g', u = v / N. Even weights have g' = 0, and it is
    /// 4 (D^2 - w) w + 2 w^2 for V0.
    pub fn variances(&self) -> [f64; 3] {
        let [weight, slope, _] = self.weight;
        let (difference, s) = (self.difference, self.reference);
        let squared = difference * difference;
        let w = self.own + s;
        let [spread, mixed] = self.spread;
        let weights = self.mean_weight().powi(2);
        let square = (squared - s) * slope - 2.0 * difference * weight;
        let again = 2.0 * (weight - difference * slope);
        let noise = self.plain_noise() * slope;
        let linear =
            4.0 * weights * (squared - w) * self.own + s * (square * square - again * again * w);
        [
            linear + self.least(),
            weights * 2.0 * difference * mixed * self.inverse + s * square * noise,
            weights * spread * self.inverse * self.inverse + s * noise * noise,
        ]
    }

    /// V0 where there is no bias.
    pub fn least(&self) -> f64 {
        let w = self.own + self.reference;
        2.0 * (self.mean_weight() * w).powi(2)
    }

    fn plain_noise(&self) -> f64 {
        self.variance * self.inverse
    }

    /// The weight without what the reference's noise adds to it.
    fn mean_weight(&self) -> f64 {
        self.weight[0] - 0.5 * self.reference * self.weight[2]
    }
}

impl Weight {
    /// Value and first two derivatives.
    fn at(self, reference: f64) -> [f64; 3] {
        match self {
            Weight::Even => [1.0, 0.0, 0.0],
            Weight::Relative => {
                let squared = reference * reference;
                let weight = 1.0 / (squared + NEAR_BLACK);
                let second = weight * weight * (8.0 * squared * weight - 2.0);
                [weight, -2.0 * reference * weight * weight, second]
            }
        }
    }
}
