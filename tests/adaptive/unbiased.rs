//! The expectation of a picture, and what it says of its own error, over many seeds, where both are known.

use crate::support::bench::{Bench, benches};
use lampray::film::Film;
use lampray::render::{Task, render};
use lampray::scene::{Assignment, Scene};
use std::ops::ControlFlow;

/// Standard errors that a mean may lie from the truth: two-sided p of 6.3e-5 for each comparison.
const MOST_ERRORS: f64 = 4.0;

/// The eye in the middle of a glowing ball whose walls reflect all, and of whose paths a share `survival`
/// goes on to the one reflection: each sample is 1 + 1 / survival with that chance, and 1 without. The truth is
/// 2, and the variance of a sample 1 / survival - 1.
fn rare(survival: f64, side: u32, seed: u64) -> Scene {
    let text = format!(
        "version = 1\n\
         camera = {{ position = [0, 0, 0], look_at = [0, 0, -1] }}\n\
         image = {{ width = {side}, height = {side} }}\n\
         render = {{ samples = 100000, max_bounces = 1 }}\n\
         materials.wall = {{ albedo = [1, 1, 1], emission = [1, 1, 1], survival = {survival} }}\n\
         [[spheres]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"wall\"\n"
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

/// One film for each seed. Not adaptive is the naive rule: a picture of one tile that stops when its own samples
/// say that its error is small enough.
fn films(
    bench: Bench,
    survival: f64,
    side: u32,
    target: f64,
    adaptive: bool,
    seeds: u64,
) -> Vec<Film> {
    bench.with(|device| {
        let mut of_seed = |seed| {
            let scene = rare(survival, side, seed);
            let task = Task {
                target_error: Some(target),
                adaptive,
                ..Task::new(&scene)
            };
            let rendering = render(device, &task, &mut |_| ControlFlow::Continue(()));
            rendering.unwrap_or_else(|error| panic!("{error}")).film
        };
        (1..=seeds).map(&mut of_seed).collect()
    })
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

fn means(films: &[Film]) -> Vec<f64> {
    films.iter().map(|film| film.picture_mean()[0]).collect()
}

/// The distance of the mean over the seeds from the truth, in its own standard errors.
fn z(films: &[Film]) -> f64 {
    let means = means(films);
    (mean(&means) - TRUTH) / (variance(&means) / means.len() as f64).sqrt()
}

/// Bright paths so rare that a first look often has seen too few of them. The naive rule then stops too early just
/// where it is too dark; the scouts err as often, but in no way that goes with the picture.
#[test]
fn rare_bright_paths_are_not_lost() {
    for bench in benches() {
        let seeds = match bench {
            Bench::Twin => 3000,
            Bench::Vulkan => 500,
        };
        let films = |adaptive| films(bench, 1.0 / 256.0, 2, 0.25, adaptive, seeds);
        let (scouted, naive) = (films(true), films(false));
        let counts: Vec<_> = scouted.iter().map(|film| film.counts[0] as f64).collect();
        assert!(variance(&counts) > 0.0, "the rule never decided anything");
        let [ours, naive_z] = [z(&scouted), z(&naive)];
        let naive_mean = mean(&means(&naive));
        println!(
            "{bench:?}: {seeds} seeds, truth {TRUTH}: scouts {:.4} (z {ours:+.2}), naive rule {naive_mean:.4} (z {naive_z:+.2})",
            mean(&means(&scouted))
        );
        assert!(ours.abs() <= MOST_ERRORS, "{bench:?}: {ours}");
        assert!(
            naive_z < -MOST_ERRORS,
            "the test would not see a bias: {naive_z}"
        );
    }
}

/// The square of the standard error that a picture states is, over the seeds, the variance that pictures have; and
/// 95 % of the pictures are within 1.96 of it.
#[test]
fn the_stated_error_is_honest() {
    for bench in benches() {
        let seeds = match bench {
            Bench::Twin => 2000,
            Bench::Vulkan => 400,
        };
        let films = films(bench, 0.25, 4, 0.1, true, seeds);
        let means = means(&films);
        let errors: Vec<_> = films.iter().map(|film| film.standard_error()[0]).collect();
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

/// What was asked for is what comes out: the mean over seeds of the true relative error, by the true variance and
/// the samples that were taken.
#[test]
fn the_error_is_about_what_was_asked_for() {
    const TARGET: f64 = 0.1;
    let films = films(Bench::Twin, 0.25, 16, TARGET, true, 40);
    let error = |film: &Film| {
        let variance = 1.0 / 0.25 - 1.0;
        (variance / film.counts[0] as f64).sqrt() / (1.01 * TRUTH)
    };
    let errors: Vec<_> = films.iter().map(error).collect();
    let middle = mean(&errors) / TARGET;
    assert!((0.8..1.0).contains(&middle), "{middle}");
}
