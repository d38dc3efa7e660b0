//! A diffuse floor under a lamp, seen from many angles: Lambert's surface is equally bright from
//! all of them. The radiance is rho Le F with the lamp's form factor F.

use super::cross::{check_all, covering};
use super::lamp::form_factor;
use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};
use glam::DVec3;

const ALBEDO: [f64; 3] = [0.7, 0.45, 0.9];
const EMISSION: [f64; 3] = [2.0, 5.0, 1.0];
const LAMP: DVec3 = DVec3::new(0.9, 1.2, -0.4);
const RADIUS: f64 = 0.8;

/// Angles from the normal, in degrees: head-on to grazing.
const ANGLES: [f64; 4] = [0.0, 60.0, 85.0, 88.5];

/// The floor's origin, seen from the side that is away from the lamp.
fn seen_at(degrees: f64) -> Case {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let eye = 0.4 * DVec3::new(-0.8 * sine, cosine, 0.6 * sine);
    let scene = format!(
        "version = 1
        camera = {{ position = {eye}, look_at = [0, 0, 0], up = [0.6, 0.0, 0.8], fov = 0.02 }}
        image = {{ width = 32, height = 32 }}
        render = {{ max_bounces = 1 }}
        boxes = [{{ min = [-2.0, -0.5, -2.0], max = [2.0, 0.0, 2.0], material = \"floor\" }}]
        spheres = [{{ center = {LAMP}, radius = {RADIUS}, material = \"lamp\" }}]
        [materials.floor]
        albedo = {ALBEDO:?}
        survival = 0.85
        [materials.lamp]
        albedo = [0.5, 0.5, 0.5]
        emission = {EMISSION:?}"
    );
    let distance = LAMP.length();
    let factor = form_factor((RADIUS / distance).asin(), (LAMP.y / distance).acos());
    let truth = [0, 1, 2].map(|channel| ALBEDO[channel] * EMISSION[channel] * factor);
    Case::new(
        format!("seen at {degrees} degrees"),
        scene,
        Form::Mean(truth),
    )
}

#[test]
fn a_lambert_floor_is_as_bright_at_grazing_angles() {
    let mut family = Family::new("view of a floor", 24_000);
    for bench in benches() {
        check_all(&mut family, bench, &covering(bench), |choice| {
            seen_at(choice.pick(&ANGLES))
        });
        for degrees in ANGLES {
            family.check(bench, &seen_at(degrees));
        }
    }
    family.finish();
}

/// A wide lobe is not Lambert's law: it fails from every side.
#[test]
fn the_gate_rejects_what_depends_on_the_view() {
    let mut family = Family::new("view of a floor, mutants", 24_500);
    for bench in benches() {
        for degrees in ANGLES {
            let lobe = seen_at(degrees).set("materials.floor.scatter", "directional");
            family.reject(bench, &lobe.set("materials.floor.spread", 3));
            let brighter = "[0.707, 0.4545, 0.909]";
            family.reject(
                bench,
                &seen_at(degrees).set("materials.floor.albedo", brighter),
            );
        }
    }
}
