//! The paper's literal weight over one lamp: a drawn point counts with the solid angle
//! 2 pi (1 - sqrt(1 - s^2 / d^2)), d its own distance, wherever the lamp itself is seen. Its mean
//! is not the truth; here it is integrated over each sampler's law.

use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};
use crate::support::quadrature::integrate;
use std::f64::consts::PI;

#[derive(Clone, Copy, Debug)]
enum Law {
    /// `uniform-angles` with the pole along the line to the lamp.
    PoleToward,
    /// `uniform-angles` with the pole across it.
    PoleSideways,
    /// `inverse-cosine` and `gaussian`.
    Area,
    Cone,
}

fn solid_angle(s: f64, distance: f64) -> f64 {
    2.0 * PI * (1.0 - (1.0 - (s / distance).powi(2)).max(0.0).sqrt())
}

/// Cosine at the face times weight for the lamp's point at height `mu`, the cosine between
/// its normal and the way from face to lamp. The lamp's centre is at distance 1, straight above.
fn weighted(q: f64, s: f64, mu: f64) -> f64 {
    let distance = (1.0 + 2.0 * q * mu + q * q).sqrt();
    (1.0 + q * mu) / distance * solid_angle(s, distance)
}

/// The same for a direction of the cone, at cosine `c` from its axis: it meets the near side.
fn weighted_direction(q: f64, s: f64, c: f64) -> f64 {
    let half_chord = (q * q - (1.0 - c * c)).max(0.0).sqrt();
    c * solid_angle(s, c - half_chord)
}

/// Expected direct light over the truth pi q^2.
fn ratio(law: Law, q: f64, s: f64) -> f64 {
    let point = |mu: f64| weighted(q, s, mu);
    let mean = match law {
        Law::PoleToward => integrate(0.0, PI, 400, |phi| point(phi.cos())) / PI,
        // mu = sin(phi) cos(theta), phi and theta even.
        Law::PoleSideways => {
            integrate(0.0, PI, 100, |phi| {
                integrate(0.0, PI, 100, |theta| point(phi.sin() * theta.cos())) / PI
            }) / PI
        }
        Law::Area => 0.5 * integrate(-1.0, 1.0, 400, point),
        Law::Cone => {
            let edge = (1.0 - q * q).sqrt();
            // c = edge + x^2 smooths the root at the cone's rim.
            let widest = (1.0 - edge).sqrt();
            let rim = |x: f64| 2.0 * x * weighted_direction(q, s, edge + x * x);
            integrate(0.0, widest, 400, rim) / (1.0 - edge)
        }
    };
    mean / (PI * q * q)
}

/// Radius over distance of the base code's large lamp, seen from a wall.
const ROOM: f64 = 8.5 / 49.5;

#[test]
fn the_known_biases_come_out() {
    // The montelight room's large lamp before a wall: radius 8.5 at 49.5, or 0.17.
    let known = [
        (Law::PoleToward, 1.031),
        (Law::PoleSideways, 0.997),
        (Law::Area, 1.008),
    ];
    for (law, value) in known {
        let found = ratio(law, ROOM, ROOM);
        assert!((found - value).abs() < 0.0005, "{law:?}: {found}");
    }
    // To second order the law's own q^2 / 4 and its quadrupole: 3 / 4 q^2 toward, -3 / 8 q^2 sideways.
    let q = 0.01;
    for (law, square) in [
        (Law::PoleToward, 1.0),
        (Law::PoleSideways, -0.125),
        (Law::Area, 0.25),
    ] {
        let found = (ratio(law, q, q) - 1.0) / (q * q);
        assert!((found - square).abs() < 0.001, "{law:?}: {found}");
    }
    // The small-angle weight pi s^2 / d^2 has no bias under an even law (Newton's shell theorem).
    let small = ratio(Law::Area, 0.17, 1e-4) * (0.17 / 1e-4_f64).powi(2);
    assert!((small - 1.0).abs() < 1e-6, "{small}");
}

