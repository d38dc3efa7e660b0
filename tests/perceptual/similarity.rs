//! SSIM against scikit-image, MS-SSIM against TensorFlow.

use super::pictures::{assert_pixels, bytes};
use lampray::compare::similarity::{ms_ssim, ssim};
use serde_json::Value;

/// The luma is rounded to f32 here and is f64 in scikit-image; 5.5e-9 is the most that was seen.
const SSIM: f64 = 1e-7;
/// The map is of f32; 7e-8 is the most that was seen.
const PIXEL: f64 = 1e-6;
/// TensorFlow calculates in f32; 4.3e-6 is the most that was seen.
const MS_SSIM: f64 = 1e-5;

#[test]
fn ssim_and_ms_ssim_are_what_other_libraries_say() {
    let listed: Vec<Value> =
        serde_json::from_str(include_str!("../fixtures/flip/similarity.json")).unwrap();
    assert_eq!(listed.len(), 7);
    for entry in listed {
        let [width, height] = ["width", "height"].map(|key| entry[key].as_u64().unwrap() as u32);
        let name = entry["name"].as_str().unwrap();
        let pair = bytes(name, width, height);
        assert_eq!(
            serde_json::json!(pair.sums),
            entry["sums"],
            "the formulas of {name} differ"
        );
        let (mean, map) = ssim(&pair.reference, &pair.test).unwrap();
        let theirs = entry["ssim"].as_f64().unwrap();
        assert!(
            (mean - theirs).abs() <= SSIM,
            "{name}: {mean} and not {theirs}"
        );
        assert_pixels(&map, &entry["pixels"], PIXEL, name);
        let multi = ms_ssim(&pair.reference, &pair.test);
        let theirs = entry["ms_ssim"].as_f64();
        assert_eq!(multi.is_some(), theirs.is_some(), "{name}");
        let apart = multi.unwrap_or(0.0) - theirs.unwrap_or(0.0);
        assert!(
            apart.abs() <= MS_SSIM,
            "{name}: {multi:?} and not {theirs:?}"
        );
    }
}

#[test]
fn ssim_does_not_depend_on_the_threads() {
    let pair = bytes("noisy", 180, 177);
    let all = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let (mean, map) = ssim(&pair.reference, &pair.test).unwrap();
            (mean, map, ms_ssim(&pair.reference, &pair.test))
        })
    };
    assert!(all(1) == all(2) && all(1) == all(5));
}
