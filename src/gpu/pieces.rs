//! Mesa's software drivers used to leave every loop of an invocation, without a word, once its loops
//! together had taken 65,535 iterations (`LP_MAX_TGSI_LOOP_ITERATIONS`; so with 22.3.6, no more with
//! 25.0.7, where `tests/splits` traces several times as many). There a
//! pixel's samples come in pieces that stay below that. Where rays try every body, a piece stays below it
//! whatever its paths do. In a tree they could visit every node, but never do: there each lane counts,
//! and stops without a tally at its share of the iterations; what it left is traced again in smaller pieces.

use crate::device::{Block, DeviceInfo, DeviceKind, run_ranges};
use crate::knobs::LightStrategy;
use crate::pack::{Packed, RUN_LENGTH, Rect, Tally, Traversal};

/// Loop iterations that an invocation may plan, with some to spare.
const SOFTWARE_ITERATIONS: u64 = 65_000;
/// Steps of a lane that are not too long for one dispatch, a fraction of a second each million: only where paths
/// may be longer than a hundred thousand bounces, or send as many shadow rays, does a run come in pieces.
const LONG_LANE: u64 = 1 << 21;
/// Lanes that a software driver runs in step, 32 bits each in its widest vectors: their loops go on
/// until the last is done, so that together they may take no more than one may.
const LANES: u64 = 8;

/// The first major version of Mesa that was found to let loops go on.
const FREE_MESA: u32 = 25;

/// Whether a driver leaves loops that take long. Of software drivers other than Mesa's nothing is known.
fn stops_early(device: &DeviceInfo) -> bool {
    let version = device.driver.split_once("Mesa ").map(|(_, text)| text);
    let major = version.and_then(|text| text.split('.').next()?.parse::<u32>().ok());
    device.kind == DeviceKind::Software && major.is_none_or(|major| major < FREE_MESA)
}

/// Loop iterations that an invocation is given where its driver leaves loops that take long.
pub fn planned_iterations(device: &DeviceInfo) -> Option<u32> {
    stops_early(device).then_some(SOFTWARE_ITERATIONS as u32)
}

/// How much of a pixel one dispatch may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Allowance {
    /// Steps of a lane; one that needs more writes no tally.
    pub steps: u32,
    /// Samples: a power of two.
    pub samples: u32,
    /// Whether lanes count the iterations of their loops.
    counted: bool,
    /// Iterations of a lane that counts them, and of one that is alone in its group.
    pub iterations: u32,
    alone: u32,
}

impl Allowance {
    /// None where a device cannot take a single step of the scene.
    pub fn new(device: &DeviceInfo, scene: &Packed) -> Option<Self> {
        if !stops_early(device) {
            // A step that asks every one of many lamps is as long as that many steps.
            let rays = u64::from(scene.strategy.shadow_rays()).max(1);
            let steps = scene.longest_path().saturating_mul(rays);
            let samples = (LONG_LANE / steps).max(1);
            return Some(Self {
                steps: u32::MAX,
                samples: 1 << samples.ilog2(),
                counted: scene.hierarchy.is_some(),
                iterations: u32::MAX,
                alone: u32::MAX,
            });
        }
        if scene.hierarchy.is_some() {
            return Self::in_tree(scene);
        }
        let steps = SOFTWARE_ITERATIONS / iterations(scene);
        let samples = (steps / scene.longest_path()).max(1);
        (steps > 0).then_some(Self {
            steps: steps as u32,
            samples: 1 << samples.ilog2(),
            counted: false,
            iterations: u32::MAX,
            alone: u32::MAX,
        })
    }

    /// The steps, or iterations, of a lane whose samples take at most `steps` steps.
    pub fn steps(&self, steps: u32, rect: Rect) -> u32 {
        match (self.counted, rect.area()) {
            (false, _) => steps.min(self.steps),
            (true, 1) => self.alone,
            (true, _) => self.iterations,
        }
    }

