//! Twin of `shaders/rectangle.wgsl`: boxes that shine, a direction to a face even by solid angle.

use super::r#box::{box_local, box_world};
use super::maths::*;
use crate::pack::Cuboid;
use glam::{Vec2, Vec3, Vec4};
use std::f32::consts::PI;

#[derive(Clone, Copy, Debug)]
pub struct BoxSample {
    pub direction: Vec3,
    /// How far the shadow ray must be free.
    pub distance: f32,
    /// Inverse density by solid angle; 0 where no face is seen.
    pub inverse_density: f32,
}

/// A face in its own axes, seen from the receiver.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    low: Vec2,
    size: Vec2,
    /// Above zero where the face is seen.
    height: f32,
}

/// Steradians below which points are drawn by area.
const SMALL_FACE: f32 = 3e-3;

/// The angle of (cosine, sine), sine >= 0, up to half a turn; the two need not be of unit length.
fn angle_of(cosine: f32, sine: f32) -> f32 {
    let inverse = 1.0 / greater(cosine * cosine + sine * sine, 1e-37).sqrt();
    let chord = sine * inverse * (2.0 / (1.0 + cosine.abs() * inverse)).sqrt();
    let angle = angle_of_chord(chord);
    if cosine >= 0.0 { angle } else { PI - angle }
}

/// A vector with `axis` as its third component and the next two before it.
fn turned(v: Vec3, axis: u32) -> Vec3 {
    match axis {
        0 => Vec3::new(v.y, v.z, v.x),
        1 => Vec3::new(v.z, v.x, v.y),
        _ => v,
    }
}

fn turned_back(v: Vec3, axis: u32) -> Vec3 {
    match axis {
        0 => Vec3::new(v.z, v.x, v.y),
        1 => Vec3::new(v.y, v.z, v.x),
        _ => v,
    }
}

/// The face across an axis: on the receiver's side of the box's middle, or on the far side.
fn box_rectangle(half_size: Vec3, local: Vec3, inside: bool, axis: u32, far: bool) -> Rectangle {
    let (size, place) = (turned(half_size, axis), turned(local, axis));
    let height = match (inside, far) {
        (true, true) => size.z + place.z.abs(),
        (false, true) => 0.0,
        (true, false) => size.z - place.z.abs(),
        (false, false) => place.z.abs() - size.z,
    };
    Rectangle {
        low: -size.truncate() - place.truncate(),
        size: 2.0 * size.truncate(),
        height,
    }
}

fn to_scale(face: Rectangle) -> Rectangle {
    let (low, high) = (face.low.abs(), (face.low + face.size).abs());
    let ends = greater(greater(low.x, low.y), greater(high.x, high.y));
    let scale = 1.0 / greater(greater(ends, face.height), 1e-30);
    Rectangle {
        low: face.low * scale,
        size: face.size * scale,
        height: face.height * scale,
    }
}

fn triangle_angle(a: Vec3, b: Vec3, c: Vec3, volume: f32) -> f32 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    2.0 * angle_of(below, volume)
}

/// Solid angle; 0 for a face that is not seen.
fn rectangle_angle(seen: Rectangle) -> f32 {
    if seen.height <= 0.0 {
        return 0.0;
    }
    let face = to_scale(seen);
    let (low, high, z) = (face.low, face.low + face.size, face.height);
    let volume = z * face.size.x * face.size.y;
    let (a, c) = (low.extend(z), high.extend(z));
    let first = triangle_angle(a, Vec3::new(high.x, low.y, z), c, volume);
    let second = triangle_angle(a, Vec3::new(low.x, high.y, z), c, volume);
    first + second
}

/// Solid angles of the three near faces and of the three far ones.
#[derive(Clone, Copy, Debug)]
struct BoxAngles {
    near: Vec3,
    far: Vec3,
}

fn box_angles(half_size: Vec3, local: Vec3, inside: bool) -> BoxAngles {
    let three = |far: bool| {
        let one = |axis| rectangle_angle(box_rectangle(half_size, local, inside, axis, far));
        Vec3::new(one(0), one(1), one(2))
    };
    BoxAngles {
        near: three(false),
        far: if inside { three(true) } else { Vec3::ZERO },
    }
}

fn all_angles(angles: BoxAngles) -> f32 {
    (angles.near + angles.far).dot(Vec3::ONE)
}

/// The face on whose stretch of the sum of all angles a number lies.
fn box_face_at(angles: BoxAngles, place: f32) -> u32 {
    let each = [angles.near.to_array(), angles.far.to_array()].concat();
    let (mut sum, mut face) = (each[0], 0);
    for (number, &angle) in each.iter().enumerate().skip(1) {
        if place >= sum && angle > 0.0 {
            face = number as u32;
        }
        sum += angle;
    }
    face
}

