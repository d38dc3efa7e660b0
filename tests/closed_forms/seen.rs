//! What a camera sees directly, and an empty scene: the very bits, whatever the knobs.

use super::cross::{check_all, covering};
use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};

/// Numbers that need all their bits.
const RADIANCE: [f32; 3] = [0.1, 0.333_333_3, 0.987_654];

/// All of the picture: a lamp from outside and from inside, a box, and the sky alone.
const SHAPES: [&str; 4] = [
    "spheres = [{ center = [0.0, 0.0, -3.0], radius = 2.0, material = \"lamp\" }]",
    "spheres = [{ center = [0.0, 0.0, -3.0], radius = 7.0, material = \"lamp\" }]",
    "boxes = [{ min = [-2.0, -2.0, -6.0], max = [2.0, 2.0, -3.0], rotation = [10.0, 20.0, 30.0], material = \"lamp\" }]",
    "",
];

/// The sky has the radiance where there is nothing else, and another where there is.
fn seen(shape: &str, albedo: f64) -> Case {
    let sky = if shape.is_empty() {
        RADIANCE
    } else {
        [5.0, 6.0, 7.0]
    };
    let scene = format!(
        "version = 1
        camera = {{ position = [0.0, 0.0, 0.0], look_at = [0.0, 0.0, -1.0], fov = 30 }}
        image = {{ width = 32, height = 32 }}
        background = {{ emission = {sky:?} }}
        {shape}
        [materials.lamp]
        albedo = [{albedo}, {albedo}, {albedo}]
        emission = {RADIANCE:?}"
    );
    Case::new(
        format!("seen directly: {shape}"),
        scene,
        Form::Bits(RADIANCE),
    )
}

#[test]
fn every_preset_shows_emission_and_background_bit_for_bit() {
    let mut family = Family::new("seen directly", 16_000);
    for bench in benches() {
        for shape in SHAPES {
            for preset in ["montelight", "paper", "corrected", "reference"] {
                family.check(bench, &seen(shape, 0.0).set("render.preset", preset));
            }
        }
    }
    family.finish();
}

/// A black lamp sends nothing on, and one that is not does not either where no bounce is allowed.
/// Exposure is for the PNG alone.
#[test]
fn every_knob_leaves_what_is_seen_directly() {
    let mut family = Family::new("seen directly, crossed", 16_200);
    for bench in benches() {
        for (shape, exposure) in SHAPES.into_iter().zip([-3, 0, 2, 5]) {
            check_all(&mut family, bench, &covering(bench), |choice| {
                let (albedo, max_bounces) = choice.pick(&[(0.0, 5), (0.6, 0)]);
                seen(shape, albedo)
                    .set("render.max_bounces", max_bounces)
                    .set("image.exposure", exposure)
            });
        }
    }
    family.finish();
}

#[test]
fn the_gate_rejects_the_last_bit() {
    let mut family = Family::new("seen directly, mutants", 16_800);
    for bench in benches() {
        for shape in &SHAPES[..3] {
            let lamp = seen(shape, 0.0);
            let bit = "[0.1, 0.33333334, 0.987654]";
            assert_ne!(0.333_333_34_f32, RADIANCE[1]);
            family.reject(bench, &lamp.clone().set("materials.lamp.emission", bit));
            family.reject(bench, &lamp.set("render.clamp", 0.98));
            let grey = seen(shape, 0.01).set("render.max_bounces", 1);
            family.reject(bench, &grey);
        }
        let sky = "[0.1, 0.3333333, 0.9876541]";
        family.reject(bench, &seen("", 0.0).set("background.emission", sky));
    }
}