    /// On a software driver, where lanes count their iterations.
    fn in_tree(scene: &Packed) -> Option<Self> {
        let strategy = &scene.strategy;
        // A lane that stops finishes its step: one more look at each lamp.
        let last_step = u64::from(strategy.light_loops) + 64;
        let iterations = (SOFTWARE_ITERATIONS / LANES).checked_sub(last_step)?;
        // A guess at the iterations of a ray: few of the rays that a path may take are taken, and few
        // pieces have to be traced again.
        let tree = &scene.hierarchy.as_ref()?.tree;
        let of_ray = tree.outside.len() as u64 + 4 + 3 * u64::from(tree.nodes.len().ilog2()) / 2;
        let rays =
            (u64::from(scene.max_bounces) + 1).min(9) * (1 + u64::from(strategy.shadow_rays()));
        let samples = (iterations / (of_ray * rays)).clamp(1, u64::from(RUN_LENGTH));
        Some(Self {
            steps: u32::MAX,
            samples: 1 << samples.ilog2(),
            counted: true,
            iterations: iterations as u32,
            alone: (SOFTWARE_ITERATIONS - last_step) as u32,
        })
    }
}

/// The most loop iterations of one step: its own, those over the lamps, and those over the bodies for the
/// ray and for each shadow ray. A loop's last look at its condition counts as one. Baked bodies take none.
fn iterations(scene: &Packed) -> u64 {
    let bodies = match scene.traversal {
        Traversal::Baked => 0,
        _ => (scene.spheres.len() + scene.boxes.len()) as u64 + 3,
    };
    let strategy = &scene.strategy;
    let background = u32::from(strategy.background_lamp);
    let (loops, shadow_rays) = match strategy.light_strategy {
        LightStrategy::Hit => (0, 0),
        _ => (strategy.light_loops, strategy.shadow_rays() + background),
    };
    2 + bodies + u64::from(loops) + u64::from(shadow_rays) * bodies
}

/// The pieces of a block, of at most `most` samples each. They end where the sample index is a multiple of
/// `most`: they never depend on how the work was split before.
pub fn pieces(block: Block, most: u32) -> impl Iterator<Item = Block> {
    let (first_sample, most) = (block.first_sample, u64::from(most));
    let end = first_sample + u64::from(block.samples);
    (first_sample / most..end.div_ceil(most)).map(move |piece| {
        let start = (piece * most).max(first_sample);
        Block {
            first_sample: start,
            samples: (((piece + 1) * most).min(end) - start) as u32,
            ..block
        }
    })
}

/// The tallies of a range's pieces, run by run.
#[derive(Debug)]
pub struct Gathered {
    pub tallies: Vec<Tally>,
    pixels: usize,
    /// Number of the last run, and how many of its samples are there.
    last: Option<(u64, u32)>,
}

impl Gathered {
    pub fn new(pixels: usize) -> Self {
        Self {
            tallies: Vec::new(),
            pixels,
            last: None,
        }
    }

    /// Adds the next piece; a run that the last one broke off goes on.
    pub fn add(&mut self, first_sample: u64, samples: u32, tallies: &[Tally]) {
        let runs = run_ranges(first_sample, samples).zip(tallies.chunks(self.pixels));
        for ((start, count), part) in runs {
            let run = start / u64::from(RUN_LENGTH);
            match self.last {
                Some((last, before)) if last == run => {
                    let tail = self.tallies.len() - self.pixels;
                    for (tally, more) in self.tallies[tail..].iter_mut().zip(part) {
                        *tally = joined(tally, before, more, count);
                    }
                    self.last = Some((run, before + count));
                }
                _ => {
                    self.tallies.extend_from_slice(part);
                    self.last = Some((run, count));
                }
            }
        }
    }
}

