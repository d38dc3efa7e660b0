//! Random numbers: the published hash, equal on both devices bit for bit, and even and independent
//! in every direction that a render draws them in.
//!
//! Every statistical gate runs on fixed seeds at a stated level, and on a broken generator that it
//! must refuse.

mod support;

use lampray::cpu::random::{pcg4d, random_bits, random_key, random_unit};
use lampray::pack::{ProbeInput, ProbeOutput, words};
use lampray::shader::Probe;
use support::chance::{fit, sidak};
use support::stream::Stream;

/// Chance that any of a test's gates refuses a perfect generator.
const LEVEL: f64 = 0.01;

/// pcg4d once more, from the publication's words and in 64-bit arithmetic: each lane through a
/// linear congruential step, two rounds of multiply-and-add around the lanes, and between them each
/// lane folded on its upper half.
fn published(input: [u32; 4]) -> [u32; 4] {
    const WORD: u64 = 1 << 32;
    let mut v = input.map(|x| (u64::from(x) * 1_664_525 + 1_013_904_223) % WORD);
    for round in 0..2 {
        for (target, a, b) in [(0, 1, 3), (1, 2, 0), (2, 0, 1), (3, 1, 2)] {
            v[target] = (v[target] + v[a] * v[b] % WORD) % WORD;
        }
        if round == 0 {
            v = v.map(|x| x ^ (x / 65_536));
        }
    }
    v.map(|x| x as u32)
}

#[test]
fn the_hash_gives_the_known_answers() {
    for (input, answer) in KNOWN {
        assert_eq!(published(input), answer, "{input:?}");
        assert_eq!(pcg4d(input), answer, "{input:?}");
    }
    let mut stream = Stream::new(2);
    for _ in 0..1 << 20 {
        let (a, b) = (stream.bits(), stream.bits());
        let input = [a as u32, (a >> 32) as u32, b as u32, (b >> 32) as u32];
        assert_eq!(pcg4d(input), published(input), "{input:?}");
    }
}

/// Inputs and outputs, worked out once outside this program.
const KNOWN: [([u32; 4], [u32; 4]); 6] = [
    (
        [0x0000_0000, 0x0000_0000, 0x0000_0000, 0x0000_0000],
        [0x0f02_f829, 0x2d56_8769, 0x32b0_c43b, 0xd325_48ea],
    ),
    (
        [0x0000_0001, 0x0000_0000, 0x0000_0000, 0x0000_0000],
        [0x0b3c_efc3, 0xa31d_c1d5, 0x5ffb_e5a5, 0x623d_099e],
    ),
    (
        [0x0000_0000, 0x0000_0001, 0x0000_0002, 0x0000_0003],
        [0x37a6_3737, 0x8642_5e4b, 0x4eef_b3bc, 0x76a7_b083],
    ),
    (
        [0xffff_ffff, 0xffff_ffff, 0xffff_ffff, 0xffff_ffff],
        [0x974e_d892, 0xc015_dc67, 0x9f95_5760, 0xa1bb_a208],
    ),
    (
        [0x1234_5678, 0x9abc_def0, 0x0fed_cba9, 0x8765_4321],
        [0x1ac7_36e7, 0xe06f_b5f3, 0x81ae_951b, 0x5467_09f6],
    ),
    (
        [0x00ff_0100, 0x0000_1000, 0x0000_0001, 0x0000_0007],
        [0x7885_96b2, 0x93eb_56bd, 0x10a1_0ef2, 0x6f09_3738],
    ),
];

/// An address: what a number is a function of.
#[derive(Clone, Copy, Debug, Default)]
struct Address {
    seed: u64,
    pixel: [u32; 2],
    sample: u64,
    vertex: u32,
    slot: u32,
}

impl Address {
    fn key(&self) -> [u32; 4] {
        random_key(words(self.seed), self.pixel, words(self.sample))
    }

    fn bits(&self) -> [u32; 4] {
        random_bits(self.key(), self.vertex, self.slot)
    }

