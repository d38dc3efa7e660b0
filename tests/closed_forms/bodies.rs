//! Lone bodies under an even sky: one reflection multiplies it by the albedo, whatever the body.

use super::cross::{check_all, crossed};
use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};

pub const SKY: [f32; 3] = [0.9, 1.3, 0.1];
pub const ALBEDO: [f32; 3] = [0.83, 0.4, 0.17];

const SPHERE: &str = "spheres = [{ center = [0.3, 0.2, -4.0], radius = 1.5, material = \"body\" }]";
const TURNED_BOX: &str = "boxes = [{ min = [-1.7, -1.8, -6.0], max = [2.3, 2.2, -2.0], rotation = [30.0, 20.0, -50.0], material = \"body\" }]";

/// A camera that sees nothing but the body in the middle of the picture.
fn view(shape: &str, scatter: &str, form: Form) -> Case {
    let scene = format!(
        "version = 1
        camera = {{ position = [0.3, 0.2, 0.0], look_at = [0.3, 0.2, -4.0], fov = 25 }}
        image = {{ width = 32, height = 32 }}
        background = {{ emission = {SKY:?} }}
        {shape}
        [materials.body]
        scatter = \"{scatter}\"
        albedo = {ALBEDO:?}
        survival = 0.9"
    );
    Case::new(format!("{scatter} {shape}"), scene, form)
}

/// One reflection of the sky, in the arithmetic of a device.
pub fn reflected() -> [f32; 3] {
    [0, 1, 2].map(|channel| ALBEDO[channel] * SKY[channel])
}

#[test]
fn a_convex_body_reflects_its_albedo_exactly() {
    let mut family = Family::new("convex bodies, exact", 12_000);
    for bench in benches() {
        for shape in [SPHERE, TURNED_BOX] {
            for scatter in ["diffuse", "mirror"] {
                for (max_bounces, strategy) in [(1, "sample"), (8, "mis"), (2, "hit")] {
                    let case = view(shape, scatter, Form::Bits(reflected()))
                        .set("render.max_bounces", max_bounces)
                        .set("light.strategy", strategy)
                        .set("interruption.rule", "none");
                    family.check(bench, &case);
                }
                let dark = view(shape, scatter, Form::Bits([0.0; 3]));
                family.check(bench, &dark.set("render.max_bounces", 0));
            }
        }
    }
    family.finish();
}

/// Without variance where every path goes on with the albedo as its weight: then the very bits.
#[test]
fn every_knob_leaves_a_convex_body_its_albedo() {
    let mut family = Family::new("convex bodies, crossed", 13_000);
    for bench in benches() {
        check_all(&mut family, bench, &crossed(bench), |choice| {
            // Shadow rays to the sky are as constant, but not to the last bit.
            let form = match choice.is_plain() && !choice.samples_background() {
                true => Form::Bits(reflected()),
                false => Form::Mean(reflected().map(f64::from)),
            };
            let case = view(choice.pick(&[SPHERE, TURNED_BOX]), "diffuse", form);
            case.set("render.max_bounces", choice.pick(&[1, 3, 8]))
        });
    }
    family.finish();
}

/// White bodies, wholly in the picture: nothing tells them from the sky.
#[test]
fn a_white_body_is_invisible() {
    let mut family = Family::new("white bodies", 12_500);
    for bench in benches() {
        for shape in [SPHERE, TURNED_BOX] {
            for scatter in ["diffuse", "mirror"] {
                let case = view(shape, scatter, Form::Bits(SKY))
                    .set("materials.body.albedo", "[1, 1, 1]")
                    .set("camera.fov", 120)
                    .set("interruption.rule", "none");
                family.check(bench, &case);
                let grey = view(shape, scatter, Form::Bits(SKY)).set("camera.fov", 120);
                family.reject(
                    bench,
                    &grey.set("materials.body.albedo", "[1, 0.999999, 1]"),
                );
            }
        }
    }
    family.finish();
}

#[test]
fn the_gates_reject_small_faults() {
    let mut family = Family::new("convex bodies, mutants", 17_000);
    for bench in benches() {
        for shape in [SPHERE, TURNED_BOX] {
            let exact = view(shape, "mirror", Form::Bits(reflected()));
            family.reject(
                bench,
                &exact.set("materials.body.albedo", "[0.83, 0.4, 0.1700001]"),
            );
            let noisy = view(shape, "diffuse", Form::Mean(reflected().map(f64::from)));
            let noisy = noisy.set("scatter.diffuse", "uniform");
            family.reject(
                bench,
                &noisy.set("materials.body.albedo", "[0.83, 0.404, 0.17]"),
            );
        }
        let noisy = view(SPHERE, "diffuse", Form::Mean(reflected().map(f64::from)));
        let literal = noisy.set("interruption.weight", "literal");
        for rule in ["survival", "albedo", "throughput"] {
            let literal = literal.clone().set("interruption.rule", rule);
            family.reject(bench, &literal.set("interruption.start", 0));
        }
    }
}
