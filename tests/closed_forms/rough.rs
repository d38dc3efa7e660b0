//! Rough mirrors under an even sky: what one reflection by facets keeps of it.
//!
//! The share is a quadrature over the facets' normals, which knows nothing of how directions are drawn:
//! the integral of D(m) G2(i, o) (i.m) / i.z over m, with o the reflection of i by m.

use super::bodies::{ALBEDO, SKY, reflected};
use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};
use glam::DVec3;
use std::f64::consts::TAU;

fn lambda(alpha: f64, v: DVec3) -> f64 {
    let slope = alpha * v.truncate().length() / v.z;
    0.5 * ((1.0 + slope * slope).sqrt() - 1.0)
}

/// Share of the light that a rough mirror of albedo 1 reflects once, for light from `away` radians of the
/// normal. With tan^2 = alpha^2 t / (1 - t), D(m) m.z dm is even over t and the azimuth.
fn kept(alpha: f64, away: f64) -> f64 {
    const STEPS: usize = 1500;
    let i = DVec3::new(away.sin(), 0.0, away.cos());
    let of = |place: usize| {
        let t = (0.5 + (place / STEPS) as f64) / STEPS as f64;
        let (sine, cosine) = ((0.5 + (place % STEPS) as f64) * TAU / STEPS as f64).sin_cos();
        let slope = alpha * (t / (1.0 - t)).sqrt();
        let m = DVec3::new(slope * cosine, slope * sine, 1.0).normalize();
        let o = 2.0 * i.dot(m) * m - i;
        if i.dot(m) <= 0.0 || o.z <= 0.0 {
            return 0.0;
        }
        i.dot(m) / (i.z * m.z * (1.0 + lambda(alpha, i) + lambda(alpha, o)))
    };
    (0..STEPS * STEPS).map(of).sum::<f64>() / (STEPS * STEPS) as f64
}

#[test]
fn smooth_facets_keep_all_and_rough_ones_less() {
    assert!((kept(1e-3, 1.0) - 1.0).abs() < 1e-4);
    let falling = [0.1, 0.3, 0.6, 1.0].map(|alpha| kept(alpha, 0.5));
    assert!(
        falling.is_sorted_by(|a, b| a > b) && falling[3] > 0.3,
        "{falling:?}"
    );
}

/// A rough face or ball seen at one angle from its normal.
fn facets(shape: &str, alpha: f64, degrees: f64) -> Case {
    let away = degrees.to_radians();
    let (x, y) = (3.0 * away.sin(), 3.0 * away.cos());
    let share = kept(alpha, away);
    let truth = reflected().map(|value| f64::from(value) * share);
    let scene = format!(
        "version = 1
        camera = {{ position = [{x}, {y}, 0.0], look_at = [0.0, 0.0, 0.0], up = [0.0, 0.0, 1.0], fov = 0.02 }}
        image = {{ width = 32, height = 32 }}
        background = {{ emission = {SKY:?} }}
        {shape}
        [materials.body]
        scatter = \"rough\"
        roughness = {alpha}
        albedo = {ALBEDO:?}"
    );
    Case::new(
        format!("facets at {degrees} degrees"),
        scene,
        Form::Mean(truth),
    )
}

/// Both have a normal along y at the origin.
const BALL: &str = "spheres = [{ center = [0.0, -2.0, 0.0], radius = 2.0, material = \"body\" }]";
const FACE: &str =
    "boxes = [{ min = [-1.0, -0.4, -1.0], max = [1.0, 0.0, 1.0], material = \"body\" }]";

#[test]
fn a_rough_mirror_keeps_what_its_facets_do_not_hide() {
    let mut family = Family::new("rough mirrors", 60_000);
    for bench in benches() {
        for (s, alpha) in [0.05, 0.2, 0.5, 1.0].into_iter().enumerate() {
            for (a, degrees) in [0.5, 45.0, 70.0, 85.0].into_iter().enumerate() {
                let even = (s + a + bench as usize).is_multiple_of(2);
                family.check(
                    bench,
                    &facets(if even { BALL } else { FACE }, alpha, degrees),
                );
            }
        }
    }
    family.finish();
}

/// A lamp that fills the whole sky is the sky, by light samples, by hits and by both.
#[test]
fn light_samples_and_hits_keep_the_same() {
    let mut family = Family::new("rough mirrors in a lamp", 61_000);
    let room = "[[spheres]]
        center = [0.0, 0.0, 0.0]
        radius = 20.0
        material = \"sky\"
        [materials.sky]
        albedo = [0.0, 0.0, 0.0]
        emission = [0.9, 1.3, 0.1]
        [[boxes]]
        min = [-1.0, -0.4, -1.0]
        max = [1.0, 0.0, 1.0]
        material = \"body\"";
    for bench in benches() {
        for (alpha, degrees) in [(0.3, 60.0), (0.8, 30.0)] {
            for strategy in ["sample", "hit", "mis"] {
                let mut case = facets("", alpha, degrees);
                case.scene = format!("{}\n{room}", case.scene);
                case.name = format!("{strategy} of {}", case.name);
                family.check(bench, &case.within(0.02).set("light.strategy", strategy));
            }
        }
    }
    family.finish();
}

#[test]
fn the_gate_rejects_small_faults() {
    let mut family = Family::new("rough mirrors, mutants", 62_000);
    for bench in benches() {
        let case = facets(FACE, 0.5, 70.0);
        family.reject(bench, &case.clone().set("materials.body.roughness", 0.53));
        family.reject(bench, &case.clone().set("materials.body.scatter", "mirror"));
        family.reject(bench, &case.set("camera.position", "[2.92, 0.7, 0.0]"));
    }
}
