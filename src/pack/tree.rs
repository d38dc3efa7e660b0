//! The bodies of a packed scene as a tree.

use super::{Cuboid, Sphere};
use crate::bvh::{BOX, Bounds, Encoded, NOT_SPHERE, Tree};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// The tree over spheres and boxes.
pub(super) fn tree(spheres: &[Sphere], boxes: &[Cuboid]) -> Tree {
    let round = spheres.par_iter().map(sphere_bounds);
    let bounds: Vec<_> = round.chain(boxes.par_iter().map(box_bounds)).collect();
    Tree::new(&bounds, |index| match spheres.get(index) {
        Some(sphere) => sphere_leaf(sphere),
        None => [(index - spheres.len()) as u32, 0, 0, NOT_SPHERE | BOX],
    })
}

/// The very numbers that the general kernel intersects.
fn sphere_leaf(sphere: &Sphere) -> Encoded {
    let [x, y, z] = sphere.center.map(f32::to_bits);
    [x, y, z, sphere.radius.to_bits()]
}

fn sphere_bounds(sphere: &Sphere) -> Bounds {
    let reach = DVec3::splat(f64::from(sphere.radius));
    Bounds::around(sphere.center.into(), reach)
}

/// Of rotated ones too: the axes of the others are the scene's.
fn box_bounds(shape: &Cuboid) -> Bounds {
    let axes = [shape.axis_x, shape.axis_y, shape.axis_z];
    let reach = axes.iter().zip(shape.half_size);
    let reach = reach.map(|(axis, half)| Vec3::from(*axis).as_dvec3().abs() * f64::from(half));
    Bounds::around(shape.center.into(), reach.sum())
}
