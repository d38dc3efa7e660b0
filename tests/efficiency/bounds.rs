//! Scenes in which paths could split or go on without end, and such as a pilot learns nothing of.

use super::pilot::room;
use crate::support::bench::Bench;
use lampray::cpu::pilot::Pilot;
use lampray::pack::Worth;
use lampray::render::{Task, render};
use lampray::scene::Scene;
use std::ops::ControlFlow;

/// Rays but for shadow rays, here without lamps: at most the longest path for each.
fn rays(task: &Task) -> u64 {
    let rendering =
        Bench::Twin.with(|device| render(device, task, &mut |_| ControlFlow::Continue(())));
    let film = rendering.unwrap().film;
    assert_eq!(film.non_finite, 0);
    film.rays
}

fn closed(albedo: f64, max_bounces: u32, split: u32) -> Scene {
    let text = format!(
        "version = 1
        camera = {{ position = [0.3, -0.1, 0.2], look_at = [1.0, 0.5, -0.4] }}
        image = {{ width = 2, height = 2 }}
        render = {{ max_bounces = {max_bounces}, samples = 2 }}
        interruption = {{ rule = \"efficiency\", start = 0, split = {split} }}
        boxes = [
            {{ min = [-1, -1, -1], max = [1, 1, 1], material = \"wall\" }},
            {{ min = [-0.9, 0.8, -0.9], max = [-0.8, 0.9, -0.8], material = \"lamp\" }},
        ]
        [materials.wall]
        albedo = [{albedo}, {albedo}, {albedo}]
        [materials.lamp]
        albedo = [{albedo}, {albedo}, {albedo}]
        emission = [5, 5, 5]"
    );
    Scene::parse("closed", &text, &[]).unwrap()
}

/// Nothing absorbs and every body asks for more rays than there may be: each path takes all that it may, the steps
/// of so many branches, and no more.
#[test]
fn paths_that_never_fade_end_where_they_must() {
    for split in [1, 5, 16] {
        let scene = closed(1.0, 10_000, split);
        let task = Task::new(&scene);
        let worths = vec![
            Worth {
                split: [1e12; 3],
                keep: [1e12; 3],
                ..Worth::default()
            };
            2
        ];
        let pilot = Pilot {
            worths,
            paths: 0,
            rays: 0,
        };
        task.pilot.set(pilot).unwrap();
        let longest = task.packed().longest_path();
        assert_eq!(longest, 10_001 * u64::from(split));
        let taken = rays(&task);
        assert!(taken <= 8 * longest, "{taken} rays, split {split}");
        assert!(taken >= 8 * 10_001, "{taken} rays, split {split}");
    }
}

/// What a pilot finds of such a scene is finite, and found soon.
#[test]
fn a_pilot_of_a_scene_that_never_fades_is_bounded() {
    let scene = closed(1.0, 1_000_000, 16);
    let task = Task::new(&scene);
    let pilot = task.pilot().unwrap();
    let finite = |worth: &Worth| worth.split.iter().chain(&worth.keep).all(|x| x.is_finite());
    assert!(pilot.worths.iter().all(finite), "{:?}", pilot.worths);
    // A round is left behind the wave in which it has taken enough: 16 places, 6 samples of 16 branches each.
    let wave = 16 * 6 * 16 * 65;
    assert!(pilot.rays <= 6 * ((1 << 20) + wave), "{}", pilot.rays);
}

#[test]
fn scenes_without_light_or_bodies_are_black_and_end() {
    let dark = room(&[
        "materials.lamp.emission=[0,0,0]",
        "background.emission=[0,0,0]",
    ]);
    let task = Task::new(&dark);
    assert_eq!(task.pilot().unwrap().worths, vec![Worth::UNKNOWN; 6]);
    assert!(rays(&task) > 0);
    let text = "version = 1
        camera = { position = [0, 0, 1], look_at = [0, 0, 0] }
        image = { width = 4, height = 4 }
        background = { emission = [1, 1, 1] }
        interruption = { rule = \"efficiency\" }";
    let empty = Scene::parse("empty", text, &[]).unwrap();
    for bench in crate::support::bench::benches() {
        let film = bench.film(&empty, 0..16);
        assert_eq!(film.picture_mean(), [1.0; 3], "{bench:?}");
    }
}

/// Most of so many bodies are met by no path of a pilot: theirs is the worth of all.
#[test]
fn a_crowd_of_bodies_has_its_worths() {
    let ball = |i: usize| {
        let (x, y) = (i % 320, i / 320);
        let (x, y) = (0.01 * x as f64 - 1.6, 0.01 * y as f64 - 1.6);
        format!("{{ center = [{x}, {y}, -1], radius = 0.004, material = \"ball\" }},")
    };
    let balls: String = (0..100_000).map(ball).collect();
    let text = format!(
        "version = 1
        camera = {{ position = [0, 0, 1], look_at = [0, 0, 0] }}
        image = {{ width = 16, height = 16 }}
        background = {{ emission = [1, 1, 1] }}
        interruption = {{ rule = \"efficiency\", start = 0 }}
        materials.ball = {{ albedo = [0.5, 0.5, 0.5] }}
        spheres = [{balls}]"
    );
    let scene = Scene::parse("crowd", &text, &[]).unwrap();
    let task = Task::new(&scene);
    let worths = &task.pilot().unwrap().worths;
    assert_eq!(worths.len(), 100_000);
    let mut seen: Vec<_> = worths.iter().map(|worth| worth.keep[0].to_bits()).collect();
    seen.sort_unstable();
    seen.dedup();
    assert!(seen.len() > 100 && seen.len() < 50_000, "{}", seen.len());
    assert!(rays(&task) >= 256);
}
