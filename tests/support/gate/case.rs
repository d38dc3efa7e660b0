//! What is rendered, and what must come out.

use super::{MOST_ERRORS, MOST_RELATIVE_ERROR};
use crate::support::bench::Bench;
use lampray::film::Film;
use lampray::scene::{Assignment, Scene};
use std::fmt;

/// Samples of each pixel where there is no noise.
const FEW: u64 = 48;

/// What a render is compared with, and how.
#[derive(Clone, Copy, Debug)]
pub enum Form {
    /// A mean with noise: within 4 standard errors, at a standard error of 0.2 % or less (or the case's own).
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
    fn is_noisy(self) -> bool {
        matches!(self, Form::Mean(_) | Form::Measured(..))
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
    /// Relative standard error that a comparison may have.
    pub most_error: f64,
}

impl Case {
    pub fn new(name: impl Into<String>, scene: impl Into<String>, form: Form) -> Self {
        Self {
            name: name.into(),
            scene: scene.into(),
            sets: Vec::new(),
            form,
            most_error: MOST_RELATIVE_ERROR,
        }
    }

    /// The case under a gate of another width: four standard errors are at most this share.
    pub fn within(mut self, share: f64) -> Self {
        self.most_error = share / MOST_ERRORS;
        self
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

    /// Renders to a relative standard error, or a few samples where there is no noise.
    pub fn film(&self, bench: Bench, seed: u64, precision: f64) -> Film {
        let scene = self.scene(seed);
        match self.form.is_noisy() {
            true => bench.measure(&scene, precision),
            false => bench.film(&scene, 0..FEW),
        }
    }
}

/// Renders a scene to a relative standard error: its mean, as [`Form::Measured`] wants it.
pub fn measure_mean(bench: Bench, case: &Case, seed: u64, precision: f64) -> Form {
    let film = case.film(bench, seed, precision);
    Form::Measured(film.picture_mean(), film.standard_error())
}
