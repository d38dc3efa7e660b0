//! What each technique of the baked kernel is worth: the kernel without it, against the kernel.
//!
//!   cargo bench --bench ablation -- [DEVICE] [SCENE] [ROUNDS] [NAMES]
//!
//! for example `software scenes/cornell.toml 7 selects,loops`. DEVICE is `software` or `hardware`; NAMES are parts
//! of the techniques' names, none for all of them. A name that ends in `.wgsl` is a file that holds a whole text of the kernel, to be
//! measured like a technique; `text` alone prints the one that ships, to begin with.
//!
//! Each round takes every variant once, forwards and then backwards, so that a clock that drifts is
//! everyone's; a ratio is of the times in one round. The table has the median over rounds, and the
//! smallest and largest. Every variant must draw the same picture: to the bit, or to rounding.

mod edit;
#[path = "../support/processor.rs"]
mod processor;
mod runner;
mod techniques;

use edit::edited;
use lampray::pack::{Packed, Rect, Tally, Traversal};
use lampray::scene::Scene;
use lampray::shader::{self, Baked, Joined, Kernel, SceneArrays};
use processor::processor_seconds;
use runner::{Device, Variant};
use techniques::{Picture, SAMPLES, TECHNIQUES, Technique};

/// Samples of each pixel in a visit.
const VISIT: u32 = 64;

struct Entry {
    name: String,
    instead: String,
    expected: Option<[f64; 2]>,
    samples: u32,
    picture: Picture,
    variant: Variant,
    /// Seconds of processor time a sample, one a visit.
    costs: Vec<f64>,
    tallies: Vec<Tally>,
}

/// Texts of the kernel: as it ships, and the general one of the same scene.
fn texts(scene: &Packed) -> (Joined, String) {
    let arrays = SceneArrays::new(scene);
    let baked = Baked::new(scene, arrays).and_then(|baked| shader::baked_source(&baked));
    let general = shader::source(Kernel::Trace, arrays);
    (baked.unwrap(), general.unwrap().text)
}

fn entries(device: &Device, scene: &Packed, names: &[String]) -> Vec<Entry> {
    let (shipping, general) = texts(scene);
    let entry = |name: &str, text: String, technique: Option<&Technique>| {
        let mut joined = shipping.clone();
        joined.text = text;
        Entry {
            name: name.into(),
            instead: technique.map_or("", |technique| technique.instead).into(),
            expected: technique.map(|technique| technique.expected),
            samples: technique.map_or(SAMPLES, |technique| technique.samples),
            picture: technique.map_or(Picture::Mean, |technique| technique.picture),
            variant: device.variant(&joined, scene),
            costs: Vec::new(),
            tallies: Vec::new(),
        }
    };
    let mut all = vec![entry("as it ships", shipping.text.clone(), None)];
    let (files, names): (Vec<_>, Vec<_>) = names.iter().partition(|name| name.ends_with(".wgsl"));
    let wanted = |technique: &&Technique| {
        (names.is_empty() && files.is_empty())
            || names
                .iter()
                .any(|name| technique.name.contains(name.as_str()))
    };
    for technique in TECHNIQUES.iter().filter(wanted) {
        let text = edited(&shipping.text, &general, technique.edits);
        let text = text.unwrap_or_else(|fault| panic!("{}: {fault}", technique.name));
        all.push(entry(technique.name, text, Some(technique)));
    }
    for file in files {
        let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
        all.push(entry(file, text, None));
    }
    all
}

fn visit(device: &Device, entry: &mut Entry, scene: &Packed, rect: Rect) {
    let before = processor_seconds().expect("the system does not tell processor time");
    let dispatches = VISIT / entry.samples;
    for dispatch in 0..dispatches {
        let first = u64::from(dispatch * entry.samples);
        let tallies = device.trace(&entry.variant, scene, rect, first, entry.samples);
        entry.tallies.extend(tallies);
    }
    let took = processor_seconds().unwrap_or(before) - before;
    entry
        .costs
        .push(took / (rect.area() as f64 * f64::from(VISIT)));
}

