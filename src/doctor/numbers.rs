//! Integers, random numbers and conversions.

use super::ask::Ask;
use super::canaries::{Verdict, judge_rows};
use crate::cpu::canary::random_words;
use crate::device::Limits;
use crate::error::Result;
use crate::shader::Canary;

/// Integers at which something turns over.
const EDGES: [u32; 13] = [
    0,
    1,
    2,
    3,
    7,
    31,
    32,
    0xffff,
    0x1_0000,
    0x7fff_ffff,
    0x8000_0000,
    0xdead_beef,
    u32::MAX,
];

fn integer_inputs() -> Vec<[u32; 4]> {
    let pairs = EDGES.iter().flat_map(|&a| EDGES.map(|b| (a, b)));
    pairs
        .flat_map(|(a, b)| [0, 1, 2].map(|operation| [a, b, operation, 0]))
        .collect()
}

/// What WGSL says of runtime integers; a quotient that does not exist is its dividend, a remainder zero.
fn integers([a, b, operation, _]: [u32; 4]) -> [u32; 4] {
    let shift = b & 31;
    match operation {
        0 => [
            a.wrapping_add(b),
            a.wrapping_sub(b),
            a.wrapping_mul(b),
            a ^ b,
        ],
        1 => [
            a.checked_div(b).unwrap_or(a),
            a.checked_rem(b).unwrap_or(0),
            a << shift,
            a >> shift,
        ],
        _ => {
            let (c, d) = (a.cast_signed(), b.cast_signed());
            [
                c.checked_div(d).unwrap_or(c),
                c.checked_rem(d).unwrap_or(0),
                c.wrapping_mul(d),
                c >> shift,
            ]
            .map(i32::cast_unsigned)
        }
    }
}

pub fn ask_integers(ask: &mut Ask) -> Result<Option<Vec<u32>>> {
    ask.canary(Canary::Integers, &integer_inputs())
}

pub fn judge_integers(words: &[u32], _: Option<Limits>) -> Verdict {
    let inputs = integer_inputs();
    let praise = format!("{} results as expected", 4 * inputs.len());
    let right = |input, answer| integers(input) == answer;
    judge_rows(words, &inputs, right, praise)
}

/// Lanes that draw four words each.
const DRAWS: u32 = 1 << 14;

/// The first 16 digits of the BLAKE3 hash of all words, little-endian.
const WORDS_HASH: &str = "19e4f531c97a2f47";

pub fn ask_random(ask: &mut Ask) -> Result<Option<Vec<u32>>> {
    let lanes: Vec<_> = (0..DRAWS).map(|lane| [lane, 0, 0, 0]).collect();
    ask.canary(Canary::Random, &lanes)
}

pub fn judge_random(words: &[u32], _: Option<Limits>) -> Verdict {
    let twin: Vec<u32> = (0..DRAWS).flat_map(random_words).collect();
    let wrong = twin.iter().zip(words).filter(|(a, b)| a != b).count();
    if wrong > 0 || words.len() != twin.len() {
        return Err(format!("{wrong} of {} words differ", twin.len()));
    }
    // The twin itself is held against the numbers of the day it was written.
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let hash = blake3::hash(&bytes).to_hex();
    match hash.starts_with(WORDS_HASH) {
        true => Ok(format!("{} words, 0 mismatches", words.len())),
        false => Err(format!(
            "the words' hash is {}, not {WORDS_HASH}",
            &hash[..16]
        )),
    }
}

/// A float to make integers of, and an integer to make floats of.
const CONVERSIONS: [(f32, u32); 14] = [
    (0.0, 0),
    (0.99, 1),
    (1.0, 0xff),
    (3.7, 0x100),
    (-0.99, 0xffff),
    (-3.7, 0x00ff_ffff),
    (16_777_216.0, 0x0100_0000),
    (2_147_483_520.0, 0x7fff_ffff),
    (2_147_483_648.0, 0x8000_0000),
    (4_294_967_040.0, 0xffff_feff),
    (4_294_967_296.0, 0xffff_ff00),
    (1e30, 0xffff_ffff),
    (-1e30, 0xdead_beef),
    (f32::MAX, 0x1234_5678),
];

