//! Twin of `shaders/light_tree.wgsl`: one pair of a light tree.

use super::maths::{greater, root};
use glam::{Vec3, Vec4};

#[derive(Clone, Copy, Debug)]
pub struct LightPair {
    /// A sphere around the lamps of each group: centre, radius.
    pub first: Vec4,
    pub second: Vec4,
    /// What the groups send out; the ratio alone says something.
    pub power: [f32; 2],
    /// What stands below: another pair, or [`LEAF`] with a lamp.
    pub link: [u32; 2],
}

pub const LEAF: u32 = 0x8000_0000;
/// Shares are whole parts of this many.
pub const WHOLE_SHARE: u32 = 1 << 24;
/// No share is smaller.
pub const LEAST_SHARE: u32 = 1 << 12;
/// Below the horizon groups count as under this cosine.
const LEAST_COSINE: f32 = 0.015625;

/// What a group of unit power may bring to a point of a surface.
#[inline(always)]
fn nearness(ball: Vec4, point: Vec3, normal: Vec3) -> f32 {
    let to_center = ball.truncate() - point;
    let inverse = 1.0 / greater(to_center.dot(to_center), ball.w * ball.w).sqrt();
    let cosine = to_center.dot(normal) * inverse;
    let cone_sine = ball.w * inverse;
    let cone_cosine = root(1.0 - cone_sine * cone_sine);
    let highest = if cosine >= cone_cosine {
        1.0
    } else {
        cosine * cone_cosine + root(1.0 - cosine * cosine) * cone_sine
    };
    greater(highest, LEAST_COSINE) * inverse * inverse
}

/// How many parts of [`WHOLE_SHARE`] the first group has, seen from a point of a surface.
#[inline(always)]
pub fn first_share(pair: &LightPair, point: Vec3, normal: Vec3) -> u32 {
    let first = pair.power[0] * nearness(pair.first, point, normal);
    let second = pair.power[1] * nearness(pair.second, point, normal);
    let share = (first / (first + second) * WHOLE_SHARE as f32) as u32;
    share.clamp(LEAST_SHARE, WHOLE_SHARE - LEAST_SHARE)
}
