//! The expectation of a picture, and what it says of its own error, over many seeds, where both are known.

use crate::support::bench::{Bench, benches};
use lampray::film::Film;
use lampray::render::{Task, render};
use lampray::scene::{Assignment, Scene};
use std::collections::BTreeSet;
use std::ops::ControlFlow;

/// Standard errors that a mean may lie from the truth: two-sided p of 6.3e-5 for each comparison.
const MOST_ERRORS: f64 = 4.0;

/// The eye in the middle of a glowing ball whose walls reflect all, and of whose paths a share `survival`
/// goes on to the one reflection: each sample is 1 + 1 / survival with that chance, and 1 without. The truth is
/// 2, and the variance of a sample 1 / survival - 1.
///
/// With `calm` the upper half of the picture is a plate that shines as the wall does and reflects nothing: 1, without
/// noise. A path that meets it in the place of the wall is as bright.
fn rare(survival: f64, size: [u32; 2], calm: bool, seed: u64) -> Scene {
    let plate = match calm {
        true => "[[boxes]]\nmin = [-0.4, 0, -0.3]\nmax = [0.4, 0.4, -0.2]\nmaterial = \"plate\"\n",
        false => "",
    };
    let [width, height] = size;
    let text = format!(
        "version = 1\n\
         camera = {{ position = [0, 0, 0], look_at = [0, 0, -1] }}\n\
         image = {{ width = {width}, height = {height} }}\n\
         render = {{ samples = 100000, max_bounces = 1 }}\n\
         materials.wall = {{ albedo = [1, 1, 1], emission = [1, 1, 1], survival = {survival} }}\n\
         materials.plate = {{ albedo = [0, 0, 0], emission = [1, 1, 1] }}\n\
         [[spheres]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"wall\"\n{plate}"
    );
    let sets = [
        "light.strategy=hit",
        "interruption.rule=survival",
        "interruption.weight=compensated",
        "interruption.start=0",
        &format!("render.seed={seed}"),
    ];
    let knobs: Vec<_> = sets
        .iter()
        .map(|set| Assignment::parse(set).unwrap())
        .collect();
    Scene::parse("rare.toml", &text, &knobs).unwrap_or_else(|error| panic!("{error}"))
}

const TRUTH: f64 = 2.0;

/// A column of pixels, cut into eight tiles of sixteen: few pixels a tile, so that scouts tell little of each, and
/// what they say is mostly chance.
const COLUMN: [u32; 2] = [1, 128];

/// What is rendered of each seed.
struct Case {
    survival: f64,
    size: [u32; 2],
    calm: bool,
    target: f64,
    /// Not adaptive a picture of a single tile is the naive rule, which ends each tile where its own samples say that
    /// its error is small enough.
    adaptive: bool,
}

impl Case {
    /// One film for each seed.
    fn films(&self, bench: Bench, seeds: u64) -> Vec<Film> {
        bench.with(|device| {
            let mut of_seed = |seed| {
                let scene = rare(self.survival, self.size, self.calm, seed);
                let task = Task {
                    target_error: Some(self.target),
                    adaptive: self.adaptive,
                    ..Task::new(&scene)
                };
                let rendering = render(device, &task, &mut |_| ControlFlow::Continue(()));
                rendering.unwrap_or_else(|error| panic!("{error}")).film
            };
            (1..=seeds).map(&mut of_seed).collect()
        })
    }

    /// Of each film the mean of the pixels that have noise.
    fn means(&self, films: &[Film]) -> Vec<f64> {
        let of = |film: &Film| {
            let all = film.counts.len();
            let noisy = if self.calm { all / 2..all } else { 0..all };
            mean(&noisy.map(|pixel| film.mean(pixel)[0]).collect::<Vec<_>>())
        };
        films.iter().map(of).collect()
    }

