//! Twin of `shaders/sequence.wgsl`: numbers that fill their space more evenly than chance, equal to the GPU's bit
//! for bit.

use super::random::{branch_key, pcg4d, random_bits, random_key};
use crate::knobs::Sequence;
use crate::pack::Strategy;
use std::array::from_fn;

/// Pixels along the side of a tile whose points are one set, as a power of two.
pub fn tile_bits(strategy: &Strategy) -> u32 {
    match strategy.sequence {
        Sequence::BlueNoise => ((32 - strategy.randomisation_bits) / 2).min(8),
        _ => 0,
    }
}

/// Morton's order of a tile's pixels.
fn z_order(pixel: [u32; 2]) -> u32 {
    let [x, y] = pixel.map(|mut v| {
        v = (v | v << 4) & 0x0f0f;
        v = (v | v << 2) & 0x3333;
        (v | v << 1) & 0x5555
    });
    x | y << 1
}

/// What one path draws its numbers from: a hash of what its set is made random by, and its index in the set.
#[inline(always)]
pub fn sequence_key(
    strategy: &Strategy,
    seed: [u32; 2],
    pixel: [u32; 2],
    sample: [u32; 2],
) -> [u32; 4] {
    if strategy.sequence == Sequence::Independent {
        return random_key(seed, pixel, sample);
    }
    set_key(strategy, seed, pixel, sample)
}

#[inline(never)]
fn set_key(strategy: &Strategy, seed: [u32; 2], pixel: [u32; 2], sample: [u32; 2]) -> [u32; 4] {
    let bits = strategy.randomisation_bits;
    let randomisation = [
        sample[0] >> bits | sample[1] << (32 - bits),
        sample[1] >> bits,
    ];
    let within = sample[0] & ((1 << bits) - 1);
    let tile = tile_bits(strategy);
    let place = z_order(pixel.map(|v| v & ((1 << tile) - 1)));
    let key = random_key(seed, pixel.map(|v| v >> tile), randomisation);
    let [x, y, z, _] = pcg4d(key);
    [x, y, z, place << bits | within]
}

/// A hash in which each bit depends on itself and on those below it (Laine and Karras 2011, Burley 2020, Vegdahl 2021).
fn laine_karras(bits: u32, seed: u32) -> u32 {
    let mut v = bits;
    v ^= v.wrapping_mul(0x3d20_adea);
    v = v.wrapping_add(seed);
    v = v.wrapping_mul(seed >> 16 | 1);
    v ^= v.wrapping_mul(0x0552_6c56);
    v ^ v.wrapping_mul(0x53a2_2864)
}

/// Owen's scrambling of a fraction whose bits are given in reverse, the first one lowest.
fn owen_scramble(reversed: u32, seed: u32) -> u32 {
    laine_karras(reversed, seed).reverse_bits()
}

/// The second dimension of Sobol's sequence, its bits in reverse: Pascal's triangle modulo 2.
pub fn second_dimension(index: u32) -> u32 {
    let mut v = index;
    v ^= v >> 16;
    v ^= (v & 0xff00_ff00) >> 8;
    v ^= (v & 0xf0f0_f0f0) >> 4;
    v ^= (v & 0xcccc_cccc) >> 2;
    v ^ (v & 0xaaaa_aaaa) >> 1
}

/// The images of 0, 1, 2 and 3, two bits each, in the six orders that leave 0 where it is.
fn order_of_three(number: u32) -> u32 {
    let orders: u32 = if number > 3 { 0x0000_b49c } else { 0x786c_d8e4 };
    orders >> (8 * (number & 3)) & 0xff
}

/// One of the 24 orders of four things, by a hash.
fn permuted_digit(digit: u32, hash: u32) -> u32 {
    let order = order_of_three((hash >> 8) % 6);
    order >> (2 * ((digit ^ hash) & 3)) & 3
}

/// A pixel's place in its tile, the digits of Morton's order shuffled, each by those above it (Ahmed and Wonka 2020).
fn shuffled_tile(strategy: &Strategy, index: u32, seed: u32) -> u32 {
    let bits = strategy.randomisation_bits;
    let mut shuffled = index & ((1 << bits) - 1);
    for digit in 0..tile_bits(strategy) {
        let shift = bits + 2 * digit;
        let from_here = index >> shift;
        let hash = pcg4d([from_here >> 2, digit, seed, 0])[0];
        shuffled |= permuted_digit(from_here & 3, hash) << shift;
    }
    shuffled
}

