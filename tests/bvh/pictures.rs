//! Whole pictures by both kernels on one device: byte-identical, with their first hits. And which kernel
//! a scene gets.

use super::crowds::{KINDS, crowd, empty};
use crate::support::bench::benches;
use crate::support::same::{rendering, same};
use lampray::pack::{Feature, Traversal};
use lampray::render::whole;
use lampray::scene::{Scene, Sphere};

fn ids(features: &[Feature]) -> usize {
    let mut ids: Vec<_> = features.iter().map(|feature| feature.id).collect();
    ids.sort_unstable();
    ids.dedup();
    ids.len()
}

#[test]
fn both_kernels_make_the_same_picture() {
    for bench in benches() {
        let mut seen = 0;
        for kind in KINDS {
            let [general, tree] = crowd(kind, 150, 30);
            let pair = [general, tree].map(|scene| bench.with(|device| rendering(device, &scene)));
            same(&pair[0], &pair[1], &format!("{bench:?}: {kind}"));
            seen += ids(pair[0].features.as_ref().unwrap());
        }
        assert!(seen > 60, "only {seen} bodies in sight");
    }
}

#[test]
fn the_ready_scenes_are_the_same_by_both_kernels() {
    for name in ["cornell", "three-balls", "montelight-complex"] {
        let path = format!("scenes/{name}.toml");
        let load = |kernel: &str| {
            let sets = [
                format!("render.kernel={kernel}"),
                "image.width=16".into(),
                "image.height=16".into(),
            ];
            let sets = sets.map(|set: String| lampray::scene::Assignment::parse(&set).unwrap());
            Scene::load(path.as_ref(), &sets).unwrap_or_else(|error| panic!("{error}"))
        };
        for bench in benches() {
            let pair = ["general", "bvh"]
                .map(|kernel| bench.with(|device| rendering(device, &load(kernel))));
            same(&pair[0], &pair[1], &format!("{bench:?}: {name}"));
            assert_eq!(pair[0].film.region, whole(&load("auto")));
        }
    }
}

#[test]
fn the_scene_alone_chooses_the_kernel() {
    let of = |kernel: &str, bodies: usize| {
        let mut scene = empty(kernel);
        let one = Sphere {
            center: glam::DVec3::ONE,
            radius: 1.0,
            material: 0,
        };
        scene.spheres = vec![one; bodies];
        Traversal::of(&scene)
    };
    for bodies in [0, 1, 10_000] {
        assert_eq!(of("general", bodies), Traversal::General);
        assert_eq!(of("bvh", bodies), Traversal::Bvh);
    }
    assert_eq!(
        (of("auto", 20), of("auto", 2000)),
        (Traversal::General, Traversal::Bvh)
    );
    let border = (20..2000)
        .find(|bodies| of("auto", *bodies) == Traversal::Bvh)
        .unwrap();
    assert_eq!(of("auto", border - 1), Traversal::General);
}
