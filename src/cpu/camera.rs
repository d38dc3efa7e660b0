//! Twin of `shaders/camera.wgsl`: a pinhole camera at the origin.

use super::maths::root;
use crate::knobs::Filter;
use crate::pack::Camera;
use glam::{Vec2, Vec3};

/// Inverse of the tent's distribution function on [-1, 1]: density 1 - |x|.
pub fn tent(u: f32) -> f32 {
    let v = 2.0 * u;
    if v < 1.0 {
        root(v) - 1.0
    } else {
        1.0 - root(2.0 - v)
    }
}

/// Where in the image a path starts, in pixels from the upper left corner.
pub fn sample_film(filter: Filter, pixel: [u32; 2], u: Vec2) -> Vec2 {
    let corner = Vec2::new(pixel[0] as f32, pixel[1] as f32);
    match filter {
        Filter::Tent => Vec2::new(corner.x + tent(u.x), corner.y + 1.0 - tent(u.y)),
        Filter::Box => corner + u,
    }
}

/// Unit direction from the eye through a place in the image.
pub fn camera_direction(camera: &Camera, film: Vec2) -> Vec3 {
    let at = film * Vec2::from(camera.pixel) - 1.0;
    (Vec3::from(camera.forward) + at.x * Vec3::from(camera.right) + at.y * Vec3::from(camera.down))
        .normalize()
}
