//! A closed diffuse enclosure that shines evenly, seen from inside: every reflection multiplies by
//! the albedo, so that N of them leave e (1 + rho + ... + rho^N).
//!
//! A sphere is a lamp that is sampled from inside; a box is found by scattered rays alone.

use super::cross::{check_all, covering};
use crate::support::bench::{Bench, benches};
use crate::support::gate::{Case, Family, Form};

const EMISSION: [f64; 3] = [0.7, 1.0, 2.3];
const ALBEDO: [f64; 3] = [0.75, 0.5, 0.3];
const SURVIVAL: f64 = 0.75;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    Sphere,
    Box,
    TurnedBox,
}

pub(super) const SHAPES: [Shape; 3] = [Shape::Sphere, Shape::Box, Shape::TurnedBox];

impl Shape {
    fn text(self) -> &'static str {
        match self {
            Shape::Sphere => {
                "spheres = [{ center = [0.1, 0.2, 0.3], radius = 1.7, material = \"wall\" }]"
            }
            Shape::Box => {
                "boxes = [{ min = [-1.0, -0.7, -1.3], max = [1.2, 0.9, 1.1], material = \"wall\" }]"
            }
            Shape::TurnedBox => {
                "boxes = [{ min = [-1.0, -0.7, -1.3], max = [1.2, 0.9, 1.1], rotation = [20.0, -35.0, 50.0], material = \"wall\" }]"
            }
        }
    }
}

/// The partial sum 1 + ratio + ... + ratio^n, by Horner's rule.
fn series(ratio: f64, n: u32) -> f64 {
    (0..n).fold(1.0, |sum, _| 1.0 + ratio * sum)
}

/// The sky would be seen through any leak: it is a thousand times as bright as the walls.
pub(super) fn case(shape: Shape, max_bounces: u32, form: Form) -> Case {
    let scene = format!(
        "version = 1
        camera = {{ position = [0.3, -0.1, 0.2], look_at = [1.0, 0.5, -0.4], fov = 100 }}
        image = {{ width = 32, height = 32 }}
        render = {{ max_bounces = {max_bounces} }}
        background = {{ emission = [1000.0, 1000.0, 1000.0] }}
        {}
        [materials.wall]
        albedo = {ALBEDO:?}
        emission = {EMISSION:?}
        survival = {SURVIVAL}",
        shape.text()
    );
    let name = format!("{shape:?}, {max_bounces} bounces");
    Case::new(name, scene, form).set("interruption.rule", "none")
}

/// The walls' emission times something, by channel.
fn times(factor: impl Fn(usize) -> f64) -> [f64; 3] {
    [0, 1, 2].map(|channel| EMISSION[channel] * factor(channel))
}

pub(super) fn whole(max_bounces: u32) -> [f64; 3] {
    times(|channel| series(ALBEDO[channel], max_bounces))
}

#[test]
fn without_variance_every_sample_is_the_partial_sum() {
    let mut family = Family::new("enclosures without variance", 6000);
    for bench in benches() {
        for shape in SHAPES {
            for max_bounces in [0, 1, 4, 64] {
                let case = case(shape, max_bounces, Form::Constant(whole(max_bounces)));
                family.check(bench, &case.set("light.strategy", "hit"));
            }
        }
    }
    family.finish();
}

/// The variance of uniform scattering and of interruption grows with every bounce: few of them.
#[test]
fn every_knob_gives_the_partial_sum() {
    let mut family = Family::new("enclosures, crossed", 7000);
    for bench in benches() {
        for shape in SHAPES {
            check_all(&mut family, bench, &covering(bench), |choice| {
                let max_bounces = choice.pick(&[1, 4, 2]);
                case(shape, max_bounces, Form::Mean(whole(max_bounces)))
            });
        }
        // The first hit that is tested need not be the camera's.
        let late = case(Shape::Sphere, 8, Form::Mean(whole(8))).set("interruption.start", 2);
        family.check(bench, &late.set("interruption.rule", "albedo"));
    }
    family.finish();
}

