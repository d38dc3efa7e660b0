//! Twin of `shaders/ray.wgsl`: a ray, what it crosses, and the rule for the body it starts on.

use super::maths::{greater, largest};
use glam::Vec3;

#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: Vec3,
    /// Unit length.
    pub direction: Vec3,
    /// 1 + index of the body that the ray starts on; 0 for none.
    pub source: u32,
    /// Whether the ray starts on that body's inner side.
    pub inside: bool,
}

/// Where a ray enters and leaves a convex body.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    pub near: f32,
    pub far: f32,
    pub met: bool,
}

/// The first distance at which a ray meets a body from the side it is on, or -1. A ray that leaves
/// a convex body outwards cannot meet it again; one on its inner side meets the far side, always.
pub fn first_distance(crossing: Crossing, ray: &Ray, body: u32) -> f32 {
    if ray.source == body {
        return if ray.inside {
            greater(crossing.far, 1e-30)
        } else {
            -1.0
        };
    }
    match crossing.met {
        true if crossing.near > 0.0 => crossing.near,
        true => crossing.far,
        false => -1.0,
    }
}

/// A point a few units in the last place off the surface, on the side that `normal` points to.
pub fn offset_origin(point: Vec3, normal: Vec3) -> Vec3 {
    point + normal * (largest(point.abs()) * 1e-6)
}
