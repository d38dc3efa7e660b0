//! The bodies of a packed scene as a tree.

use super::{Cuboid, Sphere};
use crate::bvh::{BOX, Bounds, Encoded, NOT_SPHERE, Tree};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// The bodies of a scene as a device that walks a tree needs them.
#[derive(Clone, Debug, PartialEq)]
pub struct Hierarchy {
    pub tree: Tree,
    /// The spheres that stand outside the tree.
    pub spheres: Vec<Sphere>,
    /// The boxes that do, unrotated ones first.
    pub boxes: Vec<Cuboid>,
    /// How many of those are rotated.
    pub rotated: u32,
}

impl Hierarchy {
    /// Over the packed bodies of a scene, of whose boxes the first `straight` are unrotated,
    /// seen along `view`.
    pub(super) fn new(spheres: &[Sphere], boxes: &[Cuboid], straight: usize, view: Vec3) -> Self {
        let tree = tree(spheres, boxes, view);
        let outside = || tree.outside.iter().map(|body| *body as usize - 1);
        let round = outside().filter_map(|index| spheres.get(index).copied());
        let place = |index: usize| index.checked_sub(spheres.len());
        let rotated = outside()
            .filter_map(place)
            .filter(|place| *place >= straight)
            .count();
        let boxes = outside().filter_map(place).map(|place| boxes[place]);
        Self {
            spheres: round.collect(),
            boxes: boxes.collect(),
            rotated: rotated as u32,
            tree,
        }
    }
}

fn tree(spheres: &[Sphere], boxes: &[Cuboid], view: Vec3) -> Tree {
    let round = spheres.par_iter().map(sphere_bounds);
    let bounds: Vec<_> = round.chain(boxes.par_iter().map(box_bounds)).collect();
    Tree::new(&bounds, view, |index| match spheres.get(index) {
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
