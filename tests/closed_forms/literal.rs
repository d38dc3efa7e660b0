//! The paper's literal weight over one lamp: a drawn point counts with the solid angle
//! 2 pi (1 - sqrt(1 - s^2 / d^2)), d its own distance, wherever the lamp itself is seen. Its mean
//! is not the truth; here it is integrated over each sampler's law.

use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};
use lampray::theory::{Law, literal_ratio as ratio};

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
