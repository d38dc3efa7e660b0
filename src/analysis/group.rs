//! One group's figures, region by region, and its maps.

use super::agreement::agreement;
use super::cell::Weight;
use super::energy::Energy;
use super::quantity::{Channels, Quantity};
use super::question::Question;
use super::ratios;
use super::reference::Reference;
use super::runs::Runs;
use crate::compare::part;
use crate::compare::verdict::{Relation, Side, Sides, Verdict, judge};
use crate::pack::Rect;
use serde_json::{Map, Value};
use std::sync::Arc;

/// What runs that differ in nothing but their seed say.
#[derive(Clone, Debug)]
pub struct Group {
    pub name: String,
    /// Value of each axis but the seed, by path.
    pub values: Map<String, Value>,
    /// Number of the reference that it is held against.
    pub reference: Option<usize>,
    pub runs: usize,
    /// Samples a pixel of a run.
    pub samples: f64,
    /// Tracing time of a run.
    pub seconds: Quantity,
    /// In the order of the question's regions.
    pub regions: Vec<RegionFigures>,
    /// Clones of a group share them.
    pub maps: Arc<Maps>,
}

/// Pictures of a group, linear light.
#[derive(Clone, Debug)]
pub struct Maps {
    /// Mean of the runs.
    pub mean: Vec<[f32; 3]>,
    /// Mean of the runs minus the reference, signed.
    pub bias: Option<Vec<[f32; 3]>>,
    /// Standard deviation of one sample.
    pub deviation: Vec<[f32; 3]>,
}

/// Figures of one region.
#[derive(Clone, Debug)]
pub struct RegionFigures {
    pub mean: Channels,
    /// Mean minus the reference's, whose noise counts.
    pub bias: Option<Channels>,
    /// The same, mean of the channels, over the reference's mean; absent also where that is black.
    pub relative_bias: Option<Quantity>,
    /// Of one sample.
    pub variance: Channels,
    /// Bias^2, noise and MSE; without a reference the noise alone.
    pub energy: Energy,
    /// The same relative to the reference.
    pub relative: Option<Energy>,
    /// Variance over the runs, over what the stored variances say: 1 is expected.
    pub agreement: Option<Quantity>,
    /// Against the reference.
    pub verdict: Option<Verdict>,
}

impl Group {
    pub(super) fn new(question: &Question, runs: Runs, number: Option<usize>) -> Self {
        let reference = number.map(|number| &question.references[number]);
        let planes = Planes::new(&runs);
        let regions = question.regions.iter().map(|region| {
            let pixels = question.pixels(region.rect);
            let figures = RegionFigures::new(&runs, reference, &pixels);
            match reference {
                Some(reference) => {
                    let width = question.size[0] as usize;
                    let test = Planes::cut(&planes.side(), width, region.rect);
                    figures.against(reference, &test, region.rect, question)
                }
                None => figures,
            }
        });
        Self {
            regions: regions.collect(),
            maps: Arc::new(Maps::new(&runs, reference, planes.mean)),
            reference: number,
            runs: runs.len(),
            samples: runs.samples(),
            seconds: ratios::seconds(&runs.seconds),
            name: runs.name,
            values: runs.values,
        }
    }
}

impl Maps {
    fn new(runs: &Runs, reference: Option<&Reference>, mean: Vec<[f32; 3]>) -> Self {
        let difference = |index: usize| {
            [0, 1, 2].map(|channel| {
                let reference = reference.map_or(0.0, |picture| picture.mean(index, channel));
                (runs.pixels[index].mean[channel] - reference) as f32
            })
        };
        let deviations = runs.pixels.iter();
        Self {
            bias: reference.map(|_| (0..mean.len()).map(difference).collect()),
            deviation: deviations
                .map(|pixel| pixel.variance.map(|variance| variance.sqrt() as f32))
                .collect(),
            mean,
        }
    }
}

