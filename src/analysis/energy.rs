//! Mean squared error as a sum of bias^2 and noise, with what is not known of both together.

use super::cell::{Cell, Weight};
use super::quantity::{Channels, Quantity};
use super::reference::Reference;
use super::runs::Runs;

/// bias^2 + a v / N for any a, mean over some pixels; v / N is the noise of one run.
///
/// Of the mean D of all K runs minus the reference, and of u = v / N, the sums S = D^2 - v_r / n_r and u are
/// kept: bias^2 = S - u / K, and bias^2 + a u = S + c u with c = a - 1 / K. The variance of S + c u is
/// V0 + 2 c V1 + c^2 V2, so three numbers give the error of every figure that mixes bias^2 and noise.
///
/// - **Two runs and more**: u and m vary over the runs, pixel by pixel; that gives V2, and V1 as 2 D times
///   their covariance. D is the mean of many samples, so D^2 has the variance of a normal number's
///   square, 4 b^2 w + 2 w^2 with w = v / (N K) + v_r / n_r; b^2 is estimated as D^2 - w.
/// - **One run**: nothing varies but from pixel to pixel. Neighbours in a row are of about the same
///   picture, so half the sum of the squared differences between neighbours is the variance of the
///   sum (von Neumann 1941; for systematic samples Wolter 2007, chapter 8). Where neighbours are
///   not alike it is too large, never too small.
#[derive(Clone, Copy, Debug)]
pub struct Energy {
    channels: [Channel; 3],
    /// 1 / K, or 0 where there is no reference and bias is left aside.
    offset: f64,
}

/// Means over the pixels.
#[derive(Clone, Copy, Debug, Default)]
struct Channel {
    square: f64,
    noise: f64,
    /// V0, V1, V2.
    variances: [f64; 3],
    freedom: f64,
}

impl Energy {
    /// Of a run's pixels against the reference; without one, of its noise alone.
    pub(super) fn new(
        runs: &Runs,
        reference: Option<&Reference>,
        pixels: &[usize],
        weight: Weight,
    ) -> Self {
        let channel = |channel| {
            let mut sums = Sums::new(runs.len());
            for &pixel in pixels {
                sums.add(&Cell::new(runs, reference, pixel, channel, weight));
            }
            sums.channel()
        };
        Self {
            channels: [0, 1, 2].map(channel),
            offset: reference.map_or(0.0, |_| 1.0 / runs.len() as f64),
        }
    }

    /// The variance of one sample, which is noise at one sample a pixel.
    pub(super) fn of_one_sample(runs: &Runs, pixels: &[usize]) -> Channels {
        let channel = |channel| {
            let mut sums = Sums::new(runs.len());
            for &pixel in pixels {
                sums.add(&Cell::of_one_sample(runs, pixel, channel));
            }
            sums.channel().at(1.0)
        };
        [0, 1, 2].map(channel)
    }

    /// bias^2 + `noise` times v / N: 0 for bias^2 alone, 1 for the MSE of a run, t for one that has 1 / t of
    /// the samples.
    pub fn channels(&self, noise: f64) -> Channels {
        self.channels.map(|channel| channel.at(noise - self.offset))
    }

    /// Mean of the channels of [`Energy::channels`].
    pub fn at(&self, noise: f64) -> Quantity {
        Quantity::over(&self.channels(noise))
    }

    pub fn bias_squared(&self) -> Quantity {
        self.at(0.0)
    }

    /// Of a run.
    pub fn mse(&self) -> Quantity {
        self.at(1.0)
    }

    /// v / N, the part of the MSE that more samples take away.
    pub fn noise(&self) -> f64 {
        self.channels
            .iter()
            .map(|channel| channel.noise)
            .sum::<f64>()
            / 3.0
    }
}

impl Channel {
    fn at(&self, times: f64) -> Quantity {
        let [square, both, noise] = self.variances;
        Quantity::new(
            self.square + times * self.noise,
            square + 2.0 * times * both + times * times * noise,
            self.freedom,
        )
    }
}

/// Sums over pixels.
#[derive(Clone, Debug, Default)]
struct Sums {
    runs: usize,
    pixels: f64,
    samples: f64,
    square: f64,
    noise: f64,
    /// V0, V1 and V2 from the spread over the runs, and the least that V0 can be.
    within: [f64; 3],
    least: f64,
    /// Sum of V2's parts squared, for the degrees of freedom.
    fourth: f64,
    /// V0, V1 and V2 from the differences between neighbours.
    between: [f64; 3],
    /// Square and noise of the pixel before.
    before: Option<[f64; 2]>,
}

impl Sums {
    fn new(runs: usize) -> Self {
        Self {
            runs,
            ..Self::default()
        }
    }

    fn add(&mut self, cell: &Cell) {
        let (square, noise) = (cell.square(), cell.noise());
        let within = cell.variances();
        self.pixels += 1.0;
        self.samples += cell.samples;
        self.square += square;
        self.noise += noise;
        for (sum, variance) in self.within.iter_mut().zip(within) {
            *sum += variance;
        }
        self.least += cell.least();
        self.fourth += within[2] * within[2];
        if let Some([last_square, last_noise]) = self.before {
            let (a, b) = (square - last_square, noise - last_noise);
            self.between[0] += 0.5 * a * a;
            self.between[1] += 0.5 * a * b;
            self.between[2] += 0.5 * b * b;
        }
        self.before = Some([square, noise]);
    }

    fn channel(&self) -> Channel {
        let (variances, freedom) = self.variances();
        let pixels = self.pixels.max(1.0);
        Channel {
            square: self.square / pixels,
            noise: self.noise / pixels,
            variances: variances.map(|variance| variance / (pixels * pixels)),
            freedom,
        }
    }

    fn variances(&self) -> ([f64; 3], f64) {
        if self.runs == 1 && self.pixels > 1.0 {
            // There is one difference less than there are pixels. Overlapping differences are worth
            // two thirds of as many independent ones (von Neumann et al. 1941).
            let scale = self.pixels / (self.pixels - 1.0);
            let freedom = 2.0 / 3.0 * (self.pixels - 1.0);
            return (self.between.map(|variance| variance * scale), freedom);
        }
        let [square, both, noise] = self.within;
        let runs = self.runs as f64;
        let freedom = if self.runs == 1 {
            self.samples - 1.0
        } else if self.fourth > 0.0 {
            // Welch and Satterthwaite; the square of a variance of K - 1 degrees of freedom is too
            // large by (K + 1) / (K - 1).
            let each = (runs + 1.0) * noise * noise / self.fourth;
            each.min(self.pixels * (runs - 1.0))
        } else {
            f64::INFINITY
        };
        ([square.max(self.least), both, noise], freedom)
    }
}
