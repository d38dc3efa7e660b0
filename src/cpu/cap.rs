//! Twin of `shaders/cap.wgsl`: directions to a ball even by projected solid angle.

use super::maths::*;
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// The directions to a ball as a receiver with its normal upwards sees them.
#[derive(Clone, Copy, Debug)]
pub struct ProjectedCap {
    /// x along the ball's side of the horizon, z the receiver's normal.
    pub frame: Basis,
    /// Sine and cosine of the ball's half angle, and those of its middle above the horizon.
    pub sine: f32,
    pub cosine: f32,
    pub height: f32,
    pub side: f32,
    /// Areas of the ellipse that is drawn from, and of the lune; 0 where there is none.
    pub ellipse: f32,
    pub lune: f32,
    /// 1 - k, and the cubic for g.
    pub span: f32,
    pub cubic: [f32; 4],
}

const GAUSS_LOWER: Vec3 = Vec3::new(0.033_765_24, 0.169_395_31, 0.380_690_4);
const GAUSS_UPPER: Vec3 = Vec3::new(0.966_234_74, 0.830_604_7, 0.619_309_6);
const GAUSS_SHARES: Vec3 = Vec3::new(0.085_662_246, 0.180_380_79, 0.233_956_96);

fn lune_rim(cap: &ProjectedCap, v: f32) -> f32 {
    root(cap.cosine * cap.cosine + cap.sine * cap.sine * v * v)
}

fn lune_divisor(cap: &ProjectedCap, v: f32) -> f32 {
    lune_rim(cap, v) + cap.side * cap.cosine + cap.height.abs() * cap.sine * v
}

fn lune_law(cap: &ProjectedCap, e: f32) -> f32 {
    let v = 1.0 - cap.span + cap.span * e;
    v / (greater(lune_divisor(cap, v), 1e-30) * root(1.0 - 0.5 * cap.span * (1.0 - e)))
}

fn lune_cubic(cap: &ProjectedCap, e: f32) -> f32 {
    let [a, b, c, d] = cap.cubic;
    a + e * (b + e * (c + e * d))
}

fn lune_density(cap: &ProjectedCap, r: f32) -> f32 {
    let e = r * (2.0 - r);
    e * e * lune_cubic(cap, e)
}

fn lune_mass(cap: &ProjectedCap, r: f32) -> f32 {
    let at = |places: Vec3| Vec3::from(places.to_array().map(|x| lune_density(cap, r * x)));
    r * GAUSS_SHARES.dot(at(GAUSS_LOWER) + at(GAUSS_UPPER))
}

/// The ball whose middle is along `axis` and whose half angle has the squared sine `sine_squared`.
pub fn projected_cap(axis: Vec3, sine_squared: f32, normal: Vec3) -> ProjectedCap {
    let basis = basis_around(normal);
    let flat = Vec2::new(axis.dot(basis.x), axis.dot(basis.y));
    let side = flat.length();
    let toward = if side > 1e-30 {
        flat / greater(side, 1e-30)
    } else {
        Vec2::X
    };
    let frame = Basis {
        x: toward.x * basis.x + toward.y * basis.y,
        y: toward.x * basis.y - toward.y * basis.x,
        z: normal,
    };
    let height = axis.dot(normal);
    let sine = root(sine_squared);
    let mut cap = ProjectedCap {
        frame,
        sine,
        cosine: root(1.0 - sine_squared),
        height,
        side,
        ellipse: PI * sine_squared * greater(height, 0.0),
        lune: 0.0,
        span: 1.0,
        cubic: [0.0; 4],
    };
    let ratio = height.abs() / greater(sine, 1e-30);
    if ratio < 1.0 {
        add_lune(&mut cap, ratio, sine_squared);
    }
    cap
}

/// `ratio`: of the sine of the middle's height to that of the half angle.
fn add_lune(cap: &mut ProjectedCap, ratio: f32, sine_squared: f32) {
    let side = cap.side;
    let end = lesser(ratio * cap.cosine / greater(side, 1e-6), 1.0);
    let slope = greater(side * side * (1.0 + end), 1e-12);
    cap.span = lesser((1.0 - ratio) * (1.0 + ratio) / slope, 1.0);
    let [a, b, c, d] = [0.0, 0.25, 0.75, 1.0].map(|e| lune_law(cap, e));
    cap.cubic = [
        a,
        (-19.0 * a + 24.0 * b - 8.0 * c + 3.0 * d) / 3.0,
        (32.0 * a - 56.0 * b + 40.0 * c - 16.0 * d) / 3.0,
        (-16.0 * a + 32.0 * b - 32.0 * c + 16.0 * d) / 3.0,
    ];
    let span = cap.span;
    let scale = 2.0 * sine_squared * cap.sine * side * side * span * span * root(2.0 * span);
    cap.lune = scale * lune_mass(cap, 1.0);
}