/// A point of a face, even by solid angle.
fn sample_spherical(seen: Rectangle, angle: f32, u: Vec2) -> Vec2 {
    let face = to_scale(seen);
    let (low, high, z) = (face.low, face.low + face.size, face.height);
    let (low_square, high_square) = (low.y * low.y, high.y * high.y);
    let upper = angle_of(low.x * high.y, z * Vec3::new(low.x, high.y, z).length());
    let lower = angle_of(-low.x * low.y, z * low.extend(z).length());
    let turn = sincos_turn(((u.x * angle + PI - upper - lower) / (2.0 * PI)).clamp(-0.5, 0.5));
    let b = Vec2::new(
        -low.y / (low_square + z * z).sqrt(),
        high.y / (high_square + z * z).sqrt(),
    );
    let sine = match turn.x.abs() < 1e-12 {
        true if turn.x >= 0.0 => 1e-12,
        true => -1e-12,
        false => turn.x,
    };
    let slope = ((turn.y * b.x + b.y) / sine).clamp(-1e15, 1e15);
    let square = slope * slope - z * z / (low_square + z * z);
    let across = z / greater(square, 1e-12).sqrt();
    let x = if slope > 0.0 { across } else { -across }.clamp(low.x, high.x);
    let depth = x * x + z * z;
    let start = low.y / (low_square + depth).sqrt();
    let end = high.y / (high_square + depth).sqrt();
    let h = start + u.y * (end - start);
    let y = h * depth.sqrt() / greater((1.0 - h) * (1.0 + h), 1e-12).sqrt();
    let point = Vec2::new(x, y.clamp(low.y, high.y)) - low;
    seen.low + point / face.size * seen.size
}

/// Inverse density of a point of a face by solid angle, the face chosen by its share of `total`.
fn face_inverse_density(face: Rectangle, angle: f32, total: f32, point: Vec2) -> f32 {
    if angle >= SMALL_FACE {
        return total;
    }
    let to = point.extend(face.height);
    let squared = greater(to.dot(to), 1e-36);
    let by_area = face.size.x / squared * face.size.y * (face.height / squared.sqrt());
    by_area * total / greater(angle, 1e-36)
}

/// `inside`: whether `origin` is inside the box.
pub fn sample_box(shape: &Cuboid, origin: Vec3, inside: bool, u: Vec4) -> BoxSample {
    let half_size = Vec3::from(shape.half_size);
    let local = box_local(shape, origin - Vec3::from(shape.center));
    let angles = box_angles(half_size, local, inside);
    let total = all_angles(angles);
    let chosen = box_face_at(angles, u.z * total);
    let (axis, far) = (chosen % 3, chosen >= 3);
    let angle = turned(if far { angles.far } else { angles.near }, axis).z;
    let face = box_rectangle(half_size, local, inside, axis, far);
    let u = Vec2::new(u.x, u.y);
    let point = if angle >= SMALL_FACE {
        sample_spherical(face, angle, u)
    } else {
        face.low + u * face.size
    };
    let outward = turned(local, axis).z >= 0.0;
    let upward = (inside && !far) == outward;
    let height = if upward { face.height } else { -face.height };
    let to = turned_back(point.extend(height), axis);
    let distance = to.length();
    let seen = face.height > 0.0 && total > 0.0;
    BoxSample {
        direction: box_world(shape, to / greater(distance, 1e-30)),
        distance,
        inverse_density: if seen {
            face_inverse_density(face, angle, total, point)
        } else {
            0.0
        },
    }
}

/// Inverse density with which [`sample_box`] draws the direction to the point of the box at `origin + to`, where
/// its outward unit normal is `outward`.
pub fn box_inverse_density(
    shape: &Cuboid,
    origin: Vec3,
    inside: bool,
    to: Vec3,
    outward: Vec3,
) -> f32 {
    let half_size = Vec3::from(shape.half_size);
    let local = box_local(shape, origin - Vec3::from(shape.center));
    let normal = box_local(shape, outward);
    let slant = normal.abs();
    let axis = if slant.x >= slant.y && slant.x >= slant.z {
        0
    } else if slant.y >= slant.z {
        1
    } else {
        2
    };
    let outward = turned(normal, axis).z >= 0.0;
    let far = inside && outward != (turned(local, axis).z >= 0.0);
    let angles = box_angles(half_size, local, inside);
    let face = box_rectangle(half_size, local, inside, axis, far);
    let angle = turned(if far { angles.far } else { angles.near }, axis).z;
    let point = turned(box_local(shape, to), axis).truncate();
    face_inverse_density(face, angle, all_angles(angles), point)
}