/// Mean over pixels and channels, and its standard error.
fn mean(tallies: &[Tally]) -> (f64, f64) {
    let count = 3.0 * tallies.len() as f64;
    let runs = f64::from(lampray::pack::RUN_LENGTH);
    let all =
        |of: fn(&Tally) -> [f32; 3]| -> f64 { tallies.iter().flat_map(of).map(f64::from).sum() };
    let error = (all(|tally| tally.squares) / (runs * (runs - 1.0))).sqrt();
    (all(|tally| tally.mean) / count, error / count)
}

/// Whether a picture is what it must be, in words.
fn judged(entry: &Entry, shipping: &[Tally]) -> String {
    if entry.tallies == shipping {
        return "same bits".into();
    }
    let of_file = entry.expected.is_none();
    assert!(
        of_file || entry.picture == Picture::Mean,
        "{}: other bits",
        entry.name
    );
    let ((ours, error), (theirs, _)) = (mean(&entry.tallies), mean(shipping));
    // The paths are the same ones, so that this is far stricter than the noise of two pictures.
    let apart = (ours - theirs) / error;
    assert!(
        of_file || apart.abs() < 1.0,
        "{}: another picture, {apart:.1} standard errors",
        entry.name
    );
    format!(
        "mean {:+.4} %, {apart:+.2} s.e.",
        100.0 * (ours / theirs - 1.0)
    )
}

/// Smallest, middle and largest.
fn spread(values: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut sorted: Vec<_> = values.collect();
    sorted.sort_by(f64::total_cmp);
    [0, sorted.len() / 2, sorted.len() - 1].map(|place| sorted[place])
}

/// Times of one round: those of its two visits together.
fn rounds(costs: &[f64]) -> impl Iterator<Item = f64> {
    costs.chunks(2).map(|pair| pair.iter().sum::<f64>() / 2.0)
}

fn print(entries: &[Entry], shipping: &[Tally]) {
    let first = &entries[0];
    let [low, middle, high] = spread(rounds(&first.costs)).map(|cost| 1e9 * cost);
    println!(
        "{}: {middle:.1} ns a sample ({low:.1} to {high:.1})",
        first.name
    );
    println!(
        "| without | instead | expected: 22.3.6, 25.0.7 | measured | smallest, largest | picture |"
    );
    println!("|---|---|---|---|---|---|");
    for entry in &entries[1..] {
        let pairs = rounds(&entry.costs).zip(rounds(&first.costs));
        let [low, middle, high] = spread(pairs.map(|(of, ship)| of / ship));
        let expected = entry
            .expected
            .map_or("-".into(), |[old, new]| format!("{old:.2}, {new:.2}"));
        println!(
            "| {} | {} | {expected} | {middle:.3} | {low:.3}, {high:.3} | {} |",
            entry.name,
            entry.instead,
            judged(entry, shipping)
        );
    }
}

fn main() {
    let words: Vec<_> = std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with("--"))
        .collect();
    let word = |place: usize, default: &str| words.get(place).cloned().unwrap_or(default.into());
    let scene = Scene::load(word(1, "scenes/cornell.toml").as_ref(), &[]);
    let scene = scene.unwrap_or_else(|error| panic!("{error}"));
    let rect = lampray::render::whole(&scene);
    let scene = Packed::by(&scene, Traversal::Baked);
    let names: Vec<String> = word(3, "")
        .split(',')
        .filter(|name| !name.is_empty())
        .map(String::from)
        .collect();
    if names == ["text"] {
        return print!("{}", texts(&scene).0.text);
    }
    let device = Device::open(word(0, "software") == "software");
    println!("{}", device.name);
    let mut entries = entries(&device, &scene, &names);
    for entry in &mut entries {
        visit(&device, entry, &scene, rect);
        entry.costs.clear();
    }
    // A dispatch of fewer samples gives the same tallies in the same order.
    let shipping = entries[0].tallies.clone();
    for _ in 0..word(2, "5").parse().unwrap() {
        for entry in &mut entries {
            visit(&device, entry, &scene, rect);
        }
        for entry in entries.iter_mut().rev() {
            visit(&device, entry, &scene, rect);
        }
        for entry in &mut entries {
            entry.tallies.truncate(shipping.len());
        }
    }
    print(&entries, &shipping);
}
