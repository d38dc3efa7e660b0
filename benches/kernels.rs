//! What a sample costs by each kernel, in rooms of more and more spheres or in scene files.
//!
//!   MESA_SHADER_CACHE_DISABLE=1 cargo bench --bench kernels -- [DEVICE] [SCENES] [ROUNDS] [KERNELS]
//!
//! for example `software 8,32,128,1000 5 general,bvh`; a scene is a number of spheres, or a file with any
//! `+KNOB=VALUE` behind it: `scenes/cornell.toml+light.strategy=sample`. Each round takes every scene and kernel once, forwards and
//! then backwards, so that a clock that drifts is everyone's; the table has medians. The same pixels
//! and samples are traced by all, and they must agree bit for bit.

#[path = "support/processor.rs"]
mod processor;
#[path = "support/spheres.rs"]
mod spheres;

use lampray::device::Device;
use lampray::pack::{Packed, Rect, Tally};
use lampray::scene::{Assignment, Scene};
use processor::processor_seconds;
use std::time::Instant;

const SIDE: u32 = 96;
/// A trace is repeated with more samples until it takes this long.
const SECONDS: f64 = 0.4;

struct Entry {
    name: String,
    kernel: String,
    packed: Packed,
    whole: Rect,
    samples: u32,
    /// Seconds that the first load took: most of it goes to compiling.
    load: f64,
    /// Seconds a sample, one a visit: of processor time where it is known.
    costs: Vec<f64>,
    rays: f64,
}

fn timed<T>(what: impl FnOnce() -> T) -> (T, f64) {
    let began = Instant::now();
    let outcome = what();
    (outcome, began.elapsed().as_secs_f64())
}

/// A room of so many spheres, or a scene file with its settings.
fn scene(name: &str, kernel: &str) -> Scene {
    let kernel = format!("render.kernel={kernel}");
    if let Ok(count) = name.parse() {
        let size = ["width", "height"].map(|side| format!("image.{side}={SIDE}"));
        return spheres::room(count, &[&size[..], &[kernel]].concat());
    }
    let mut words = name.split('+');
    let path = words.next().unwrap_or_default();
    let sets = words.chain([kernel.as_str()]);
    let sets: Result<Vec<_>, _> = sets.map(Assignment::parse).collect();
    Scene::load(path.as_ref(), &sets.unwrap()).unwrap_or_else(|error| panic!("{error}"))
}

fn sum(tallies: &[Tally]) -> f64 {
    tallies.iter().map(|tally| f64::from(tally.rays)).sum()
}

/// An entry whose number of samples takes long enough, and one sample of it; none where the device
/// refuses the scene.
fn entry(device: &mut dyn Device, name: &str, kernel: &str) -> Option<(Entry, Vec<Tally>)> {
    let scene = scene(name, kernel);
    let whole = lampray::render::whole(&scene);
    let (packed, pack) = timed(|| Packed::new(&scene));
    let (loaded, load) = timed(|| device.load(&packed));
    println!("{name:>8} {kernel:>8}: pack {pack:.2} s, load {load:.2} s");
    let first = loaded.and_then(|()| device.trace(whole, 0, 1));
    let first = first.inspect_err(|error| println!("{error}")).ok()?;
    let (again, took) = timed(|| device.trace(whole, 1, 1));
    let again = again.inspect_err(|error| println!("{error}")).ok()?;
    let entry = Entry {
        name: name.into(),
        kernel: kernel.into(),
        packed,
        whole,
        samples: ((SECONDS / took) as u32).clamp(1, 64),
        load,
        costs: Vec::new(),
        rays: sum(&again) / whole.area() as f64,
    };
    Some((entry, first))
}

fn visit(device: &mut dyn Device, entry: &mut Entry) {
    device.load(&entry.packed).unwrap();
    device.trace(entry.whole, 0, 1).unwrap();
    let before = processor_seconds();
    let (_, took) = timed(|| device.trace(entry.whole, 0, entry.samples).unwrap());
    let took = processor_seconds()
        .zip(before)
        .map_or(took, |(after, before)| after - before);
    let samples = entry.whole.area() as f64 * f64::from(entry.samples);
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
    let names = word(1, "8,32,128,1000,10000");
    let rounds: usize = word(2, "5").parse().unwrap();
    println!("{} ({})", device.info().name, device.info().driver);
    let mut entries = Vec::new();
    let kernels = word(3, "general,bvh,baked");
    for name in names.split(',') {
        let mut seen: Option<Vec<Tally>> = None;
        let spheres = name.parse().unwrap_or(0);
        for kernel in kernels.split(',') {
            let most = match kernel {
                "general" => 2000,
                "baked" => 128,
                _ => usize::MAX,
            };
            if spheres > most {
                continue;
            }
            if let Some((entry, tallies)) = entry(&mut *device, name, kernel) {
                let other = seen.get_or_insert_with(|| tallies.clone());
                assert!(*other == tallies, "{name}: the kernels differ");
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
    println!("| scene | kernel | load, s | us a sample | rays a sample | Mrays/s | of the first |");
    println!("|---|---|---|---|---|---|---|");
    for entry in &entries {
        let (cost, rays) = (1e6 * median(&entry.costs), entry.rays);
        let mut alike = entries.iter().filter(|other| other.name == entry.name);
        let first = alike.next().map_or(f64::NAN, |first| median(&first.costs));
        println!(
            "| {} | {} | {:.2} | {cost:.3} | {rays:.2} | {:.2} | {:.2} |",
            entry.name,
            entry.kernel,
            entry.load,
            rays / cost,
            1e6 * first / cost
        );
    }
}
