//! Twin of `shaders/canary.wgsl`, for the canaries that say something of a processor: what Rust itself
//! fixes, such as integers and loops, has no place here.

use super::maths::{sincos_turn, unit_circle};
use super::random::{random_bits, random_key};
use crate::knobs::Choice;
use crate::pack::CanaryJob;
use crate::shader::Canary;
use glam::Vec3;
use std::hint::black_box;

pub fn random_words(lane: u32) -> [u32; 4] {
    let pixel = [lane & 127, lane >> 7];
    let key = random_key(
        [lane, !lane],
        pixel,
        [lane.wrapping_mul(2_654_435_761), lane],
    );
    random_bits(key, lane & 7, lane >> 3)
}

/// As the tracing twin tells a radiance that is not finite.
fn finiteness(input: [u32; 4]) -> [u32; 4] {
    let [x, y, z, _] = input.map(f32::from_bits);
    let x = black_box(x * y + z);
    [
        u32::from(x.is_finite()),
        u32::from(Vec3::new(1.0, x, 2.0).is_finite()),
        u32::from(Vec3::new(1.0, 2.0, x).is_finite()),
        1,
    ]
}

fn denormal(input: [u32; 4]) -> [u32; 4] {
    let [x, y, z, _] = black_box(input).map(f32::from_bits);
    [x.to_bits(), (x * y).to_bits(), (x + z).to_bits(), 1]
}

fn floats(input: [u32; 4]) -> [u32; 4] {
    let [x, y, _, _] = black_box(input).map(f32::from_bits);
    if input[2] == 0 {
        return [x / y, x.sqrt(), 1.0 / x.sqrt(), 1.0].map(f32::to_bits);
    }
    let (turn, point) = (sincos_turn(x), unit_circle(y));
    [turn.x, turn.y, point.x, point.y].map(f32::to_bits)
}

/// The answers to a canary's inputs; none where the canary is none of a processor's.
pub fn canary(job: &CanaryJob, inputs: &[[u32; 4]]) -> Option<Vec<[u32; 4]>> {
    let answer: fn([u32; 4]) -> [u32; 4] = match Canary::ALL.get(job.canary as usize)? {
        Canary::Random => |input| random_words(input[0]),
        Canary::Finite => finiteness,
        Canary::Denormals => denormal,
        Canary::Floats => floats,
        Canary::Loops | Canary::Integers | Canary::Layout | Canary::Bounds | Canary::Conversion => {
            return None;
        }
    };
    Some(inputs.iter().copied().map(answer).collect())
}
