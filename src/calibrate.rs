//! Which limit a metric should have: measured, with the chance that it fails a picture that is as
//! it should be.
//!
//! The scene is rendered with several seeds on every device at hand. Pairs of such pictures differ
//! by noise alone, so what a metric says of them is what a limit must let pass. The logarithm of an
//! error metric over such pairs is near normal; a one-sided prediction bound (Hahn and Meeker,
//! "Statistical intervals") is then exceeded by the next pair with the stated chance.

use crate::compare::verdict::quantile;
use crate::compare::{Metric, Pair, Study, Viewing};
use crate::device::Device;
use crate::error::{Error, Result};
use crate::film::{Pixels, Raster, RasterFile};
use crate::render::{self, Task};
use crate::scene::Scene;
use crate::wording::{counted, counted_as};
use serde::Serialize;
use std::fmt;
use std::ops::ControlFlow;
use std::path::Path;

/// What to calibrate.
pub struct Plan<'a> {
    pub scene: &'a Scene,
    pub metrics: Vec<Metric>,
    pub viewing: Viewing,
    /// How many pictures each device renders.
    pub seeds: u32,
    /// Chance that the limit fails a picture that is as it should be.
    pub false_alarms: f64,
    /// What the pictures are compared with; with each other in pairs without it.
    pub reference: Option<&'a Path>,
}

/// A proposal for one metric.
#[derive(Clone, Debug, Serialize)]
pub struct Proposal {
    pub metric: Metric,
    /// The largest value that passes, or the least where larger is better; absent where so few seeds
    /// say so little that it would limit nothing.
    pub limit: Option<f64>,
    /// Colour space and settings, with which the limit is to be used.
    pub settings: String,
    /// Of the comparisons that were made: the middle and the worst value.
    pub median: f64,
    pub worst: f64,
    /// Number of comparisons, no two of which share a picture but the reference.
    pub comparisons: usize,
    /// Chance that the limit fails a picture that is as it should be.
    pub false_alarms: f64,
}

/// What was found.
#[derive(Clone, Debug, Serialize)]
pub struct Calibration {
    pub devices: Vec<String>,
    pub seeds: u32,
    pub samples: u64,
    pub proposals: Vec<Proposal>,
}

/// Renders and compares; `say` is told of each picture.
///
/// # Errors
/// Those of rendering and reading; [`Error::Usage`] for a metric that these pictures do not have.
pub fn calibrate(
    plan: &Plan,
    devices: Vec<Box<dyn Device>>,
    say: &mut dyn FnMut(&str),
) -> Result<Calibration> {
    let reference = plan
        .reference
        .map(|path| fitting(path, plan.scene))
        .transpose()?;
    let names = devices
        .iter()
        .map(|device| device.info().name.clone())
        .collect();
    let mut images = Vec::new();
    for mut device in devices {
        say(&format!(
            "{} on {}",
            counted(plan.seeds, "picture"),
            device.info().name
        ));
        for _ in 0..plan.seeds {
            // Seeds that nobody is likely to have given a render of his own.
            let seed = 0x00ca_11b0_0000_0000 + images.len() as u64;
            images.push(image(
                device.as_mut(),
                plan.scene,
                seed,
                reference.as_ref(),
            )?);
        }
    }
    let found = compare_all(plan, &images, reference)?;
    let proposals = plan.metrics.iter().zip(found);
    Ok(Calibration {
        devices: names,
        seeds: plan.seeds,
        samples: plan.scene.settings.render.samples,
        proposals: proposals
            .map(|(metric, found)| propose(*metric, found, plan.false_alarms))
            .collect(),
    })
}

/// Reads the reference, once it is known to have the size of the scene's pictures.
fn fitting(path: &Path, scene: &Scene) -> Result<Raster> {
    let file = RasterFile::open(path)?;
    let (width, height) = (scene.settings.image.width, scene.settings.image.height);
    if (file.width(), file.height()) != (width, height) {
        return Err(Error::Data {
            path: path.into(),
            reason: format!(
                "{} x {} pixels, but the scene's pictures have {width} x {height}",
                file.width(),
                file.height()
            ),
        });
    }
    file.read()
}

/// Renders one picture, in the form that the reference has.
fn image(
    device: &mut dyn Device,
    scene: &Scene,
    seed: u64,
    reference: Option<&Raster>,
) -> Result<Raster> {
    let mut scene = scene.clone();
    scene.settings.render.seed = seed;
    let task = Task::one_of_many(&scene);
    let rendering = render::render(device, &task, &mut |_| ControlFlow::Continue(()))?;
    let picture = render::picture(&task, device.info(), &rendering, &[]);
    let encoded = reference.is_some_and(|image| !matches!(image.pixels, Pixels::Linear(_)));
    Ok(if encoded {
        picture.encoded_raster()
    } else {
        picture.raster()
    })
}

/// A metric's values, and how they were found.
#[derive(Clone, Debug, Default)]
struct Found {
    values: Vec<f64>,
    settings: String,
}

