//! A scene without a closed form: a mirror ball, a ball and a box of directional scattering, turned
//! boxes, two lamps, a box that shines and a sky. Every setting that claims no bias must give the picture
//! of one long render.

use super::cross::{CHOICES, DIFFUSE, ORDERS, POLES, RULES, SAMPLERS, STRATEGIES};
use crate::support::bench::{Bench, benches};
use crate::support::gate::{Case, Family, Form, measure_mean};
use std::sync::LazyLock;

const SCENE: &str = r#"version = 1
camera = { position = [0.4, 1.3, 4.2], look_at = [0.0, 0.6, 0.0], fov = 48 }
image = { width = 32, height = 32 }
render = { max_bounces = 4 }
background = { emission = [0.25, 0.35, 0.5] }

[materials]
floor = { albedo = [0.7, 0.6, 0.5], survival = 0.8 }
mirror = { scatter = "mirror", albedo = [0.9, 0.9, 0.8], survival = 0.9 }
satin = { scatter = "directional", spread = 0.35, albedo = [0.8, 0.5, 0.7], survival = 0.85 }
glow = { albedo = [0.5, 0.5, 0.5], emission = [0.6, 0.3, 0.1], survival = 0.7 }
small = { albedo = [0.0, 0.0, 0.0], emission = [7.0, 8.0, 9.0] }
large = { albedo = [0.6, 0.4, 0.2], emission = [1.5, 1.2, 0.9], survival = 0.75 }

[[boxes]]
min = [-3.0, -0.3, -3.0]
max = [3.0, 0.0, 3.0]
material = "floor"
[[boxes]]
min = [-1.6, 0.0, -1.4]
max = [-0.9, 1.1, -0.7]
rotation = [0.0, 30.0, 0.0]
material = "glow"
[[boxes]]
min = [0.9, 0.1, -0.4]
max = [1.5, 0.7, 0.2]
rotation = [20.0, 40.0, 10.0]
material = "satin"

[[spheres]]
center = [-0.5, 0.5, 0.3]
radius = 0.5
material = "mirror"
[[spheres]]
center = [0.5, 0.4, 0.9]
radius = 0.4
material = "satin"
[[spheres]]
center = [0.3, 2.0, 0.5]
radius = 0.2
material = "small"
[[spheres]]
center = [0.4, 0.6, -1.2]
radius = 0.6
material = "large"
"#;

/// The long render: the reference preset on the CPU twin, under a seed of its own.
static LONG: LazyLock<Form> = LazyLock::new(|| {
    let case = Case::new("long", SCENE, Form::Mean([0.0; 3]));
    measure_mean(Bench::Twin, &case, 18_000, 0.0004)
});

fn mixed() -> Case {
    Case::new("mixed scene", SCENE, *LONG)
}

/// Both unbiased presets as they are, then every sampler with every strategy, the other knobs
/// going round beside them.
fn settings(bench: Bench) -> Vec<Case> {
    let preset = |name| mixed().set("render.preset", name);
    let mut cases = vec![preset("corrected"), preset("reference")];
    for (s, sampler) in SAMPLERS.iter().enumerate() {
        for (t, strategy) in STRATEGIES.iter().enumerate() {
            let case = preset(["corrected", "reference"][s % 2])
                .set("light.sampler", sampler)
                .set("light.strategy", strategy)
                .set("light.choice", CHOICES[(s + t + 2 * bench as usize) % 4])
                .set("light.pole", POLES[(s + t) % 3])
                .set("scatter.diffuse", DIFFUSE[(s / 2 + t) % 2])
                .set("interruption.rule", RULES[(s + t + bench as usize) % 4])
                .set("interruption.order", ORDERS[(s + t / 2) % 2])
                .set("interruption.start", (s + 2 * t) % 3);
            cases.push(case);
        }
    }
    cases
}

#[test]
fn unbiased_settings_agree_on_a_mixed_scene() {
    let mut family = Family::new("mixed scene", 18_000);
    for bench in benches() {
        for case in settings(bench) {
            family.check(bench, &case);
        }
    }
    family.finish();
}

#[test]
fn the_gate_rejects_biased_settings() {
    let mut family = Family::new("mixed scene, mutants", 19_000);
    for bench in benches() {
        let with = |path: &str, value: &str| mixed().set(path, value);
        let literal = with("interruption.weight", "literal").set("interruption.start", 0);
        let mutants = [
            with("light.strategy", "sample").set("light.direct", "lambert"),
            with("light.strategy", "sample")
                .set("light.weight", "solid-angle")
                .set("light.weight_radius", 0.19),
            literal.set("interruption.rule", "survival"),
            with("spheres.2.radius", "0.204"),
            with("materials.satin.albedo", "[0.92, 0.575, 0.805]"),
            with("render.max_bounces", "2"),
            with("render.clamp", "5"),
            with("materials.floor.albedo", "[0.735, 0.63, 0.525]"),
            with("render.preset", "paper"),
            with("render.preset", "montelight"),
        ];
        for mutant in mutants {
            family.reject(bench, &mutant);
        }
    }
}
