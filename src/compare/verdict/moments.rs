//! Means, variances and counts of both pictures, added up over some of their pixels.

use super::estimate::Parts;
use super::vicinity::{Vicinity, Whereabouts};
use crate::pack::Rect;

/// One picture with its noise.
#[derive(Clone, Copy, Debug)]
pub struct Side<'a> {
    pub mean: &'a [[f32; 3]],
    /// Sample variance of one path's radiance.
    pub variance: &'a [[f32; 3]],
    /// Paths of each pixel, at least 2.
    pub samples: &'a [f32],
    /// Paths behind one of the independent estimates that the variance is made of: 1, or the length of a
    /// randomisation. A pixel has two of them at least.
    pub run: f64,
}

/// What is known of how the two pictures were made.
#[derive(Clone, Copy, Debug, Default)]
pub struct Relation {
    /// Whether of the same random numbers.
    pub paired: bool,
    /// Whether by the same estimator, so that their noise is alike wherever their images are.
    pub same_estimator: bool,
}

/// Both pictures: reference and test.
#[derive(Debug)]
pub struct Sides<'a> {
    pub reference: Side<'a>,
    pub test: Side<'a>,
    pub width: usize,
    pub height: usize,
    /// Column and row of the first pixel in the files, for naming places.
    pub origin: [u32; 2],
    pub relation: Relation,
    vicinity: Vicinity,
    /// Of paired pictures: the variance of their difference over what independent ones would have.
    shared: [f64; 3],
}

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
    pub fn new(reference: Side<'a>, test: Side<'a>, region: Rect, relation: Relation) -> Self {
        let (width, height) = (region.width() as usize, region.height() as usize);
        let mut sides = Self {
            reference,
            test,
            width,
            height,
            origin: [region.x0, region.y0],
            relation,
            vicinity: Vicinity::new([reference, test], width, height),
            shared: [1.0; 3],
        };
        if relation.paired {
            sides.shared = [0, 1, 2].map(|channel| sides.sum_all(channel).shared());
        }
        sides
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

    /// The fewest independent estimates that a pixel's variance is made of, in either picture.
    pub fn fewest_estimates(&self) -> f64 {
        let all = |side: &Side| {
            let fewest = side.samples.iter().copied().fold(f32::INFINITY, f32::min);
            f64::from(fewest) / side.run
        };
        all(&self.reference).min(all(&self.test))
    }

    fn add(&self, sums: &mut Sums, pixel: usize, channel: usize, around: &Whereabouts) {
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
        let expected = if self.relation.same_estimator {
            [noisy, calm]
        } else {
            around.expected([calm, noisy], [reference, test])
        };
        sums.other[0] += expected[0] / many;
        sums.other[1] += expected[1] / n;
        let [of_first, of_second] =
            [(many, self.reference.run), (n, self.test.run)].map(|(n, run)| n / run - 1.0);
        sums.spread += first * first / of_first + second * second / of_second;
    }

    fn sum_all(&self, channel: usize) -> Sums {
        let mut sums = Sums::default();
        for pixel in 0..self.pixels() {
            self.add(&mut sums, pixel, channel, &Whereabouts::default());
        }
        sums
    }

    fn sum(&self, [x0, y0, x1, y1]: [usize; 4], channel: usize) -> Sums {
        let around = self.vicinity.of(x0, y0, channel);
        let mut sums = Sums::default();
        for y in y0..y1 {
            for x in x0..x1 {
                self.add(&mut sums, y * self.width + x, channel, &around);
            }
        }
        sums
    }

    /// The mean difference over all pixels.
    ///
    /// Where the pictures share their random numbers, the variances of the two say nothing of their
    /// difference. But pixels share none among themselves, so its spread over the pixels does; with
    /// a difference that is not the same everywhere it is too large, never too small.
    pub fn everywhere(&self, channel: usize) -> Parts {
        let sums = self.sum_all(channel);
        if self.relation.paired {
            sums.by_spread()
        } else {
            sums.by_variances(sums.own[0] + sums.own[1])
        }
    }

    /// The mean difference over the pixels of a tile or of a part of one, for which the pictures' own
    /// variances cannot be trusted blindly.
    ///
    /// Where light comes by rare bright paths, a few samples may have met none of them, and then say
    /// with one voice that it is dark and that they are sure. So each picture's variance is taken to
    /// be at least what the other picture makes one expect (`vicinity.rs` says how).
    ///
    /// Of paired pictures, the spread over the tile's pixels counts; but no less than the share of
    /// that variance which is left over the whole picture, for a few pixels may not have met what
    /// makes the two differ.
    pub fn within(&self, rect: [usize; 4], channel: usize) -> Parts {
        let sums = self.sum(rect, channel);
        if !self.relation.paired {
            return sums.by_variances(sums.larger());
        }
        let left = sums.by_variances(self.shared[channel] * sums.larger());
        let spread = sums.by_spread();
        Parts {
            variance: spread.variance.max(left.variance),
            ..spread
        }
    }

    /// The difference of one pixel. Its variance is at least the mean one of its tile, of which
    /// [`Sides::within`] has told.
    pub fn at(&self, pixel: usize, channel: usize, tile: &Parts, size: usize) -> Parts {
        let (x, y) = (pixel % self.width, pixel / self.width);
        let sums = self.sum([x, y, x + 1, y + 1], channel);
        sums.by_variances(sums.larger().max(tile.variance * size as f64))
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

    /// The variance of the mean difference by its spread, over what independent pictures would have.
    fn shared(&self) -> f64 {
        let independent = self.own[0] + self.own[1];
        let spread = self.by_spread().variance * self.pixels * self.pixels;
        if independent > 0.0 {
            (spread / independent).min(1.0)
        } else {
            1.0
        }
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
