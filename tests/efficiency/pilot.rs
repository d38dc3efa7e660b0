//! What a pilot finds depends on scene, knobs and seed alone.

use crate::support::bench::Bench;
use crate::support::gate::{Case, Form};
use lampray::cpu::pilot::Pilot;
use lampray::pack::{Rect, Worth};
use lampray::render::Task;
use lampray::scene::{Assignment, Scene};

/// A room with a lamp, a mirror and a matt ball; rays also leave it.
pub const ROOM: &str = "version = 1
    camera = { position = [0, 1, 3.4], look_at = [0, 1, 0] }
    image = { width = 24, height = 20 }
    render = { samples = 40 }
    background = { emission = [0.05, 0.06, 0.08] }
    interruption = { rule = \"efficiency\", start = 0 }
    materials.white = { albedo = [0.75, 0.7, 0.6] }
    materials.mirror = { scatter = \"mirror\", albedo = [0.9, 0.9, 0.9] }
    materials.gloss = { scatter = \"directional\", albedo = [0.3, 0.5, 0.8] }
    materials.lamp = { albedo = [0.2, 0.2, 0.2], emission = [9, 8, 7] }
    spheres = [
        { center = [0, 1.7, 0], radius = 0.15, material = \"lamp\" },
        { center = [-0.4, 0.4, -0.2], radius = 0.4, material = \"mirror\" },
        { center = [0.4, 0.3, 0.2], radius = 0.3, material = \"gloss\" },
    ]
    boxes = [
        { min = [-1, -0.1, -1], max = [1, 0, 1], material = \"white\" },
        { min = [-1, 0, -1.1], max = [1, 2, -1], material = \"white\" },
        { min = [-1.1, 0, -1], max = [-1, 2, 1], rotation = [0, 5, 0], material = \"white\" },
    ]";

pub fn room(sets: &[&str]) -> Scene {
    let assignments: Vec<_> = sets
        .iter()
        .map(|set| Assignment::parse(set).unwrap())
        .collect();
    Scene::parse("room", ROOM, &assignments).unwrap_or_else(|error| panic!("{error}"))
}

fn pilot(scene: &Scene) -> Pilot {
    Task::new(scene)
        .pilot()
        .expect("the rule asks for one")
        .clone()
}

#[test]
fn threads_change_no_bit_of_a_pilot() {
    let scene = room(&[]);
    let wanted = pilot(&scene);
    for threads in [1, 2, 3, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let found = pool.build().unwrap().install(|| pilot(&scene));
        assert_eq!(found, wanted, "{threads} threads");
    }
}

/// So that crops, ranges and stopped renders hold samples of one and the same picture.
#[test]
fn the_part_of_the_picture_changes_no_pilot() {
    let scene = room(&[]);
    let wanted = pilot(&scene);
    let region = Rect {
        x0: 3,
        y0: 2,
        x1: 9,
        y1: 7,
    };
    let part = Task {
        region,
        samples: 7..9,
        ..Task::new(&scene)
    };
    assert_eq!(part.pilot(), Some(&wanted));
    for knob in [
        "render.samples=3",
        "render.kernel=bvh",
        "render.kernel=baked",
    ] {
        assert_eq!(pilot(&room(&[knob])), wanted, "{knob}");
    }
    let others = [
        "render.seed=1",
        "light.strategy=hit",
        "interruption.split=2",
    ];
    for knob in others {
        assert_ne!(pilot(&room(&[knob])).hash(), wanted.hash(), "{knob}");
    }
}

#[test]
fn only_the_rule_that_learns_has_a_pilot() {
    for rule in ["none", "survival", "albedo", "throughput"] {
        let scene = room(&[&format!("interruption.rule={rule}")]);
        assert_eq!(Task::new(&scene).pilot(), None, "{rule}");
        assert!(Task::new(&scene).packed().worths.is_empty(), "{rule}");
    }
}

/// An enclosure in which all see the same and every reflection brings the same: only thinning paths out makes noise.
fn enclosure(albedo: f64) -> Scene {
    let scene = format!(
        "version = 1
        camera = {{ position = [0.3, -0.1, 0.2], look_at = [1.0, 0.5, -0.4] }}
        image = {{ width = 32, height = 32 }}
        render = {{ max_bounces = 3 }}
        light = {{ strategy = \"hit\" }}
        interruption = {{ rule = \"efficiency\", start = 0 }}
        spheres = [{{ center = [0, 0, 0], radius = 2, material = \"wall\" }}]
        [materials.wall]
        albedo = [{albedo}, {albedo}, {albedo}]
        emission = [1, 2, 3]"
    );
    Case::new("enclosure", scene, Form::Bits([0.0; 3])).scene(3)
}

#[test]
fn where_nothing_comes_back_nothing_is_known() {
    assert_eq!(pilot(&enclosure(0.0)).worths, [Worth::UNKNOWN]);
}

/// There the best is not to thin out, for then nothing is left of the noise; splitting never adds any.
#[test]
fn a_pilot_finds_what_leaves_no_noise() {
    let scene = enclosure(0.5);
    let worth = pilot(&scene).worths[0];
    let film = Bench::Twin.film(&scene, 0..32);
    let still = |pixel| film.variance(pixel).iter().all(|variance| *variance < 1e-9);
    assert!((0..film.counts.len()).all(still), "{worth:?}");
}
