//! What a film keeps where the samples of a pixel are no independent ones: the spread of the means of its
//! randomisations.
//!
//! A pixel's samples are cut into G runs, each a point set made random anew (`knobs/randomisation.rs`). Their means
//! m are independent, with n samples each, N in all. The film's `squares` then hold the sum of n m^2 over the
//! runs, and its variance is (sum of n m^2 - N M^2) / (G - 1), M the mean of all: divided by N it is the squared
//! standard error of M, as the sample variance of independent samples is. A last run that is shorter, or still
//! open, counts as one of its own: with errors that fall at least as fast as those of independent samples the
//! variance is then too large, never too small.

use super::exact::Exact;
use super::moments::Film;
use crate::pack::{Rect, Tally};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::{Range, RangeFrom};

/// The randomisations of a film.
#[derive(Clone, Debug, PartialEq)]
pub struct Randomisations {
    /// Samples of one: whole tallies.
    pub length: u64,
    /// Sum of radiance of the samples of each pixel's open one.
    pub open: Vec<[f64; 3]>,
    /// Where the pixels share point sets, so that their errors are not independent: the sum over all pixels of
    /// each closed one.
    pub pictures: Option<Pictures>,
}

/// Sums of radiance over pixels, by the number of the randomisation.
pub type Pictures = BTreeMap<u64, [Exact; 3]>;

/// What the standard errors of a picture are made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ErrorEstimate {
    /// The spread of independent samples.
    #[default]
    Independent,
    /// The spread of the means of independent randomisations.
    Randomisations,
}

/// Randomisations that so many samples of a pixel are in.
pub(super) fn count(samples: u64, length: Option<u64>) -> u64 {
    length.map_or(samples, |length| samples.div_ceil(length.max(1)))
}

/// Variance of the mean of `samples` samples, of the means of their randomisations in order.
pub(super) fn variance_of_mean(means: &[[f64; 3]], length: u64, samples: u64) -> [f64; 3] {
    if means.len() < 2 {
        return [0.0; 3];
    }
    let sizes = (0..means.len() as u64).map(|number| {
        let left = samples.saturating_sub(number.saturating_mul(length));
        left.min(length) as f64
    });
    let sizes: Vec<f64> = sizes.collect();
    let all: f64 = sizes.iter().sum();
    [0, 1, 2].map(|channel| {
        let each = || {
            means
                .iter()
                .zip(&sizes)
                .map(|(mean, size)| (mean[channel], size))
        };
        let mean = each().map(|(mean, size)| mean * size).sum::<f64>() / all;
        let spread: f64 = each().map(|(m, size)| size * (m - mean).powi(2)).sum();
        spread / (means.len() - 1) as f64 / all
    })
}

/// Adds sums randomisation by randomisation; the order changes no bit.
pub(super) fn add_pictures(sums: &mut Pictures, more: &Pictures) {
    for (&number, more) in more {
        let picture = sums.entry(number).or_default();
        for (sum, more) in picture.iter_mut().zip(more) {
            sum.add_sum(more);
        }
    }
}

/// The open randomisations of pixels side by side.
pub(super) struct Sets<'a> {
    length: u64,
    open: &'a mut [[f64; 3]],
    /// Whether sums over all pixels are kept.
    shared: bool,
}

impl Sets<'_> {
    /// Adds a run of samples, which is part of one randomisation; where it closes that, and sums over pixels are
    /// kept, number and sum of it.
    pub(super) fn add(
        &mut self,
        pixel: usize,
        samples: u32,
        tally: &Tally,
        sums: &mut [f64; 3],
        squares: &mut [f64; 3],
        count: &mut u64,
    ) -> Option<(u64, [f64; 3])> {
        let open = &mut self.open[pixel];
        for channel in 0..3 {
            let sum = f64::from(samples) * f64::from(tally.mean[channel]);
            sums[channel] += sum;
            open[channel] += sum;
        }
        *count += u64::from(samples);
        if !count.is_multiple_of(self.length) {
            return None;
        }
        let closed = std::mem::take(open);
        for channel in 0..3 {
            squares[channel] += closed[channel] * closed[channel] / self.length as f64;
        }
        self.shared.then_some((*count / self.length - 1, closed))
    }
}

impl Randomisations {
    /// Those of some pixels side by side.
    pub(super) fn row(&mut self, pixels: RangeFrom<usize>) -> Sets<'_> {
        Sets {
            length: self.length,
            open: &mut self.open[pixels],
            shared: self.pictures.is_some(),
        }
    }

    /// Those of some rows of pixels, one after the other.
    pub(super) fn rows(
        &mut self,
        pixels: Range<usize>,
        width: usize,
    ) -> impl Iterator<Item = Sets<'_>> {
        let (length, shared) = (self.length, self.pictures.is_some());
        self.open[pixels].chunks_mut(width).map(move |open| Sets {
            length,
            open,
            shared,
        })
    }

    /// What a pixel's open randomisation adds to its squares.
    pub(super) fn open_square(&self, pixel: usize, count: u64) -> [f64; 3] {
        match count % self.length {
            0 => [0.0; 3],
            rest => self.open[pixel].map(|sum| sum * sum / rest as f64),
        }
    }
}

impl Film {
    /// A film of samples that are independent randomisation by randomisation only, each of `length` samples; with
    /// `shared`, neighbouring pixels share their point sets.
    pub fn of_randomisations(region: Rect, length: u64, shared: bool) -> Self {
        let open = vec![[0.0; 3]; region.area()];
        let pictures = shared.then(Pictures::new);
        Self {
            randomisations: Some(Randomisations {
                length,
                open,
                pictures,
            }),
            ..Self::new(region)
        }
    }

    /// Independent estimates that a pixel's variance is made of: its samples, or its randomisations.
    pub fn estimates(&self, pixel: usize) -> u64 {
        let length = self.randomisations.as_ref().map(|all| all.length);
        count(self.counts[pixel], length)
    }

    pub fn error_estimate(&self) -> ErrorEstimate {
        match self.randomisations {
            None => ErrorEstimate::Independent,
            Some(_) => ErrorEstimate::Randomisations,
        }
    }

    /// Where pixels share point sets: the mean over all pixels of each randomisation that all of them have, and
    /// the samples of a pixel that are in those.
    pub(super) fn shared_means(&self) -> Option<(Vec<[f64; 3]>, u64)> {
        let all = self.randomisations.as_ref()?;
        let pictures = all.pictures.as_ref()?;
        let (low, high) = (self.counts.iter().min()?, self.counts.iter().max()?);
        let pixels = self.counts.len() as f64;
        let (closed, rest) = (low / all.length, low % all.length);
        let of_closed = |number| {
            let sums = pictures.get(&number).copied().unwrap_or_default();
            sums.map(|sum| sum.value() / (pixels * all.length as f64))
        };
        let mut means: Vec<_> = (0..closed).map(of_closed).collect();
        if low != high || rest == 0 {
            return Some((means, closed * all.length));
        }
        let open = [0, 1, 2].map(|channel| {
            let sum: f64 = all.open.iter().map(|sums| sums[channel]).sum();
            sum / (pixels * rest as f64)
        });
        means.push(open);
        Some((means, *low))
    }
}
