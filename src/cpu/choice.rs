//! Twin of `shaders/choice.wgsl`: which lamp a hit's shadow ray goes to, where it goes to one alone.

use super::light_tree::*;
use super::maths::greater;
use super::random::pcg4d;
use super::sequence::sequence_bits;
use crate::knobs::LightChoice;
use crate::pack::Packed;
use glam::{Vec3, Vec4};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chosen {
    pub lamp: u32,
    pub inverse_probability: f32,
}

/// By the alias table.
fn chosen_by_table(scene: &Packed, bits: [u32; 4]) -> Chosen {
    let table = &scene.choice.entries;
    let slot = (bits[0] >> 1) >> (31 - table.len().trailing_zeros());
    let [threshold, other, ..] = table[slot as usize];
    let lamp = if bits[1] < threshold { slot } else { other };
    Chosen {
        lamp,
        inverse_probability: 1.0 / f32::from_bits(table[lamp as usize][2]),
    }
}

fn light_pair_at(scene: &Packed, place: u32) -> LightPair {
    let place = 3 * place as usize;
    let [first, second, last] = [0, 1, 2].map(|part| scene.choice.entries[place + part]);
    LightPair {
        first: Vec4::from_array(first.map(f32::from_bits)),
        second: Vec4::from_array(second.map(f32::from_bits)),
        power: [f32::from_bits(last[0]), f32::from_bits(last[1])],
        link: [last[2], last[3]],
    }
}

/// Where a walk begins: at the first pair, or with a single lamp at its end.
fn light_root(scene: &Packed) -> u32 {
    if scene.lamps.len() == 1 { LEAF } else { 0 }
}

/// What is left of a probability after one more pair.
#[inline(always)]
fn taken(probability: f32, share: u32, second: bool) -> f32 {
    let parts = if second { WHOLE_SHARE - share } else { share };
    probability * (parts as f32 * (1.0 / WHOLE_SHARE as f32))
}

/// By the tree, from the first pair down, each with a number of its own.
fn chosen_by_tree(scene: &Packed, random: [u32; 4], point: Vec3, normal: Vec3) -> Chosen {
    let mut bits = random;
    let mut link = light_root(scene);
    let mut probability = 1.0;
    let mut level = 0_u32;
    while link & LEAF == 0 {
        let pair = light_pair_at(scene, link);
        let share = first_share(&pair, point, normal);
        let second = bits[0] >> 8 >= share;
        probability = taken(probability, share, second);
        link = pair.link[usize::from(second)];
        level = level.wrapping_add(1);
        bits.rotate_left(1);
        if level & 3 == 0 {
            bits = pcg4d(bits);
        }
    }
    Chosen {
        lamp: link & !LEAF,
        inverse_probability: 1.0 / greater(probability, 1e-30),
    }
}

/// One of the lamps, of which there must be some, for a point of a surface.
pub fn choose_lamp(
    scene: &Packed,
    key: [u32; 4],
    vertex: u32,
    point: Vec3,
    normal: Vec3,
) -> Chosen {
    let bits = sequence_bits(&scene.strategy, key, vertex, 2);
    match scene.strategy.light_choice {
        LightChoice::Tree => chosen_by_tree(scene, bits, point, normal),
        _ => chosen_by_table(scene, bits),
    }
}

/// The walk along the path to one lamp.
fn tree_probability(scene: &Packed, lamp: u32, point: Vec3, normal: Vec3) -> f32 {
    let paths = 3 * (scene.lamps.len() - 1);
    let mut path = scene.choice.entries[paths + lamp as usize / 4][lamp as usize & 3];
    let mut link = light_root(scene);
    let mut probability = 1.0;
    while link & LEAF == 0 {
        let pair = light_pair_at(scene, link);
        let second = path & 1 == 1;
        probability = taken(probability, first_share(&pair, point, normal), second);
        link = pair.link[usize::from(second)];
        path >>= 1;
    }
    probability
}

/// The probability with which [`choose_lamp`] gives this lamp; 1 where every lamp has its own shadow ray.
pub fn choice_probability(scene: &Packed, lamp: u32, point: Vec3, normal: Vec3) -> f32 {
    match scene.strategy.light_choice {
        LightChoice::All => 1.0,
        LightChoice::Tree => tree_probability(scene, lamp, point, normal),
        LightChoice::Uniform | LightChoice::Power => {
            f32::from_bits(scene.choice.entries[lamp as usize][2])
        }
    }
}
