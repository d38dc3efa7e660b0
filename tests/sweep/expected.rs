//! What an experiment knows before its first run: which expected pictures there are.

use super::bench::SCENE;
use lampray::cpu::Cpu;
use lampray::device::Device;
use lampray::knobs::{Filter, Preset, Settings};
use lampray::scene::Assignment;
use lampray::sweep::{Axis, Base, Experiment, Grid, PlannedReference, ReferenceRule};

fn base(text: &str, sets: &[&str]) -> Base {
    let assignments = sets
        .iter()
        .map(|set| Assignment::parse(set).expect("a knob"));
    Base {
        name: "s.toml".into(),
        text: text.into(),
        assignments: assignments.collect(),
    }
}

/// The references of a whole sweep.
fn references(base: Base, axes: &[&str]) -> Vec<PlannedReference> {
    let grid = Grid {
        axes: axes
            .iter()
            .map(|text| Axis::parse(text).expect("an axis"))
            .collect(),
        zip: false,
        seeds: 2,
    };
    let device = Cpu::new();
    let experiment = Experiment::new(base, grid, device.info(), &ReferenceRule::Auto, None);
    let experiment = experiment.expect("an experiment");
    experiment.references(&|_| true).expect("references")
}

/// Knobs of sampling in the file and on the command line, and as an axis.
const SAMPLING: &str = "[light]\nsampler = \"gaussian\"\n[interruption]\nrule = \"survival\"\nweight = \"literal\"\n[scatter]\nbound = \"clamp\"\n";

#[test]
fn what_decides_the_sampling_is_the_presets() {
    let text = format!("{SCENE}{SAMPLING}");
    let sets = [
        "render.preset=montelight",
        "render.clamp=2",
        "light.direct=lambert",
        "render.max_bounces=3",
        "materials.white.survival=0.5",
    ];
    let all = references(base(&text, &sets), &["light.weight=pdf,solid-angle"]);
    assert_eq!(all.len(), 1);
    let scene = all[0].scene();
    let reference = Settings::of(Preset::Reference);
    let settings = &scene.settings;
    assert_eq!(settings.light, reference.light);
    assert_eq!(settings.scatter, reference.scatter);
    assert_eq!(settings.interruption, reference.interruption);
    assert_eq!(settings.render.clamp, None);
    assert!(!settings.biased());
    assert!(
        scene
            .materials
            .iter()
            .all(|material| material.survival == 1.0)
    );
    // What decides the expected picture is the scene's and the command line's.
    assert_eq!(settings.render.max_bounces, 3);
    assert_eq!(settings.image.filter, Filter::Tent);
    assert_eq!((settings.image.width, settings.image.height), (16, 16));
    // Its seed is none of the runs', its samples are theirs together: 4 runs of 64.
    assert_eq!(settings.render.seed, 40 + (1 << 63));
    assert_eq!((all[0].samples, all[0].paths), (256, 256 * 256));
}

#[test]
fn what_is_the_same_picture_shares_a_reference() {
    for axis in [
        "materials.white.survival=0.5,0.9",
        "image.exposure=0,1",
        "image.encoding=srgb,gamma22",
        "render.samples=4,8",
        "light.pole=[0,1,0],receiver",
        "render.clamp=off,2",
        "render.preset=corrected,reference",
        "interruption.start=0,3",
    ] {
        assert_eq!(references(base(SCENE, &[]), &[axis]).len(), 1, "{axis}");
    }
}

#[test]
fn what_is_another_picture_has_its_own() {
    for axis in [
        "materials.white.albedo=[0.2,0.2,0.2],[0.8,0.8,0.8]",
        "materials.white.spread=0.1,0.3",
        "spheres.0.radius=0.2,0.4",
        "boxes.0.rotation=[0,0,0],[0,9,0]",
        "render.max_bounces=1,2",
        "image.filter=box,tent",
        "camera.fov=30,50",
        "background.emission=[0,0,0],[1,1,1]",
        // Two filters.
        "render.preset=paper,corrected",
    ] {
        let all = references(base(SCENE, &[]), &[axis, "light.sampler=cone,gaussian"]);
        assert_eq!(all.len(), 2, "{axis}");
        assert_ne!(all[0].id, all[1].id);
        let path = axis.split('=').next().expect("a path");
        assert!(all[1].name.contains(path), "{}", all[1].name);
        assert!(!all[1].name.contains("sampler"), "{}", all[1].name);
    }
}

/// Seeds change no expected picture, whether repeated or swept.
#[test]
fn seeds_share_a_reference_of_another_seed() {
    let grid = Grid {
        axes: vec![Axis::parse("render.seed=1,2,3").expect("an axis")],
        zip: false,
        seeds: 1,
    };
    let device = Cpu::new();
    let rule = ReferenceRule::Samples(40);
    let experiment = Experiment::new(base(SCENE, &[]), grid, device.info(), &rule, None);
    let all = experiment.expect("an experiment").references(&|_| true);
    let all = all.expect("references");
    assert_eq!((all.len(), all[0].samples), (1, 40));
    assert_eq!(all[0].scene().settings.render.seed, 40 + (1 << 63));
}

/// How numbers fill their space changes no expected picture, and the reference has room for few samples.
#[test]
fn sequences_share_a_reference() {
    let axes = [
        "render.sequence=independent,sobol,stratified",
        "render.samples=64",
    ];
    assert_eq!(references(base(SCENE, &[]), &axes).len(), 1);
    let axes = ["render.randomisations=2,8", "render.samples=64"];
    assert_eq!(
        references(base(SCENE, &["render.sequence=sobol"]), &axes).len(),
        1
    );
}
