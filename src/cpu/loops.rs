//! Twin of `shaders/loops.wgsl`: every body is tried, four at a time.

use super::four::{Bodies, FourRay};
use super::ray::Ray;
use super::scene::{Hit, Traversal};
use glam::Vec4;

impl Traversal for Bodies {
    #[inline(always)]
    fn nearest_hit(&self, ray: &Ray) -> Hit {
        nearest_hit(self, ray)
    }

    #[inline(always)]
    fn occluded(&self, ray: &Ray, reach: f32, target_body: u32) -> bool {
        occluded(self, ray, reach, target_body)
    }
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
