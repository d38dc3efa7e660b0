//! A black ball over a wide floor under an even sky.

use super::bodies::{ALBEDO, SKY, reflected};
use super::cross::{check_all, crossed};
use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};

/// A black ball over a wide floor takes (R / d)^2 h / d of the sky, d^2 = h^2 + x^2.
fn shaded(height: f64, radius: f64, x: f64) -> Case {
    let scene = format!(
        "version = 1
        camera = {{ position = [{}, 0.5, 0.0], look_at = [{x}, 0.0, 0.0], fov = 0.02 }}
        image = {{ width = 32, height = 32 }}
        background = {{ emission = {SKY:?} }}
        spheres = [{{ center = [0.0, {height}, 0.0], radius = {radius}, material = \"black\" }}]
        boxes = [{{ min = [-50.0, -1.0, -50.0], max = [50.0, 0.0, 50.0], material = \"floor\" }}]
        [materials.black]
        albedo = [0.0, 0.0, 0.0]
        [materials.floor]
        albedo = {ALBEDO:?}
        survival = 0.8",
        x + 1.5
    );
    let d = height.hypot(x);
    let open = 1.0 - (radius / d).powi(2) * height / d;
    let truth = reflected().map(|value| f64::from(value) * open);
    Case::new(
        format!("shade at {x} of a ball at {height}"),
        scene,
        Form::Mean(truth),
    )
}

/// Height and radius of the ball, and how far from its foot the floor is seen.
const BALLS: [(f64, f64, f64); 4] = [
    (1.0, 1.0, 0.5),
    (1.0, 0.8, 1.5),
    (2.0, 1.0, 0.0),
    (1.2, 1.2, 3.0),
];

#[test]
fn a_ball_takes_its_share_of_the_sky() {
    let mut family = Family::new("shade", 15_000);
    for bench in benches() {
        check_all(&mut family, bench, &crossed(bench), |choice| {
            let (height, radius, x) = choice.pick(&BALLS);
            shaded(height, radius, x)
        });
    }
    family.finish();
}

#[test]
fn the_gate_rejects_small_faults() {
    let mut family = Family::new("shade, mutants", 17_400);
    for bench in benches() {
        let shaded = shaded(1.0, 0.8, 1.0);
        family.reject(bench, &shaded.clone().set("spheres.0.radius", 0.82));
        family.reject(bench, &shaded.set("spheres.0.center", "[0.03, 1.0, 0.0]"));
    }
}
