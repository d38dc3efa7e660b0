//! Paths that are thinned out and split by what they are worth, in a closed diffuse enclosure that shines evenly,
//! found by hits alone.
//!
//! There a path carries at hit k what it must, whatever happened before: how many rays should leave the hit is a
//! number of k and of what the path may still split into. So the moments of X, what the path and all its
//! branches bring, follow from those of the next hit: with n rays wanted, the path goes on with probability
//! min(n, 1), as c rays, floor(n) or one more; each brings an independent X of the next hit with 1/c of the weight,
//! or 1/n of it where n is below 1.

use super::roulette::{EMISSION, PLAIN, Walls};
use super::spread::{Distance, Law, measure_by};
use crate::support::bench::{Bench, benches};
use crate::support::gate::{Case, MOST_ERRORS};
use lampray::cpu::pilot::Pilot;
use lampray::film::Film;
use lampray::pack::Worth;
use lampray::render::{Task, render};
use lampray::scene::Scene;
use std::ops::ControlFlow;

const BOUNCES: u32 = 7;
const SPLIT: u32 = 8;
const WALLS: Walls = Walls {
    rule: "efficiency",
    max_bounces: BOUNCES,
    ..PLAIN
};

/// E[X^0] to E[X^4].
type Moments = [f64; 5];

const NOTHING: Moments = [1.0, 0.0, 0.0, 0.0, 0.0];

/// Of the sum of two independent numbers.
fn sum(a: Moments, b: Moments) -> Moments {
    const WAYS: [[f64; 5]; 5] = [
        [1.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0, 0.0, 0.0],
        [1.0, 2.0, 1.0, 0.0, 0.0],
        [1.0, 3.0, 3.0, 1.0, 0.0],
        [1.0, 4.0, 6.0, 4.0, 1.0],
    ];
    std::array::from_fn(|k| (0..=k).map(|j| WAYS[k][j] * a[j] * b[k - j]).sum())
}

fn certain(value: f64) -> Moments {
    std::array::from_fn(|k| value.powi(k as i32))
}

/// Of what a path brings from hit `hit` on: three channels, and its rays.
fn moments(worth: &Worth, hit: u32, throughput: [f64; 3], allowed: u32) -> [Moments; 4] {
    let [r, g, b] = [0, 1, 2].map(|c| throughput[c] * EMISSION[c]);
    let here = [r, g, b, 1.0].map(certain);
    if hit == BOUNCES {
        return here;
    }
    let size = |worth: [f32; 3]| {
        let terms = (0..3).map(|c| throughput[c].powi(2) * f64::from(worth[c]));
        terms.sum::<f64>().sqrt()
    };
    let thinned = size(worth.keep).clamp(0.05, 1.0);
    let wanted = size(worth.split).max(thinned).min(f64::from(allowed));
    let (lives, split) = (wanted.min(1.0), wanted.max(1.0));
    let more = split - split.floor();
    let counts = [(split as u32, 1.0 - more), (split as u32 + 1, more)];
    let mut there = [NOTHING.map(|moment| moment * (1.0 - lives)); 4];
    for (count, chance) in counts.into_iter().filter(|(_, chance)| *chance > 0.0) {
        let share = lives * f64::from(count);
        let next = [0, 1, 2].map(|c| throughput[c] * WALLS.albedo[c] / share);
        let branch = moments(worth, hit + 1, next, allowed / count);
        for (all, one) in there.iter_mut().zip(branch) {
            let together = (0..count).fold(NOTHING, |all, _| sum(all, one));
            for (moment, more) in all.iter_mut().zip(together) {
                *moment += lives * chance * more;
            }
        }
    }
    std::array::from_fn(|c| sum(here[c], there[c]))
}

fn laws(worth: &Worth) -> [Law; 4] {
    let all = moments(worth, 0, [1.0; 3], SPLIT);
    all.map(|moments| Law::from_moments(|k| moments[k as usize]))
}

