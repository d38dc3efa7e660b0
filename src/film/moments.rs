//! The first two moments of every pixel, summed in f64.

use super::randomisations::{Pictures, Randomisations, Sets, add_pictures, variance_of_mean};
use super::{Features, Picture, Record};
use crate::device::{Block, run_ranges};
use crate::pack::{Rect, Tally};
use rayon::prelude::*;

/// Fewer tallies than this are added faster than other threads are woken.
const PARALLEL: usize = 1 << 17;

/// What has been measured of a rectangle of pixels so far.
///
/// Every field is plain data: a checkpoint stores them as they are, and a film rebuilt from them
/// goes on bit for bit. Pixels are row-major within the region, channels are R, G, B.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    pub region: Rect,
    /// Sum of radiance.
    pub sums: Vec<[f64; 3]>,
    /// Sum of squared radiance; of randomisations that are closed, of their means' squares times their samples.
    pub squares: Vec<[f64; 3]>,
    /// Samples taken.
    pub counts: Vec<u64>,
    /// Paths traced: the sum of `counts`.
    pub paths: u64,
    /// Rays traced, shadow rays included.
    pub rays: u64,
    /// Samples whose radiance was not finite; they count as black.
    pub non_finite: u64,
    pub first_non_finite: Option<NonFinite>,
    /// Present where samples are not independent of each other.
    pub randomisations: Option<Randomisations>,
}

/// Where a sample was not finite. The first of several is that of the smallest index, then row,
/// then column, so that it does not depend on how the work was split.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NonFinite {
    pub sample: u64,
    /// Row in the whole image.
    pub y: u32,
    /// Column in the whole image.
    pub x: u32,
}

impl Film {
    /// A film without samples.
    pub fn new(region: Rect) -> Film {
        let pixels = region.area();
        Film {
            region,
            sums: vec![[0.0; 3]; pixels],
            squares: vec![[0.0; 3]; pixels],
            counts: vec![0; pixels],
            paths: 0,
            rays: 0,
            non_finite: 0,
            first_non_finite: None,
            randomisations: None,
        }
    }

    /// Adds one run of `samples` samples, the first of them number `first_sample`, to a pixel.
    ///
    /// Sums in f64 are not associative: the same runs in the same order give the same film.
    pub fn add(&mut self, pixel: usize, first_sample: u64, samples: u32, tally: &Tally) {
        // Both fit: a region's width and height are u32.
        let width = self.region.width() as usize;
        let at = [
            self.region.x0 + (pixel % width) as u32,
            self.region.y0 + (pixel / width) as u32,
        ];
        let mut row = Row {
            sums: &mut self.sums[pixel..],
            squares: &mut self.squares[pixel..],
            counts: &mut self.counts[pixel..],
            sets: self.randomisations.as_mut().map(|all| all.row(pixel..)),
        };
        let mut totals = Totals::default();
        totals.add(at, first_sample, samples, tally);
        totals.close(row.add(0, samples, tally));
        self.count(totals);
    }

    /// Adds what a device made of a block: tallies run by run, and in each run row by row, as many as there
    /// are.
    pub fn add_block(&mut self, block: &Block, tallies: &[Tally]) {
        let (rect, region) = (block.rect, self.region);
        let (width, wide) = (region.width() as usize, rect.width() as usize);
        let pixels = (rect.y0 - region.y0) as usize * width..(rect.y1 - region.y0) as usize * width;
        let column = (rect.x0 - region.x0) as usize;
        let add = |(y, mut row): (usize, Row)| {
            let mut totals = Totals::default();
            let runs = run_ranges(block.first_sample, block.samples);
            for ((first, samples), run) in runs.zip(tallies.chunks(rect.area())) {
                let of_row = run.iter().skip(y * wide).take(wide);
                for (x, tally) in of_row.enumerate() {
                    totals.close(row.add(column + x, samples, tally));
                    let at = [rect.x0 + x as u32, rect.y0 + y as u32];
                    totals.add(at, first, samples, tally);
                }
            }
            totals
        };
        let mut sets = self
            .randomisations
            .as_mut()
            .map(|all| all.rows(pixels.clone(), width));
        let rows = self.sums[pixels.clone()]
            .chunks_mut(width)
            .zip(self.squares[pixels.clone()].chunks_mut(width))
            .zip(self.counts[pixels].chunks_mut(width))
            .map(|((sums, squares), counts)| Row {
                sums,
                squares,
                counts,
                sets: sets.as_mut().and_then(Iterator::next),
            });
        let totals = if tallies.len() < PARALLEL {
            rows.enumerate()
                .map(add)
                .fold(Totals::default(), Totals::with)
        } else {
            let rows: Vec<_> = rows.enumerate().collect();
            rows.into_par_iter()
                .map(add)
                .reduce(Totals::default, Totals::with)
        };
        drop(sets);
        self.count(totals);
    }

