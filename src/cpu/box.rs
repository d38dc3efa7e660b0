//! Twin of `shaders/box.wgsl`: rays against boxes, by slabs.

use super::maths::{greater, lesser};
use super::ray::Crossing;
use crate::pack::Cuboid;
use glam::Vec3;

/// Into the box's own axes.
pub fn box_local(shape: &Cuboid, v: Vec3) -> Vec3 {
    let dot = |axis: [f32; 3]| Vec3::from(axis).dot(v);
    Vec3::new(dot(shape.axis_x), dot(shape.axis_y), dot(shape.axis_z))
}

/// Back into the scene's axes.
pub fn box_world(shape: &Cuboid, v: Vec3) -> Vec3 {
    v.x * Vec3::from(shape.axis_x) + v.y * Vec3::from(shape.axis_y) + v.z * Vec3::from(shape.axis_z)
}

/// One over each component, with zero read as a tiny number.
pub fn safe_inverse(v: Vec3) -> Vec3 {
    let inverse = |x: f32| {
        let tiny = if x >= 0.0 { 1e-12 } else { -1e-12 };
        1.0 / if x.abs() < 1e-12 { tiny } else { x }
    };
    Vec3::new(inverse(v.x), inverse(v.y), inverse(v.z))
}

/// The far distance is padded (Ize, "Robust BVH Ray Traversal", JCGT 2013).
pub fn intersect_box(half_size: Vec3, from_center: Vec3, inverse: Vec3) -> Crossing {
    let middle = -from_center * inverse;
    let reach = half_size * inverse.abs();
    let enter = middle - reach;
    let leave = middle + reach;
    let near = greater(enter.x, greater(enter.y, enter.z));
    let far = lesser(leave.x, lesser(leave.y, leave.z)) * 1.000_000_2;
    Crossing {
        near,
        far,
        met: near <= far && far > 0.0,
    }
}

/// A point of a box and the outward normal there, in the box's own axes.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    pub point: Vec3,
    pub normal: Vec3,
}

/// The face nearest to `local`, with the point put on it; `outward` says on which side of each
/// axis the face must be.
pub fn box_face(half_size: Vec3, local: Vec3, outward: Vec3) -> Face {
    let depth = local.abs() - half_size;
    let axis = if depth.x >= depth.y && depth.x >= depth.z {
        0
    } else if depth.y >= depth.z {
        1
    } else {
        2
    };
    let side = if outward[axis] >= 0.0 { 1.0 } else { -1.0 };
    let mut face = Face {
        point: local.clamp(-half_size, half_size),
        normal: Vec3::ZERO,
    };
    face.point[axis] = side * half_size[axis];
    face.normal[axis] = side;
    face
}
