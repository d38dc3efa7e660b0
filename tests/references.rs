//! Pictures against stored references of 4096 samples a pixel, on both devices, by the verdict of
//! `lampray diff`: whatever is changed in the renderer, the expected image stays. `tests/references/make`
//! made them, and says with which command.

mod support;

use lampray::compare::verdict::{Outcome, Relation, Side, Sides, Terms, Verdict, judge};
use lampray::film::{Film, Picture, read_exr};
use lampray::pack::Rect;
use lampray::scene::{Assignment, Scene};
use support::bench::{Bench, benches};

/// Of one comparison; there are 14 of pictures that should be the same.
const TERMS: Terms = Terms {
    alpha: 0.001,
    margin: 0.02,
    tolerance: 1e-5,
};
/// Scenes, and the samples that show the margin; the references have others, for their seed is another.
const SCENES: [(&str, u64); 4] = [
    ("cornell", 256),
    ("three-balls", 512),
    ("many-lamps", 160),
    ("montelight-complex", 128),
];

fn reference(name: &str) -> Picture {
    let path = format!("{}/tests/references/{name}.exr", env!("CARGO_MANIFEST_DIR"));
    read_exr(path).unwrap_or_else(|error| panic!("{error}"))
}

fn scene(name: &str, sets: &[&str]) -> Scene {
    let own = ["image.width=64", "image.height=64", "render.seed=3"];
    let assignments: Vec<_> = own
        .iter()
        .chain(sets)
        .map(|set| Assignment::parse(set).unwrap_or_else(|error| panic!("{error}")))
        .collect();
    let path = format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Scene::load(path.as_ref(), &assignments).unwrap_or_else(|error| panic!("{error}"))
}

fn compare(reference: &Picture, film: &Film) -> Verdict {
    let pixels = 0..film.counts.len();
    let narrow = |value: [f64; 3]| value.map(|value| value as f32);
    let mean: Vec<_> = pixels
        .clone()
        .map(|pixel| narrow(film.mean(pixel)))
        .collect();
    let variance: Vec<_> = pixels.map(|pixel| narrow(film.variance(pixel))).collect();
    let samples: Vec<_> = film.counts.iter().map(|count| *count as f32).collect();
    let stored = Side {
        mean: &reference.mean,
        variance: &reference.variance,
        samples: &reference.samples,
        run: 1.0,
    };
    let test = Side {
        mean: &mean,
        variance: &variance,
        samples: &samples,
        run: 1.0,
    };
    let whole = Rect {
        x0: 0,
        y0: 0,
        x1: reference.width,
        y1: reference.height,
    };
    judge(&Sides::new(stored, test, whole, Relation::default()), TERMS)
}

fn outcome(bench: Bench, reference: &Picture, name: &str, sets: &[&str]) -> Verdict {
    let samples = SCENES
        .iter()
        .find(|(scene, _)| *scene == name)
        .map_or(0, |(_, samples)| *samples);
    let film = bench.film(&scene(name, sets), 0..samples);
    compare(reference, &film)
}

/// As it ships, and with other samplers that claim the same expected image.
#[test]
fn expected_images_stay() {
    let unbiased: &[&str] = &["render.preset=corrected", "interruption.rule=albedo"];
    for bench in benches() {
        for (name, _) in SCENES {
            let reference = reference(name);
            let biased = reference.record.biased;
            for sets in [&[][..], unbiased] {
                // A biased scene keeps its own rules.
                if biased && !sets.is_empty() {
                    continue;
                }
                let verdict = outcome(bench, &reference, name, sets);
                let margin = 100.0 * verdict.supported_margin;
                println!(
                    "{name} {sets:?} on {bench:?}: {:?}, means within {margin:.2} %",
                    verdict.outcome
                );
                assert_eq!(
                    verdict.outcome,
                    Outcome::Same,
                    "{name} {sets:?} {bench:?}: {verdict:#?}"
                );
            }
        }
    }
}

/// Renderers that are wrong by little: a lamp two percent brighter, walls one percent, a ball moved.
#[test]
fn wrong_images_are_found() {
    let mutants: [(&str, &[&str]); 4] = [
        (
            "cornell",
            &["materials.white.albedo=[0.7752, 0.765, 0.7446]"],
        ),
        ("cornell", &["spheres.1.center=[-0.42, 0.37, -0.42]"]),
        ("three-balls", &["materials.satin.spread=0.3"]),
        ("montelight-complex", &["interruption.weight=compensated"]),
    ];
    for bench in benches() {
        for (name, sets) in mutants {
            let verdict = outcome(bench, &reference(name), name, sets);
            assert_eq!(
                verdict.outcome,
                Outcome::Different,
                "{name} {sets:?} {bench:?}"
            );
        }
    }
}
