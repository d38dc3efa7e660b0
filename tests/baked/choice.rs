//! When a scene is baked, and what records say of it.

use crate::support::bench::{Bench, benches};
use crate::support::same::rendering;
use lampray::device::Device;
use lampray::pack::{Rect, Traversal};
use lampray::render::{Task, picture, render};
use lampray::scene::{Assignment, Scene};
use std::ops::ControlFlow;

fn cornell(sets: &[&str]) -> Scene {
    let sets: Vec<_> = sets
        .iter()
        .map(|set| Assignment::parse(set).unwrap())
        .collect();
    Scene::load("scenes/cornell.toml".as_ref(), &sets).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn auto_bakes_what_pays_for_it() {
    let of = |sets: &[&str]| Traversal::of(&cornell(sets));
    assert_eq!(of(&["render.samples=63"]), Traversal::General);
    assert_eq!(of(&["render.samples=64"]), Traversal::Baked);
    assert_eq!(
        of(&["render.samples=16", "image.width=512", "image.height=512"]),
        Traversal::Baked
    );
    // Short paths are less work.
    assert_eq!(
        of(&["render.samples=64", "render.max_bounces=2"]),
        Traversal::General
    );
    assert_eq!(
        of(&["render.samples=256", "render.max_bounces=0"]),
        Traversal::Baked
    );
    for (kernel, expected) in [("general", Traversal::General), ("bvh", Traversal::Bvh)] {
        let kernel = format!("render.kernel={kernel}");
        assert_eq!(of(&["render.samples=4096", &kernel]), expected);
    }
    assert_eq!(
        of(&["render.samples=1", "render.kernel=baked"]),
        Traversal::Baked
    );
}

#[test]
fn auto_bakes_few_bodies_alone() {
    let mut scene = cornell(&["render.samples=4096"]);
    let one = scene.spheres[1].clone();
    for (bodies, expected) in [
        (64, Traversal::Baked),
        (65, Traversal::General),
        (200, Traversal::Bvh),
    ] {
        scene
            .spheres
            .resize(bodies - scene.boxes.len(), one.clone());
        assert_eq!(Traversal::of(&scene), expected, "{bodies}");
    }
}

/// The same job has one kernel, whatever part of it is traced.
#[test]
fn parts_of_a_picture_are_traced_alike() {
    let scene = cornell(&["render.samples=128"]);
    let corner = Rect {
        x0: 0,
        y0: 0,
        x1: 2,
        y1: 2,
    };
    let part = Task {
        region: corner,
        samples: 3..5,
        ..Task::new(&scene)
    };
    for bench in benches() {
        let record = bench.with(|device| recorded(device, &part));
        let ran = if bench == Bench::Twin {
            "general"
        } else {
            "baked"
        };
        assert_eq!(record, ran, "{bench:?}");
    }
}

fn recorded(device: &mut dyn Device, task: &Task) -> String {
    let rendering = render(device, task, &mut |_| ControlFlow::Continue(())).unwrap();
    picture(task, device.info(), &rendering, &[]).record.kernel
}

/// Values that vary from run to run are no reason to compile each, unless that is asked for.
#[test]
fn one_of_many_scenes_is_not_baked_unasked() {
    let small = ["image.width=4", "image.height=4"];
    let scene = cornell(&["render.samples=16777216", small[0], small[1]]);
    assert_eq!(Task::new(&scene).traversal, Traversal::Baked);
    assert_eq!(Task::one_of_many(&scene).traversal, Traversal::General);
    let forced = cornell(&["render.kernel=baked", small[0], small[1]]);
    assert_eq!(Task::one_of_many(&forced).traversal, Traversal::Baked);
    for bench in benches() {
        let first = |task: Task<'_>| {
            let task = Task {
                samples: 0..2,
                ..task
            };
            bench.with(|device| recorded(device, &task))
        };
        assert_eq!(first(Task::one_of_many(&scene)), "general");
        let ran = if bench == Bench::Twin {
            "general"
        } else {
            "baked"
        };
        assert_eq!(first(Task::one_of_many(&forced)), ran);
    }
}

/// More scenes than pipelines are kept, in turn and back again.
#[test]
fn a_device_goes_through_many_baked_scenes() {
    let scenes: Vec<_> = (0..6)
        .map(|step| {
            let radius = format!("spheres.1.radius=0.3{step}");
            cornell(&[
                "render.kernel=baked",
                "image.width=4",
                "image.height=4",
                &radius,
            ])
        })
        .collect();
    for bench in benches() {
        bench.with(|device| {
            let first = rendering(device, &scenes[0]);
            let others = scenes.iter().map(|scene| rendering(device, scene).film);
            let films: Vec<_> = others.collect();
            assert!(films[0] == first.film);
            assert!(films[1..].iter().all(|film| *film != first.film));
            assert!(rendering(device, &scenes[0]).film == first.film);
        });
    }
}
