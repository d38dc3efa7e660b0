//! Renderings that must be the same, bit for bit.

use lampray::device::Device;
use lampray::render::{Rendering, Task, render};
use lampray::scene::Scene;
use std::ops::ControlFlow;

/// Four samples of every pixel, with the first hits.
pub fn rendering(device: &mut dyn Device, scene: &Scene) -> Rendering {
    let task = Task {
        samples: 0..4,
        features: true,
        ..Task::new(scene)
    };
    render(device, &task, &mut |_| ControlFlow::Continue(()))
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Every pixel of two films and of their first hits is the same, bit for bit.
pub fn same(a: &Rendering, b: &Rendering, what: &str) {
    let pixels = (0..a.film.sums.len()).filter(|&pixel| {
        let of = |one: &Rendering| {
            (
                one.film.sums[pixel],
                one.film.squares[pixel],
                one.features.as_ref().unwrap()[pixel],
            )
        };
        of(a) != of(b)
    });
    let unlike: Vec<_> = pixels
        .map(|pixel| (pixel, a.film.sums[pixel], b.film.sums[pixel]))
        .collect();
    assert!(
        unlike.is_empty(),
        "{what}: {} pixels differ: {:?}",
        unlike.len(),
        &unlike[..unlike.len().min(4)]
    );
    assert_eq!(a.film.rays, b.film.rays, "{what}");
    assert!(a.film == b.film, "{what}");
}
