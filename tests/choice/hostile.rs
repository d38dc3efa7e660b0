//! Lamps as nobody would place them.

use super::sums::{CHOSEN, check_sums, packed};
use crate::support::bench::benches;
use crate::support::stream::Stream;
use glam::{DVec3, Vec3};
use lampray::film::Film;
use lampray::knobs::LightChoice;
use lampray::scene::{Assignment, Scene, Sphere};

/// The first material is as faint, and the second as bright, as scenes may say.
const ENDS: &str = "version = 1
camera = { position = [0.0, 0.5, 2.0], look_at = [0, 0, 0] }
image = { width = 8, height = 8 }
[materials]
faint = { albedo = [0, 0, 0], emission = [1e-30, 0, 0] }
bright = { albedo = [0, 0, 0], emission = [1e12, 1e12, 1e12] }
grey = { albedo = [0.5, 0.5, 0.5] }
[[boxes]]
min = [-5, -2, -5]
max = [5, -1, 5]
material = \"grey\"
";

type Lamps = Vec<(DVec3, f64, usize)>;

fn swarm(count: usize, size: f64, radius: f64) -> Lamps {
    let mut stream = Stream::new(91);
    let mut place = || size * stream.unit() * DVec3::from_array(stream.direction());
    (0..count)
        .map(|number| (place(), radius, number % 2))
        .collect()
}

/// Each farther and larger than the last, by half: powers from 1 to 1e30 times the faintest.
fn chain() -> Lamps {
    let lamp = |k: i32| (DVec3::X * 1.5_f64.powi(k), 0.1 * 1.5_f64.powi(k), 1);
    (0..60).map(lamp).collect()
}

fn all() -> Vec<(&'static str, Lamps)> {
    vec![
        ("one", swarm(1, 1.0, 0.1)),
        ("faint and bright", swarm(2, 1.0, 0.1)),
        ("many of both", swarm(200, 1.0, 0.01)),
        ("in one place", vec![(DVec3::ZERO, 0.1, 1); 70]),
        (
            "one inside the other",
            (1..40)
                .map(|k| (DVec3::ZERO, 0.02 * f64::from(k), 1))
                .collect(),
        ),
        ("smallest", swarm(50, 1.0, 1e-12)),
        ("largest", swarm(50, 1e12, 1e12)),
        ("farthest", swarm(50, 1e12, 1e-12)),
        (
            "on a line",
            (0..100)
                .map(|k| (DVec3::X * f64::from(k), 0.01, 1))
                .collect(),
        ),
        ("each larger", chain()),
    ]
}

#[test]
fn every_lamp_keeps_a_chance() {
    let at = [
        Vec3::ZERO,
        Vec3::new(0.1, 0.0, 0.0),
        Vec3::new(0.0, -1.0, 1.0),
        Vec3::splat(1e11),
    ];
    let normals = [Vec3::Y, -Vec3::Y, Vec3::X, Vec3::new(0.6, 0.0, -0.8)];
    let receivers: Vec<_> = at
        .into_iter()
        .flat_map(|p| normals.map(|n| (p, n)))
        .collect();
    for (name, lamps) in all() {
        for choice in CHOSEN {
            check_sums(
                &packed(choice, ENDS, &lamps),
                &receivers,
                &format!("{name} by {choice}"),
            );
        }
    }
}

fn scene(lamps: &Lamps, choice: &str) -> Scene {
    let set = Assignment::parse(&format!("light.choice={choice}")).unwrap();
    let mut scene = Scene::parse("hostile", ENDS, &[set]).unwrap();
    let sphere = |&(center, radius, material): &(DVec3, f64, usize)| Sphere {
        center,
        radius,
        material,
    };
    scene.spheres = lamps.iter().map(sphere).collect();
    scene
}

/// Nothing overflows that does not where every lamp is asked: their sum may be beyond 32-bit floats there.
#[test]
fn pictures_are_numbers() {
    for (name, lamps) in all() {
        for bench in benches() {
            let film = |choice: &str| -> Film { bench.film(&scene(&lamps, choice), 0..16) };
            let whole = film("all").non_finite;
            // Drawn alike, by tables of other numbers.
            for choice in ["power", "tree"] {
                let found = film(choice).non_finite;
                assert!(
                    found <= whole,
                    "{name} by {choice} on {bench:?}: {found} of {whole}"
                );
            }
        }
    }
}

/// A scene without lamps, and one whose lamps are hit alone, choose nothing.
#[test]
fn there_may_be_nothing_to_choose() {
    for bench in benches() {
        for choice in CHOSEN.map(|choice| choice.to_string()) {
            let dark = bench.film(&scene(&Lamps::new(), &choice), 0..4);
            assert_eq!(dark.picture_mean(), [0.0; 3]);
        }
    }
    let lamps = swarm(20, 1.0, 0.1);
    let set = |text: &str| Assignment::parse(text).unwrap();
    let mut scene = scene(&lamps, "tree");
    scene.settings.light.strategy = lampray::knobs::LightStrategy::Hit;
    assert!(lampray::pack::Packed::new(&scene).choice.entries.is_empty());
    let hit = [set("light.choice=tree"), set("light.strategy=hit")];
    assert!(Scene::parse("hit", ENDS, &hit).is_ok());
}

/// As many lamps as a scene may have bodies: within one storage buffer, and their paths within a word.
#[test]
fn a_million_lamps_fit() {
    let lamps = swarm(1 << 20, 1.0, 1e-4);
    for (choice, loops) in [(LightChoice::Power, 1), (LightChoice::Tree, 66)] {
        let packed = packed(choice, ENDS, &lamps);
        let bytes = packed.choice.entries.len() * 16;
        assert!(bytes <= 128 << 20, "{choice}: {bytes} bytes");
        assert!(
            packed.choice.loops <= loops,
            "{choice}: {}",
            packed.choice.loops
        );
    }
}