/// For each metric its values: each picture with the reference; or without one in pairs, a picture
/// from the first half of all with one from the second, so that devices meet. The exposures of the
/// first pair are those of all.
fn compare_all(plan: &Plan, images: &[Raster], reference: Option<Raster>) -> Result<Vec<Found>> {
    let mut all = vec![Found::default(); plan.metrics.len()];
    let mut viewing = plan.viewing;
    let half = images.len() / 2;
    let count = if reference.is_some() {
        images.len()
    } else {
        half
    };
    for index in 0..count {
        let (first, second) = match &reference {
            Some(reference) => (reference, &images[index]),
            None => (&images[index], &images[half + index]),
        };
        let pair = Pair::new(first.clone(), second.clone(), None)?;
        let study = Study::new(&pair, viewing);
        for (metric, found) in plan.metrics.iter().zip(&mut all) {
            let figure = study.figure(*metric)?;
            found.values.push(figure.value);
            found.settings = figure.settings;
        }
        if plan.metrics.contains(&Metric::HdrFlip) {
            viewing.exposures = Some(study.hdr_flip()?.1);
        }
    }
    Ok(all)
}

/// What the metric is near normal in, and back; larger is worse.
fn normal_scale(metric: Metric, value: f64) -> f64 {
    match metric {
        Metric::Psnr => -value,
        Metric::Ssim | Metric::MsSsim => (1.0 - value).ln(),
        _ => value.ln(),
    }
}

fn metric_scale(metric: Metric, number: f64) -> f64 {
    match metric {
        Metric::Psnr => -number,
        Metric::Ssim | Metric::MsSsim => 1.0 - number.exp(),
        _ => number.exp(),
    }
}

fn propose(metric: Metric, found: Found, false_alarms: f64) -> Proposal {
    let mut numbers: Vec<f64> = found
        .values
        .iter()
        .map(|value| normal_scale(metric, *value))
        .collect();
    numbers.sort_by(f64::total_cmp);
    let worst = numbers[numbers.len() - 1];
    // Pictures without noise are equal, and their limit is that they stay so.
    let noisy = numbers.iter().all(|number| number.is_finite());
    let bound = if noisy {
        upper_bound(&numbers, false_alarms)
    } else {
        worst
    };
    let limit = outward(metric, metric_scale(metric, bound));
    Proposal {
        metric,
        // Beyond what the metric can reach a limit would limit nothing.
        limit: Some(limit).filter(|limit| metric.range().contains(limit)),
        settings: found.settings,
        median: metric_scale(metric, numbers[numbers.len() / 2]),
        worst: metric_scale(metric, worst),
        comparisons: numbers.len(),
        false_alarms,
    }
}

/// What the next of such normal numbers is above with probability `chance`:
/// mean + t s sqrt(1 + 1/n), with Student's t by Wallace's approximation.
fn upper_bound(numbers: &[f64], chance: f64) -> f64 {
    let n = numbers.len() as f64;
    let mean = numbers.iter().sum::<f64>() / n;
    let variance = numbers.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let freedom = n - 1.0;
    let z = quantile(1.0 - chance) * (8.0 * freedom + 3.0) / (8.0 * freedom + 1.0);
    let t = (freedom * (z * z / freedom).exp_m1()).sqrt();
    mean + t * (variance * (1.0 + 1.0 / n)).sqrt()
}

/// Two digits, rounded so that more passes. Similarities are counted from 1 down.
fn outward(metric: Metric, limit: f64) -> f64 {
    let from_one = matches!(metric, Metric::Ssim | Metric::MsSsim);
    let size = if from_one { 1.0 - limit } else { limit };
    if size == 0.0 || !size.is_finite() {
        return limit;
    }
    let unit = 10f64.powf(size.abs().log10().floor() - 1.0);
    let digits = if metric == Metric::Psnr {
        (size / unit).floor()
    } else {
        (size / unit).ceil()
    };
    let value = if from_one {
        1.0 - digits * unit
    } else {
        digits * unit
    };
    // Back over a decimal text: three times 0.1 is not 0.3.
    format!("{value:.12}").parse().unwrap_or(value)
}

impl fmt::Display for Calibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} at {} on each of: {}",
            counted(self.seeds, "seed"),
            counted_as(self.samples, "sample a pixel", "samples a pixel"),
            self.devices.join(", ")
        )?;
        for proposal in &self.proposals {
            let flag = if proposal.metric.rises() {
                "--min"
            } else {
                "--max"
            };
            let (metric, count) = (proposal.metric, proposal.comparisons);
            match proposal.limit {
                Some(limit) => writeln!(
                    f,
                    "--metric {metric} {flag} {limit}   by {count} comparisons, 1 good picture in {:.0} will fail",
                    1.0 / proposal.false_alarms
                )?,
                None => writeln!(
                    f,
                    "--metric {metric}: no limit of use; more --seeds would tell more"
                )?,
            }
            writeln!(
                f,
                "    median {:.4e}, worst {:.4e}; {}",
                proposal.median, proposal.worst, proposal.settings
            )?;
        }
        Ok(())
    }
}
