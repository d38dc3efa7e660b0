//! The tree by itself: its boxes hold what is below them, every order holds every body once, and
//! neither depends on the number of threads.

use super::crowds::{KINDS, bodies, empty, packed};
use crate::support::stream::Stream;
use glam::{DVec3, Vec3};
use lampray::bvh::{BOX, Bounds, Grid, HEADER, MOST_BYTES, NOT_SPHERE, Tree};
use lampray::pack::{Hierarchy, Packed};

/// What a body takes up, in f64 and by another way than the tree's own.
fn extent(scene: &Packed, body: u32) -> (DVec3, DVec3) {
    let index = body as usize - 1;
    if let Some(sphere) = scene.spheres.get(index) {
        let center = Vec3::from(sphere.center).as_dvec3();
        let radius = f64::from(sphere.radius);
        return (center - radius, center + radius);
    }
    let shape = &scene.boxes[index - scene.spheres.len()];
    let axes = [shape.axis_x, shape.axis_y, shape.axis_z].map(|axis| Vec3::from(axis).as_dvec3());
    let half = shape.half_size.map(f64::from);
    let center = Vec3::from(shape.center).as_dvec3();
    let corners = (0..8).map(|corner: u32| {
        let signed = |axis: usize| {
            axes[axis] * half[axis] * f64::from((corner >> axis & 1) * 2) - axes[axis] * half[axis]
        };
        center + signed(0) + signed(1) + signed(2)
    });
    let first = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    corners.fold(first, |(low, high), at| (low.min(at), high.max(at)))
}

/// Walks one order as a device would with every box entered, and checks that each node's subtree
/// ends where it says and lies in its box. The bodies met, and the boxes that were looked at.
fn walk(scene: &Packed, tree: &Tree, octant: usize) -> (Vec<u32>, usize) {
    let (grid, range) = (tree.grid(), tree.order(octant));
    let mut open: Vec<(usize, DVec3, DVec3)> = Vec::new();
    let (mut bodies, mut boxes) = (Vec::new(), 0);
    for place in range.clone() {
        open.retain(|(end, ..)| *end > place);
        let node = tree.nodes[place];
        if node[3] & (NOT_SPHERE | BOX) == NOT_SPHERE {
            let end = place + (node[3] & !NOT_SPHERE) as usize;
            let parent = open.last().map_or(range.end, |(end, ..)| *end);
            assert!(end > place + 2 && end <= parent, "a subtree ends elsewhere");
            assert_eq!(tree.bodies[place], 0);
            let (low, high) = grid.decode([node[0], node[1], node[2]]);
            open.push((end, low, high));
            boxes += 1;
            continue;
        }
        let body = tree.bodies[place];
        let (low, high) = extent(scene, body);
        // The extent of a rotated box is rounded here too.
        let rounding = 1e-13 * (low.abs() + high.abs()).max_element();
        for (_, box_low, box_high) in &open {
            let holds =
                low.cmpge(*box_low - rounding).all() && high.cmple(*box_high + rounding).all();
            assert!(
                holds,
                "body {body}: {low} {high} outside {box_low} {box_high}"
            );
        }
        bodies.push(body);
    }
    (bodies, boxes)
}

fn hierarchy(scene: &Packed) -> &Hierarchy {
    scene.hierarchy.as_ref().expect("a scene for the tree")
}

#[test]
fn boxes_hold_all_that_is_below_them_in_every_order() {
    for kind in KINDS {
        for count in [2, 18, 40, 3000] {
            let scene = &packed(kind, count, 7)[1];
            let tree = &hierarchy(scene).tree;
            assert_eq!(tree.orders(), 8);
            for octant in 0..8 {
                let (mut bodies, boxes) = walk(scene, tree, octant);
                let in_tree = bodies.len();
                assert_eq!(boxes, in_tree.saturating_sub(1), "{kind}");
                bodies.extend(&tree.outside);
                bodies.sort_unstable();
                let all = scene.spheres.len() + scene.boxes.len();
                assert!(bodies.into_iter().eq(1..all as u32 + 1), "{kind} {count}");
                assert!(
                    count < 3000 || in_tree > 2000,
                    "{kind}: {in_tree} in the tree"
                );
            }
        }
    }
}