impl RegionFigures {
    fn new(runs: &Runs, reference: Option<&Reference>, pixels: &[usize]) -> Self {
        Self {
            mean: mean(runs, pixels),
            bias: None,
            relative_bias: None,
            variance: Energy::of_one_sample(runs, pixels),
            energy: Energy::new(runs, reference, pixels, Weight::Even),
            relative: reference.map(|_| Energy::new(runs, reference, pixels, Weight::Relative)),
            agreement: agreement(runs, pixels),
            verdict: None,
        }
    }

    /// With what the verdict's own sums say of the difference.
    fn against(
        self,
        reference: &Reference,
        test: &Planes,
        rect: Rect,
        question: &Question,
    ) -> Self {
        let width = question.size[0] as usize;
        let reference = Planes::cut(&reference.side(), width, rect);
        let sides = Sides::new(reference.side(), test.side(), rect, Relation::default());
        let parts = [0, 1, 2].map(|channel| sides.everywhere(channel));
        let bias = parts.map(|of| Quantity::new(of.difference, of.variance, of.freedom));
        Self {
            relative_bias: relative(&bias, parts.map(|of| of.reference), &reference),
            bias: Some(bias),
            verdict: Some(judge(&sides, question.terms)),
            ..self
        }
    }
}

/// Mean radiance, with the noise that the stored variances tell of.
fn mean(runs: &Runs, pixels: &[usize]) -> Channels {
    let count = pixels.len() as f64;
    [0, 1, 2].map(|channel| {
        let (mut sum, mut variance, mut spread) = (0.0, 0.0, 0.0);
        for &pixel in pixels {
            let noise = runs.noise(pixel, channel);
            sum += runs.pixels[pixel].mean[channel];
            variance += noise;
            spread += noise * noise / runs.freedom(runs.pixels[pixel].samples);
        }
        let freedom = if spread > 0.0 {
            variance * variance / spread
        } else {
            f64::INFINITY
        };
        Quantity::new(sum / count, variance / (count * count), freedom)
    })
}

/// Of test / reference - 1, by the delta method: the reference's noise is in both.
fn relative(bias: &Channels, reference: [f64; 3], planes: &Planes) -> Option<Quantity> {
    let level = reference.iter().sum::<f64>() / 3.0;
    let value = Quantity::over(bias).value / level;
    let own = planes.noise();
    let channels = [0, 1, 2].map(|channel| {
        let of = bias[channel];
        let test = (of.error * of.error - own[channel]).max(0.0);
        let variance = test + (1.0 + value).powi(2) * own[channel];
        Quantity::new(of.value, variance, of.freedom)
    });
    (level > 0.0).then(|| Quantity::over(&channels).times(1.0 / level))
}

/// A picture as the verdict takes it: all runs of a group as one, or the reference.
struct Planes {
    mean: Vec<[f32; 3]>,
    variance: Vec<[f32; 3]>,
    samples: Vec<f32>,
    run: f64,
}

impl Planes {
    fn new(runs: &Runs) -> Self {
        let variance = |index: usize| {
            let samples = runs.pixels[index].samples;
            [0, 1, 2].map(|channel| (runs.noise(index, channel) * samples) as f32)
        };
        let pixels = runs.pixels.iter();
        Self {
            mean: pixels
                .clone()
                .map(|pixel| pixel.mean.map(|mean| mean as f32))
                .collect(),
            variance: (0..runs.pixels.len()).map(variance).collect(),
            samples: pixels.map(|pixel| pixel.samples as f32).collect(),
            run: runs.run(),
        }
    }

    fn cut(side: &Side, width: usize, rect: Rect) -> Self {
        Self {
            mean: part(side.mean, width, rect),
            variance: part(side.variance, width, rect),
            samples: part(side.samples, width, rect),
            run: side.run,
        }
    }

    fn side(&self) -> Side<'_> {
        Side {
            mean: &self.mean,
            variance: &self.variance,
            samples: &self.samples,
            run: self.run,
        }
    }

    /// Variance of the mean over all pixels.
    fn noise(&self) -> [f64; 3] {
        let count = self.samples.len() as f64;
        [0, 1, 2].map(|channel| {
            let noise = self.variance.iter().zip(&self.samples);
            noise
                .map(|(variance, n)| f64::from(variance[channel]) / f64::from(*n))
                .sum::<f64>()
                / (count * count)
        })
    }
}
