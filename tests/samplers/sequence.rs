//! The point sets that `render.sequence` makes of a pixel's samples: how evenly they lie, and that one is
//! independent of another.
//!
//! The twin alone draws here: `tests/twin` holds that a GPU draws the same bits. Each gate is shown to refuse
//! independent numbers, or a set that is used twice.

use super::LEVEL;
use crate::support;
use crate::support::chance::{fit, sidak};
use lampray::cpu::sequence::{sequence_bits, sequence_key, tile_bits};
use lampray::knobs::Sequence;
use lampray::pack::{Strategy, words};

const SETS: [Sequence; 3] = [Sequence::Stratified, Sequence::Sobol, Sequence::BlueNoise];

fn strategy(sequence: Sequence, randomisation_bits: u32) -> Strategy {
    Strategy {
        sequence,
        randomisation_bits,
        ..support::strategy()
    }
}

/// Where a number is drawn from.
#[derive(Clone, Copy, Debug)]
struct Address {
    seed: u64,
    pixel: [u32; 2],
    sample: u64,
    vertex: u32,
    slot: u32,
}

impl Address {
    fn bits(&self, strategy: &Strategy) -> [u32; 4] {
        let key = sequence_key(strategy, words(self.seed), self.pixel, words(self.sample));
        sequence_bits(strategy, key, self.vertex, self.slot)
    }
}

/// Places all over: seeds, pixels, randomisations and dimensions.
fn places(count: u64) -> impl Iterator<Item = Address> {
    (0..count).map(|place| Address {
        seed: [0, 1, u64::MAX][place as usize % 3],
        pixel: [place as u32 * 8 % 1000, 8 * (place as u32 / 5)],
        sample: place * 977,
        vertex: place as u32 % 7,
        slot: place as u32 % 3,
    })
}

/// One pair of the numbers of some samples.
fn pair(strategy: &Strategy, at: Address, samples: u64, pair: usize) -> Vec<[u32; 2]> {
    let first = at.sample << strategy.randomisation_bits;
    let draw = |sample| Address { sample, ..at }.bits(strategy);
    let bits = (first..first + samples).map(draw);
    bits.map(|bits| [bits[2 * pair], bits[2 * pair + 1]])
        .collect()
}

/// Whether each box of 2^-wide by 2^-high holds one of the 2^(wide + high) points.
fn one_in_each(points: &[[u32; 2]], wide: u32, high: u32) -> bool {
    let cell = |[x, y]: [u32; 2]| {
        let [column, row] = [(x, wide), (y, high)].map(|(v, bits)| u64::from(v) >> (32 - bits));
        (row << wide | column) as usize
    };
    let mut seen = vec![false; points.len()];
    assert_eq!(points.len(), 1 << (wide + high));
    points
        .iter()
        .all(|point| !std::mem::replace(&mut seen[cell(*point)], true))
}

/// Whether every box of area 1 / N whose sides are powers of two holds one of N points.
fn is_net(points: &[[u32; 2]]) -> bool {
    let bits = points.len().ilog2();
    (0..=bits).all(|wide| one_in_each(points, wide, bits - wide))
}

