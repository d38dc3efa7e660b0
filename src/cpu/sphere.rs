//! Twin of `shaders/sphere.wgsl`: rays against spheres.

use super::maths::{root, unit_vector};
use super::ray::{Crossing, Ray};
use glam::Vec3;

/// Haines, Guenther and Akenine-Moeller, Ray Tracing Gems (2019), chapter 7.
pub fn intersect_sphere(center: Vec3, radius: f32, ray: &Ray) -> Crossing {
    let from_center = ray.origin - center;
    let b = -from_center.dot(ray.direction);
    let nearest = from_center + b * ray.direction;
    let discriminant = radius * radius - nearest.dot(nearest);
    let c = from_center.dot(from_center) - radius * radius;
    let half_chord = root(discriminant);
    let q = b + if b >= 0.0 { half_chord } else { -half_chord };
    let other = c / if q == 0.0 { 1e-30 } else { q };
    let (near, far) = if b >= 0.0 { (other, q) } else { (q, other) };
    Crossing {
        near,
        far,
        met: discriminant >= 0.0,
    }
}

/// Outward unit normal at the point of the sphere nearest to `point`.
pub fn sphere_normal(center: Vec3, point: Vec3) -> Vec3 {
    unit_vector(point - center)
}
