//! Twin of `shaders/efficiency.wgsl`: how many rays should leave a hit so that the whole picture gains most
//! for its cost.

use super::maths::{greater, lesser};
use crate::pack::Worth;
use glam::Vec3;

/// Below this no path is thinned out, so that what the pilot never saw is not lost.
const LEAST_CONTINUATIONS: f32 = 0.05;

/// The number of rays that should leave a hit, at most `most`.
pub fn wanted_continuations(worth: &Worth, throughput: Vec3, most: f32) -> f32 {
    let squared = throughput * throughput;
    let split = squared.dot(worth.split.into()).sqrt();
    let keep = squared.dot(worth.keep.into()).sqrt();
    lesser(
        greater(split, greater(lesser(keep, 1.0), LEAST_CONTINUATIONS)),
        most,
    )
}

/// A whole number with that expectation, for a number of at least 1 and u in [0, 1).
pub fn count_continuations(wanted: f32, u: f32) -> u32 {
    let least = wanted.floor();
    least as u32 + u32::from(u < wanted - least)
}
