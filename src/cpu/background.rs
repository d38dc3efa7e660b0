//! Twin of `shaders/background.wgsl`: the background as a light.

use super::maths::greater;
use glam::Vec3;
use std::f32::consts::PI;

/// The slot of its random numbers: no lamp's.
pub const BACKGROUND_SLOT: u32 = 0xffff_ffff;

/// Inverse density by solid angle of `sample_cosine`.
pub fn background_inverse_density(normal: Vec3, direction: Vec3) -> f32 {
    let up = normal.dot(direction);
    if up > 0.0 {
        PI / greater(up, 1e-30)
    } else {
        1e30
    }
}
