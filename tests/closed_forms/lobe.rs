//! Directional scattering under an even sky: what falls below the surface is lost.

use super::bodies::{ALBEDO, SKY, reflected};
use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};
use crate::support::quadrature::{erf, integrate};
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

/// Share of the half-normal lobe that falls below the surface, for a mirror direction at `away` from
/// the normal: of the ring at angle t, acos(cot t cot away) / pi. A clamp piles the law's tail up
/// on the ring at a right angle, half of which is below; truncation leaves it out.
fn below(spread: f64, away: f64, clamp: bool) -> f64 {
    let inside = erf(FRAC_PI_2 / (SQRT_2 * spread));
    let law = |t: f64| (2.0 / PI).sqrt() / spread * (-0.5 * (t / spread).powi(2)).exp();
    // t = start + x^2 smooths the root at the angle that touches the horizon.
    let start = FRAC_PI_2 - away;
    let ring = |x: f64| {
        let t = start + x * x;
        let share = (1.0 / (t.tan() * away.tan())).clamp(-1.0, 1.0).acos() / PI;
        2.0 * x * law(t) * share
    };
    let mass = integrate(0.0, away.sqrt(), 200, ring);
    if clamp {
        mass + 0.5 * (1.0 - inside)
    } else {
        mass / inside
    }
}

#[test]
fn the_lobe_s_share_below_is_known() {
    let known = [
        (0.1, 85.0, 0.098),
        (0.2, 75.0, 0.041),
        (0.3, 60.0, 0.016),
        (0.5, 45.0, 0.028),
        (1.0, 30.0, 0.062),
        (1.0, 85.0, 0.403),
    ];
    for (spread, degrees, share) in known {
        let found = below(spread, f64::to_radians(degrees), false);
        assert!(
            (found - share).abs() < 0.0006,
            "{spread} {degrees}: {found}"
        );
    }
}

/// A directional face seen at one angle from its normal: a pinhole so narrow that there is no other.
fn lobe(shape: &str, spread: f64, degrees: f64, bound: &str) -> Case {
    let away = degrees.to_radians();
    let (x, y) = (3.0 * away.sin(), 3.0 * away.cos());
    let share = 1.0 - below(spread, away, bound == "clamp");
    let truth = reflected().map(|value| f64::from(value) * share);
    let scene = format!(
        "version = 1
        camera = {{ position = [{x}, {y}, 0.0], look_at = [0.0, 0.0, 0.0], up = [0.0, 0.0, 1.0], fov = 0.02 }}
        image = {{ width = 32, height = 32 }}
        background = {{ emission = {SKY:?} }}
        {shape}
        [materials.body]
        scatter = \"directional\"
        spread = {spread}
        albedo = {ALBEDO:?}"
    );
    Case::new(
        format!("lobe at {degrees} degrees"),
        scene,
        Form::Mean(truth),
    )
    .set("scatter.bound", bound)
}

/// Both have a normal along y at the origin.
const BALL: &str = "spheres = [{ center = [0.0, -2.0, 0.0], radius = 2.0, material = \"body\" }]";
const FACE: &str =
    "boxes = [{ min = [-1.0, -0.4, -1.0], max = [1.0, 0.0, 1.0], material = \"body\" }]";

#[test]
fn a_directional_body_loses_what_falls_below_it() {
    let mut family = Family::new("directional bodies", 14_000);
    let angles = [20.0, 45.0, 60.0, 75.0, 85.0];
    for bench in benches() {
        for (s, spread) in [0.1, 0.3, 0.6, 1.0, 3.0].into_iter().enumerate() {
            for (a, degrees) in angles.into_iter().enumerate() {
                let even = (s + a + bench as usize).is_multiple_of(2);
                let shape = if even { BALL } else { FACE };
                let bound = ["truncate", "clamp"][(s + a / 2) % 2];
                family.check(bench, &lobe(shape, spread, degrees, bound));
            }
        }
    }
    family.finish();
}

#[test]
fn the_gate_rejects_small_faults() {
    let mut family = Family::new("directional bodies, mutants", 17_200);
    for bench in benches() {
        let lobe = lobe(FACE, 0.6, 75.0, "truncate");
        family.reject(bench, &lobe.clone().set("materials.body.spread", 0.63));
        family.reject(
            bench,
            &lobe
                .clone()
                .set("scatter.bound", "clamp")
                .set("materials.body.spread", 1.0),
        );
        family.reject(bench, &lobe.set("camera.position", "[2.92, 0.7, 0.0]"));
    }
}
