//! Twin of `shaders/scene.wgsl`: what was hit, and what every traversal is.

use super::r#box::{box_face, box_local, box_world, intersect_box, safe_inverse};
use super::ray::{Crossing, Ray};
use super::sphere::sphere_normal;
use crate::pack::{Cuboid, Packed};
use glam::Vec3;

#[derive(Clone, Copy, Debug)]
pub struct Hit {
    pub distance: f32,
    /// 0: nothing.
    pub body: u32,
}

#[derive(Clone, Copy, Debug)]
pub struct Surface {
    pub point: Vec3,
    /// Faces the arriving ray.
    pub normal: Vec3,
    pub material: u32,
    /// 1 + index among the lamps; 0 for what is no lamp.
    pub lamp: u32,
    /// The body that was hit, and whether from inside it.
    pub body: u32,
    pub inside: bool,
    /// Place in the scene file: spheres from 1 on, then boxes.
    pub id: u32,
}

/// How rays find bodies.
pub trait Traversal {
    fn nearest_hit(&self, ray: &Ray) -> Hit;

    /// Whether anything but the body `target_body` stands nearer than `reach`.
    fn occluded(&self, ray: &Ray, reach: f32, target_body: u32) -> bool;
}

pub fn rotated_box_crossing(shape: &Cuboid, ray: &Ray) -> Crossing {
    let from_center = box_local(shape, ray.origin - Vec3::from(shape.center));
    let inverse = safe_inverse(box_local(shape, ray.direction));
    intersect_box(shape.half_size.into(), from_center, inverse)
}

#[inline(always)]
fn sphere_surface(scene: &Packed, hit: Hit, ray: &Ray) -> Surface {
    let sphere = &scene.spheres[(hit.body as usize).wrapping_sub(1)];
    let center = Vec3::from(sphere.center);
    let outward = sphere_normal(center, ray.origin + hit.distance * ray.direction);
    let inside = outward.dot(ray.direction) > 0.0;
    // The point is put back on the sphere: errors do not grow with the distance travelled.
    Surface {
        point: center + sphere.radius * outward,
        normal: if inside { -outward } else { outward },
        material: sphere.material,
        lamp: sphere.lamp,
        body: hit.body,
        inside,
        id: hit.body,
    }
}

#[inline(always)]
fn box_surface(scene: &Packed, hit: Hit, ray: &Ray) -> Surface {
    let index = (hit.body as usize).wrapping_sub(1 + scene.spheres.len());
    let shape = &scene.boxes[index];
    let rotated = index >= scene.strategy.box_count as usize;
    let (center, half_size) = (Vec3::from(shape.center), Vec3::from(shape.half_size));
    let (mut origin, mut direction) = (ray.origin - center, ray.direction);
    if rotated {
        (origin, direction) = (box_local(shape, origin), box_local(shape, direction));
    }
    let inside = ray.source == hit.body || origin.abs().cmplt(half_size).all();
    let side = if inside { direction } else { -direction };
    let face = box_face(half_size, origin + hit.distance * direction, side);
    let (mut point, mut outward) = (face.point, face.normal);
    if rotated {
        (point, outward) = (box_world(shape, point), box_world(shape, outward));
    }
    Surface {
        point: center + point,
        normal: if inside { -outward } else { outward },
        material: shape.material,
        lamp: shape.lamp,
        body: hit.body,
        inside,
        id: shape.id,
    }
}

/// Only for a hit of something.
#[inline(always)]
pub fn surface_at(scene: &Packed, hit: Hit, ray: &Ray) -> Surface {
    if hit.body as usize <= scene.spheres.len() {
        sphere_surface(scene, hit, ray)
    } else {
        box_surface(scene, hit, ray)
    }
}
