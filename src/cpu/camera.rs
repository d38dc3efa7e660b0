//! Twin of `shaders/camera.wgsl`: a camera at the origin, a pinhole or a thin lens.

use super::maths::{basis_around, root, unit_circle};
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

/// A point of the lens, even by area: a disc about the eye, across the direction of view.
pub fn sample_lens(camera: &Camera, u: Vec2) -> Vec3 {
    let basis = basis_around(camera.forward.into());
    let at = camera.aperture * root(u.x) * unit_circle(u.y);
    at.x * basis.x + at.y * basis.y
}

/// Unit direction from a point of the lens to where the ray from its middle through the same place
/// in the image meets the plane in focus.
pub fn lens_direction(camera: &Camera, film: Vec2, lens: Vec3) -> Vec3 {
    let at = film * Vec2::from(camera.pixel) - 1.0;
    let middle = Vec3::from(camera.forward)
        + at.x * Vec3::from(camera.right)
        + at.y * Vec3::from(camera.down);
    (camera.focus * middle - lens).normalize()
}
