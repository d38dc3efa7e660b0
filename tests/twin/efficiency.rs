//! The functions that the rule `efficiency` adds.

use crate::cases::{Case, UNIT, absolute, case, eight, key_of, words_input, xyz};
use crate::inputs::{many, unit};
use lampray::cpu::efficiency::{count_continuations, wanted_continuations};
use lampray::cpu::random::branch_key;
use lampray::pack::{ProbeInput, Worth};
use lampray::shader::Probe;

pub fn cases() -> [Case; 2] {
    [continuations(), branch_keys()]
}

/// Worths from none to large ones, throughputs from none to 4, limits from 1 to 16; counts of up to 17 rays.
fn continuations() -> Case {
    let inputs = many(21, |place, stream| {
        let mut any = |turn| match place % 7 {
            0 => 0.0,
            1 => 1.0,
            _ => unit(place, turn, stream),
        };
        let scale = [0.1, 1.0, 100.0][place / 7 % 3];
        let [r, g, b] = [any(0), any(1), any(2)].map(|split| scale * split);
        let most = (16.0 * any(3)).floor().max(1.0);
        let more = [any(4), any(5), any(6)].map(|keep| scale * keep);
        ProbeInput {
            a: [r, g, b, most],
            b: [r + more[0], g + more[1], b + more[2], 0.0],
            c: [4.0 * any(7), any(8), any(9), 0.0],
            d: [17.0 * any(10), 0.99 * any(11), 0.0, 0.0],
        }
    });
    let twin = |input: &ProbeInput| {
        let worth = Worth {
            split: xyz(input.a).to_array(),
            keep: xyz(input.b).to_array(),
            ..Worth::default()
        };
        let wanted = wanted_continuations(&worth, xyz(input.c), input.a[3]);
        let count = count_continuations(input.d[0].max(1.0), input.d[1]);
        eight(&[&[wanted, count as f32]])
    };
    // Six products of numbers above zero and their sum, and a root of 2.5 units; whole numbers are exact.
    let tolerance = |_: &ProbeInput, wanted: &[f32; 8]| {
        let mut each = [0.0; 8];
        each[0] = 8.0 * UNIT * f64::from(wanted[0]);
        each
    };
    case(
        "continuations",
        Probe::Continuations,
        inputs,
        Box::new(twin),
        Box::new(tolerance),
    )
}

/// Integers, exact.
fn branch_keys() -> Case {
    let twin = |input: &ProbeInput| {
        let key = branch_key(key_of(input), 3, 2);
        eight(&[&key.map(f32::from_bits)])
    };
    let inputs = many(4, words_input);
    case(
        "branch_key",
        Probe::BranchKey,
        inputs,
        Box::new(twin),
        absolute(0.0),
    )
}
