//! Grids that a stranger's scene asks for.

use super::program::{Case, scene};

fn refused(set: &str, reason: &str) {
    let case = Case::new(&scene([0.0; 3], &format!("[sweep]\nset = [{set}]\n")));
    let sweep = [
        "sweep",
        "s.toml",
        "--device",
        "cpu",
        "--dry-run",
        "-o",
        "out",
    ];
    #[cfg(unix)]
    let ended = case.run_within(1 << 30, &sweep);
    #[cfg(not(unix))]
    let ended = case.run(&sweep);
    assert_eq!(ended.code, 2, "{:.300}", ended.said);
    assert!(ended.said.contains(reason), "{:.300}", ended.said);
    assert!(ended.said.len() < 1000);
    assert!(!ended.said.contains('\u{1b}'), "{:?}", ended.said);
}

#[test]
fn grids_that_would_fill_the_memory() {
    refused(&"'a=1..1000000',".repeat(1000), "over 1000000 values");
    let list = vec!["1..900000"; 100_000].join(",");
    refused(&format!("'a={list}'"), "over 1000000 values");
    let ones: String = (0..100_000)
        .map(|number| format!("'k{number}=1',"))
        .collect();
    refused(&ones, "over 1000 knobs");
    let few: String = (0..900).map(|number| format!("'k{number}=1',")).collect();
    refused(&format!("{few}'render.seed=1..900000'"), "over 4000000");
    refused("'\\u001b[2J=1,1'", "there twice");
    refused("\"\\u001b[2J=1,1\"", "there twice");
}

/// The number of paths does not fit 64 bits, nor do the seconds a clock.
#[test]
fn the_largest_sweep_is_foretold() {
    let case = Case::new(&scene([0.0; 3], ""));
    let size = [
        "--width",
        "32768",
        "--height",
        "8192",
        "--samples",
        "2147483647",
    ];
    let grid = [
        "--set",
        "camera.fov=1..100",
        "--reference",
        "none",
        "--dry-run",
        "--json",
    ];
    let sweep = ["sweep", "s.toml", "--device", "cpu", "-o", "out"];
    let ended = case.run(&[&sweep, &size[..], &grid].concat());
    assert_eq!(ended.code, 0, "{ended:?}");
    let told: serde_json::Value = serde_json::from_str(&ended.printed).unwrap();
    assert_eq!(told["runs"], 100);
    assert_eq!(told["paths"], u64::MAX);
    assert!(told["seconds"].as_f64().unwrap() > 1e6);
    let words = case.run(&[&sweep, &size[..], &grid[..5]].concat());
    assert_eq!(words.code, 0, "{words:?}");
}
