//! Means, variances and counts of both pictures, added up over some of their pixels.

use super::estimate::Parts;
use crate::pack::Rect;

/// One picture with its noise.
#[derive(Clone, Copy, Debug)]
pub struct Side<'a> {
    pub mean: &'a [[f32; 3]],
    /// Sample variance of one path's radiance.
    pub variance: &'a [[f32; 3]],
    /// Paths of each pixel, at least 2.
    pub samples: &'a [f32],
}

/// Both pictures: reference and test.
#[derive(Clone, Copy, Debug)]
pub struct Sides<'a> {
    pub reference: Side<'a>,
    pub test: Side<'a>,
    pub width: usize,
    pub height: usize,
    /// Column and row of the first pixel in the files, for naming places.
    pub origin: [u32; 2],
    /// What the noise of one picture says of the other's, channel by channel.
    expected: [Expected; 3],
    /// Whether both pictures were made of the same random numbers.
    pub paired: bool,
}

/// What is to be expected of one channel's noise.
#[derive(Clone, Copy, Debug, Default)]
struct Expected {
    /// How much noisier one path of the test is than one of the reference, over the whole picture;
    /// 0 where that cannot be said.
    ratio: f64,
    /// Variance over mean where there is noise: how bright the paths are that bring the light. Of the
    /// picture that is [`NOISIER`] than the other; 0 for the other, or for both.
    brightness: [f64; 2],
}

/// From this ratio on two pictures are taken to come from two estimators.
const NOISIER: f64 = 2.0;

/// Sums over pixels, one channel.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    pixels: f64,
    reference: f64,
    difference: f64,
    /// Of the squares of the differences.
    squares: f64,
    /// Variances of the means, as each picture tells its own...
    own: [f64; 2],
    /// ... and as the other one tells it.
    other: [f64; 2],
    /// Sum of variance^2 / (n - 1), for the degrees of freedom.
    spread: f64,
}

impl<'a> Sides<'a> {
    pub fn new(reference: Side<'a>, test: Side<'a>, region: Rect, paired: bool) -> Self {
        Self {
            reference,
            test,
            width: region.width() as usize,
            height: region.height() as usize,
            origin: [region.x0, region.y0],
            expected: [0, 1, 2].map(|channel| Expected::of(reference, test, channel)),
            paired,
        }
    }

    pub fn pixels(&self) -> usize {
        self.width * self.height
    }

    /// A rectangle of the compared part, in the files' own pixels.
    pub fn place(&self, [x0, y0, x1, y1]: [usize; 4]) -> Rect {
        let [left, top] = self.origin;
        Rect {
            x0: left + x0 as u32,
            y0: top + y0 as u32,
            x1: left + x1 as u32,
            y1: top + y1 as u32,
        }
    }

    /// The fewest samples that a pixel of either picture has.
    pub fn fewest_samples(&self) -> f32 {
        let all = self.reference.samples.iter().chain(self.test.samples);
        all.copied().fold(f32::INFINITY, f32::min)
    }

    fn add(&self, sums: &mut Sums, pixel: usize, channel: usize) {
        let at = |side: Side| {
            let n = f64::from(side.samples[pixel]);
            let variance = f64::from(side.variance[pixel][channel]);
            (f64::from(side.mean[pixel][channel]), variance, n)
        };
        let (reference, calm, many) = at(self.reference);
        let (test, noisy, n) = at(self.test);
        let difference = test - reference;
        let (first, second) = (calm / many, noisy / n);
        sums.pixels += 1.0;
        sums.reference += reference;
        sums.difference += difference;
        sums.squares += difference * difference;
        sums.own[0] += first;
        sums.own[1] += second;
        let Expected { ratio, brightness } = self.expected[channel];
        if ratio > 0.0 {
            let rare = [test.abs() * brightness[0], reference.abs() * brightness[1]];
            sums.other[0] += (noisy / ratio).max(rare[0]) / many;
            sums.other[1] += (calm * ratio).max(rare[1]) / n;
        }
        sums.spread += first * first / (many - 1.0) + second * second / (n - 1.0);
    }

