//! The lamps that a device's tracing kernel draws, told from its pictures: each lamp has a colour of its
//! own, and a pixel's one sample shows that of the lamp that was asked.

use super::dome::{Lamp, lattice, scene};
use crate::support::bench::{Bench, benches};
use crate::support::chance::{Fit, fit, sidak};
use crate::support::stream::Stream;
use glam::Vec3;
use lampray::cpu::choice::choice_probability;
use lampray::cpu::ray::offset_origin;
use lampray::knobs::{Choice, LightChoice};
use lampray::pack::{Packed, Tally};
use lampray::scene::{Assignment, Scene};

/// Lamps: a colour of 32 by 32 shades each.
const SHADES: usize = 32;
const LAMPS: usize = SHADES * SHADES;
/// Pixels a side, and samples of each.
const SIDE: u32 = 256;
const SAMPLES: u64 = 16;
/// Chance that any of a device's tests refuses what is right.
const LEVEL: f64 = 0.01;

fn shade(number: usize) -> f64 {
    1.0 + number as f64 / (SHADES - 1) as f64
}

fn lamps() -> Vec<Lamp> {
    let (directions, apart) = lattice(LAMPS, 0.1);
    let mut stream = Stream::new(71);
    let lamp = |(number, direction)| {
        let strength = stream.scale(0.3, 3.0);
        let colour = [1.0, shade(number / SHADES), shade(number % SHADES)];
        Lamp {
            direction,
            distance: stream.scale(0.7, 8.0),
            half: apart * stream.between(0.2, 0.8),
            emission: colour.map(|x| strength * x),
        }
    };
    directions.into_iter().enumerate().map(lamp).collect()
}

fn packed(choice: LightChoice) -> Packed {
    let sets = [
        format!("light.choice={choice}"),
        "light.strategy=sample".into(),
        "render.seed=72".into(),
    ];
    let sets: Vec<_> = sets
        .iter()
        .map(|set| Assignment::parse(set).unwrap())
        .collect();
    let scene = Scene::parse("dome", &scene(&lamps(), 1.0, SIDE), &sets);
    Packed::new(&scene.unwrap_or_else(|error| panic!("{error}")))
}

/// Which lamp a sample shows.
fn decoded(tally: &Tally) -> usize {
    let [red, green, blue] = tally.mean.map(f64::from);
    assert!(
        red > 0.0,
        "a lamp that nothing hides gave no light: {tally:?}"
    );
    let number = |part: f64| ((part / red - 1.0) * (SHADES - 1) as f64).round() as usize;
    number(green) * SHADES + number(blue)
}

fn counts(bench: Bench, packed: &Packed) -> Vec<f64> {
    let whole = lampray::pack::Rect {
        x0: 0,
        y0: 0,
        x1: SIDE,
        y1: SIDE,
    };
    let mut counts = vec![0.0; LAMPS];
    bench.with(|device| {
        device.load(packed).unwrap();
        for sample in 0..SAMPLES {
            let traced = device.trace(whole, sample, 1).unwrap();
            for tally in &traced {
                counts[decoded(tally)] += 1.0;
            }
        }
    });
    counts
}

/// The probabilities that the twin states for the middle of the floor.
fn stated(packed: &Packed) -> Vec<f64> {
    // In the eye's own place.
    let point = Vec3::new(-0.3, -0.012, 0.0);
    let origin = offset_origin(point, Vec3::Y);
    let lamps = 0..LAMPS as u32;
    lamps
        .map(|lamp| f64::from(choice_probability(packed, lamp, origin, Vec3::Y)))
        .collect()
}

fn test(counts: &[f64], law: &[f64]) -> Fit {
    let draws: f64 = counts.iter().sum();
    let expected: Vec<_> = law.iter().map(|p| draws * p).collect();
    fit(counts, &expected)
}

/// A law that is off by a thirtieth for every other group of lamps.
fn tilted(law: &[f64]) -> Vec<f64> {
    let tilt = |(lamp, p): (usize, &f64)| p * if lamp / 8 % 2 == 0 { 1.03 } else { 0.97 };
    let all: Vec<_> = law.iter().enumerate().map(tilt).collect();
    let sum: f64 = all.iter().sum();
    all.into_iter().map(|p| p / sum).collect()
}

#[test]
fn lamps_are_drawn_with_the_stated_probabilities() {
    let choices = [LightChoice::Uniform, LightChoice::Power, LightChoice::Tree];
    let level = sidak(LEVEL, choices.len());
    for bench in benches() {
        let laws = choices.map(|choice| stated(&packed(choice)));
        for (place, choice) in choices.into_iter().enumerate() {
            let counts = counts(bench, &packed(choice));
            let right = test(&counts, &laws[place]);
            println!("{bench:?} {}: {right:?}, level {level:.1e}", choice.name());
            assert!(right.p >= level, "{bench:?} {}: {right:?}", choice.name());
            let others = (0..3)
                .filter(|other| *other != place)
                .map(|other| laws[other].clone());
            for wrong in others.chain([tilted(&laws[place])]) {
                let wrong = test(&counts, &wrong);
                assert!(wrong.p < level, "{bench:?} {}: {wrong:?}", choice.name());
            }
        }
    }
}
