//! Twin of `shaders/maths.wgsl`.

use glam::{Vec2, Vec3};
use std::f32::consts::PI;

pub fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

pub fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

pub fn largest(v: Vec3) -> f32 {
    greater(v.x, greater(v.y, v.z))
}

/// A vector made one of unit length.
pub fn unit_vector(v: Vec3) -> Vec3 {
    v * (1.0 / v.dot(v).sqrt())
}

/// The same for one whose length is off by rounding only: one step of Newton's method.
pub fn unit_vector_again(v: Vec3) -> Vec3 {
    v * (1.5 - 0.5 * v.dot(v))
}

pub fn root(x: f32) -> f32 {
    greater(x, 0.0).sqrt()
}

/// Sine and cosine of x turns, -1/2 <= x <= 1/2, as (sin, cos).
pub fn sincos_turn(x: f32) -> Vec2 {
    let z = x * x;
    let s =
        x * (PI + z * (-5.167_710_3 + z * (2.550_077_7 + z * (-0.598_292_2 + z * 0.077_659_406))));
    let c = 1.0
        + z * (-4.934_802
            + z * (4.058_709 + z * (-1.335_212_1 + z * (0.234_937_56 + z * -0.024_396_716))));
    Vec2::new(2.0 * s * c, (c - s) * (c + s))
}

/// A point of the unit circle, (cos, sin), evenly distributed for even u in [0, 1).
pub fn unit_circle(u: f32) -> Vec2 {
    let turn = sincos_turn(u - 0.5);
    Vec2::new(turn.y, turn.x)
}

/// A point of the unit sphere, even by area.
pub fn unit_sphere(u: Vec2) -> Vec3 {
    let around = unit_circle(u.y);
    (2.0 * root(u.x * (1.0 - u.x)) * around).extend(1.0 - 2.0 * u.x)
}

/// A direction by its cosine to `normal`.
pub fn sample_cosine(normal: Vec3, u: Vec2) -> Vec3 {
    let sum = normal + unit_sphere(u);
    let size = sum.dot(sum);
    if size > 1e-12 {
        sum * (1.0 / size.sqrt())
    } else {
        normal
    }
}

/// 2 asin(chord / 2), up to a right angle.
pub fn angle_of_chord(chord: f32) -> f32 {
    let z = chord * chord;
    let tail =
        z * (5.382_144_8e-5 + z * (8.248_420_6e-5 + z * (-2.525_284_6e-5 + z * 7.172_082_3e-6)));
    chord * (1.0 + z * (0.041_667_69 + z * (0.004_677_552 + z * (7.340_854e-4 + tail))))
}

/// Inverse error function, 0 <= x < 1.
pub fn inverse_erf(x: f32) -> f32 {
    let w = -((1.0 - x) * (1.0 + x)).ln();
    if w < 5.0 {
        let a = w - 2.5;
        let high =
            2.172_605_5e-4 + a * (-4.253_934_5e-6 + a * (-3.177_755_2e-6 + a * 3.304_928_7e-7));
        return x
            * (1.501_409_2
                + a * (0.246_641_05 + a * (-0.004_176_085 + a * (-0.001_254_145_2 + a * high))));
    }
    let b = w.sqrt() - 3.0;
    let high =
        0.005_820_285_5 + b * (-0.003_412_726_8 + b * (0.001_129_532_3 + b * -1.325_071_4e-4));
    x * (2.832_977_3 + b * (1.001_680_9 + b * (0.009_427_444 + b * (-0.007_706_454 + b * high))))
}

/// Three perpendicular unit vectors; z is the one given.
#[derive(Clone, Copy, Debug)]
pub struct Basis {
    pub x: Vec3,
    pub y: Vec3,
    pub z: Vec3,
}

/// Duff et al., "Building an Orthonormal Basis, Revisited" (JCGT 2017).
pub fn basis_around(z: Vec3) -> Basis {
    let s = if z.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (s + z.z);
    let b = z.x * z.y * a;
    Basis {
        x: Vec3::new(1.0 + s * z.x * z.x * a, s * b, -s * z.x),
        y: Vec3::new(b, s + z.y * z.y * a, -z.y),
        z,
    }
}

pub fn from_basis(basis: Basis, v: Vec3) -> Vec3 {
    v.x * basis.x + v.y * basis.y + v.z * basis.z
}
