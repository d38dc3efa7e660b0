//! Rough mirrors, glass and the lens: what they have in common with what was there before them.

use super::room::TRUTH;
use crate::support::bench::{Bench, benches};
use crate::support::gate::{Case, Family, Form, measure_mean};
use lampray::film::Film;

/// Rough, glass and matt bodies under two lamps, one of them in a ball of glass, all lengths times `scale`.
fn text(scale: f64) -> String {
    let v = |x: f64, y: f64, z: f64| format!("[{:?}, {:?}, {:?}]", scale * x, scale * y, scale * z);
    let sphere = |x: f64, y: f64, z: f64, radius: f64, material: &str| {
        let (center, radius) = (v(x, y, z), scale * radius);
        format!("[[spheres]]\ncenter = {center}\nradius = {radius:?}\nmaterial = {material:?}\n")
    };
    let spheres = [
        sphere(-0.5, 0.52, 0.3, 0.5, "facets"),
        sphere(0.5, 0.42, 0.9, 0.4, "glass"),
        sphere(0.3, 2.1, 0.5, 0.35, "lamp"),
        sphere(-1.3, 0.9, 0.9, 0.45, "glass"),
        sphere(-1.3, 0.9, 0.9, 0.3, "lamp"),
    ];
    format!(
        "version = 1
        camera = {{ position = {}, look_at = {}, fov = 48, aperture = {:?}, focus = {:?} }}
        image = {{ width = 32, height = 32 }}
        render = {{ max_bounces = 6 }}
        background = {{ emission = [0.25, 0.35, 0.5] }}
        materials.floor.albedo = [0.7, 0.6, 0.5]
        materials.facets = {{ scatter = \"rough\", roughness = 0.25, albedo = [0.9, 0.8, 0.5] }}
        materials.glass = {{ scatter = \"glass\", index = 1.6, albedo = [0.95, 0.9, 0.97] }}
        materials.lamp = {{ albedo = [0.3, 0.3, 0.3], emission = [2.8, 3.2, 3.6] }}
        {}
        [[boxes]]
        min = {}
        max = {}
        material = \"floor\"
        [[boxes]]
        min = {}
        max = {}
        rotation = [20.0, 40.0, 10.0]
        material = \"glass\"",
        v(0.4, 1.3, 4.2),
        v(0.0, 0.6, 0.0),
        scale * 0.06,
        scale * 3.5,
        spheres.concat(),
        v(-3.0, -0.3, -3.0),
        v(3.0, 0.0, 3.0),
        v(0.9, 0.1, -0.4),
        v(1.5, 0.7, 0.2),
    )
}

fn case(scale: f64, sets: &[&str], form: Form) -> Case {
    let split = |set: &&str| {
        set.split_once('=')
            .map(|(a, b)| (a.to_string(), b.to_string()))
    };
    let case = Case::new("gloss", text(scale), form).within(0.012);
    sets.iter()
        .filter_map(split)
        .fold(case, |case, (path, value)| case.set(&path, value))
}

fn film(bench: Bench, scale: f64, sets: &[&str]) -> Film {
    let scene = case(scale, sets, Form::Mean([0.0; 3])).scene(7);
    bench.film(&scene, 3..43)
}

#[test]
fn powers_of_two_leave_the_very_film() {
    for bench in benches() {
        for sets in [&["render.preset=reference"], &["render.preset=paper"]] {
            let one = film(bench, 1.0, sets);
            for factor in [1024.0, 1.0 / 1024.0] {
                assert!(
                    film(bench, factor, sets) == one,
                    "{bench:?} {sets:?} {factor}"
                );
            }
            let other = ["camera.focus=3.51", sets[0]];
            assert!(
                film(bench, 1.0, &other) != one,
                "{bench:?}: the lens is seen"
            );
        }
    }
}

#[test]
fn every_kernel_gives_the_very_film() {
    for bench in benches() {
        let one = film(bench, 1.0, &["render.kernel=general"]);
        for kernel in ["render.kernel=bvh", "render.kernel=baked"] {
            assert!(film(bench, 1.0, &[kernel]) == one, "{bench:?} {kernel}");
        }
    }
}

#[test]
fn smooth_facets_are_the_mirror_and_a_lens_of_no_size_the_pinhole() {
    for bench in benches() {
        let mirror = film(bench, 1.0, &["materials.facets.scatter=mirror"]);
        for smooth in [
            "materials.facets.roughness=0",
            "materials.facets.roughness=0.000999",
        ] {
            assert!(film(bench, 1.0, &[smooth]) == mirror, "{bench:?} {smooth}");
        }
        let rough = film(bench, 1.0, &["materials.facets.roughness=0.001"]);
        assert!(rough != mirror, "{bench:?}");
        let pinhole = film(bench, 1.0, &["camera.aperture=0", "camera.focus=off"]);
        let focused = film(bench, 1.0, &["camera.aperture=0", "camera.focus=0.1"]);
        assert!(focused == pinhole && focused != rough, "{bench:?}");
    }
}

/// As published, direct light is Lambert's on every surface, whatever it is.
#[test]
fn lambert_s_direct_light_knows_no_scattering() {
    for bench in benches() {
        let paper = ["render.preset=paper", "render.max_bounces=1"];
        let all = ["diffuse", "directional", "mirror", "rough", "glass"].map(|scatter| {
            let set = format!("materials.facets.scatter={scatter}");
            film(bench, 1.0, &[paper[0], paper[1], &set])
        });
        assert!(all.iter().all(|one| *one == all[0]), "{bench:?}");
    }
}

#[test]
fn facets_that_are_all_but_smooth_have_the_mirror_s_mean() {
    let mut family = Family::new("smooth facets", 68_000);
    let mut mutants = Family::new("smooth facets, mutants", 68_100);
    for (number, bench) in benches().into_iter().enumerate() {
        let mirror = case(
            1.0,
            &["materials.facets.scatter=mirror"],
            Form::Mean([0.0; 3]),
        );
        let form = measure_mean(bench, &mirror, 68_200 + number as u64, TRUTH);
        for alpha in ["0.001", "0.003", "0.01"] {
            let smooth = format!("materials.facets.roughness={alpha}");
            family.check(bench, &case(1.0, &[&smooth], form));
        }
        let dull = case(
            1.0,
            &[
                "materials.facets.roughness=0.01",
                "materials.facets.albedo=[0.75, 0.7, 0.4]",
            ],
            form,
        );
        mutants.reject(bench, &dull);
    }
    family.finish();
}

/// What lies behind glass is found by hits alone, whatever finds the rest.
#[test]
fn light_samples_and_hits_agree_about_glass() {
    let mut family = Family::new("strategies and glass", 69_000);
    let mut mutants = Family::new("strategies and glass, mutants", 69_100);
    for (number, bench) in benches().into_iter().enumerate() {
        let both = case(1.0, &["light.strategy=mis"], Form::Mean([0.0; 3]));
        let form = measure_mean(bench, &both, 69_200 + number as u64, TRUTH);
        for sets in [
            &["light.strategy=hit"][..],
            &["light.strategy=sample"],
            &[
                "light.strategy=sample",
                "light.sampler=gaussian",
                "scatter.diffuse=uniform",
            ],
            &[
                "light.strategy=mis",
                "interruption.rule=albedo",
                "interruption.start=0",
            ],
        ] {
            family.check(bench, &case(1.0, sets, form));
        }
        let sets = [
            "light.strategy=sample",
            "materials.glass.albedo=[0.9, 0.85, 0.92]",
        ];
        mutants.reject(bench, &case(1.0, &sets, form));
    }
    family.finish();
}