    fn probe_input(&self) -> ProbeInput {
        let ([s0, s1], [n0, n1]) = (words(self.seed), words(self.sample));
        let float = |words: [u32; 4]| words.map(f32::from_bits);
        ProbeInput {
            a: float([s0, s1, self.pixel[0], self.pixel[1]]),
            b: float([n0, n1, self.vertex, self.slot]),
            ..ProbeInput::default()
        }
    }
}

/// Addresses as renders have them, with the ends of every range among them.
fn addresses(count: usize) -> Vec<Address> {
    let mut stream = Stream::new(3);
    let mut any = |_| {
        let mut pick = |ends: &[u64], most: u64| match stream.bits() % 4 {
            0 => ends[(stream.bits() % ends.len() as u64) as usize],
            _ => stream.bits() % most,
        };
        Address {
            seed: pick(&[0, 1, u64::from(u32::MAX), 1 << 32, u64::MAX], u64::MAX),
            pixel: [0, 0].map(|_: u32| pick(&[0, 1, 32_767], 32_768) as u32),
            sample: pick(&[0, (1 << 32) - 1, 1 << 32, (1 << 63) - 1], 1 << 40),
            vertex: pick(&[0, 1, u64::from(u32::MAX)], 64) as u32,
            slot: pick(&[0, 1, 1 << 20], 16) as u32,
        }
    };
    (0..count).map(&mut any).collect()
}

#[test]
fn both_devices_draw_the_same_bits() {
    let Some(mut gpu) = support::gpu("random numbers, bit for bit") else {
        return;
    };
    let all = addresses(1 << 20);
    let mut compared = 0;
    // Several dispatches: a number does not depend on which one draws it.
    for (place, part) in all.chunks(150_001).enumerate() {
        let inputs: Vec<_> = part.iter().map(Address::probe_input).collect();
        let mut probe = |function| gpu.probe(&support::strategy(), function, &inputs).unwrap();
        let (bits, units) = (probe(Probe::RandomBits), probe(Probe::RandomUnit));
        for ((address, bits), unit) in part.iter().zip(&bits).zip(&units) {
            let key = address.key();
            assert_eq!(
                bits.a.map(f32::to_bits),
                address.bits(),
                "{place} {address:?}"
            );
            assert_eq!(bits.b.map(f32::to_bits), key, "{place} {address:?}");
            let unit_bits = unit.a.map(f32::to_bits);
            let twin = random_unit(key, address.vertex, address.slot).map(f32::to_bits);
            assert_eq!(unit_bits, twin, "{place} {address:?}");
            compared += 1;
        }
    }
    assert_eq!(compared, 1 << 20);
}

/// The hash is a bijection, so that any wanted output has an input: undone step by step.
fn undo(output: [u32; 4]) -> [u32; 4] {
    let around = |mut v: [u32; 4]| {
        for (target, a, b) in [(3, 1, 2), (2, 0, 1), (1, 2, 0), (0, 1, 3)] {
            v[target] = v[target].wrapping_sub(v[a].wrapping_mul(v[b]));
        }
        v
    };
    let folded = around(output).map(|x| x ^ (x >> 16));
    // The inverse of 1664525 modulo 2^32, by Newton's iteration.
    let inverse = (0..5).fold(1_664_525u32, |x, _| {
        x.wrapping_mul(2u32.wrapping_sub(1_664_525u32.wrapping_mul(x)))
    });
    around(folded).map(|x| x.wrapping_sub(1_013_904_223).wrapping_mul(inverse))
}

