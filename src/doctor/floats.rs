//! Floats: what is not finite, what is too small to be normal, and how exact the rest is.

use super::ask::Ask;
use super::canaries::{Verdict, judge_rows, rows};
use crate::cpu::random::pcg4d;
use crate::device::Limits;
use crate::error::Result;
use crate::shader::Canary;
use std::f64::consts::TAU;

const ONE: u32 = 0x3f80_0000;

/// Quiet and signalling NaN of either sign, infinities, and finite numbers of every kind.
const BITS: [u32; 14] = [
    0x7fc0_0000,
    0x7f80_0001,
    0xffc1_2345,
    0xff80_0001,
    0x7fff_ffff,
    0xffff_ffff,
    0x7f80_0000,
    0xff80_0000,
    0x7f7f_ffff,
    0xff7f_ffff,
    0,
    0x8000_0000,
    ONE,
    0x0080_0000,
];

pub fn ask_finite(ask: &mut Ask) -> Result<Option<Vec<u32>>> {
    ask.canary(Canary::Finite, &BITS.map(|bits| [bits, ONE, 0, 0]))
}

pub fn judge_finite(words: &[u32], _: Option<Limits>) -> Verdict {
    let right = |bits: u32, answer| {
        let finite = u32::from(f32::from_bits(bits).is_finite());
        answer == [finite, finite, finite, 1]
    };
    judge_rows(words, &BITS, right, format!("{} of {0} told", BITS.len()))
}

/// Numbers below the smallest normal one, then normal numbers.
const SMALL: [u32; 6] = [
    1,
    0x000f_ffff,
    0x0040_0000,
    0x007f_ffff,
    0x8000_0001,
    0x807f_ffff,
];
const NORMAL: [u32; 4] = [0x0080_0000, 0x8080_0000, ONE, 0xff7f_ffff];

fn denormal_inputs() -> Vec<u32> {
    SMALL.into_iter().chain(NORMAL).collect()
}

pub fn ask_denormals(ask: &mut Ask) -> Result<Option<Vec<u32>>> {
    let inputs: Vec<_> = denormal_inputs()
        .into_iter()
        .map(|bits| [bits, ONE, 0, 0])
        .collect();
    ask.canary(Canary::Denormals, &inputs)
}

pub fn judge_denormals(words: &[u32], _: Option<Limits>) -> Verdict {
    let inputs = denormal_inputs();
    let is_zero = |bits: u32| bits << 1 == 0;
    let right = |bits: u32, answer: [u32; 4]| {
        let same = |found: u32| found == bits || (SMALL.contains(&bits) && is_zero(found));
        answer[..3].iter().all(|found| same(*found)) && answer[3] == 1
    };
    judge_rows(words, &inputs, right, String::new())?;
    let small = || rows(words).take(SMALL.len());
    let fate = |column: usize| match small().all(|answer| !is_zero(answer[column])) {
        true => "kept",
        false => "flushed",
    };
    Ok(format!(
        "copies {}, products {}, sums {}",
        fate(0),
        fate(1),
        fate(2)
    ))
}

/// Inputs of each of the two halves.
const FLOATS: u32 = 256;

/// Numbers between 2^-60 and 2^60 in pairs, then turns in [-1/2, 1/2) with numbers in [0, 1).
fn float_inputs() -> Vec<[u32; 4]> {
    let wide = |bits: u32| f32::from_bits((67 + (bits >> 23) % 120) << 23 | (bits & 0x007f_ffff));
    let unit = |bits: u32| (bits >> 8) as f32 / (1 << 24) as f32;
    let pair = |index| {
        let [a, b, ..] = pcg4d([index, 1, 2, 3]);
        [wide(a).to_bits(), wide(b).to_bits(), 0, 0]
    };
    let turn = |index| {
        let [a, b, ..] = pcg4d([index, 4, 5, 6]);
        [(unit(a) - 0.5).to_bits(), unit(b).to_bits(), 1, 0]
    };
    let indices = 0..FLOATS;
    indices.clone().map(pair).chain(indices.map(turn)).collect()
}

pub fn ask_floats(ask: &mut Ask) -> Result<Option<Vec<u32>>> {
    ask.canary(Canary::Floats, &float_inputs())
}

/// Distance from the truth in units of the last place of a 32-bit float there.
fn ulps(found: u32, truth: f64) -> f64 {
    let unit = (truth.abs().log2().floor() - 23.0).exp2();
    (f64::from(f32::from_bits(found)) - truth).abs() / unit
}

/// The largest error of each of the four columns of some answers. NaN counts as infinite.
fn worst(errors: impl Iterator<Item = [f64; 4]>) -> [f64; 4] {
    let larger = |a: f64, b: f64| if b <= a { a } else { b.max(f64::MIN_POSITIVE) };
    let infinite = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
    errors.fold([0.0; 4], |most, now| {
        std::array::from_fn(|column| larger(most[column], infinite(now[column])))
    })
}

