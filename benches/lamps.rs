//! What a sample costs by each choice of lamps, and how noisy it is, in rooms of more and more lamps.
//!
//!   cargo bench --bench lamps -- [DEVICE] [COUNTS] [ROUNDS] [CHOICES] [KNOB=VALUE...]
//!
//! for example `cpu 100,1000,10000 3 all,tree light.strategy=sample`. Each round takes every room and choice
//! once, forwards and then backwards; the table has medians of processor time where it is known. The error
//! is the standard deviation of one sample, over the mean of the picture, from the samples themselves; the
//! last column is 1 / (variance x time), over that of the room's first choice: above 1 the choice pays.
//!
//! Expected before anything was measured: `all` costs as many shadow rays as there are lamps, 10 times as
//! much for 10 times the lamps and more as the tree of bodies deepens; what one lamp costs is a ray more and,
//! with `tree`, a walk of log2 n pairs: from 100 to 100,000 lamps at most 2.5 times the time (17 pairs for
//! 7, and the bodies' tree grows alike). `uniform` is noisiest, `power` has a quarter less deviation, `tree`
//! two to three times less than `uniform`, hardly growing with n. At equal time `tree` beats `all` by
//! 3 at 100 lamps and by 1000 at 100,000.

#[path = "support/lamps.rs"]
mod lamps;
#[path = "support/processor.rs"]
mod processor;

use lampray::device::{Device, run_ranges};
use lampray::pack::{Packed, Rect, Tally};
use processor::processor_seconds;
use std::time::Instant;

/// The whole picture: so small that every lamp's shadow rays are affordable.
const PART: Rect = Rect {
    x0: 0,
    y0: 0,
    x1: 8,
    y1: 8,
};
/// A visit takes as many samples as fit into this, whole runs of 16 where they are more.
const SECONDS: f64 = 0.5;
const MOST_SAMPLES: u32 = 2048;

struct Entry {
    count: usize,
    choice: String,
    packed: Packed,
    /// Of a visit; the next one takes the samples after them.
    samples: u32,
    next: u64,
    pack: f64,
    /// Seconds a sample, one a visit.
    costs: Vec<f64>,
    /// Summed over runs and channels: squared deviations, and the samples less one.
    squares: f64,
    freedom: f64,
    /// Summed over samples and channels.
    light: f64,
    weight: f64,
}

fn timed<T>(what: impl FnOnce() -> T) -> (T, f64) {
    let began = Instant::now();
    let outcome = what();
    (outcome, began.elapsed().as_secs_f64())
}

/// None where the device refuses the scene.
fn entry(device: &mut dyn Device, count: usize, choice: &str, sets: &[String]) -> Option<Entry> {
    let sets = [sets, &[format!("light.choice={choice}")]].concat();
    let scene = lamps::room(count, &sets);
    let (packed, pack) = timed(|| Packed::new(&scene));
    let loaded = device.load(&packed).and_then(|()| device.trace(PART, 0, 1));
    let refused = |error: &lampray::Error| println!("{count} {choice}: {error}");
    loaded.inspect_err(refused).ok()?;
    let (_, took) = timed(|| device.trace(PART, 1, 1));
    let samples = ((SECONDS / took) as u32).clamp(2, MOST_SAMPLES);
    Some(Entry {
        count,
        choice: choice.into(),
        packed,
        samples: if samples > 16 {
            samples / 16 * 16
        } else {
            samples
        },
        next: 16,
        pack,
        costs: Vec::new(),
        squares: 0.0,
        freedom: 0.0,
        light: 0.0,
        weight: 0.0,
    })
}

fn add(entry: &mut Entry, tallies: &[Tally]) {
    let runs = run_ranges(entry.next, entry.samples);
    for ((_, samples), tallies) in runs.zip(tallies.chunks(PART.area())) {
        let samples = f64::from(samples);
        for tally in tallies {
            entry.squares += tally.squares.iter().map(|x| f64::from(*x)).sum::<f64>();
            entry.light += samples * tally.mean.iter().map(|x| f64::from(*x)).sum::<f64>();
            entry.freedom += 3.0 * (samples - 1.0);
            entry.weight += 3.0 * samples;
        }
    }
}

fn visit(device: &mut dyn Device, entry: &mut Entry) {
    device.load(&entry.packed).unwrap();
    let before = processor_seconds();
    let (tallies, took) = timed(|| device.trace(PART, entry.next, entry.samples).unwrap());
    let took = processor_seconds()
        .zip(before)
        .map_or(took, |(after, before)| after - before);
    add(entry, &tallies);
    entry.next = (entry.next + u64::from(entry.samples)).next_multiple_of(16);
    entry
        .costs
        .push(took / (PART.area() as f64 * f64::from(entry.samples)));
}

impl Entry {
    fn cost(&self) -> f64 {
        let mut sorted = self.costs.clone();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() / 2]
    }

    /// Of one sample.
    fn variance(&self) -> f64 {
        self.squares / self.freedom
    }

    fn mean(&self) -> f64 {
        self.light / self.weight
    }
}

fn main() {
    let words: Vec<_> = std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with("--"))
        .collect();
    let word = |place: usize, default: &str| words.get(place).cloned().unwrap_or(default.into());
    let mut device = lampray::render::open(&word(0, "auto").parse().unwrap(), None)
        .unwrap()
        .device;
    let counts = word(1, "100,1000,10000,100000");
    let rounds: usize = word(2, "3").parse().unwrap();
    let choices = word(3, "all,uniform,power,tree");
    let sets: Vec<_> = words.iter().skip(4).cloned().collect();
    println!("{} ({})", device.info().name, device.info().driver);
    let mut entries = Vec::new();
    for count in counts.split(',').map(|count| count.parse().unwrap()) {
        for choice in choices.split(',') {
            entries.extend(entry(&mut *device, count, choice, &sets));
        }
    }
    for _ in 0..rounds {
        for entry in &mut entries {
            visit(&mut *device, entry);
        }
        for entry in entries.iter_mut().rev() {
            visit(&mut *device, entry);
        }
    }
    println!(
        "| lamps | choice | pack, s | us a sample | mean | error of a sample | 1 / (variance x time) |"
    );
    println!("|---|---|---|---|---|---|---|");
    for entry in &entries {
        let worth = |entry: &Entry| 1.0 / (entry.variance() * entry.cost());
        let mut alike = entries.iter().filter(|other| other.count == entry.count);
        let first = alike.next().map_or(f64::NAN, worth);
        println!(
            "| {} | {} | {:.2} | {:.2} | {:.4} | {:.3} | {:.3} |",
            entry.count,
            entry.choice,
            entry.pack,
            1e6 * entry.cost(),
            entry.mean(),
            entry.variance().sqrt() / entry.mean(),
            worth(entry) / first
        );
    }
}