#[test]
fn every_elementary_box_holds_one_point() {
    for sequence in [Sequence::Sobol, Sequence::BlueNoise] {
        for bits in [4, 5, 8, 11] {
            let strategy = strategy(sequence, bits);
            for at in places(60) {
                for which in 0..2 {
                    let points = pair(&strategy, at, 1 << bits, which);
                    assert!(is_net(&points), "{sequence} 2^{bits} {at:?}");
                    // Aligned parts of the set as well, which a stopped render has taken.
                    for part in 1..bits {
                        let mut parts = points.chunks(1 << part);
                        assert!(parts.all(is_net), "{sequence} 2^{part} of 2^{bits} {at:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn every_square_of_pixels_has_a_net() {
    for bits in [4, 6] {
        let strategy = strategy(Sequence::BlueNoise, bits);
        for at in places(12) {
            for side in [2, 4, 8] {
                let corner = at.pixel.map(|v| v / side * side);
                let pixels = (0..side * side).map(|n| [corner[0] + n % side, corner[1] + n / side]);
                let points: Vec<_> = pixels
                    .flat_map(|pixel| pair(&strategy, Address { pixel, ..at }, 1 << bits, 1))
                    .collect();
                assert!(is_net(&points), "{side} x {side} pixels, 2^{bits} {at:?}");
            }
        }
    }
    // The gate could tell: pixels by themselves have none.
    let alone = strategy(Sequence::Sobol, 4);
    let at = places(1).next().unwrap();
    let pixels = [[0, 0], [1, 0], [0, 1], [1, 1]];
    let points: Vec<_> = pixels
        .into_iter()
        .flat_map(|pixel| pair(&alone, Address { pixel, ..at }, 16, 0))
        .collect();
    assert!(!is_net(&points));
}

#[test]
fn strata_hold_one_point_each() {
    for bits in [4, 5, 8, 11] {
        let strategy = strategy(Sequence::Stratified, bits);
        let columns = bits - bits / 2;
        for at in places(60) {
            for which in 0..2 {
                let points = pair(&strategy, at, 1 << bits, which);
                for wide in [0, columns, bits] {
                    assert!(one_in_each(&points, wide, bits - wide), "2^{bits} {at:?}");
                }
            }
        }
    }
}

#[test]
fn the_gates_reject_independent_numbers() {
    let strategy = strategy(Sequence::Independent, 4);
    let nets = places(200).filter(|at| is_net(&pair(&strategy, *at, 16, 0)));
    assert_eq!(nets.count(), 0);
}

/// Pascal's triangle modulo 2 from its definition: digit i of the value is the sum of C(j, i) a_j.
#[test]
fn the_second_dimension_is_pascals_triangle() {
    let value = |index: u32| {
        (0..32).fold(0, |value, i: u32| {
            // C(j, i) is odd where the digits of i are among those of j (Lucas).
            let sum = (0..32)
                .filter(|j| index >> j & 1 == 1 && j & i == i)
                .count();
            value | (sum as u32 & 1) << i
        })
    };
    for index in (0..100_000)
        .chain((0..32).map(|bit| 1 << bit))
        .chain([u32::MAX])
    {
        let found = lampray::cpu::sequence::second_dimension(index);
        assert_eq!(found, value(index), "{index:#x}");
    }
}

/// Smallest p of chi-square tests, for all 16 pairs of one number here and one there, over many seeds.
fn independence(strategy: &Strategy, here: Address, there: Address) -> f64 {
    const SIDE: usize = 16;
    const SEEDS: u64 = 1 << 14;
    let mut counts = vec![vec![0.0; SIDE * SIDE]; 16];
    for seed in 0..SEEDS {
        let [a, b] = [here, there].map(|at| Address { seed, ..at }.bits(strategy));
        for (number, counts) in counts.iter_mut().enumerate() {
            let [x, y] = [a[number / 4], b[number % 4]].map(|bits| (bits >> 28) as usize);
            counts[x * SIDE + y] += 1.0;
        }
    }
    let expected = vec![SEEDS as f64 / (SIDE * SIDE) as f64; SIDE * SIDE];
    let p = counts.iter().map(|counts| fit(counts, &expected).p);
    p.fold(1.0, f64::min)
}

/// What must be independent of a sample: other dimensions of its own and of other samples of the set, other
/// randomisations, and other pixels where they do not share a set.
fn others(strategy: &Strategy, at: Address) -> Vec<Address> {
    let length = 1 << strategy.randomisation_bits;
    let apart = 1 << tile_bits(strategy);
    let [x, y] = at.pixel;
    vec![
        Address {
            vertex: at.vertex + 1,
            ..at
        },
        Address {
            slot: at.slot + 1,
            ..at
        },
        Address {
            slot: at.slot + 1,
            sample: at.sample + 1,
            ..at
        },
        Address {
            sample: at.sample + length,
            ..at
        },
        Address {
            sample: at.sample + (length << 32),
            ..at
        },
        Address {
            pixel: [x + apart, y],
            ..at
        },
        Address {
            pixel: [x, y + apart],
            ..at
        },
    ]
}

/// Also that every number is even at a fixed address, whatever it is: rows and columns of the same tables.
#[test]
fn sets_are_independent_of_each_other_and_each_number_is_even() {
    let mut tests = Vec::new();
    for sequence in SETS {
        for (bits, sample) in [(4, 0), (4, 11), (9, 300)] {
            let strategy = strategy(sequence, bits);
            let at = Address {
                seed: 0,
                pixel: [21, 9],
                sample,
                vertex: 2,
                slot: 1,
            };
            for other in others(&strategy, at) {
                let p = independence(&strategy, at, other);
                tests.push((p, format!("{sequence} 2^{bits} {at:?} {other:?}")));
            }
        }
    }
    let level = sidak(LEVEL, 16 * tests.len());
    let (p, worst) = tests.iter().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    assert!(*p > level, "{worst}: p = {p:.1e}, level {level:.1e}");
}

#[test]
fn the_gate_rejects_a_set_that_is_used_twice() {
    let strategy = strategy(Sequence::Sobol, 4);
    let at = Address {
        seed: 0,
        pixel: [3, 4],
        sample: 5,
        vertex: 1,
        slot: 0,
    };
    // Two samples of one set avoid each other.
    let next = Address { sample: 6, ..at };
    assert!(independence(&strategy, at, next) < 1e-12);
}

/// The mean product of two numbers over a set, each about its own mean, over many sets: nothing on average, and
/// its variance over that of independent numbers.
fn covariance(strategy: &Strategy, lanes: [usize; 2], slots: [u32; 2]) -> (f64, f64) {
    const SETS: u64 = 4096;
    let length = 1 << strategy.randomisation_bits;
    let about = |bits: u32| f64::from(bits) / 4_294_967_296.0 - 0.5;
    let mut sums = [0.0; 2];
    for seed in 0..SETS {
        let draw = |sample, side: usize| {
            let at = Address {
                seed,
                pixel: [21, 9],
                sample,
                vertex: 2,
                slot: slots[side],
            };
            about(at.bits(strategy)[lanes[side]])
        };
        let sum: f64 = (0..length).map(|n| draw(n, 0) * draw(n, 1)).sum();
        let scaled = sum * 12.0 / (length as f64).sqrt();
        sums = [sums[0] + scaled, sums[1] + scaled * scaled];
    }
    let count = SETS as f64;
    (sums[0] / count.sqrt(), sums[1] / count)
}

/// Pairs of dimensions are dealt to each other at random. Nested shuffling keeps neighbours together, so that
/// what two pairs have in common varies by up to twice what it does for independent numbers, never more.
#[test]
fn dimensions_of_a_set_are_uncorrelated() {
    for sequence in SETS {
        let strategy = strategy(sequence, 5);
        for (lanes, slots) in [
            ([0, 2], [1, 1]),
            ([1, 3], [1, 1]),
            ([0, 0], [0, 1]),
            ([1, 2], [0, 1]),
        ] {
            let (mean, variance) = covariance(&strategy, lanes, slots);
            println!("{sequence} {lanes:?} {slots:?}: {mean:.2} {variance:.2}");
            // Twelve tests at 0.01 together: 3.5 standard errors, of which the variance may be 2.
            assert!(
                mean.abs() < 3.5 * 2f64.sqrt(),
                "{sequence} {lanes:?} {slots:?}: {mean}"
            );
            assert!(
                (0.5..2.2).contains(&variance),
                "{sequence} {lanes:?}: {variance}"
            );
        }
    }
    let (mean, _) = covariance(&strategy(Sequence::Sobol, 5), [0, 0], [1, 1]);
    assert!(mean > 100.0, "a number with itself: {mean}");
}