/// Sobol's first two dimensions, twice, scrambled.
fn sobol_bits(index: [u32; 2], shuffle: [u32; 2], scramble: [u32; 4]) -> [u32; 4] {
    let order: [u32; 2] = from_fn(|pair| owen_scramble(index[pair].reverse_bits(), shuffle[pair]));
    let [a, b] = order;
    let values = [a, second_dimension(a), b, second_dimension(b)];
    from_fn(|lane| owen_scramble(values[lane], scramble[lane]))
}

/// Some order of the numbers below 2^bits: nested from below, then from above.
fn permuted(number: u32, bits: u32, low: u32, high: u32) -> u32 {
    let mask = (1 << bits) - 1;
    let turned = (laine_karras(number, low) & mask).reverse_bits() >> (32 - bits);
    laine_karras(turned, high) & mask
}

/// Correlated multi-jittered points (Kensler 2013), twice.
fn stratified_bits(bits: u32, index: u32, seed: [u32; 4]) -> [u32; 4] {
    let rows = bits / 2;
    let columns = bits - rows;
    let other = pcg4d(seed);
    let more = pcg4d(other);
    let jitter = pcg4d([seed[0], seed[1], seed[2], index]);
    let mut all = [0; 4];
    for pair in 0..2 {
        let (x, y) = (2 * pair, 2 * pair + 1);
        let place = permuted(index, bits, seed[x], seed[y]);
        let (column, row) = (place & ((1 << columns) - 1), place >> columns);
        let stratum = [
            column << rows | permuted(row, rows, other[x], more[x]),
            row << columns | permuted(column, columns, other[y], more[y]),
        ];
        for (lane, stratum) in [x, y].into_iter().zip(stratum) {
            all[lane] = stratum << (32 - bits) | jitter[lane] >> bits;
        }
    }
    all
}

/// Four 32-bit numbers of a dimension, named as [`random_bits`] does.
#[inline(always)]
pub fn sequence_bits(strategy: &Strategy, key: [u32; 4], vertex: u32, slot: u32) -> [u32; 4] {
    if strategy.sequence == Sequence::Independent {
        return random_bits(key, vertex, slot);
    }
    set_bits(strategy, key, vertex, slot)
}

#[inline(never)]
fn set_bits(strategy: &Strategy, key: [u32; 4], vertex: u32, slot: u32) -> [u32; 4] {
    let [x, y, z, index] = key;
    let seed = pcg4d([x.wrapping_add(vertex), y.wrapping_add(slot), z, 0]);
    if strategy.sequence == Sequence::Stratified {
        return stratified_bits(strategy.randomisation_bits, index, seed);
    }
    let more = pcg4d(seed);
    let index = match strategy.sequence {
        Sequence::BlueNoise => [seed[3], more[3]].map(|seed| shuffled_tile(strategy, index, seed)),
        _ => [index; 2],
    };
    let scramble = [seed[1], seed[2], more[1], more[2]];
    sobol_bits(index, [seed[0], more[0]], scramble)
}

/// Four numbers in [0, 1).
#[inline(always)]
pub fn sequence_unit(strategy: &Strategy, key: [u32; 4], vertex: u32, slot: u32) -> [f32; 4] {
    sequence_bits(strategy, key, vertex, slot).map(|bits| (bits >> 8) as f32 * 5.960_464_5e-8)
}

/// What branch `branch`, counted from 1, of a path that splits draws its numbers from: as [`branch_key`] has it, or
/// another scrambling of the same set.
pub fn sequence_branch(strategy: &Strategy, key: [u32; 4], vertex: u32, branch: u32) -> [u32; 4] {
    if strategy.sequence == Sequence::Independent {
        return branch_key(key, vertex, branch);
    }
    let [x, y, z, index] = key;
    let [x, y, z, _] = branch_key([x, y, z, 0], vertex, branch);
    [x, y, z, index]
}