fn nearer_place(cap: &ProjectedCap, r: f32, wanted: f32) -> f32 {
    let mass = lune_mass(cap, r);
    let slope = mass / (r * lune_density(cap, r));
    lesser(r * (wanted / mass).powf(slope), 1.0)
}

/// The r below which the share `u` of the lune's law lies.
fn lune_place(cap: &ProjectedCap, u: f32) -> f32 {
    let share = greater(u, 3e-8);
    let wanted = share * lune_mass(cap, 1.0);
    let r = nearer_place(cap, nearer_place(cap, share.powf(0.29), wanted), wanted);
    (r + (wanted - lune_mass(cap, r)) / lune_density(cap, r)).clamp(0.0, 1.0)
}

fn lune_width(cap: &ProjectedCap, e: f32) -> f32 {
    let v = 1.0 - cap.span + cap.span * e;
    let deep = cap.sine * cap.side * cap.span * e;
    deep * deep / greater(lune_divisor(cap, v), 1e-30)
}

fn sample_lune(cap: &ProjectedCap, u: Vec2) -> Vec3 {
    let across = 2.0 * u.x - 1.0;
    let r = lune_place(cap, across.abs());
    let half_turn = 0.5 * cap.span * (1.0 - r) * (1.0 - r);
    let y = 2.0 * cap.sine * root(half_turn * (1.0 - half_turn));
    let rim = lune_rim(cap, 1.0 - 2.0 * half_turn);
    let inward = u.y * lune_width(cap, r * (2.0 - r));
    let y = if across >= 0.0 { y } else { -y };
    Vec3::new(rim - inward, y, root(inward * (2.0 * rim - inward)))
}

fn sample_ellipse(cap: &ProjectedCap, u: Vec2) -> Vec3 {
    let place = root(u.x) * unit_circle(u.y);
    let below = cap.cosine * cap.height + cap.sine * cap.side * place.x;
    let up = root(below * below + cap.sine * cap.sine * (1.0 - u.x));
    let x = cap.cosine * cap.side - cap.sine * cap.height * place.x;
    Vec3::new(x, cap.sine * place.y, up)
}

/// A direction of unit length; any at all where the whole cap is below the horizon.
pub fn sample_projected_cap(cap: &ProjectedCap, u: Vec3) -> Vec3 {
    let by_ellipse = u.z * (cap.ellipse + cap.lune) < cap.ellipse || cap.lune == 0.0;
    let local = if by_ellipse {
        sample_ellipse(cap, Vec2::new(u.x, u.y))
    } else {
        sample_lune(cap, Vec2::new(u.x, u.y))
    };
    unit_vector_again(from_basis(cap.frame, local))
}

/// Inverse density by solid angle of a direction of the cap; 0 where the receiver's horizon hides it.
pub fn projected_cap_inverse_density(cap: &ProjectedCap, direction: Vec3) -> f32 {
    let up = cap.frame.z.dot(direction);
    let area = cap.ellipse + cap.lune;
    if up <= 0.0 || area == 0.0 {
        return 0.0;
    }
    let y = lesser(cap.frame.y.dot(direction).abs() / cap.sine, 1.0);
    let e = (root(1.0 - y * y) - 1.0 + cap.span) / cap.span;
    let within = e.clamp(1e-6, 1.0);
    let rim = lune_rim(cap, 1.0 - cap.span + cap.span * within);
    let width = lune_width(cap, within);
    let beyond = e > 0.0 && up * up < width * (2.0 * rim - width);
    let in_lune = cap.lune > 0.0 && (cap.height <= 0.0 || beyond);
    let made_up = lune_law(cap, within) / greater(lune_cubic(cap, within), 1e-30);
    area / up * if in_lune { made_up } else { 1.0 }
}