#[test]
fn numbers_stay_below_one_at_the_extremes() {
    let extremes = [
        0,
        1,
        255,
        256,
        1 << 31,
        u32::MAX - 256,
        u32::MAX - 1,
        u32::MAX,
    ];
    let keys: Vec<_> = extremes.iter().map(|&bits| undo([bits; 4])).collect();
    for (key, bits) in keys.iter().zip(extremes) {
        assert_eq!(pcg4d(*key), [bits; 4]);
        let unit = random_unit(*key, 0, 0);
        let exact = f64::from(bits >> 8) / f64::from(1 << 24);
        assert!(
            unit.iter().all(|&u| f64::from(u) == exact && u < 1.0),
            "{bits:#x}: {unit:?}"
        );
    }
    // The plain product with 2^-32 does reach 1: this test could tell.
    assert!(u32::MAX as f32 * 2f32.powi(-32) >= 1.0);
}

#[test]
fn numbers_on_the_gpu_stay_in_range() {
    let Some(mut gpu) = support::gpu("random numbers in [0, 1)") else {
        return;
    };
    // Seeds 0 and 2^64 - 1, samples on both sides of 2^32, and the last one there is.
    let mut inputs = Vec::new();
    for seed in [0, u64::MAX] {
        for sample in [0, (1 << 32) - 1, 1 << 32, (1 << 63) - 1] {
            for x in 0..8192 {
                let pixel = [x, 0];
                let address = Address {
                    seed,
                    pixel,
                    sample,
                    ..Address::default()
                };
                inputs.push(address.probe_input());
            }
        }
    }
    let outputs = gpu
        .probe(&support::strategy(), Probe::RandomUnit, &inputs)
        .unwrap();
    let in_range = |output: &ProbeOutput| output.a.iter().all(|u| (0.0..1.0).contains(u));
    assert!(outputs.iter().all(in_range));
    let different: std::collections::HashSet<_> = outputs
        .iter()
        .map(|output| output.a.map(f32::to_bits))
        .collect();
    // Of 65,536 quadruples of 24-bit numbers no two should ever agree.
    assert_eq!(different.len(), outputs.len());
}

/// A generator: from an address to four words.
type Generator = fn(&Address) -> [u32; 4];

/// What a render varies from one draw to the next.
#[derive(Clone, Copy, Debug)]
enum Step {
    Column,
    Row,
    Sample,
    FarSample,
    Vertex,
    Slot,
    Seed,
    HighSeed,
}

const STEPS: [Step; 8] = [
    Step::Column,
    Step::Row,
    Step::Sample,
    Step::FarSample,
    Step::Vertex,
    Step::Slot,
    Step::Seed,
    Step::HighSeed,
];

impl Step {
    fn from(self, mut at: Address) -> Address {
        match self {
            Step::Column => at.pixel[0] += 1,
            Step::Row => at.pixel[1] += 1,
            Step::Sample => at.sample += 1,
            Step::FarSample => at.sample += 1 << 32,
            Step::Vertex => at.vertex += 1,
            Step::Slot => at.slot += 1,
            Step::Seed => at.seed = at.seed.wrapping_add(1),
            Step::HighSeed => at.seed = at.seed.wrapping_add(1 << 32),
        }
        at
    }
}

/// A 64 x 64 image of 16 samples: neighbours as a render has them.
fn image(seed: u64) -> impl Iterator<Item = Address> {
    (0..64 * 64 * 16).map(move |index| Address {
        seed,
        pixel: [index % 64, index / 64 % 64],
        sample: u64::from(index / 4096),
        ..Address::default()
    })
}

/// Smallest p of the four chi-square tests of each word's upper bits against evenness.
fn evenness(generate: Generator, seed: u64) -> f64 {
    const BINS: usize = 1024;
    let mut counts = vec![vec![0.0; BINS]; 4];
    let mut total = 0.0;
    for address in image(seed) {
        for (word, counts) in generate(&address).iter().zip(&mut counts) {
            counts[(*word >> 22) as usize] += 1.0;
        }
        total += 1.0;
    }
    let expected = vec![total / BINS as f64; BINS];
    let worst = |least: f64, counts: &Vec<f64>| least.min(fit(counts, &expected).p);
    counts.iter().fold(1.0, worst)
}

