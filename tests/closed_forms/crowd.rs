//! Small black balls before a bright sky, or before a large lamp: seen from the floor no two overlap, and
//! each takes its form factor away. Only with so many bodies is there a tree worth the name: one ball that
//! is passed over, or met where it is not, is a quarter of the gate.

use super::lamp::form_factor;
use crate::support::bench::{Bench, benches};
use crate::support::gate::{Case, Family, Form};
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

const BALLS: usize = 240;
const ALBEDO: [f64; 3] = [0.7, 0.45, 0.9];
const LIGHT: [f64; 3] = [2.0, 5.0, 1.0];

/// Directions that lie evenly over the cap around the normal down to the cosine `lowest` (a
/// Fibonacci lattice), and half the angle that any two of them are at least apart.
fn lattice(lowest: f64) -> (Vec<DVec3>, f64) {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let direction = |index: usize| {
        let cosine = 1.0 - (1.0 - lowest) * (index as f64 + 0.5) / BALLS as f64;
        let (sine, turn) = ((1.0 - cosine * cosine).sqrt(), golden * index as f64);
        DVec3::new(sine * turn.cos(), cosine, sine * turn.sin())
    };
    let all: Vec<_> = (0..BALLS).map(direction).collect();
    let pairs = (0..BALLS).flat_map(|one| (0..one).map(move |other| (one, other)));
    let nearest = pairs.map(|(one, other)| all[one].angle_between(all[other]));
    let least = nearest.fold(TAU, f64::min);
    (all, 0.5 * least)
}

/// The balls' text, and the sum of their form factors. Each is as large as it can be without
/// touching another's cone, at a distance of its own between 0.5 and 2.
fn balls(lowest: f64) -> (String, f64) {
    let (directions, half_angle) = lattice(lowest);
    let angle = 0.98 * half_angle;
    let (mut text, mut factors) = (String::new(), 0.0);
    for (index, direction) in directions.into_iter().enumerate() {
        let distance = 0.5 + 1.5 * (0.618_033_988_75 * index as f64).fract();
        let (center, radius) = (distance * direction, distance * angle.sin());
        let _ = write!(
            text,
            "[[spheres]]\ncenter = {center}\nradius = {radius}\nmaterial = \"black\"\n"
        );
        factors += form_factor(angle, direction.y.acos());
    }
    (text, factors)
}

/// A spot of floor in the middle of it all, seen along the floor.
fn scene(rest: &str) -> String {
    format!(
        "version = 1
        camera = {{ position = [0.3, 0.012, 0.0], look_at = [0, 0, 0], fov = 0.02 }}
        image = {{ width = 32, height = 32 }}
        render = {{ max_bounces = 1 }}
        [materials]
        floor = {{ albedo = {ALBEDO:?} }}
        black = {{ albedo = [0, 0, 0] }}
        lamp = {{ albedo = [0, 0, 0], emission = {LIGHT:?} }}
        [[boxes]]
        min = [-3.0, -0.5, -3.0]
        max = [3.0, 0.0, 3.0]
        material = \"floor\"
        {rest}"
    )
}

fn truth(factor: f64) -> Form {
    Form::Mean([0, 1, 2].map(|channel| ALBEDO[channel] * LIGHT[channel] * factor))
}

/// Before the sky: scattered rays find what the balls leave of it.
fn before_sky() -> Case {
    let (balls, shaded) = balls(0.15);
    let rest = format!("[background]\nemission = {LIGHT:?}\n{balls}");
    Case::new("balls before a sky", scene(&rest), truth(1.0 - shaded))
}

/// Before a lamp that stands behind them all: shadow rays too.
fn before_lamp() -> Case {
    let (balls, shaded) = balls(0.82);
    let (distance, radius) = (10.0_f64, 7.0);
    let lamp = format!(
        "[[spheres]]\ncenter = [0, {distance}, 0]\nradius = {radius}\nmaterial = \"lamp\"\n"
    );
    let whole = form_factor((radius / distance).asin(), 0.0);
    Case::new(
        "balls before a lamp",
        scene(&(lamp + &balls)),
        truth(whole - shaded),
    )
}

fn cases(bench: Bench) -> Vec<Case> {
    let kernels: &[&str] = match bench {
        // Its loops have their closed forms elsewhere.
        Bench::Twin => &["bvh"],
        Bench::Vulkan => &["bvh", "general"],
    };
    let mut cases = Vec::new();
    for kernel in kernels {
        let with = |case: Case| case.set("render.kernel", kernel);
        cases.push(with(before_sky()));
        for strategy in ["sample", "hit", "mis"] {
            cases.push(with(before_lamp()).set("light.strategy", strategy));
        }
    }
    cases
}

#[test]
fn balls_take_away_what_they_cover() {
    let mut family = Family::new("balls before a light", 31_000);
    for bench in benches() {
        for case in cases(bench) {
            family.check(bench, &case);
        }
    }
    family.finish();
}

/// A scene with few balls less, or with balls larger by a hundredth, is told apart.
#[test]
fn the_gate_rejects_other_balls() {
    let mut family = Family::new("balls before a light, mutants", 31_500);
    for bench in benches() {
        for mut case in [before_sky(), before_lamp()] {
            case = case
                .set("render.kernel", "bvh")
                .set("light.strategy", "sample");
            for ball in 0..8 {
                case = case.set(&format!("spheres.{}.radius", 20 * ball + 30), "1e-6");
            }
            family.reject(bench, &case);
        }
    }
}
