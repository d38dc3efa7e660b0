//! The numbers of each sequence: integers all the way, so equal bit for bit.

use super::cases::Case;
use super::inputs::many;
use crate::support::strategy;
use lampray::cpu::sequence::{sequence_key, sequence_unit};
use lampray::knobs::{Choice, Sequence};
use lampray::pack::{ProbeInput, Strategy};
use lampray::shader::Probe;

pub fn cases() -> Vec<Case> {
    let lengths = [4, 5, 9, 16, 24];
    let all = Sequence::ALL
        .iter()
        .flat_map(|&sequence| lengths.map(|bits| (sequence, bits)));
    all.map(|(sequence, bits)| case(sequence, bits)).collect()
}

/// Words, kept to those that are numbers as floats: those that are none may change on the way.
fn case(sequence: Sequence, randomisation_bits: u32) -> Case {
    let strategy = Strategy {
        sequence,
        randomisation_bits,
        ..strategy()
    };
    let inputs = many(70, |place, stream| {
        let mut word = |most: u32| f32::from_bits(stream.bits() as u32 & most);
        let edge = f32::from_bits([0, 1, u32::MAX >> 9][place % 3]);
        let sample = if place % 4 == 0 {
            edge
        } else {
            word(0x7f7f_ffff)
        };
        ProbeInput {
            a: [
                word(0x7f7f_ffff),
                word(0x7f7f_ffff),
                word(0x7fff),
                word(0x7fff),
            ],
            b: [sample, word(0xf), word(0xff), word(0xff)],
            ..ProbeInput::default()
        }
    });
    let twin = move |input: &ProbeInput| {
        let ([s, t, x, y], [n, m, vertex, slot]) =
            (input.a.map(f32::to_bits), input.b.map(f32::to_bits));
        let key = sequence_key(&strategy, [s, t], [x, y], [n, m]);
        let [a, b, c, d] = sequence_unit(&strategy, key, vertex, slot);
        let [e, f, g, h] = key.map(f32::from_bits);
        [a, b, c, d, e, f, g, h]
    };
    Case {
        name: format!("sequence {sequence}, 2^{randomisation_bits}"),
        probe: Probe::Sequence,
        strategy,
        inputs,
        twin: Box::new(twin),
        tolerance: Box::new(|_, _| [0.0; 8]),
        strays: 0,
    }
}
