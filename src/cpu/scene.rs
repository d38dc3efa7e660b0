//! Twin of `shaders/scene.wgsl`: nearest hit, any hit, and what was hit.

use super::r#box::{box_face, box_local, box_world};
use super::four::{Bodies, FourRay};
use super::ray::Ray;
use super::sphere::sphere_normal;
use crate::pack::Packed;
use glam::{Vec3, Vec4};

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

#[inline(always)]
pub fn nearest_hit(bodies: &Bodies, ray: &Ray) -> Hit {
    let mut distance = Vec4::splat(3e38);
    let mut body = Vec4::ZERO;
    bodies.visit(&FourRay::new(ray), |found, numbers| {
        let closer = found.cmpgt(Vec4::ZERO) & found.cmplt(distance);
        distance = Vec4::select(closer, found, distance);
        body = Vec4::select(closer, numbers, body);
        false
    });
    first_of_four(distance, body)
}

/// The nearest of four hits; of equal ones that of the first body, as one after the other finds it.
#[inline(always)]
fn first_of_four(distance: Vec4, body: Vec4) -> Hit {
    let (distance, body) = (distance.to_array(), body.to_array());
    let mut best = 0;
    for lane in 1..4 {
        let tie = distance[lane] == distance[best] && body[lane] < body[best];
        if distance[lane] < distance[best] || tie {
            best = lane;
        }
    }
    Hit {
        distance: distance[best],
        body: body[best] as u32,
    }
}

/// Whether anything but the body `target_body` stands nearer than `reach`.
#[inline(always)]
pub fn occluded(bodies: &Bodies, ray: &Ray, reach: f32, target_body: u32) -> bool {
    let (reach, target) = (Vec4::splat(reach), Vec4::splat(target_body as f32));
    let mut blocked = false;
    bodies.visit(&FourRay::new(ray), |found, numbers| {
        let near = found.cmpgt(Vec4::ZERO) & found.cmplt(reach);
        blocked = (near & !numbers.cmpeq(target)).any();
        blocked
    });
    blocked
}

#[inline(always)]
fn sphere_surface(scene: &Packed, hit: Hit, ray: &Ray) -> Surface {
    let sphere = &scene.spheres[hit.body as usize - 1];
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
    let index = hit.body as usize - 1 - scene.spheres.len();
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
        lamp: 0,
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