    fn count(&mut self, more: Totals) {
        self.paths = self.paths.saturating_add(more.paths);
        self.rays = self.rays.saturating_add(more.rays);
        self.non_finite = self.non_finite.saturating_add(more.non_finite);
        self.first_non_finite = earlier(self.first_non_finite, more.first_non_finite);
        let pictures = self
            .randomisations
            .as_mut()
            .and_then(|all| all.pictures.as_mut());
        if let Some(pictures) = pictures {
            add_pictures(pictures, &more.closed);
        }
    }

    /// Mean radiance of a pixel; black before its first sample.
    pub fn mean(&self, pixel: usize) -> [f64; 3] {
        match self.counts[pixel] {
            0 => [0.0; 3],
            count => self.sums[pixel].map(|sum| sum / count as f64),
        }
    }

    /// Sample variance of one path's radiance, (S2 - S^2 / n) / (n - 1); 0 below two samples. Of randomisations,
    /// what their means say it would be: n times the variance of the pixel's mean; 0 below two of them.
    pub fn variance(&self, pixel: usize) -> [f64; 3] {
        let estimates = self.estimates(pixel);
        if estimates < 2 {
            return [0.0; 3];
        }
        let n = self.counts[pixel] as f64;
        let open = self
            .randomisations
            .as_ref()
            .map(|all| all.open_square(pixel, self.counts[pixel]));
        std::array::from_fn(|channel| {
            let (sum, squares) = (self.sums[pixel][channel], self.squares[pixel][channel]);
            let squares = squares + open.map_or(0.0, |open| open[channel]);
            // Equal samples leave a rounding error here, which may be below zero.
            ((squares - sum * sum / n) / (estimates as f64 - 1.0)).max(0.0)
        })
    }

    /// Mean over the pixels of their means.
    pub fn picture_mean(&self) -> [f64; 3] {
        self.over_pixels().mean()
    }

    /// Standard error of [`Film::picture_mean`], taking the pixels as independent; where they share point sets, by the
    /// spread of the picture's mean over the randomisations.
    ///
    /// A pixel of which no variance is known adds nothing: [`Film::describe`] leaves the error out then.
    pub fn standard_error(&self) -> [f64; 3] {
        self.over_pixels().spread()
    }

    fn over_pixels(&self) -> PictureMean {
        let mut mean = PictureMean::default();
        for (pixel, &count) in self.counts.iter().enumerate() {
            let estimates = self.estimates(pixel);
            mean.add(self.mean(pixel), self.variance(pixel), count, estimates);
        }
        if let (Some((means, samples)), Some(all)) = (self.shared_means(), &self.randomisations) {
            mean.told_by(&means, all.length, samples);
        }
        mean
    }

    /// Writes what the film knows into a record: size, totals, mean and its standard error.
    pub fn describe(&self, record: &mut Record) {
        record.width = self.region.width();
        record.height = self.region.height();
        record.paths = self.paths;
        record.rays = self.rays;
        record.non_finite = self.non_finite;
        let mean = self.over_pixels();
        record.mean = mean.mean();
        record.standard_error = mean.standard_error();
        record.error_estimate = self.error_estimate();
        record.randomisation = self.randomisations.as_ref().map(|all| all.length);
        record.randomisation_means = self.shared_means().map_or(Vec::new(), |(means, _)| means);
    }

    /// The picture as it stands, with the record completed by [`Film::describe`].
    pub fn picture(
        &self,
        mut record: Record,
        features: Option<Features>,
        scene_text: Option<String>,
    ) -> Picture {
        self.describe(&mut record);
        let pixels = 0..self.counts.len();
        Picture {
            width: self.region.width(),
            height: self.region.height(),
            mean: pixels
                .clone()
                .map(|pixel| self.mean(pixel).map(narrow))
                .collect(),
            variance: pixels
                .map(|pixel| self.variance(pixel).map(narrow))
                .collect(),
            samples: self.counts.iter().map(|&count| count as f32).collect(),
            features,
            record,
            scene_text,
        }
    }
}

/// Pixels side by side, to be added to.
struct Row<'a> {
    sums: &'a mut [[f64; 3]],
    squares: &'a mut [[f64; 3]],
    counts: &'a mut [u64],
    sets: Option<Sets<'a>>,
}