/// The same for pairs: a word here and a word one step on, in a 32 x 32 grid; all 16 pairs of words.
fn independence(generate: Generator, step: Step, seed: u64) -> f64 {
    const SIDE: usize = 32;
    let mut counts = vec![vec![0.0; SIDE * SIDE]; 16];
    let mut total = 0.0;
    for address in image(seed) {
        let (here, there) = (generate(&address), generate(&step.from(address)));
        for pair in 0..16 {
            let (a, b) = (here[pair / 4] >> 27, there[pair % 4] >> 27);
            counts[pair][a as usize * SIDE + b as usize] += 1.0;
        }
        total += 1.0;
    }
    let expected = vec![total / (SIDE * SIDE) as f64; SIDE * SIDE];
    let worst = |least: f64, counts: &Vec<f64>| least.min(fit(counts, &expected).p);
    counts.iter().fold(1.0, worst)
}

const SEEDS: [u64; 3] = [0, 1, u64::MAX];

/// Whether a generator passes every gate; the first that it does not otherwise.
fn verdict(generate: Generator) -> Result<(), String> {
    let tests = SEEDS.len() * (4 + 16 * STEPS.len());
    let level = sidak(LEVEL, tests);
    for seed in SEEDS {
        let p = evenness(generate, seed);
        if p < level {
            return Err(format!("seed {seed}: words are not even, p = {p:.1e}"));
        }
        for step in STEPS {
            let p = independence(generate, step, seed);
            if p < level {
                return Err(format!(
                    "seed {seed}: {step:?} neighbours depend, p = {p:.1e}"
                ));
            }
        }
    }
    Ok(())
}

#[test]
fn numbers_are_even_and_neighbours_independent() {
    assert_eq!(verdict(Address::bits), Ok(()));
}

/// One linear congruential step over a packed address, as renderers once did.
fn congruential(at: &Address) -> [u32; 4] {
    let packed = (at.pixel[0] | at.pixel[1] << 16)
        ^ (at.sample as u32).wrapping_mul(9781)
        ^ at.vertex.wrapping_mul(6271)
        ^ at.slot.wrapping_mul(26_699)
        ^ at.seed as u32;
    let next = |x: u32| x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    let x = next(packed);
    [x, next(x), next(next(x)), next(next(next(x)))]
}

#[test]
fn broken_generators_are_refused() {
    let broken: [(&str, Generator); 7] = [
        ("congruential", congruential),
        ("no row", |at| {
            Address {
                pixel: [at.pixel[0], 0],
                ..*at
            }
            .bits()
        }),
        ("no high sample word", |at| {
            Address {
                sample: at.sample & 0xffff_ffff,
                ..*at
            }
            .bits()
        }),
        ("no vertex", |at| Address { vertex: 0, ..*at }.bits()),
        ("no slot", |at| Address { slot: 0, ..*at }.bits()),
        ("no high seed word", |at| {
            Address {
                seed: at.seed & 0xffff_ffff,
                ..*at
            }
            .bits()
        }),
        ("one bit lost", |at| at.bits().map(|word| word | 1 << 25)),
    ];
    for (name, generate) in broken {
        assert!(verdict(generate).is_err(), "{name} passed");
    }
}

#[test]
fn every_word_of_an_address_counts() {
    // Each step from 4096 addresses changes about half of the 128 bits: 64 +- 5 standard errors.
    for step in STEPS {
        let mut flipped = 0;
        for address in addresses(4096) {
            let low = Address {
                vertex: 3,
                slot: 2,
                ..address
            };
            let low = Address {
                sample: low.sample >> 1,
                ..low
            };
            let (here, there) = (low.bits(), step.from(low).bits());
            let differing = here.iter().zip(there).map(|(a, b)| (a ^ b).count_ones());
            flipped += differing.sum::<u32>();
        }
        let mean = f64::from(flipped) / 4096.0;
        assert!(
            (mean - 64.0).abs() < 5.0 * 32f64.sqrt() / 64.0,
            "{step:?}: {mean}"
        );
    }
}
