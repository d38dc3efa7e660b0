//! The gates: what a render must pass to agree with a closed form. Tests and their mutants use the
//! same ones.

use super::Bench;
use lampray::film::Film;
use lampray::scene::{Assignment, Scene};
use std::fmt;

/// Standard errors that a mean may lie from the truth.
const MOST_ERRORS: f64 = 4.5;
/// Two-sided p of that for one comparison: erfc(4.5 / sqrt 2).
const LEVEL: f64 = 6.8e-6;
/// Relative standard error that a comparison may have.
const MOST_RELATIVE_ERROR: f64 = 0.002;
/// Relative standard error that a mutant is rendered to: 1 % is then twelve of them.
const MUTANT_PRECISION: f64 = 0.0008;
/// Relative error of 32-bit arithmetic along a path, where noise is smaller than that.
const ARITHMETIC: f64 = 1e-5;
/// Samples of each pixel where there is no noise.
const FEW: u64 = 48;

/// What a render is compared with, and how.
#[derive(Clone, Copy, Debug)]
pub enum Form {
    /// A mean with noise: within 4.5 standard errors, at a standard error of 0.2 % or less.
    Mean([f64; 3]),
    /// An estimator without variance: every sample within 1e-5.
    Constant([f64; 3]),
    /// The very number, in every pixel.
    Bits([f32; 3]),
    /// A mean that is itself measured: (mean, standard error). The difference is within 4.5 of its
    /// own standard errors, and those are 0.2 % or less.
    Measured([f64; 3], [f64; 3]),
}

impl Form {
    /// Relative standard error to render to; none where there is no noise.
    fn precision(self) -> Option<f64> {
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

    fn scene(&self, seed: u64) -> Scene {
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

    fn film(&self, bench: Bench, seed: u64, precision: Option<f64>) -> Film {
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

/// Why a render does not pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    /// Too noisy to say.
    Noise,
    /// It differs.
    Apart,
    /// Samples that are not finite.
    NotFinite,
}

/// One channel of one render beside its truth.
#[derive(Clone, Debug)]
struct Comparison {
    case: String,
    bench: Bench,
    channel: usize,
    mean: f64,
    truth: f64,
    error: f64,
    /// Whether no other comparison shares the truth's own noise.
    independent: bool,
    fault: Option<Fault>,
}

impl Comparison {
    fn z(&self) -> f64 {
        (self.mean - self.truth) / self.error.max(1e-30)
    }

    /// Whether noise, not arithmetic, decides.
    fn is_noisy(&self) -> bool {
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

/// 4.5 standard errors, or the arithmetic's own error; and not above a relative standard error.
fn judge_mean(mean: f64, truth: f64, error: f64) -> Option<Fault> {
    let allowed = (MOST_ERRORS * error).max(ARITHMETIC * truth);
    // Written so that a NaN is a fault.
    let near = (mean - truth).abs() <= allowed;
    let sharp = error <= MOST_RELATIVE_ERROR * truth;
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
            let fault = judge_mean(mean, truth[channel], own_error);
            (truth[channel], own_error, fault)
        }
        Form::Measured(other, error) => {
            let error = error[channel].hypot(own_error);
            let fault = judge_mean(mean, other[channel], error);
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

fn compare(case: &Case, bench: Bench, film: &Film) -> Vec<Comparison> {
    let channel = |channel| compare_channel(case, bench, film, channel);
    (0..3).map(channel).collect()
}

/// The comparisons of one test.
#[derive(Debug)]
pub struct Family {
    name: &'static str,
    seed: u64,
    made: Vec<Comparison>,
}

impl Family {
    /// Renders of this family have the seeds from `first_seed` on, each its own.
    pub fn new(name: &'static str, first_seed: u64) -> Self {
        Self {
            name,
            seed: first_seed,
            made: Vec::new(),
        }
    }

    fn next_seed(&mut self) -> u64 {
        self.seed += 1;
        self.seed
    }

    /// Renders a case and compares it with what it must be.
    pub fn check(&mut self, bench: Bench, case: &Case) {
        let film = case.film(bench, self.next_seed(), case.form.precision());
        self.made.extend(compare(case, bench, &film));
    }

    /// Renders a case that is wrong on purpose: the gate must find it different in some channel.
    /// Being too noisy to say is not enough.
    pub fn reject(&mut self, bench: Bench, mutant: &Case) {
        let precision = mutant.form.precision().map(|_| MUTANT_PRECISION);
        let film = mutant.film(bench, self.next_seed(), precision);
        let made = compare(mutant, bench, &film);
        let caught = made.iter().any(|one| one.fault == Some(Fault::Apart));
        let lines: Vec<_> = made.iter().map(Comparison::to_string).collect();
        assert!(caught, "the gate let a mutant pass:\n{}", lines.join("\n"));
        let z = made.iter().map(|one| one.z().abs().min(9999.0));
        let z = z.fold(0.0, f64::max);
        let (name, sets) = (&self.name, mutant.sets.join(" "));
        println!("{name}: rejected on {bench:?} with |z| {z:.1}: {sets}");
    }

    /// Says how many comparisons there were, and fails with all that did not pass.
    pub fn finish(self) {
        println!("{}", self.summary());
        let at_fault = self.made.iter().filter(|one| one.fault.is_some());
        let faults: Vec<_> = at_fault.map(Comparison::to_string).collect();
        assert!(
            faults.is_empty(),
            "{} of {} comparisons fail:\n{}",
            faults.len(),
            self.made.len(),
            faults.join("\n")
        );
        for bench in [Bench::Twin, Bench::Vulkan] {
            for channel in 0..3 {
                self.pool(bench, channel);
            }
        }
    }

    /// Number of comparisons, largest |z|, and the chance of a false alarm among them all: at most
    /// the sum of theirs (Bonferroni), for the channels of one render are not independent.
    fn summary(&self) -> String {
        let noisy: Vec<_> = self.made.iter().filter(|one| one.is_noisy()).collect();
        let largest = noisy.iter().map(|one| one.z().abs()).fold(0.0, f64::max);
        format!(
            "{}: {} comparisons, {} of them with noise; largest |z| {largest:.2}, {MOST_ERRORS} allowed; chance of a false alarm at most {:.1e}",
            self.name,
            self.made.len(),
            noisy.len(),
            LEVEL * noisy.len() as f64
        )
    }

    /// Each case has a seed of its own, so that the z of one device and channel, summed over n cases
    /// and divided by sqrt n, is again a standard normal number. It finds a bias that all cases
    /// share and none shows. Cases that share a measured truth are not independent: they are left out.
    fn pool(&self, bench: Bench, channel: usize) {
        let chosen = |one: &&Comparison| {
            one.bench == bench && one.channel == channel && one.is_noisy() && one.independent
        };
        let z: Vec<_> = self.made.iter().filter(chosen).map(Comparison::z).collect();
        let pooled = z.iter().sum::<f64>() / (z.len().max(1) as f64).sqrt();
        if z.is_empty() {
            return;
        }
        let line = format!(
            "{}: {bench:?}, channel {channel}: z of {} cases pooled {pooled:+.2}",
            self.name,
            z.len()
        );
        assert!(pooled.abs() <= MOST_ERRORS, "{line}");
        println!("  {line}");
    }
}