    /// The mean difference over all pixels.
    ///
    /// Where the pictures share their random numbers, the variances of the two say nothing of their
    /// difference. But pixels share none among themselves, so its spread over the pixels does; with
    /// a difference that is not the same everywhere it is too large, never too small.
    pub fn everywhere(&self, channel: usize) -> Parts {
        let mut sums = Sums::default();
        for pixel in 0..self.pixels() {
            self.add(&mut sums, pixel, channel);
        }
        if self.paired {
            sums.by_spread()
        } else {
            sums.by_variances(sums.own[0] + sums.own[1])
        }
    }

    /// The mean difference over the pixels of a rectangle, for which the pictures' own variances
    /// cannot be trusted blindly.
    ///
    /// Where light comes by rare bright paths, a few samples may have met none of them, and then say
    /// with one voice that it is dark and that they are sure. So each picture's variance is taken to
    /// be at least what the other picture finds in the same place, times the ratio of the two
    /// pictures' noise as a whole.
    pub fn within(&self, [x0, y0, x1, y1]: [usize; 4], channel: usize) -> Parts {
        let mut sums = Sums::default();
        for y in y0..y1 {
            for x in x0..x1 {
                self.add(&mut sums, y * self.width + x, channel);
            }
        }
        if self.paired {
            sums.by_spread()
        } else {
            sums.by_variances(sums.larger())
        }
    }

    /// The difference of one pixel. Its variance is at least the mean one of its surroundings, a
    /// rectangle of which [`Sides::within`] has told.
    pub fn at(&self, pixel: usize, channel: usize, surroundings: &Parts, size: usize) -> Parts {
        let mut sums = Sums::default();
        self.add(&mut sums, pixel, channel);
        let typical = surroundings.variance * size as f64;
        sums.by_variances(sums.larger().max(typical))
    }
}

impl Expected {
    fn of(reference: Side, test: Side, channel: usize) -> Self {
        let [calm, noisy] = [reference, test].map(|side| Total::of(side, channel));
        if calm.variance == 0.0 || noisy.variance == 0.0 {
            return Self::default();
        }
        let ratio = noisy.variance / calm.variance;
        let only = |noisier: bool, total: Total| {
            if noisier {
                total.variance / total.mean
            } else {
                0.0
            }
        };
        Self {
            ratio,
            brightness: [
                only(ratio < 1.0 / NOISIER, calm),
                only(ratio > NOISIER, noisy),
            ],
        }
    }
}

/// Of the pixels that have noise.
#[derive(Clone, Copy)]
struct Total {
    variance: f64,
    mean: f64,
}

impl Total {
    fn of(side: Side, channel: usize) -> Self {
        let mut total = Total {
            variance: 0.0,
            mean: 0.0,
        };
        for (mean, variance) in side.mean.iter().zip(side.variance) {
            if variance[channel] > 0.0 {
                total.variance += f64::from(variance[channel]);
                total.mean += f64::from(mean[channel].abs());
            }
        }
        total
    }
}

impl Sums {
    /// Degrees of freedom after Welch (1947) and Satterthwaite (1946).
    fn by_variances(&self, variance: f64) -> Parts {
        let own = self.own[0] + self.own[1];
        let freedom = if self.spread > 0.0 {
            own * own / self.spread
        } else {
            f64::INFINITY
        };
        Parts {
            reference: self.reference / self.pixels,
            difference: self.difference / self.pixels,
            variance: variance / (self.pixels * self.pixels),
            freedom,
        }
    }

    /// Variance of the sum, each picture's as the one that says more has it.
    fn larger(&self) -> f64 {
        self.own[0].max(self.other[0]) + self.own[1].max(self.other[1])
    }

    fn by_spread(&self) -> Parts {
        let freedom = (self.pixels - 1.0).max(1.0);
        let about = self.squares - self.difference * self.difference / self.pixels;
        // One pixel has no spread: its own difference stands for it, and t is then 1.
        let variance = if self.pixels > 1.0 {
            about.max(0.0) / freedom / self.pixels
        } else {
            self.squares
        };
        Parts {
            reference: self.reference / self.pixels,
            difference: self.difference / self.pixels,
            variance,
            freedom,
        }
    }
}
