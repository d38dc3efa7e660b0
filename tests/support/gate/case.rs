//! What is rendered, and what must come out.

use super::MOST_RELATIVE_ERROR;
use crate::support::bench::Bench;
use lampray::film::Film;
use lampray::scene::{Assignment, Scene};
use std::fmt;

/// Samples of each pixel where there is no noise.
const FEW: u64 = 48;

/// What a render is compared with, and how.
#[derive(Clone, Copy, Debug)]
pub enum Form {
    /// A mean with noise: within 4 standard errors, at a standard error of 0.2 % or less.
    Mean([f64; 3]),
    /// An estimator without variance: every sample within 1e-5.
    Constant([f64; 3]),
    /// The very number, in every pixel.
    Bits([f32; 3]),
    /// A mean that is itself measured: (mean, standard error). The difference is within 4 of its
    /// own standard errors, and those are 0.2 % or less.
    Measured([f64; 3], [f64; 3]),
}

impl Form {
    /// Relative standard error to render to; none where there is no noise.
    pub(super) fn precision(self) -> Option<f64> {
        match self {
            Form::Mean(_) => Some(0.95 * MOST_RELATIVE_ERROR),
            // The truth's own error takes its part.
            Form::Measured(..) => Some(0.9 * MOST_RELATIVE_ERROR),
            Form::Constant(_) | Form::Bits(_) => None,
        }
    }
}

/// A scene with knobs, and what its picture must be.
#[derive(Clone, Debug)]
pub struct Case {
    pub name: String,
    pub scene: String,
    /// `PATH=VALUE`, as for `--set`.
    pub sets: Vec<String>,
    pub form: Form,
}

impl Case {
    pub fn new(name: impl Into<String>, scene: impl Into<String>, form: Form) -> Self {
        Self {
            name: name.into(),
            scene: scene.into(),
            sets: Vec::new(),
            form,
        }
    }

    /// The case with one more knob set.
    pub fn set(mut self, path: &str, value: impl fmt::Display) -> Self {
        self.sets.push(format!("{path}={value}"));
        self
    }

    pub fn scene(&self, seed: u64) -> Scene {
        let seed = format!("render.seed={seed}");
        let assignments: Vec<_> = self
            .sets
            .iter()
            .chain([&seed])
            .map(|set| Assignment::parse(set).unwrap_or_else(|error| panic!("{error}")))
            .collect();
        let scene = Scene::parse("test", &self.scene, &assignments);
        scene.unwrap_or_else(|error| panic!("{error}\n{}", self.scene))
    }

    pub(super) fn film(&self, bench: Bench, seed: u64, precision: Option<f64>) -> Film {
        let scene = self.scene(seed);
        match precision {
            Some(precision) => bench.measure(&scene, precision),
            None => bench.film(&scene, 0..FEW),
        }
    }
}

/// Renders a scene to a relative standard error: its mean, as [`Form::Measured`] wants it.
pub fn measure_mean(bench: Bench, case: &Case, seed: u64, precision: f64) -> Form {
    let film = case.film(bench, seed, Some(precision));
    Form::Measured(film.picture_mean(), film.standard_error())
}
