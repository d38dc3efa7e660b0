//! Everything that is to be said of two pictures, and what follows from it.

use super::flip::Exposures;
use super::gate::{Gate, Judgement};
use super::metric::{Figure, Metric};
use super::pair::Pair;
use super::records::Kinship;
use super::study::{Study, Viewing};
use super::survey::{NonFinite, TileError};
use super::verdict::{self, Outcome, Relation, Side, Sides, Terms, Verdict};
use crate::error::{Error, Result};
use crate::film::{Noise, Pixels, Raster};
use serde::Serialize;

/// Pixels up to which metrics that nobody asked for may take their time and memory: a 4K picture.
const LARGE: usize = 1 << 23;

/// The worst tiles that are named.
const WORST: usize = 5;

/// What to find, and how to judge it.
#[derive(Clone, Debug, Default)]
pub struct Wishes {
    /// Metrics to report; all that the pictures have where neither these nor gates are given.
    pub metrics: Vec<Metric>,
    pub gates: Vec<Gate>,
    pub viewing: Viewing,
    pub terms: Terms,
    /// Whether the verdict counts beside gates, too.
    pub verdict_counts: bool,
    /// Whether pixels that are NaN or infinite may be there; they must then be so in both pictures.
    pub allow_non_finite: bool,
}

/// One of the two images, for people and programs.
#[derive(Clone, Debug, Serialize)]
pub struct Described {
    pub format: String,
    pub width: u32,
    pub height: u32,
    /// What of the file was left aside.
    pub left_aside: Vec<String>,
    /// Samples a pixel, where it is known: the least.
    pub samples: Option<u64>,
    /// The most, where pixels have not all the same.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub most_samples: Option<u64>,
    pub device: Option<String>,
    pub seed: Option<u64>,
}

/// The whole comparison.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    pub conclusion: Outcome,
    pub reference: Described,
    pub test: Described,
    pub identical: bool,
    pub non_finite: NonFinite,
    pub figures: Vec<Figure>,
    /// The exposures of HDR-FLIP, to be given again for other tests of the same reference.
    pub exposures: Option<Exposures>,
    pub gates: Vec<Judgement>,
    pub verdict: Option<Verdict>,
    /// Whether the verdict counts; where there are limits, they decide alone unless it is asked for too.
    pub verdict_decides: bool,
    /// Why there is no verdict, where there is none.
    pub no_verdict: Option<String>,
    pub kinship: Option<Kinship>,
    pub worst_tiles: Vec<TileError>,
    pub warnings: Vec<String>,
}

/// Compares two pictures.
///
/// # Errors
/// [`Error::Usage`] for a metric that the pictures have no value of, for pixels that are not finite unless
/// they are allowed, and for variances or counts that cannot be.
pub fn compare(study: &Study, wishes: &Wishes) -> Result<Comparison> {
    let pair = study.pair;
    let non_finite = study.survey.non_finite;
    if !wishes.allow_non_finite {
        refuse_non_finite(&non_finite)?;
    }
    let relation = pair.kinship();
    let made = relation
        .as_ref()
        .map_or_else(Relation::default, Kinship::relation);
    let mut warnings = Vec::new();
    let figures = figures(study, wishes, &mut warnings)?;
    let gates = judge_gates(study, wishes)?;
    let judged = match sides(pair, made) {
        _ if study.survey.identical => Err(NoVerdict::Needless),
        Ok(_) if non_finite != NonFinite::default() => Err(NoVerdict::NotFinite),
        Ok(sides) => Ok(verdict::judge(&sides, wishes.terms)),
        Err(NoVerdict::Broken(reason)) => return Err(Error::Usage(reason)),
        Err(reason) => Err(reason),
    };
    let verdict_decides = gates.is_empty() || wishes.verdict_counts;
    let conclusion = conclude(study, verdict_decides, &gates, &judged);
    let (verdict, no_verdict) = match judged {
        Ok(verdict) => (Some(verdict), None),
        Err(reason) => (None, reason.text()),
    };
    let high = figures
        .iter()
        .any(|figure| figure.metric == Metric::HdrFlip);
    let exposures = high
        .then(|| study.hdr_flip())
        .transpose()?
        .map(|(_, exposures)| *exposures);
    Ok(Comparison {
        conclusion,
        reference: describe(&pair.reference),
        test: describe(&pair.test),
        identical: study.survey.identical,
        non_finite,
        exposures,
        figures,
        gates,
        verdict,
        verdict_decides,
        no_verdict,
        kinship: relation,
        worst_tiles: study.survey.worst(WORST),
        warnings,
    })
}

fn refuse_non_finite(found: &NonFinite) -> Result<()> {
    let Some([x, y]) = found.first else {
        return Ok(());
    };
    Err(Error::Usage(format!(
        "{} pixels of the reference and {} of the test are NaN or infinite, the first at {x},{y}; --allow-non-finite compares the others, and wants these to be alike",
        found.reference, found.test
    )))
}

fn figures(study: &Study, wishes: &Wishes, warnings: &mut Vec<String>) -> Result<Vec<Figure>> {
    let mut metrics = wishes.metrics.clone();
    metrics.extend(wishes.gates.iter().map(|gate| gate.metric));
    let asked = !metrics.is_empty();
    if !asked {
        metrics.extend(Metric::LINEAR);
        if study.pair.len() <= LARGE {
            metrics.extend(Metric::DISPLAY);
            metrics.extend(
                study
                    .pair
                    .is_high_dynamic_range()
                    .then_some(Metric::HdrFlip),
            );
        } else {
            let reason = "ssim, ms-ssim and flip are left out of pictures of over 8 million pixels unless --metric asks for them";
            warnings.push(reason.into());
        }
    }
    metrics.sort();
    metrics.dedup();
    let mut figures = Vec::new();
    for metric in metrics {
        match study.figure(metric) {
            Ok(figure) => figures.push(figure),
            // Nobody asked for it, and it is not there for pictures so small.
            Err(Error::Usage(_)) if !asked => {}
            Err(error) => return Err(error),
        }
    }
    Ok(figures)
}

