//! The gate for variances: the moments of one sample, and a film beside them.

use crate::support::bench::Bench;
use crate::support::gate::{Case, MOST_ERRORS};
use lampray::film::Film;

/// Relative standard error of a variance that is rendered to, and that a gate allows: four of the
/// latter are below 5 %.
const PRECISION: f64 = 0.006;
const MOST_ERROR: f64 = 0.012;

/// Of the radiance of one path: mean, variance and fourth central moment.
#[derive(Clone, Copy, Debug)]
pub struct Law {
    pub mean: f64,
    pub variance: f64,
    pub fourth: f64,
}

impl Law {
    /// From the expectation of X^k, k = 1 to 4.
    pub fn from_moments(moment: impl Fn(i32) -> f64) -> Self {
        let [a, b, c, d] = [1, 2, 3, 4].map(moment);
        Self {
            mean: a,
            variance: b - a * a,
            fourth: d - 4.0 * a * c + 6.0 * a * a * b - 3.0 * a.powi(4),
        }
    }

    /// Variance over squared mean.
    pub fn relative_variance(self) -> f64 {
        self.variance / (self.mean * self.mean)
    }

    pub fn scaled(self, k: f64) -> Self {
        Self {
            mean: self.mean * k,
            variance: self.variance * k.powi(2),
            fourth: self.fourth * k.powi(4),
        }
    }

    fn kurtosis(self) -> f64 {
        self.fourth / (self.variance * self.variance)
    }

    /// Relative standard error of the mean of `pixels` sample variances of `n` samples each:
    /// Var(s^2) = variance^2 (kurtosis - (n - 3) / (n - 1)) / n.
    fn error_of_variance(self, n: f64, pixels: f64) -> f64 {
        ((self.kurtosis() - (n - 3.0) / (n - 1.0)) / (n * pixels)).sqrt()
    }

    /// Samples of each pixel that make that error small enough.
    fn samples(self, pixels: f64) -> u64 {
        let wanted = self.kurtosis() / (PRECISION * PRECISION * pixels);
        (wanted.ceil() as u64).max(64)
    }
}

/// Mean over the pixels of the sample variance.
pub fn variance(film: &Film, channel: usize) -> f64 {
    let pixels = 0..film.counts.len();
    let sum: f64 = pixels.map(|pixel| film.variance(pixel)[channel]).sum();
    sum / film.counts.len() as f64
}

/// How far one channel of a film is from a law, in standard errors that the law itself gives.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    pub relative_variance: f64,
    pub mean: f64,
    pub variance: f64,
    /// Relative standard error of the variance.
    pub error: f64,
}

impl Distance {
    fn new(film: &Film, channel: usize, law: Law) -> Self {
        let (pixels, n) = (film.counts.len() as f64, film.counts[0] as f64);
        let (mean, variance) = (film.picture_mean()[channel], variance(film, channel));
        let error = law.error_of_variance(n, pixels);
        Self {
            relative_variance: variance / (mean * mean),
            mean: (mean - law.mean) / (law.variance / (n * pixels)).sqrt(),
            variance: (variance / law.variance - 1.0) / error,
            error,
        }
    }

    /// Sharp enough to tell, and near. Written so that a NaN is not.
    pub fn passes(&self) -> bool {
        let near = self.mean.abs() <= MOST_ERRORS && self.variance.abs() <= MOST_ERRORS;
        near && self.error <= MOST_ERROR
    }
}

/// Renders a case, all of whose pixels see the same, and measures it against a law for each channel.
pub fn measure(bench: Bench, case: &Case, seed: u64, laws: [Law; 3]) -> (Film, [Distance; 3]) {
    let scene = case.scene(seed);
    let pixels = f64::from(scene.settings.image.width * scene.settings.image.height);
    measure_by(laws, pixels, |samples| bench.film(&scene, 0..samples))
}

/// The same for a film that somebody else takes, with as many samples of each pixel as he is told.
pub fn measure_by(
    laws: [Law; 3],
    pixels: f64,
    take: impl FnOnce(u64) -> Film,
) -> (Film, [Distance; 3]) {
    let samples = laws.map(|law| law.samples(pixels)).into_iter().max();
    let film = take(samples.unwrap_or(64));
    assert_eq!(film.non_finite, 0);
    let distances = [0, 1, 2].map(|channel| Distance::new(&film, channel, laws[channel]));
    (film, distances)
}

fn describe(bench: Bench, case: &Case, laws: [Law; 3], distances: [Distance; 3]) -> String {
    let each = |of: &dyn Fn(usize) -> f64| format!("{:.4?}", [0, 1, 2].map(of));
    let (name, sets) = (&case.name, case.sets.join(" "));
    format!(
        "{name} {sets} on {bench:?}: relative variance {} for {}, z {} at a standard error of {}, z of the mean {}",
        each(&|channel| distances[channel].relative_variance),
        each(&|channel| laws[channel].relative_variance()),
        each(&|channel| distances[channel].variance),
        each(&|channel| distances[channel].error),
        each(&|channel| distances[channel].mean),
    )
}

/// Mean and variance of a render must be its laws'.
pub fn check(bench: Bench, case: &Case, seed: u64, laws: [Law; 3]) -> Film {
    let (film, distances) = measure(bench, case, seed, laws);
    let line = describe(bench, case, laws, distances);
    assert!(distances.iter().all(Distance::passes), "{line}");
    println!("{line}");
    film
}

/// A render that has other laws must be seen to have them: by its variance where its mean is right.
pub fn reject(bench: Bench, mutant: &Case, seed: u64, laws: [Law; 3]) {
    let (_, distances) = measure(bench, mutant, seed, laws);
    let line = describe(bench, mutant, laws, distances);
    let far = distances.iter().any(|one| one.variance.abs() > MOST_ERRORS);
    assert!(far, "the gate let a mutant pass: {line}");
    println!("rejected: {line}");
}