/// The tally of `n` samples and `m` more (Chan, Golub and LeVeque 1979).
fn joined(a: &Tally, n: u32, b: &Tally, m: u32) -> Tally {
    let share = f64::from(m) / f64::from(n + m);
    let apart: [f64; 3] = std::array::from_fn(|c| f64::from(b.mean[c]) - f64::from(a.mean[c]));
    let squares = |c: usize| {
        let between = apart[c] * apart[c] * share * f64::from(n);
        (f64::from(a.squares[c]) + f64::from(b.squares[c]) + between) as f32
    };
    // The place of the first fault is in the high half.
    let faults = match (a.non_finite, b.non_finite) {
        (0, 0) => 0,
        (0, more) => more + (n << 16),
        (some, more) => some + (more & 0xffff),
    };
    Tally {
        mean: std::array::from_fn(|c| (f64::from(a.mean[c]) + apart[c] * share) as f32),
        rays: a.rays + b.rays,
        squares: std::array::from_fn(squares),
        non_finite: faults,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tally(values: &[f32]) -> Tally {
        let n = values.len() as f32;
        let mean = values.iter().sum::<f32>() / n;
        let squares = values.iter().map(|x| (x - mean) * (x - mean)).sum();
        Tally {
            mean: [mean; 3],
            rays: values.len() as u32,
            squares: [squares; 3],
            non_finite: 0,
        }
    }

    fn block(first_sample: u64, samples: u32) -> Block {
        let rect = Rect {
            x0: 0,
            y0: 0,
            x1: 1,
            y1: 1,
        };
        Block {
            rect,
            first_sample,
            samples,
        }
    }

    #[test]
    fn only_old_software_drivers_stop_early() {
        let device = |kind, driver: &str| DeviceInfo {
            kind,
            driver: driver.into(),
            ..crate::cpu::info()
        };
        let software = |driver| stops_early(&device(DeviceKind::Software, driver));
        assert!(software("llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"));
        assert!(software("llvmpipe Mesa 24.9.1"));
        assert!(software("SwiftShader driver 5.0.0"));
        assert!(!software("llvmpipe Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)"));
        assert!(!software("llvmpipe Mesa 26.1.0-devel"));
        assert!(!stops_early(&device(
            DeviceKind::Hardware,
            "radv Mesa 22.3.6"
        )));
    }

    #[test]
    fn pieces_cover_a_range_and_end_at_fixed_places() {
        for (first, samples, most) in [(0, 64, 4), (5, 40, 8), (7, 1, 1), ((1 << 40) + 3, 99, 32)] {
            let mut next = first;
            for piece in pieces(block(first, samples), most) {
                assert_eq!(piece.first_sample, next);
                next += u64::from(piece.samples);
                let end = first + u64::from(samples);
                assert!(
                    piece.samples <= most && (next == end || next.is_multiple_of(u64::from(most)))
                );
            }
            assert_eq!(next, first + u64::from(samples));
        }
    }

    #[test]
    fn pieces_add_up_to_runs() {
        let values: Vec<f32> = (0..24u8)
            .map(|i| f32::from(i.wrapping_mul(37) % 11))
            .collect();
        let mut gathered = Gathered::new(1);
        for piece in pieces(block(4, 24), 4) {
            let (start, count) = (piece.first_sample, piece.samples);
            let from = start as usize - 4;
            gathered.add(start, count, &[tally(&values[from..from + count as usize])]);
        }
        let runs = [&values[..12], &values[12..]].map(tally);
        assert_eq!(gathered.tallies.len(), 2);
        for (got, wanted) in gathered.tallies.iter().zip(runs) {
            assert!((got.mean[0] - wanted.mean[0]).abs() < 1e-5, "{got:?}");
            assert!((got.squares[0] - wanted.squares[0]).abs() < 1e-3, "{got:?}");
            assert_eq!(got.rays, wanted.rays);
        }
    }

    #[test]
    fn the_first_fault_of_a_run_keeps_its_place() {
        let (clean, faulty) = (
            tally(&[1.0, 2.0]),
            Tally {
                non_finite: 1 | 1 << 16,
                ..tally(&[0.0, 0.0])
            },
        );
        assert_eq!(joined(&clean, 2, &faulty, 2).non_finite, 1 | 3 << 16);
        assert_eq!(joined(&faulty, 2, &faulty, 2).non_finite, 2 | 1 << 16);
        assert_eq!(joined(&faulty, 2, &clean, 2).non_finite, 1 | 1 << 16);
    }
}
