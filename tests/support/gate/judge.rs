//! One channel of one render beside its truth.

use super::{ARITHMETIC, Case, Form, MOST_ERRORS};
use crate::support::bench::Bench;
use lampray::film::Film;
use std::fmt;

/// Why a render does not pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    /// Too noisy to say.
    Noise,
    /// It differs.
    Apart,
    /// Samples that are not finite.
    NotFinite,
}

/// One channel of one render beside its truth.
#[derive(Clone, Debug)]
pub(super) struct Comparison {
    case: String,
    pub(super) bench: Bench,
    pub(super) channel: usize,
    mean: f64,
    truth: f64,
    error: f64,
    /// Whether no other comparison shares the truth's own noise.
    pub(super) independent: bool,
    pub(super) fault: Option<Fault>,
}

impl Comparison {
    pub(super) fn z(&self) -> f64 {
        (self.mean - self.truth) / self.error.max(1e-30)
    }

    /// Whether noise, not arithmetic, decides.
    pub(super) fn is_noisy(&self) -> bool {
        self.error > 10.0 * ARITHMETIC * self.truth
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let fault = self
            .fault
            .map_or("passes".into(), |fault| format!("{fault:?}"));
        let percent = 100.0 / self.truth;
        write!(
            f,
            "{fault}: {} on {:?}, channel {}: mean {:.7}, truth {:.7} ({:+.4} %), standard error {:.2e} ({:.4} %), z {:+.2}",
            self.case,
            self.bench,
            self.channel,
            self.mean,
            self.truth,
            percent * (self.mean - self.truth),
            self.error,
            percent * self.error,
            self.z()
        )
    }
}

/// Four standard errors, or the arithmetic's own error; and not above a relative standard error.
fn judge_mean(mean: f64, truth: f64, error: f64, most_error: f64) -> Option<Fault> {
    let allowed = (MOST_ERRORS * error).max(ARITHMETIC * truth);
    // Written so that a NaN is a fault.
    let near = (mean - truth).abs() <= allowed;
    let sharp = error <= most_error * truth;
    match (near, sharp) {
        (false, _) => Some(Fault::Apart),
        (true, false) => Some(Fault::Noise),
        (true, true) => None,
    }
}

/// Means and spread of every pixel: with no spread, each sample is the truth too.
fn judge_constant(film: &Film, channel: usize, truth: f64) -> Option<Fault> {
    let near = |pixel| (film.mean(pixel)[channel] - truth).abs() <= ARITHMETIC * truth;
    let still = |pixel| film.variance(pixel)[channel].sqrt() <= ARITHMETIC * truth;
    let all = (0..film.counts.len()).all(|pixel| near(pixel) && still(pixel));
    (!all).then_some(Fault::Apart)
}

fn judge_bits(film: &Film, channel: usize, truth: f32) -> Option<Fault> {
    let same = |pixel| film.mean(pixel)[channel] == f64::from(truth);
    (!(0..film.counts.len()).all(same)).then_some(Fault::Apart)
}

fn compare_channel(case: &Case, bench: Bench, film: &Film, channel: usize) -> Comparison {
    let mean = film.picture_mean()[channel];
    let own_error = film.standard_error()[channel];
    let (truth, error, fault) = match case.form {
        Form::Mean(truth) => {
            let fault = judge_mean(mean, truth[channel], own_error, case.most_error);
            (truth[channel], own_error, fault)
        }
        Form::Measured(other, error) => {
            let error = error[channel].hypot(own_error);
            let fault = judge_mean(mean, other[channel], error, case.most_error);
            (other[channel], error, fault)
        }
        Form::Constant(truth) => {
            let fault = judge_constant(film, channel, truth[channel]);
            (truth[channel], own_error, fault)
        }
        Form::Bits(truth) => {
            let fault = judge_bits(film, channel, truth[channel]);
            (f64::from(truth[channel]), own_error, fault)
        }
    };
    let fault = if film.non_finite > 0 {
        Some(Fault::NotFinite)
    } else {
        fault
    };
    Comparison {
        case: format!("{} {}", case.name, case.sets.join(" ")),
        bench,
        channel,
        mean,
        truth,
        error,
        independent: !matches!(case.form, Form::Measured(..)),
        fault,
    }
}

pub(super) fn compare(case: &Case, bench: Bench, film: &Film) -> Vec<Comparison> {
    let channel = |channel| compare_channel(case, bench, film, channel);
    (0..3).map(channel).collect()
}