    /// The relative distance of their mean over the seeds from the truth, and its standard error.
    fn bias(&self, films: &[Film]) -> [f64; 2] {
        let means = self.means(films);
        let error = (variance(&means) / means.len() as f64).sqrt();
        [mean(&means) / TRUTH - 1.0, error / TRUTH]
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Sample variance.
fn variance(values: &[f64]) -> f64 {
    let middle = mean(values);
    let squares = values.iter().map(|value| (value - middle).powi(2));
    squares.sum::<f64>() / (values.len() - 1) as f64
}

/// Bright paths so rare that a first look often has seen too few of them. The naive rule then stops too early just
/// where it is too dark. Scouts err as often, but in no way that goes with the picture, and one error of all pixels
/// ends the climb: what is left of a bias is of the kind of even sampling's, and below a hundredth.
#[test]
fn rare_bright_paths_are_not_lost() {
    for bench in benches() {
        let seeds = match bench {
            Bench::Twin => 600,
            Bench::Vulkan => 100,
        };
        let shaped = Case {
            survival: 1.0 / 256.0,
            size: COLUMN,
            calm: true,
            target: 0.35,
            adaptive: true,
        };
        let even = Case {
            adaptive: false,
            ..shaped
        };
        let naive = Case {
            size: [2, 2],
            calm: false,
            ..even
        };
        let films = shaped.films(bench, seeds);
        let counts = |film: &Film| film.counts.iter().copied().collect::<BTreeSet<_>>().len();
        let uneven = films.iter().filter(|film| counts(film) > 2).count();
        assert!(2 * uneven > films.len(), "{uneven} have a shape by chance");
        let ours = shaped.bias(&films);
        let of_even = even.bias(&even.films(bench, seeds));
        let of_naive = naive.bias(&naive.films(bench, 3 * seeds));
        println!(
            "{bench:?}: {seeds} seeds: bias, standard error: adaptive {ours:+.4?}, even {of_even:+.4?}, naive rule {of_naive:+.4?}"
        );
        assert!(
            ours[0].abs() <= 0.01 + MOST_ERRORS * ours[1],
            "{bench:?}: {ours:?}"
        );
        assert!(
            of_naive[0] + MOST_ERRORS * of_naive[1] < -0.05,
            "the test would not see a bias: {of_naive:?}"
        );
    }
}

/// The square of the standard error that a picture states is, over the seeds, the variance that pictures have; and
/// 95 % of the pictures are within 1.96 of it.
#[test]
fn the_stated_error_is_honest() {
    for bench in benches() {
        let seeds = match bench {
            Bench::Twin => 1000,
            Bench::Vulkan => 200,
        };
        let case = Case {
            survival: 0.05,
            size: COLUMN,
            calm: true,
            target: 0.12,
            adaptive: true,
        };
        let films = case.films(bench, seeds);
        // Of half of the pixels the error is twice that of the picture, whose other half has none.
        let means = case.means(&films);
        let errors: Vec<_> = films
            .iter()
            .map(|film| 2.0 * film.standard_error()[0])
            .collect();
        let squares: Vec<_> = errors.iter().map(|error| error * error).collect();
        let ratio = mean(&squares) / variance(&means);
        // The sample variance of n numbers that are all but normal has a relative error of sqrt(2 / (n - 1)).
        let allowed = MOST_ERRORS * (2.0 / (seeds - 1) as f64).sqrt();
        let covered = means.iter().zip(&errors);
        let covered = covered
            .filter(|(mean, error)| (**mean - TRUTH).abs() <= 1.96 * **error)
            .count();
        let share = covered as f64 / seeds as f64;
        let spread = MOST_ERRORS * (0.95 * 0.05 / seeds as f64).sqrt();
        println!(
            "{bench:?}: {seeds} seeds: stated variance {ratio:.3} of the true one, {:.1} % covered",
            100.0 * share
        );
        assert!((ratio - 1.0).abs() <= allowed, "{bench:?}: {ratio}");
        assert!((share - 0.95).abs() <= spread, "{bench:?}: {share}");
    }
}

/// What was asked for is what comes out: every picture says that it is within its target, and the mean over seeds of
/// the true relative error, by the true variance and the samples that were taken, is about that.
#[test]
fn the_error_is_what_was_asked_for() {
    let case = Case {
        survival: 0.25,
        size: [16, 64],
        calm: false,
        target: 0.1,
        adaptive: true,
    };
    let films = case.films(Bench::Twin, 40);
    let error = |film: &Film| {
        assert!(film.relative_error().reaches(case.target));
        let variance = 1.0 / case.survival - 1.0;
        let errors = film
            .counts
            .iter()
            .map(|count| (variance / *count as f64).sqrt());
        let errors: Vec<_> = errors.map(|error| error / (1.01 * TRUTH)).collect();
        mean(&errors)
    };
    let errors: Vec<_> = films.iter().map(error).collect();
    let middle = mean(&errors) / case.target;
    assert!((0.8..1.0).contains(&middle), "{middle}");
}