/// Units of the last place: division and inverseSqrt as WGSL has them (and half a unit of the truth's own
/// rounding), sqrt by way of both.
const DIVISION: f64 = 2.5;
const ROOT: f64 = 4.5;
const INVERSE_ROOT: f64 = 2.5;
/// A sine and a cosine, absolute: what `shaders/maths.wgsl` states, and what fusing may add.
const SINCOS: f64 = 8e-7;

pub fn judge_floats(words: &[u32], _: Option<Limits>) -> Verdict {
    let inputs = float_inputs();
    if words.len() != 4 * inputs.len() {
        return Err(format!("{} words", words.len()));
    }
    let answers = || inputs.iter().zip(rows(words));
    let single = |bits: u32| f64::from(f32::from_bits(bits));
    let [division, root, inverse, one] = worst(answers().take(FLOATS as usize).map(
        |(&[x, y, ..], [quotient, root, inverse, one])| {
            let (x, y) = (single(x), single(y));
            [
                ulps(quotient, x / y),
                ulps(root, x.sqrt()),
                ulps(inverse, 1.0 / x.sqrt()),
                ulps(one, 1.0),
            ]
        },
    ));
    let circle = worst(
        answers()
            .skip(FLOATS as usize)
            .map(|(&[turn, unit, ..], answer)| {
                let (turn, unit) = (TAU * single(turn), TAU * (single(unit) - 0.5));
                let truths = [turn.sin(), turn.cos(), unit.cos(), unit.sin()];
                std::array::from_fn(|i| (single(answer[i]) - truths[i]).abs())
            }),
    );
    let sincos = circle.into_iter().fold(0.0, f64::max);
    let found = format!(
        "division {division:.1}, sqrt {root:.1}, inverseSqrt {inverse:.1} ULP, sine and cosine {sincos:.1e}"
    );
    let within = division <= DIVISION
        && root <= ROOT
        && inverse <= INVERSE_ROOT
        && one == 0.0
        && sincos <= SINCOS;
    if within { Ok(found) } else { Err(found) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::canary::canary;
    use crate::knobs::Choice;
    use crate::pack::CanaryJob;

    fn twin(kernel: Canary, inputs: &[[u32; 4]]) -> Vec<u32> {
        let job = CanaryJob {
            canary: kernel.index(),
            ..CanaryJob::default()
        };
        canary(&job, inputs).unwrap().concat()
    }

    #[test]
    fn a_number_that_is_told_wrongly_is_seen() {
        let right = twin(Canary::Finite, &BITS.map(|bits| [bits, ONE, 0, 0]));
        assert_eq!(judge_finite(&right, None), Ok("14 of 14 told".into()));
        for place in 0..right.len() {
            let mut wrong = right.clone();
            wrong[place] ^= 1;
            assert!(judge_finite(&wrong, None).is_err(), "word {place}");
        }
    }

    #[test]
    fn denormals_may_be_kept_or_flushed_but_not_changed() {
        let kept: Vec<u32> = denormal_inputs()
            .into_iter()
            .flat_map(|bits| [bits, bits, bits, 1])
            .collect();
        let verdict = judge_denormals(&kept, None).unwrap();
        assert_eq!(verdict, "copies kept, products kept, sums kept");
        let mut flushed = kept.clone();
        for row in 0..SMALL.len() {
            flushed[4 * row + 1] &= 0x8000_0000;
            flushed[4 * row + 2] = 0;
        }
        let verdict = judge_denormals(&flushed, None).unwrap();
        assert_eq!(verdict, "copies kept, products flushed, sums flushed");
        for place in 0..kept.len() {
            let mut wrong = kept.clone();
            wrong[place] ^= 0x0010_0000;
            assert!(judge_denormals(&wrong, None).is_err(), "word {place}");
        }
        // A normal number flushed.
        let mut wrong = kept.clone();
        wrong[4 * SMALL.len() + 1] = 0;
        assert!(judge_denormals(&wrong, None).is_err());
    }

    #[test]
    fn floats_that_are_off_are_seen() {
        let right = twin(Canary::Floats, &float_inputs());
        let verdict = judge_floats(&right, None).unwrap();
        assert!(verdict.starts_with("division 0.5, sqrt 0.5"), "{verdict}");
        // Units in the last place of a quotient, a root and its inverse, and of what must be 1.
        for (place, add) in [(0, 4), (4 * 255 + 1, 6), (2, 4), (3, 1)] {
            let mut wrong = right.clone();
            wrong[place] += add;
            assert!(judge_floats(&wrong, None).is_err(), "word {place}");
        }
        for place in 4 * FLOATS as usize..right.len() {
            let mut wrong = right.clone();
            wrong[place] = (f32::from_bits(right[place]) + 2e-6).to_bits();
            assert!(judge_floats(&wrong, None).is_err(), "word {place}");
        }
        let mut wrong = right.clone();
        wrong[4 * 100] = f32::NAN.to_bits();
        assert!(judge_floats(&wrong, None).is_err());
    }
}