impl Row<'_> {
    /// Adds a run to a pixel; where that closes a randomisation whose pixels' sums are kept, number and sum of it.
    fn add(&mut self, pixel: usize, samples: u32, tally: &Tally) -> Option<(u64, [f64; 3])> {
        if let Some(sets) = &mut self.sets {
            let [sums, squares] = [&mut self.sums[pixel], &mut self.squares[pixel]];
            return sets.add(
                pixel,
                samples,
                tally,
                sums,
                squares,
                &mut self.counts[pixel],
            );
        }
        let n = f64::from(samples);
        for channel in 0..3 {
            let mean = f64::from(tally.mean[channel]);
            self.sums[pixel][channel] += n * mean;
            self.squares[pixel][channel] += f64::from(tally.squares[channel]) + n * mean * mean;
        }
        self.counts[pixel] += u64::from(samples);
        None
    }
}

/// What a film counts over all pixels, of some runs.
#[derive(Clone, Default)]
struct Totals {
    paths: u64,
    rays: u64,
    non_finite: u64,
    first_non_finite: Option<NonFinite>,
    /// Sums of randomisations that were closed.
    closed: Pictures,
}

impl Totals {
    fn close(&mut self, closed: Option<(u64, [f64; 3])>) {
        let Some((number, sums)) = closed else {
            return;
        };
        let picture = self.closed.entry(number).or_default();
        for (exact, sum) in picture.iter_mut().zip(sums) {
            exact.add(sum);
        }
    }

    /// Counts one run of the pixel `at` column and row of the whole image.
    fn add(&mut self, at: [u32; 2], first_sample: u64, samples: u32, tally: &Tally) {
        self.paths += u64::from(samples);
        self.rays += u64::from(tally.rays);
        // How many below, the place of the first above.
        let count = tally.non_finite & 0xffff;
        if count > 0 {
            self.non_finite += u64::from(count);
            let [x, y] = at;
            let sample = first_sample + u64::from(tally.non_finite >> 16);
            let found = NonFinite { sample, y, x };
            self.first_non_finite = earlier(self.first_non_finite, Some(found));
        }
    }

    fn with(mut self, other: Self) -> Self {
        add_pictures(&mut self.closed, &other.closed);
        Self {
            closed: self.closed,
            paths: self.paths + other.paths,
            rays: self.rays + other.rays,
            non_finite: self.non_finite + other.non_finite,
            first_non_finite: earlier(self.first_non_finite, other.first_non_finite),
        }
    }
}

fn earlier(a: Option<NonFinite>, b: Option<NonFinite>) -> Option<NonFinite> {
    a.into_iter().chain(b).min()
}

/// The mean of a picture and its standard error, pixel after pixel.
#[derive(Default)]
pub(super) struct PictureMean {
    sums: [f64; 3],
    /// Sum of the variances of the pixels' means.
    variances: [f64; 3],
    pixels: u64,
    /// Pixels with fewer than two independent estimates: their noise is not known.
    unknown: u64,
    /// Variance of the mean of the picture, where the pixels' own do not tell it.
    told: Option<[f64; 3]>,
}

impl PictureMean {
    /// Adds a pixel's mean and the variance of one of its `count` samples, made of so many independent estimates.
    pub(super) fn add(&mut self, mean: [f64; 3], variance: [f64; 3], count: u64, estimates: u64) {
        self.unknown += u64::from(estimates < 2);
        for channel in 0..3 {
            self.sums[channel] += mean[channel];
            self.variances[channel] += variance[channel] / count.max(1) as f64;
        }
        self.pixels += 1;
    }

    pub(super) fn mean(&self) -> [f64; 3] {
        self.sums.map(|sum| sum / self.pixels.max(1) as f64)
    }

    /// The pixels share point sets: these are the picture's means by randomisation.
    pub(super) fn told_by(&mut self, means: &[[f64; 3]], length: u64, samples: u64) {
        if means.len() < 2 {
            self.unknown = self.pixels;
        }
        self.told = Some(variance_of_mean(means, length, samples));
    }

    /// The standard error of the mean, where it is known of every pixel.
    pub(super) fn standard_error(&self) -> Option<[f64; 3]> {
        (self.unknown == 0).then(|| self.spread())
    }

    /// The same of the pixels of which it is known.
    fn spread(&self) -> [f64; 3] {
        if let Some(told) = self.told {
            return told.map(f64::sqrt);
        }
        self.variances
            .map(|sum| sum.sqrt() / self.pixels.max(1) as f64)
    }
}

/// Nearest f32. A variance may be finite in f64 and too large for f32; files hold no infinity.
pub(super) fn narrow(value: f64) -> f32 {
    value.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32
}