const ALBEDO: [f64; 3] = [0.8, 0.5, 0.25];
const EMISSION: [f64; 3] = [3.0, 1.0, 7.0];

/// The paper's preset, the lamp's lowest point straight above the place that the camera sees.
fn case(law: Law, q: f64, weight_radius: Option<f64>) -> Case {
    let scene = format!(
        "version = 1
        camera = {{ position = [1.1, 0.6, 0.3], look_at = [0.2, 0.0, 0.3], fov = 0.02 }}
        image = {{ width = 32, height = 32 }}
        render = {{ max_bounces = 1, preset = \"paper\" }}
        boxes = [{{ min = [-2.0, -0.5, -2.0], max = [2.0, 0.0, 2.0], material = \"white\" }}]
        spheres = [{{ center = [0.2, 1.0, 0.3], radius = {q}, material = \"lamp\" }}]
        [materials.white]
        albedo = {ALBEDO:?}
        [materials.lamp]
        albedo = [0.0, 0.0, 0.0]
        emission = {EMISSION:?}"
    );
    let lit = q * q * ratio(law, q, weight_radius.unwrap_or(q));
    let truth = [0, 1, 2].map(|channel| ALBEDO[channel] * EMISSION[channel] * lit);
    let case = Case::new(format!("{law:?}, q {q}"), scene, Form::Mean(truth));
    match weight_radius {
        Some(radius) => case.set("light.weight_radius", radius),
        None => case,
    }
}

/// Every way to ask for a law.
fn ways(law: Law) -> Vec<(&'static str, &'static str)> {
    match law {
        Law::PoleToward => vec![
            ("uniform-angles", "[0, 1, 0]"),
            ("uniform-angles", "receiver"),
        ],
        Law::PoleSideways => vec![
            ("uniform-angles", "[0, 0, 1]"),
            ("uniform-angles", "[2, 0, -1]"),
        ],
        Law::Area => vec![("inverse-cosine", "[0, 0, 1]"), ("gaussian", "receiver")],
        Law::Cone => vec![("cone", "[0, 0, 1]")],
    }
}

const LAWS: [Law; 4] = [Law::PoleToward, Law::PoleSideways, Law::Area, Law::Cone];

/// q, and the weight's radius where it is not the lamp's: smaller, larger than the nearest
/// point's distance, and larger than the farthest's.
const SIZES: [(f64, Option<f64>); 7] = [
    (ROOM, None),
    (0.17, None),
    (0.35, None),
    (0.17, Some(0.03)),
    (0.17, Some(0.3)),
    (0.17, Some(0.95)),
    (0.35, Some(1.5)),
];

#[test]
fn the_paper_s_weight_is_biased_as_computed() {
    let mut family = Family::new("literal weight", 10_000);
    for bench in benches() {
        for law in LAWS {
            for (q, weight_radius) in SIZES {
                for (sampler, pole) in ways(law) {
                    let case = case(law, q, weight_radius);
                    let case = case.set("light.sampler", sampler);
                    family.check(bench, &case.set("light.pole", pole));
                }
            }
        }
    }
    family.finish();
}

#[test]
fn the_gate_tells_the_laws_apart() {
    let mut family = Family::new("literal weight, mutants", 11_000);
    for bench in benches() {
        let area = case(Law::Area, 0.17, None).set("light.sampler", "inverse-cosine");
        let angles = area.clone().set("light.sampler", "uniform-angles");
        let mutants = [
            area.clone().set("light.weight", "pdf"),
            area.clone().set("light.weight_radius", 0.171),
            area.clone().set("spheres.0.radius", 0.171),
            angles.clone().set("light.pole", "receiver"),
            angles.set("light.pole", "[1, 0, 0]"),
        ];
        for mutant in mutants {
            family.reject(bench, &mutant);
        }
    }
}
