//! Twin of `shaders/scene.wgsl`: nearest hit, any hit, and what was hit.

use super::r#box::*;
use super::ray::{Crossing, Ray, first_distance};
use super::sphere::{intersect_sphere, sphere_normal};
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

fn rotated_box_crossing(shape: &Cuboid, ray: &Ray) -> Crossing {
    let from_center = box_local(shape, ray.origin - Vec3::from(shape.center));
    let inverse = safe_inverse(box_local(shape, ray.direction));
    intersect_box(Vec3::from(shape.half_size), from_center, inverse)
}

/// Calls `visit` with the first distance to every body that the ray meets, and the body.
#[inline(always)]
fn for_each_distance(scene: &Packed, ray: &Ray, mut visit: impl FnMut(f32, u32)) {
    let mut body = 0;
    for sphere in &scene.spheres {
        body += 1;
        let crossing = intersect_sphere(Vec3::from(sphere.center), sphere.radius, ray);
        visit(first_distance(crossing, ray, body), body);
    }
    let inverse = safe_inverse(ray.direction);
    let (straight, rotated) = scene.boxes.split_at(scene.strategy.box_count as usize);
    for shape in straight {
        body += 1;
        let from_center = ray.origin - Vec3::from(shape.center);
        let crossing = intersect_box(Vec3::from(shape.half_size), from_center, inverse);
        visit(first_distance(crossing, ray, body), body);
    }
    for shape in rotated {
        body += 1;
        visit(
            first_distance(rotated_box_crossing(shape, ray), ray, body),
            body,
        );
    }
}

pub fn nearest_hit(scene: &Packed, ray: &Ray) -> Hit {
    let mut best = Hit {
        distance: 3e38,
        body: 0,
    };
    for_each_distance(scene, ray, |distance, body| {
        if distance > 0.0 && distance < best.distance {
            best = Hit { distance, body };
        }
    });
    best
}

/// Whether anything but the body `target_body` stands nearer than `reach`.
pub fn occluded(scene: &Packed, ray: &Ray, reach: f32, target_body: u32) -> bool {
    let mut blocked = false;
    for_each_distance(scene, ray, |distance, body| {
        blocked |= distance > 0.0 && distance < reach && body != target_body;
    });
    blocked
}

fn sphere_surface(scene: &Packed, hit: Hit, ray: &Ray) -> Surface {
    let sphere = &scene.spheres[hit.body as usize - 1];
    let center = Vec3::from(sphere.center);
    let outward = sphere_normal(center, ray.origin + hit.distance * ray.direction);
    let crossing = intersect_sphere(center, sphere.radius, ray);
    let inside = ray.source == hit.body || crossing.near <= 0.0;
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

fn box_surface(scene: &Packed, hit: Hit, ray: &Ray) -> Surface {
    let shape = &scene.boxes[hit.body as usize - 1 - scene.spheres.len()];
    let center = Vec3::from(shape.center);
    let half_size = Vec3::from(shape.half_size);
    let origin = box_local(shape, ray.origin - center);
    let direction = box_local(shape, ray.direction);
    let crossing = intersect_box(half_size, origin, safe_inverse(direction));
    let inside = ray.source == hit.body || crossing.near <= 0.0;
    let side = if inside { direction } else { -direction };
    let face = box_face(half_size, origin + hit.distance * direction, side);
    let outward = box_world(shape, face.normal);
    Surface {
        point: center + box_world(shape, face.point),
        normal: if inside { -outward } else { outward },
        material: shape.material,
        lamp: 0,
        body: hit.body,
        inside,
        id: shape.id,
    }
}

/// Only for a hit of something.
pub fn surface_at(scene: &Packed, hit: Hit, ray: &Ray) -> Surface {
    if hit.body as usize <= scene.spheres.len() {
        sphere_surface(scene, hit, ray)
    } else {
        box_surface(scene, hit, ray)
    }
}
