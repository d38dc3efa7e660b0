//! What a sample costs by each kernel, in rooms of more and more spheres.
//!
//!   cargo bench --bench kernels -- [DEVICE] [COUNTS] [ROUNDS]
//!
//! for example `software 8,32,128,1000 5`. Each round takes every scene and kernel once, forwards and
//! then backwards, so that a clock that drifts is everyone's; the table has medians. The same pixels
//! and samples are traced by all, and they must agree bit for bit.

#[path = "support/spheres.rs"]
mod spheres;

use lampray::device::Device;
use lampray::pack::{Packed, Rect, Tally};
use std::time::Instant;

/// Seconds of processor time that this process has taken, where the system tells (Linux: in hundredths);
/// work of others on the same machine does not count then.
fn processor_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<_> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |place: usize| fields.get(place)?.parse::<f64>().ok();
    Some(0.01 * (ticks(11)? + ticks(12)?))
}

const SIDE: u32 = 96;
/// A trace is repeated with more samples until it takes this long.
const SECONDS: f64 = 0.4;

struct Entry {
    count: usize,
    kernel: &'static str,
    packed: Packed,
    samples: u32,
    /// Seconds a sample, one a visit: of processor time where it is known.
    costs: Vec<f64>,
    rays: f64,
}

fn timed<T>(what: impl FnOnce() -> T) -> (T, f64) {
    let began = Instant::now();
    let outcome = what();
    (outcome, began.elapsed().as_secs_f64())
}

const WHOLE: Rect = Rect {
    x0: 0,
    y0: 0,
    x1: SIDE,
    y1: SIDE,
};

fn packed(count: usize, kernel: &str) -> (Packed, f64) {
    let sets = [
        format!("render.kernel={kernel}"),
        format!("image.width={SIDE}"),
        format!("image.height={SIDE}"),
    ];
    let scene = spheres::room(count, &sets);
    timed(|| Packed::new(&scene))
}

fn sum(tallies: &[Tally]) -> f64 {
    tallies.iter().map(|tally| f64::from(tally.rays)).sum()
}

/// An entry whose number of samples takes long enough, and one sample of it; none where the device
/// refuses the scene.
fn entry(
    device: &mut dyn Device,
    count: usize,
    kernel: &'static str,
) -> Option<(Entry, Vec<Tally>)> {
    let (packed, pack) = packed(count, kernel);
    let (loaded, load) = timed(|| device.load(&packed));
    println!("{count:>8} {kernel:>8}: pack {pack:.2} s, load {load:.2} s");
    let first = loaded.and_then(|()| device.trace(WHOLE, 0, 1));
    let first = first.inspect_err(|error| println!("{error}")).ok()?;
    let (again, took) = timed(|| device.trace(WHOLE, 1, 1));
    let again = again.inspect_err(|error| println!("{error}")).ok()?;
    let entry = Entry {
        count,
        kernel,
        packed,
        samples: ((SECONDS / took) as u32).clamp(1, 64),
        costs: Vec::new(),
        rays: sum(&again) / WHOLE.area() as f64,
    };
    Some((entry, first))
}

fn visit(device: &mut dyn Device, entry: &mut Entry) {
    device.load(&entry.packed).unwrap();
    device.trace(WHOLE, 0, 1).unwrap();
    let before = processor_seconds();
    let (_, took) = timed(|| device.trace(WHOLE, 0, entry.samples).unwrap());
    let took = processor_seconds()
        .zip(before)
        .map_or(took, |(after, before)| after - before);
    let samples = WHOLE.area() as f64 * f64::from(entry.samples);
    entry.costs.push(took / samples);
}

fn median(values: &[f64]) -> f64 {
    if values.is_empty() {
        return f64::NAN;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
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
    let counts = word(1, "8,32,128,1000,10000");
    let rounds: usize = word(2, "5").parse().unwrap();
    println!("{} ({})", device.info().name, device.info().driver);
    let mut entries = Vec::new();
    for count in counts.split(',').map(|count| count.parse().unwrap()) {
        let mut seen: Option<Vec<Tally>> = None;
        for kernel in ["general", "bvh"] {
            if kernel == "general" && count > 2000 {
                continue;
            }
            if let Some((entry, tallies)) = entry(&mut *device, count, kernel) {
                let other = seen.get_or_insert_with(|| tallies.clone());
                assert!(*other == tallies, "{count}: the kernels differ");
                entries.push(entry);
            }
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
    println!("| spheres | kernel | us a sample | rays a sample | Mrays/s |");
    println!("|---|---|---|---|---|");
    for entry in &entries {
        let (cost, rays) = (1e6 * median(&entry.costs), entry.rays);
        println!(
            "| {} | {} | {cost:.3} | {rays:.2} | {:.2} |",
            entry.count,
            entry.kernel,
            rays / cost
        );
    }
}
