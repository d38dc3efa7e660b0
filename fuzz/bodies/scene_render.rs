//! A scene file, then a small picture of it by the CPU twin.

use super::support;
use lampray::cpu::Cpu;
use lampray::device::Device;
use lampray::pack::Traversal;
use lampray::render::{self, Rendering, Task};
use lampray::scene::{Assignment, Scene};
use std::ops::ControlFlow;

/// What keeps one input under a second; everything else is as the scene says.
const BOUNDS: [&str; 3] = ["image.width=8", "image.height=8", "render.samples=2"];
const MOST_BOUNCES: u32 = 16;
/// Shadow rays of a hit go to all lamps, and each asks all bodies.
const MOST_BODIES: usize = 64;

pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let bounds = BOUNDS.map(|bound| Assignment::parse(bound).expect("an assignment"));
    let mut scene = match Scene::parse("fuzz.toml", text, &bounds) {
        Ok(scene) => scene,
        Err(error) => return support::refusal(&error),
    };
    if scene.spheres.len() + scene.boxes.len() > MOST_BODIES {
        return;
    }
    let bounces = &mut scene.settings.render.max_bounces;
    *bounces = (*bounces).min(MOST_BOUNCES);
    for traversal in [Traversal::General, Traversal::Bvh] {
        picture(&scene, traversal);
    }
}

fn picture(scene: &Scene, traversal: Traversal) {
    let mut device = Cpu::new();
    let task = Task {
        features: true,
        traversal,
        ..Task::new(scene)
    };
    let mut watch = |_: &Rendering| ControlFlow::Continue(());
    let rendering = render::render(&mut device, &task, &mut watch).expect("the CPU twin renders");
    assert!(rendering.complete());
    let film = &rendering.film;
    assert_eq!(film.paths, 8 * 8 * 2);
    assert!(film.non_finite <= film.paths);
    let picture = render::picture(&task, device.info(), &rendering, &[]);
    let fine = |value: &f32| value.is_finite() && *value >= 0.0;
    assert!(picture.mean.as_flattened().iter().all(fine));
    assert!(picture.variance.as_flattened().iter().all(fine));
}
