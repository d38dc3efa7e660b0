//! Scenes with more nodes than an old software driver lets loops have iterations: they are traced whole,
//! or refused in words.

use super::crowds::{bodies, empty};
use crate::support::bench::{Bench, benches};
use crate::support::gpu;
use crate::support::stream::Stream;
use glam::DVec3;
use lampray::Error;
use lampray::device::Device;
use lampray::pack::{Feature, Packed, Rect, Tally};
use lampray::scene::{Scene, Sphere};

const SIDE: u32 = 8;
const WHOLE: Rect = Rect {
    x0: 0,
    y0: 0,
    x1: SIDE,
    y1: SIDE,
};

fn traced(device: &mut dyn Device, scene: &Packed) -> lampray::Result<(Vec<Tally>, Vec<Feature>)> {
    device.load(scene)?;
    Ok((device.trace(WHOLE, 0, 4)?, device.features(WHOLE)?))
}

fn packed(mut scene: Scene) -> Packed {
    (scene.settings.image.width, scene.settings.image.height) = (SIDE, SIDE);
    Packed::new(&scene)
}

fn mean(tallies: &[Tally]) -> f64 {
    let sum: f64 = tallies.iter().map(|tally| f64::from(tally.mean[1])).sum();
    sum / tallies.len() as f64
}

/// A million small bodies: the first hits of both devices are the same bodies.
#[test]
fn a_million_bodies_are_traced() {
    let mut scene = empty("bvh");
    scene.spheres = bodies("walls", (1 << 20) - 6, &mut Stream::new(40)).0;
    for sphere in &mut scene.spheres[..(1 << 20) - 6] {
        sphere.radius *= 0.1;
    }
    scene.spheres[0].radius = 0.4;
    scene.spheres[0].material = 2;
    let scene = packed(scene);
    let both: Vec<_> = benches()
        .into_iter()
        .map(|bench| bench.with(|device| traced(device, &scene)).unwrap())
        .collect();
    let (tallies, features) = &both[0];
    assert!(tallies.iter().all(|tally| tally.rays >= 4));
    assert!(features.iter().all(|feature| feature.id > 0));
    for (other, other_features) in &both[1..] {
        let pairs = features.iter().zip(other_features);
        let unlike = pairs.filter(|(a, b)| a.id != b.id).count();
        assert!(unlike <= 2, "{unlike} first hits differ");
        // Rounding takes paths apart at later hits, among so many bodies, but not all of them.
        let near = |a: f32, b: f32| (a - b).abs() <= 1e-3 * a.abs();
        let pairs = tallies.iter().zip(other);
        let alike = pairs.filter(|(a, b)| a.rays == b.rays && near(a.mean[1], b.mean[1]));
        let alike = alike.count();
        assert!(2 * alike > tallies.len(), "only {alike} pixels are alike");
    }
}

/// Spheres around one centre, seen from there: no box can be passed over, so that a ray looks at
/// every node. Where that is more than a driver lets a kernel do, it says so.
fn onion(layers: usize) -> Packed {
    let mut scene = empty("bvh");
    let layer = |index: usize| Sphere {
        center: DVec3::new(0.0, 0.0, -0.1),
        radius: 1.0 + 1e-6 * index as f64,
        material: 0,
    };
    scene.spheres = (0..layers).rev().map(layer).collect();
    scene.settings.render.max_bounces = 0;
    packed(scene)
}

#[test]
fn every_node_may_be_looked_at() {
    for layers in [3000, 40_000] {
        let scene = onion(layers);
        for bench in benches() {
            let (tallies, features) = bench.with(|device| match traced(device, &scene) {
                Ok(all) => all,
                Err(Error::Device(reason)) if layers > 3000 => {
                    assert!(reason.contains("65,535 loop iterations"), "{reason}");
                    Default::default()
                }
                Err(error) => panic!("{bench:?}: {error}"),
            });
            // The last in the file is the smallest.
            assert!(
                features.iter().all(|feature| feature.id == layers as u32),
                "{bench:?}"
            );
            assert!(tallies.iter().all(|tally| tally.rays == 4), "{bench:?}");
        }
    }
}

/// What a lane leaves undone is traced again in smaller pieces, whatever the split: many lamps make
/// paths that no software driver of old takes sixteen of at once.
#[test]
fn pieces_of_pieces_are_the_same_samples() {
    let Some(mut gpu) = gpu("paths that need many iterations") else {
        return;
    };
    let mut scene = empty("bvh");
    scene.spheres = bodies("walls", 500, &mut Stream::new(41)).0;
    for lamp in scene.spheres.iter_mut().take(12) {
        lamp.material = 2;
    }
    let scene = packed(scene);
    let one = |tallies: &[Tally]| tallies.iter().map(|tally| tally.mean).collect::<Vec<_>>();
    gpu.load(&scene).unwrap();
    let together = gpu.trace(WHOLE, 0, 32).unwrap();
    for (run, first) in [(0, 0), (1, 16)] {
        let alone = gpu.trace(WHOLE, first, 16).unwrap();
        assert_eq!(
            one(&together[run * WHOLE.area()..][..WHOLE.area()]),
            one(&alone)
        );
    }
    let corner = Rect {
        x0: 3,
        y0: 5,
        x1: 4,
        y1: 7,
    };
    let pixels = gpu.trace(corner, 0, 16).unwrap();
    for (pixel, place) in pixels.iter().zip([5 * SIDE + 3, 6 * SIDE + 3]) {
        assert_eq!(*pixel, together[place as usize]);
    }
    let twin = Bench::Twin.with(|device| {
        device.load(&scene)?;
        device.trace(WHOLE, 0, 32)
    });
    let apart = mean(&twin.unwrap()) / mean(&together) - 1.0;
    assert!(apart.abs() < 0.1, "{apart}");
}