/// How far literal interruption changes the sum. Emission found by a ray counts before the test
/// whatever the order; a shadow ray's light counts before or after it. With t the survival
/// probability and q = rho t:
/// - hits alone, either order: each ray survived every test before it: sum of q^n;
/// - shadow rays after the test: the same;
/// - shadow rays before the test: 1 + rho (sum of q^n over one term less);
/// - both by the power heuristic: half and half, for by the cosine and by the area a sphere is
///   seen from inside with one density, cos / pi.
fn literal(strategy: &str, order: &str, survival: f64, max_bounces: u32, channel: usize) -> f64 {
    let (albedo, ratio) = (ALBEDO[channel], ALBEDO[channel] * survival);
    let tested = series(ratio, max_bounces);
    let untested = 1.0 + albedo * series(ratio, max_bounces - 1);
    match (strategy, order) {
        ("sample", "after-direct") => untested,
        ("mis", "after-direct") => 0.5 * (tested + untested),
        _ => tested,
    }
}

fn interrupted(shape: Shape, strategy: &str, order: &str, rule: &str, weight: &str) -> Case {
    let max_bounces = 48;
    // The rule `albedo` takes the largest channel's.
    let survival = if rule == "albedo" {
        ALBEDO[0]
    } else {
        SURVIVAL
    };
    let strategy_here = if shape == Shape::Sphere {
        strategy
    } else {
        "hit"
    };
    let truth = match weight {
        "literal" => times(|channel| literal(strategy_here, order, survival, max_bounces, channel)),
        _ => whole(max_bounces),
    };
    case(shape, max_bounces, Form::Mean(truth))
        .set("light.strategy", strategy)
        .set("light.sampler", "inverse-cosine")
        .set("light.boxes", "hit")
        .set("interruption.rule", rule)
        .set("interruption.order", order)
        .set("interruption.weight", weight)
        .set("interruption.start", 0)
}

fn interruptions(bench: Bench) -> Vec<Case> {
    let mut cases = Vec::new();
    for (n, rule) in ["survival", "albedo"].into_iter().enumerate() {
        for (o, order) in ["after-direct", "before-direct"].into_iter().enumerate() {
            for weight in ["literal", "compensated"] {
                for strategy in ["sample", "hit", "mis"] {
                    cases.push(interrupted(Shape::Sphere, strategy, order, rule, weight));
                }
                let shape = SHAPES[1 + (n + o + bench as usize) % 2];
                cases.push(interrupted(shape, "mis", order, rule, weight));
            }
        }
    }
    cases
}

#[test]
fn literal_interruption_loses_what_it_must_and_compensated_nothing() {
    let mut family = Family::new("enclosures, interruption", 8000);
    for bench in benches() {
        for case in interruptions(bench) {
            family.check(bench, &case);
        }
    }
    family.finish();
}

#[test]
fn the_paper_keeps_57_percent_of_the_closed_box() {
    // rho = t = 0.75: 4 e becomes 2.2857 e.
    let kept = literal("hit", "after-direct", 0.75, 1000, 0) / series(0.75, 1000);
    assert!((kept - 2.285_714 / 4.0).abs() < 1e-6);
}

#[test]
fn the_gates_reject_small_faults() {
    let mut family = Family::new("enclosures, mutants", 9000);
    for bench in benches() {
        for shape in SHAPES {
            let still = case(shape, 4, Form::Constant(whole(4))).set("light.strategy", "hit");
            let with = |path: &str, value: &str| still.clone().set(path, value);
            family.reject(
                bench,
                &with("materials.wall.albedo", "[0.75, 0.50002, 0.3]"),
            );
            family.reject(
                bench,
                &with("materials.wall.emission", "[0.7, 1.0, 2.30005]"),
            );
            family.reject(bench, &with("render.max_bounces", "3"));
        }
        let noisy = interrupted(
            Shape::Sphere,
            "sample",
            "after-direct",
            "survival",
            "literal",
        );
        let with = |path: &str, value: &str| noisy.clone().set(path, value);
        family.reject(bench, &with("interruption.order", "before-direct"));
        family.reject(bench, &with("interruption.weight", "compensated"));
        family.reject(bench, &with("interruption.start", "1"));
        family.reject(bench, &with("materials.wall.survival", "0.76"));
        family.reject(bench, &with("light.strategy", "mis"));
    }
}
