//! FLIP against NVIDIA's own tool, and strips against the whole.

use super::pictures::{Pair, assert_pixels, bytes, light};
use lampray::compare::flip::{self, DEFAULT_PPD, Exposures};
use serde_json::Value;

/// No bit differs on the machine that made the fixtures. Other processors' `powf` may round otherwise,
/// which FLIP's exponents magnify.
const PIXEL: f64 = 2e-6;
/// NVIDIA's tool adds in f32; 1.7e-7 is the most that was seen.
const MEAN: f64 = 1e-6;
/// NVIDIA's tool finds white by f32, with 6e-7 of a stop lost; that is the most that was seen.
const STOPS: f64 = 2e-6;

/// The pairs of `fixtures/flip/nvidia.json` in linear light, or the others.
fn nvidia(high: bool) -> Vec<(String, Value, Pair)> {
    let listed: Vec<Value> =
        serde_json::from_str(include_str!("../fixtures/flip/nvidia.json")).unwrap();
    let chosen = listed
        .into_iter()
        .filter(|entry| entry.get("exposures").is_some() == high);
    let pairs = chosen.map(|entry| {
        let size = ["width", "height"].map(|key| entry[key].as_u64().unwrap());
        let name = entry["name"].as_str().unwrap();
        let make = if high { light } else { bytes };
        let pair = make(name, size[0] as u32, size[1] as u32);
        assert_eq!(
            serde_json::json!(pair.sums),
            entry["sums"],
            "the formulas of {name} differ"
        );
        (format!("{name} {size:?}"), entry, pair)
    });
    pairs.collect()
}

fn assert_mean(ours: f64, theirs: &Value, name: &str) {
    let theirs = theirs.as_f64().unwrap();
    assert!(
        (ours - theirs).abs() <= MEAN,
        "{name}: mean {ours} and not {theirs}"
    );
}

fn used(entry: &Value) -> Exposures {
    let [start, stop] = [0, 1].map(|i| entry["exposures"][i].as_f64().unwrap() as f32);
    let count = entry["exposures"][2].as_u64().unwrap() as u32;
    Exposures { start, stop, count }
}

#[test]
fn ldr_is_what_nvidias_tool_says() {
    for (name, entry, pair) in nvidia(false) {
        let ppd = entry["ppd"].as_f64().unwrap() as f32;
        let map = flip::ldr(&pair.reference, &pair.test, ppd).unwrap();
        assert_mean(map.mean(), &entry["mean"], &name);
        assert_pixels(&map, &entry["pixels"], PIXEL, &name);
    }
}

#[test]
fn hdr_is_what_nvidias_tool_says() {
    for (name, entry, pair) in nvidia(true) {
        let ppd = entry["ppd"].as_f64().unwrap() as f32;
        let map = flip::hdr(&pair.reference, &pair.test, ppd, used(&entry)).unwrap();
        assert_mean(map.mean(), &entry["mean"], &name);
        assert_pixels(&map, &entry["pixels"], PIXEL, &name);
    }
}

#[test]
fn automatic_exposures_are_nvidias() {
    let automatic = |entry: &Value| entry["given"] == false && entry["name"] != "black";
    let mut checked = 0;
    for (name, entry, pair) in nvidia(true) {
        if automatic(&entry) {
            let (ours, theirs) = (Exposures::of(&pair.reference), used(&entry));
            let apart = [ours.start - theirs.start, ours.stop - theirs.stop];
            assert!(
                apart.iter().all(|d| f64::from(d.abs()) <= STOPS),
                "{name}: {ours:?}"
            );
            assert_eq!(ours.count, theirs.count, "{name}");
            checked += 1;
        }
    }
    assert_eq!(checked, 4);
}

/// Where NVIDIA's tool goes to 24 stops for the black background, the lit part alone decides here.
#[test]
fn a_black_background_has_no_say_in_the_exposures() {
    let pair = light("black", 60, 45);
    let lit = pair.reference.pixels.iter().filter(|pixel| pixel[0] > 0.0);
    assert!(2 * lit.count() < pair.reference.pixels.len());
    let ours = Exposures::of(&pair.reference);
    let mut alone = pair.reference.clone();
    alone.pixels.retain(|pixel| pixel[0] > 0.0);
    (alone.width, alone.height) = (alone.pixels.len() as u32, 1);
    assert_eq!(ours, Exposures::of(&alone));
    let theirs = nvidia(true)
        .into_iter()
        .find(|(name, ..)| name.starts_with("black"));
    let theirs = used(&theirs.unwrap().1);
    assert!((ours.start - theirs.start).abs() < 1e-6);
    assert!(
        ours.stop < 2.0 && theirs.stop > 24.0,
        "{ours:?}, {theirs:?}"
    );
}

/// Whatever the heights of the strips, which follow the picture, the filters and the threads.
#[test]
fn strips_give_the_bits_of_the_whole() {
    for (height, ppd) in [
        (1, 30.0),
        (63, 30.0),
        (130, 9.0),
        (401, 20.0),
        (257, DEFAULT_PPD),
    ] {
        let pair = bytes("noisy", 19, height);
        let [a, b] = [&pair.reference, &pair.test].map(|picture| {
            let channels = picture.pixels.as_flattened().to_vec();
            flip_rs::RgbImage::new(19, height as usize, channels).unwrap()
        });
        let whole = flip_rs::ldr_flip(&a, &b, ppd).unwrap();
        for threads in [1, 2, 5, 16] {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            let map = pool.install(|| flip::ldr(&pair.reference, &pair.test, ppd).unwrap());
            assert_eq!(
                map.values,
                whole.pixels(),
                "{height} lines, {threads} threads, {ppd}"
            );
        }
    }
}

#[test]
fn strips_give_the_bits_of_the_whole_in_linear_light() {
    let pair = light("range", 23, 300);
    let exposures = Exposures::of(&pair.reference);
    let map = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| flip::hdr(&pair.reference, &pair.test, 12.0, exposures).unwrap())
    };
    let one = map(1);
    assert!(one.mean() > 0.01);
    assert!([2, 7, 300].into_iter().all(|threads| map(threads) == one));
}
