//! A group's pictures, taken in one after another.

use super::reference::{check, run};
use crate::compare::kinship;
use crate::error::{Error, Result};
use crate::film::{Picture, Record};
use serde_json::{Map, Value};

/// Runs that differ in nothing but their seed: means and spreads of every pixel.
///
/// Every run counts alike, whatever samples it has: with as many in each, which is the rule, that is
/// also the most precise.
#[derive(Clone, Debug)]
pub struct Runs {
    pub name: String,
    /// Value of each axis but the seed, by path.
    pub values: Map<String, Value>,
    pub(super) size: [u32; 2],
    pub(super) pixels: Vec<Pixel>,
    /// Tracing time of each run, seconds.
    pub(super) seconds: Vec<f64>,
    pub(super) records: Vec<Record>,
    /// Samples a pixel, mean over pixels, summed over runs.
    samples: f64,
}

/// Moments of a pixel over the runs, channel by channel: means, and sums of squared and mixed
/// deviations from them, updated as Welford (1962) and, for the mixed ones, Bennett et al. (2009) do.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pixel {
    pub mean: [f64; 3],
    /// Of one sample.
    pub variance: [f64; 3],
    /// Mean of 1 / samples.
    pub inverse: f64,
    /// Samples of all runs.
    pub samples: f64,
    means: [f64; 3],
    variances: [f64; 3],
    mixed: [f64; 3],
}

impl Pixel {
    fn add(&mut self, count: f64, mean: [f32; 3], variance: [f32; 3], samples: f32) {
        let samples = f64::from(samples);
        self.inverse += (1.0 / samples - self.inverse) / count;
        self.samples += samples;
        for channel in 0..3 {
            let (m, v) = (f64::from(mean[channel]), f64::from(variance[channel]));
            let (from_mean, from_variance) = (m - self.mean[channel], v - self.variance[channel]);
            self.mean[channel] += from_mean / count;
            self.variance[channel] += from_variance / count;
            let after = v - self.variance[channel];
            self.means[channel] += from_mean * (m - self.mean[channel]);
            self.variances[channel] += from_variance * after;
            self.mixed[channel] += from_mean * after;
        }
    }

    /// Sample variance, over the runs, of a run's mean, of its variance, and their covariance.
    pub fn spread(&self, channel: usize, runs: usize) -> [f64; 3] {
        let freedom = runs as f64 - 1.0;
        [self.means, self.variances, self.mixed].map(|sums| sums[channel] / freedom)
    }
}

impl Runs {
    pub fn new(name: &str, values: Map<String, Value>) -> Self {
        Self {
            name: name.into(),
            values,
            size: [0, 0],
            pixels: Vec::new(),
            seconds: Vec::new(),
            records: Vec::new(),
            samples: 0.0,
        }
    }

    /// Takes in one run. `seconds` is what tracing it took.
    ///
    /// # Errors
    /// [`Error::Usage`] for a picture of another size, one whose noise is not known, one that shares
    /// samples with a run of this group, or a time that is none.
    pub fn add(&mut self, picture: &Picture, seconds: f64) -> Result<()> {
        check(picture, &self.name)?;
        let fail = |reason: &str| Err(Error::Usage(format!("{}: {reason}", self.name)));
        let size = [picture.width, picture.height];
        if !self.pixels.is_empty() && size != self.size {
            return fail("its runs have several sizes");
        }
        if !(seconds.is_finite() && seconds >= 0.0) {
            return fail("the time of a run is not a number of seconds");
        }
        let paired = |record| kinship(record, &picture.record).paired;
        if self.records.iter().any(paired) {
            return fail("two of its runs have the same samples: each needs a seed of its own");
        }
        self.size = size;
        self.pixels.resize(picture.pixels(), Pixel::default());
        self.seconds.push(seconds);
        self.records.push(picture.record.clone());
        let count = self.len() as f64;
        for (index, pixel) in self.pixels.iter_mut().enumerate() {
            let samples = picture.samples[index];
            pixel.add(count, picture.mean[index], picture.variance[index], samples);
        }
        let samples: f64 = picture.samples.iter().copied().map(f64::from).sum();
        self.samples += samples / picture.pixels() as f64;
        Ok(())
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.seconds.len()
    }

    pub fn is_empty(&self) -> bool {
        self.seconds.is_empty()
    }

    /// Samples a pixel of a run, mean over runs and pixels.
    pub fn samples(&self) -> f64 {
        self.samples / self.len().max(1) as f64
    }

    /// Degrees of freedom of the variance of so many samples of all runs.
    pub(super) fn freedom(&self, samples: f64) -> f64 {
        match self.records.first().map_or(1.0, run) {
            1.0 => samples - 1.0,
            length => samples / length - self.len() as f64,
        }
    }

    /// Samples behind each independent estimate of the variance of a pixel over all runs.
    pub(super) fn run(&self) -> f64 {
        self.samples / (self.freedom(self.samples) + 1.0)
    }

    /// Variance of the mean of a pixel over all runs, from the stored variances.
    pub(super) fn noise(&self, pixel: usize, channel: usize) -> f64 {
        let pixel = &self.pixels[pixel];
        pixel.variance[channel] * pixel.inverse / self.len() as f64
    }
}