/// The largest floats below 2^32 and 2^31: what is larger may become these or the largest integers.
const LARGEST: (u32, i32) = (0xffff_ff00, 0x7fff_ff80);

fn converts((x, integer): (f32, u32), answer: [u32; 4]) -> bool {
    let [unsigned, signed, float, unit] = answer;
    let signed = signed.cast_signed();
    let [float, unit] = [float, unit].map(f32::from_bits);
    let unsigned_right = match x as u32 {
        wanted if wanted >= LARGEST.0 => unsigned >= LARGEST.0,
        wanted => unsigned == wanted,
    };
    let signed_right = match x as i32 {
        wanted if wanted >= LARGEST.1 => signed >= LARGEST.1,
        wanted => signed == wanted,
    };
    // Either neighbour will do where a float has no room for the integer.
    let spacing = f64::from((integer as f32).next_up()) - f64::from(integer as f32);
    let float_right = (f64::from(float) - f64::from(integer)).abs() < spacing;
    let unit_right = f64::from(unit) == f64::from(integer >> 8) / f64::from(1 << 24);
    unsigned_right && signed_right && float_right && unit_right
}

pub fn ask_conversion(ask: &mut Ask) -> Result<Option<Vec<u32>>> {
    let inputs = CONVERSIONS.map(|(x, integer)| [x.to_bits(), integer, 0, 0]);
    ask.canary(Canary::Conversion, &inputs)
}

pub fn judge_conversion(words: &[u32], _: Option<Limits>) -> Verdict {
    let huge = words.get(4 * 11).copied().unwrap_or_default();
    let praise = format!("as expected; u32(1e30) = {huge}");
    judge_rows(words, &CONVERSIONS, converts, praise)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_bit_of_an_integer_is_seen() {
        let inputs = integer_inputs();
        let right: Vec<u32> = inputs.iter().flat_map(|input| integers(*input)).collect();
        assert!(judge_integers(&right, None).is_ok());
        for place in 0..right.len() {
            let mut wrong = right.clone();
            wrong[place] ^= 1 << (place % 32);
            assert!(judge_integers(&wrong, None).is_err(), "word {place}");
        }
        assert!(judge_integers(&right[4..], None).is_err());
        // By hand: 7 / 0, 7 % 0, and the quotient that overflows.
        assert_eq!(integers([7, 0, 1, 0])[..2], [7, 0]);
        assert_eq!(
            integers([0x8000_0000, u32::MAX, 2, 0])[..2],
            [0x8000_0000, 0]
        );
    }

    #[test]
    fn one_bit_of_a_random_word_is_seen() {
        let right: Vec<u32> = (0..DRAWS).flat_map(random_words).collect();
        assert_eq!(right.len(), 1 << 16);
        assert_eq!(
            judge_random(&right, None),
            Ok("65536 words, 0 mismatches".into())
        );
        for place in [0, 1, 40_000, (1 << 16) - 1] {
            let mut wrong = right.clone();
            wrong[place] ^= 1 << (place % 32);
            assert!(judge_random(&wrong, None).is_err(), "word {place}");
        }
        assert!(judge_random(&right[4..], None).is_err());
    }

    #[test]
    fn conversions_are_judged() {
        // As a device that clamps to what floats can say.
        let answer = |(x, integer): (f32, u32)| {
            let unsigned = (x as u32).min(LARGEST.0);
            let signed = (x as i32).min(LARGEST.1).cast_unsigned();
            let unit = (integer >> 8) as f32 / (1 << 24) as f32;
            [unsigned, signed, (integer as f32).to_bits(), unit.to_bits()]
        };
        let right = CONVERSIONS.map(answer).concat();
        assert!(
            judge_conversion(&right, None)
                .unwrap()
                .contains("4294967040")
        );
        // x86's own conversion of what is out of range, and of negative numbers.
        for (row, column, word) in [(11, 0, 0), (11, 1, 0x8000_0000), (12, 0, 0x8000_0000)] {
            let mut wrong = right.clone();
            wrong[4 * row + column] = word;
            assert!(judge_conversion(&wrong, None).is_err(), "{row} {column}");
        }
        // Rounding up to 1, which no random number may.
        let mut wrong = right.clone();
        wrong[4 * 11 + 3] = 1.0f32.to_bits();
        assert!(judge_conversion(&wrong, None).is_err());
    }
}