fn judge_gates(study: &Study, wishes: &Wishes) -> Result<Vec<Judgement>> {
    let judge = |gate: &Gate| {
        let value = study.figure(gate.metric)?.value;
        gate.judge(value, || study.pixel_errors(gate.metric))
    };
    wishes.gates.iter().map(judge).collect()
}

/// Why two pictures get no verdict.
#[derive(Clone, Debug, PartialEq)]
pub enum NoVerdict {
    /// Every pixel is identical.
    Needless,
    /// There are pixels that are NaN or infinite.
    NotFinite,
    /// A file does not say how noisy it is.
    NoNoise(String),
    /// A pixel with fewer than two samples has no variance.
    TooFew(String),
    /// What a file says of its noise cannot be.
    Broken(String),
}

impl NoVerdict {
    /// For people; none where there is nothing to be said.
    fn text(self) -> Option<String> {
        match self {
            NoVerdict::Needless => None,
            NoVerdict::NotFinite => Some("there are pixels that are not finite".into()),
            NoVerdict::NoNoise(text) | NoVerdict::TooFew(text) | NoVerdict::Broken(text) => {
                Some(text)
            }
        }
    }
}

/// The pictures' moments, or why they cannot be judged.
///
/// # Errors
/// All of [`NoVerdict`] but the first two.
pub fn sides(pair: &Pair, relation: Relation) -> std::result::Result<Sides<'_>, NoVerdict> {
    let reference = side(&pair.reference, "A")?;
    let test = side(&pair.test, "B")?;
    Ok(Sides::new(reference, test, pair.region, relation))
}

/// The largest whole number up to which f64 has all.
const MOST_SAMPLES: f32 = 9.007_199e15;

fn side<'a>(image: &'a Raster, name: &str) -> std::result::Result<Side<'a>, NoVerdict> {
    let record = image.record.as_ref();
    if record.is_some_and(|record| record.denoised.is_some()) {
        return Err(NoVerdict::NoNoise(format!(
            "{name} was denoised: it is biased, and its error is no longer that of a mean of samples"
        )));
    }
    let (Pixels::Linear(mean), Some(Noise { variance, samples })) = (&image.pixels, &image.noise)
    else {
        return Err(NoVerdict::NoNoise(format!(
            "{name} carries no variance and count"
        )));
    };
    if !samples.iter().all(|n| (0.0..=MOST_SAMPLES).contains(n)) {
        return Err(NoVerdict::Broken(format!(
            "{name} has counts of samples that cannot be"
        )));
    }
    if !variance
        .iter()
        .flatten()
        .all(|v| v.is_finite() && *v >= 0.0)
    {
        return Err(NoVerdict::Broken(format!(
            "{name} has variances that are not numbers from 0 up"
        )));
    }
    let record = image.record.as_ref();
    let length = record.and_then(|record| record.randomisation);
    let run = length.map_or(1.0, |length| length as f64);
    if let Some(length) = length.filter(|_| !samples.iter().all(|n| f64::from(*n) >= 2.0 * run)) {
        return Err(NoVerdict::TooFew(format!(
            "{name} has pixels with fewer than 2 randomisations of {length} samples, which have no variance"
        )));
    }
    if !samples.iter().all(|n| *n >= 2.0) {
        return Err(NoVerdict::TooFew(format!(
            "{name} has pixels with fewer than 2 samples, which have no variance"
        )));
    }
    Ok(Side {
        mean,
        variance,
        samples,
        run,
    })
}

/// Gates decide where there are any, the verdict where there is one, and else equality does.
fn conclude(
    study: &Study,
    verdict_decides: bool,
    gates: &[Judgement],
    judged: &std::result::Result<Verdict, NoVerdict>,
) -> Outcome {
    if study.survey.non_finite.apart > 0 || gates.iter().any(|gate| !gate.passes) {
        return Outcome::Different;
    }
    match judged {
        Ok(verdict) if verdict_decides => verdict.outcome,
        Err(NoVerdict::TooFew(_)) if verdict_decides => Outcome::NotEnoughSamples,
        _ if !gates.is_empty() || study.survey.identical => Outcome::Same,
        _ => Outcome::Different,
    }
}

fn describe(image: &Raster) -> Described {
    let range = |noise: &Noise| {
        let counts = noise.samples.iter().copied();
        let least = counts.clone().fold(f32::INFINITY, f32::min) as u64;
        (least, counts.fold(0.0, f32::max) as u64)
    };
    let range = image.noise.as_ref().map(range);
    let of_record = image.record.as_ref().map(|record| record.samples);
    Described {
        format: image.format.clone(),
        width: image.width,
        height: image.height,
        left_aside: image.left_aside.clone(),
        samples: range.map(|(least, _)| least).or(of_record),
        most_samples: range.and_then(|(least, most)| (most > least).then_some(most)),
        device: image
            .record
            .as_ref()
            .map(|record| record.device.name.clone()),
        seed: image.record.as_ref().map(|record| record.seed),
    }
}