/// The check above can fail: by a body that has moved, and by a skip that is one too far.
#[test]
fn a_tree_that_is_wrong_is_caught() {
    let scene = &packed("soup", 400, 8)[1];
    let mut moved = scene.clone();
    moved.spheres[100].center[1] += 50.0;
    let tree = hierarchy(scene).tree.clone();
    let inner = |node: &[u32; 4]| node[3] & (NOT_SPHERE | BOX) == NOT_SPHERE;
    let mut long = tree.clone();
    let place = HEADER + 1 + tree.nodes[HEADER + 1..].iter().position(inner).unwrap();
    long.nodes[place][3] = NOT_SPHERE | (2 * tree.order_length() as u32);
    for (scene, tree) in [(&moved, &tree), (scene, &long)] {
        let caught = std::panic::catch_unwind(|| walk(scene, tree, 0));
        assert!(caught.is_err());
    }
}

/// Grid lines are on the outer side of whatever they enclose, also where a cell is smaller than the
/// unit in the last place of where it lies.
#[test]
fn grid_lines_never_cut_anything_off() {
    let mut stream = Stream::new(9);
    for round in 0..20_000 {
        let center = Vec3::from_array(
            stream
                .direction()
                .map(|x| (x * stream.scale(1e-3, 1e6)) as f32),
        );
        let size = stream.scale(1e-6, 1e6);
        let reach = |stream: &mut Stream| DVec3::from_array([(); 3].map(|()| stream.unit() * size));
        let hull = Bounds::around(
            center,
            reach(&mut stream) + f64::from(round % 2 == 0) * size,
        );
        let grid = Grid::over(&hull);
        let within = |stream: &mut Stream| {
            let at = std::array::from_fn(|axis| {
                let (low, high) = (f64::from(hull.lower[axis]), f64::from(hull.upper[axis]));
                stream.between(low, high) as f32
            });
            Vec3::from_array(at).clamp(hull.lower, hull.upper)
        };
        let (a, b) = (within(&mut stream), within(&mut stream));
        let inner = Bounds {
            lower: a.min(b),
            upper: a.max(b),
        };
        for bounds in [inner, hull] {
            let (low, high) = grid.decode(grid.enclose(&bounds));
            assert!(
                low.cmple(bounds.lower.as_dvec3()).all(),
                "{bounds:?} {grid:?}"
            );
            assert!(
                high.cmpge(bounds.upper.as_dvec3()).all(),
                "{bounds:?} {grid:?}"
            );
            // And no more than a cell further out.
            let slack = 1.001 * grid.cell.as_dvec3() + 1e-12 * bounds.lower.as_dvec3().abs();
            assert!(
                (bounds.lower.as_dvec3() - low).cmple(slack).all(),
                "{bounds:?} {grid:?}"
            );
        }
    }
}

#[test]
fn a_tree_does_not_depend_on_the_threads() {
    for kind in ["soup", "one centre", "all sizes"] {
        let trees = [1, 2, 5].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap()
                .install(|| packed(kind, 30_000, 10)[1].hierarchy.clone().unwrap())
        });
        assert!(trees[0] == trees[1] && trees[0] == trees[2], "{kind}");
    }
}

/// What is large beside all others stands outside: the walls of a room, not a body of a heap.
#[test]
fn only_outsize_bodies_stand_outside() {
    let walls = &packed("walls", 2000, 11)[1];
    let outside = &hierarchy(walls).tree.outside;
    assert!(outside.iter().copied().eq(2001..2007), "{outside:?}");
    assert!(hierarchy(walls).tree.grid().cell.max_element() < 1e-3);
    let heap = &packed("soup", 2000, 11)[1];
    assert!(hierarchy(heap).tree.outside.is_empty());
}

/// The most bodies that a scene may have fit what every device can bind.
#[test]
fn a_million_bodies_fit() {
    let mut scene = empty("bvh");
    scene.spheres = bodies("flat", 1 << 20, &mut Stream::new(12)).0;
    scene.camera.look_at = scene.camera.position + glam::DVec3::new(-3.0, 0.1, 1.0);
    let packed = Packed::new(&scene);
    let tree = &hierarchy(&packed).tree;
    assert_eq!(tree.orders(), 4);
    let [_, x, y, z] = tree.nodes[2];
    assert_eq!([x, y, z], [1, 0, 2], "seen along x and z, hardly along y");
    assert!(size_of_val(tree.nodes.as_slice()) <= MOST_BYTES);
    assert_eq!(tree.order(3).end + 1, tree.nodes.len());
}