fn worth(split: f32, keep: f32) -> Worth {
    Worth {
        split: [split; 3],
        keep: [keep; 3],
        ..Worth::default()
    }
}

/// Renders the enclosure with its wall worth that.
fn film(bench: Bench, scene: &Scene, worth: Worth, samples: u64) -> Film {
    let task = Task {
        samples: 0..samples,
        ..Task::new(scene)
    };
    let pilot = Pilot {
        worths: vec![worth],
        paths: 0,
        rays: 0,
    };
    task.pilot.set(pilot).unwrap();
    let rendering = bench.with(|device| render(device, &task, &mut |_| ControlFlow::Continue(())));
    rendering.unwrap().film
}

fn case() -> Case {
    WALLS.case().set("interruption.split", SPLIT)
}

/// How far a film is from the laws of a worth, and its rays in standard errors.
fn distances(bench: Bench, case: &Case, seed: u64, given: Worth, told: Worth) -> (bool, String) {
    let scene = case.scene(seed);
    let [r, g, b, rays] = laws(&told);
    let take = |samples| film(bench, &scene, given, samples);
    let (film, distances) = measure_by([r, g, b], 1024.0, take);
    let found = film.rays as f64 / film.paths as f64;
    let cost = (found - rays.mean) / (rays.variance.max(1e-12) / film.paths as f64).sqrt();
    let near = cost.abs() <= MOST_ERRORS && distances.iter().all(Distance::passes);
    let z: Vec<_> = distances.iter().map(|d| (d.mean, d.variance)).collect();
    let line = format!(
        "{bench:?}, split {:?}, keep {:?}: relative variance {:.4} for {:.4}, rays {found:.4} for {:.4}, z {cost:+.2} {z:.2?}",
        given.split[0],
        given.keep[0],
        distances[0].relative_variance,
        r.relative_variance(),
        rays.mean
    );
    (near, line)
}

/// Thinned out from the first hit on, from later ones, hardly; split in two or three, in five, and into all that is
/// allowed at once, with what is thinned out behind it.
const WORTHS: [(f32, f32); 6] = [
    (0.0, 0.2),
    (0.1, 1.2),
    (0.9, 1.5),
    (2.5, 4.0),
    (9.0, 9.0),
    (30.0, 30.0),
];

#[test]
fn branches_have_the_mean_variance_and_cost_that_are_computed() {
    for (n, bench) in benches().into_iter().enumerate() {
        for (m, (split, keep)) in WORTHS.into_iter().enumerate() {
            let worth = worth(split, keep);
            let seed = 36_000 + (10 * n + m) as u64;
            let (near, line) = distances(bench, &case(), seed, worth, worth);
            assert!(near, "{line}");
            println!("{line}");
        }
    }
}

#[test]
fn the_gate_tells_worths_apart() {
    for (n, bench) in benches().into_iter().enumerate() {
        let seed = 36_100 + 10 * n as u64;
        let told = worth(2.5, 4.0);
        let others = [worth(2.4, 4.0), worth(0.0, 4.0)];
        for (m, given) in others.into_iter().enumerate() {
            let (near, line) = distances(bench, &case(), seed + m as u64, given, told);
            assert!(!near, "the gate let a mutant pass: {line}");
        }
        let told = worth(9.0, 9.0);
        for (path, value) in [("interruption.split", "4"), ("interruption.start", "1")] {
            let (near, line) = distances(bench, &case().set(path, value), seed + 5, told, told);
            assert!(!near, "the gate let {path} {value} pass: {line}");
        }
    }
}

/// The worth that a pilot found, told to the computation.
#[test]
fn what_a_pilot_finds_has_the_laws_that_are_computed() {
    for (n, bench) in benches().into_iter().enumerate() {
        let seed = 36_200 + n as u64;
        let scene = case().scene(seed);
        let found = Task::new(&scene).pilot().unwrap().worths[0];
        let (near, line) = distances(bench, &case(), seed, found, found);
        assert!(near, "{line}");
        println!("{line}");
    }
}
