//! Ray by ray on the twin: both kernels find the same body at the same distance, bit for bit.

use super::crowds::{KINDS, packed, vector};
use crate::support::stream::Stream;
use glam::{DVec3, Vec3};
use lampray::cpu::bvh::ByTree;
use lampray::cpu::four::Bodies;
use lampray::cpu::ray::{Ray, offset_origin};
use lampray::cpu::scene::{Traversal, surface_at};
use lampray::pack::Packed;

/// Numbers of what was found, so that no test passes on rays that meet nothing.
#[derive(Debug, Default)]
struct Counts {
    rays: usize,
    hits: usize,
    blocked: usize,
    own: usize,
}

/// A ray from somewhere near the bodies, or far away, at one of them or past its edge.
fn any_ray(scene: &Packed, stream: &mut Stream) -> Ray {
    let mut pick = || scene.spheres[stream.bits() as usize % scene.spheres.len()];
    let (at, from) = (pick(), pick());
    let center = |place: [f32; 3]| Vec3::from(place).as_dvec3();
    let away = f64::from(from.radius) * stream.scale(0.1, 1e4);
    let origin = (center(from.center) + vector(stream) * away).as_vec3();
    let edge = [0.0, 0.7, 1.0, 1.00001][stream.bits() as usize % 4];
    let target = center(at.center) + vector(stream) * f64::from(at.radius) * edge;
    let along = (target - origin.as_dvec3()).normalize_or(DVec3::X);
    let axis = DVec3::AXES[stream.bits() as usize % 3];
    let direction = if stream.bits().is_multiple_of(16) {
        axis
    } else {
        along
    };
    Ray {
        origin,
        direction: direction.as_vec3(),
        source: 0,
        inside: false,
    }
}

/// Compares the kernels on a ray, and on those that its path goes on with.
fn follow(general: &Packed, tree: &Packed, first: Ray, stream: &mut Stream, counts: &mut Counts) {
    let bodies = Bodies::new(general);
    let by_tree = ByTree {
        scene: tree,
        hierarchy: tree.hierarchy.as_ref().expect("a tree"),
    };
    let mut ray = first;
    for _ in 0..6 {
        let (hit, same) = (bodies.nearest_hit(&ray), by_tree.nearest_hit(&ray));
        let bits = |distance: f32| distance.to_bits();
        assert_eq!(
            (hit.body, bits(hit.distance)),
            (same.body, bits(same.distance)),
            "{ray:?}"
        );
        counts.rays += 1;
        counts.own += usize::from(hit.body != 0 && hit.body == ray.source);
        if hit.body == 0 {
            return;
        }
        counts.hits += 1;
        for (reach, target) in [
            (hit.distance, 0),
            (hit.distance * 1.5, hit.body),
            (hit.distance.next_up(), 0),
            (hit.distance.next_up(), hit.body),
        ] {
            let blocked = bodies.occluded(&ray, reach, target);
            assert_eq!(
                blocked,
                by_tree.occluded(&ray, reach, target),
                "{ray:?} {reach}"
            );
            counts.blocked += usize::from(blocked);
        }
        let surface = surface_at(general, hit, &ray);
        let out = vector(stream).as_vec3();
        let side = if out.dot(surface.normal) < 0.0 {
            -out
        } else {
            out
        };
        ray = Ray {
            origin: offset_origin(surface.point, surface.normal),
            direction: side,
            source: surface.body,
            inside: surface.inside,
        };
    }
}

#[test]
fn both_kernels_find_the_same() {
    let mut own = 0;
    for kind in KINDS {
        for (count, paths) in [(3, 500), (17, 1000), (300, 2000)] {
            let [general, tree] = packed(kind, count, 20);
            let (mut stream, mut counts) = (Stream::new(21), Counts::default());
            for _ in 0..paths {
                let first = any_ray(&general, &mut stream);
                follow(&general, &tree, first, &mut stream, &mut counts);
            }
            println!("{kind}, {count}: {counts:?}");
            assert!(
                counts.hits > paths / 8 && counts.blocked > paths / 8,
                "{counts:?}"
            );
            own += counts.own;
        }
    }
    assert!(
        own > 1000,
        "only {own} rays met the body they started inside of"
    );
}

/// The comparison can fail: a tree over bodies that have moved finds others.
#[test]
fn a_tree_of_another_scene_is_seen() {
    let [general, _] = packed("soup", 300, 20);
    let [_, other] = packed("soup", 300, 22);
    let mut stream = Stream::new(21);
    let first: Vec<_> = (0..50).map(|_| any_ray(&general, &mut stream)).collect();
    let caught = std::panic::catch_unwind(move || {
        for ray in first {
            follow(
                &general,
                &other,
                ray,
                &mut Stream::new(1),
                &mut Counts::default(),
            );
        }
    });
    assert!(caught.is_err());
}
