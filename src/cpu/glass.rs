//! Twin of `shaders/glass.wgsl`: smooth clear glass.

use super::maths::{greater, root, unit_vector_again};
use glam::Vec3;

#[derive(Clone, Copy, Debug)]
pub struct Fresnel {
    /// Share of the light that is reflected.
    pub reflectance: f32,
    /// Cosine of the refracted direction; 0 where all is reflected.
    pub cosine: f32,
}

/// `cosine` is the arriving one, `ratio` the index on this side over the index beyond.
pub fn fresnel(cosine: f32, ratio: f32) -> Fresnel {
    let sine_squared = ratio * ratio * greater(1.0 - cosine * cosine, 0.0);
    let beyond = root(1.0 - sine_squared);
    let across = (ratio * cosine - beyond) / greater(ratio * cosine + beyond, 1e-30);
    let along = (cosine - ratio * beyond) / greater(cosine + ratio * beyond, 1e-30);
    Fresnel {
        reflectance: if sine_squared < 1.0 {
            0.5 * (across * across + along * along)
        } else {
            1.0
        },
        cosine: beyond,
    }
}

/// Where a ray goes on: reflected with the probability of its share, else by Snell's law to the other side.
pub fn sample_glass(index: f32, inside: bool, normal: Vec3, incoming: Vec3, u: f32) -> Vec3 {
    let ratio = if inside { index } else { 1.0 / index };
    let cosine = greater(-normal.dot(incoming), 0.0);
    let parts = fresnel(cosine, ratio);
    let direction = if u < parts.reflectance {
        incoming + 2.0 * cosine * normal
    } else {
        ratio * incoming + (ratio * cosine - parts.cosine) * normal
    };
    unit_vector_again(direction)
}
