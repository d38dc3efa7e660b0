//! What runs are held against.

use super::bench::*;
use serde_json::Value;
use std::fs;
use std::process::Command;

/// The paper puts Lambert light on what is not Lambert.
const PAPER: [&str; 10] = [
    "--set",
    "render.preset=paper,corrected",
    "--set",
    "image.filter=box",
    "--set",
    "materials.white.scatter=directional",
    "--set",
    "render.samples=64",
    "--seeds",
    "4",
];

/// One command tells what is biased from what is not, and a second one makes nothing anew.
#[test]
fn bias_is_found_without_being_asked_for() {
    let folder = folder();
    let at = folder.path();
    assert_eq!(code(at, &PAPER), 0);
    assert_eq!(reference_samples(at), [512]);
    let first = report(at);
    let verdicts = verdicts(&first);
    assert_eq!(verdicts.len(), 2);
    assert_eq!(verdicts[0], "different");
    assert_ne!(verdicts[1], "different");
    let words = findings(&first);
    assert!(words.starts_with("paper is biased"), "{words}");
    assert_eq!(first["references"][0]["samples"], 512);
    // The reference is no run.
    assert_eq!(entries(at).len(), 8);
    let table = fs::read_to_string(at.join("out/table.csv")).expect("a table");
    assert_eq!(table.lines().count(), 9);
    let told = sweep(at, &[&PAPER[..], &["--json"]].concat());
    let told: Value = serde_json::from_slice(&told.stdout).expect("JSON");
    assert_eq!((&told["made"], &told["skipped"]), (&0.into(), &8.into()));
    let own = &told["references"];
    assert_eq!((&own["made"], &own["found"]), (&0.into(), &1.into()));
    assert_eq!(references(at).len(), 1);
    assert_eq!(report(at)["groups"], first["groups"]);
    // One that was damaged is.
    let file = at.join("out/reference").join(&references(at)[0]);
    let bytes = fs::read(&file).expect("a reference");
    fs::write(&file, &bytes[..bytes.len() - 500]).expect("a file");
    assert_eq!(code(at, &PAPER), 0);
    lampray::film::read_exr(&file).expect("a whole picture");
    assert_eq!(report(at)["groups"], first["groups"]);
}

/// Each albedo has a picture of its own; so has each number of reflections.
#[test]
fn physics_has_a_reference_for_each_picture() {
    let folder = folder();
    let at = folder.path();
    let physics = [
        "--set",
        "materials.white.albedo=[0.2,0.2,0.2],[0.8,0.8,0.8]",
        "--set",
        "light.sampler=cone,gaussian",
        "--set",
        "render.samples=32",
        "--seeds",
        "3",
    ];
    assert_eq!(code(at, &physics), 0);
    assert_eq!(reference_samples(at), [192, 192]);
    let report = report(at);
    assert!(!verdicts(&report).contains(&"different".into()));
    let groups = report["groups"].as_array().expect("groups");
    let numbers: Vec<_> = groups.iter().map(|group| &group["reference"]).collect();
    assert_eq!(numbers, [0, 0, 1, 1]);
    let ratio = |group: &Value| group["regions"][0]["equal_time"].is_object();
    let ratios: Vec<bool> = groups.iter().map(ratio).collect();
    assert_eq!(ratios, [true, true, false, false]);
    let notes = report["notes"].to_string();
    assert!(notes.contains("2 of 4 groups have no ratios"), "{notes}");
    let name = report["references"][1]["name"].as_str().expect("a name");
    assert_eq!(name, "reference for materials.white.albedo [0.8,0.8,0.8]");
}

#[test]
fn as_many_samples_as_asked_for() {
    let folder = folder();
    let at = folder.path();
    let two = ["--set", "render.samples=4", "--reference"];
    assert_eq!(code(at, &[&two[..], &["none"]].concat()), 0);
    assert_eq!(references(at), Vec::<String>::new());
    assert_eq!(report(at)["references"], Value::Array(Vec::new()));
    assert_eq!(code(at, &[&two[..], &["24"]].concat()), 0);
    assert_eq!(reference_samples(at), [24]);
    assert_eq!(code(at, &[&two[..], &["auto"]].concat()), 0);
    assert_eq!(reference_samples(at), [16, 24]);
    // Nothing of it was asked twice.
    assert_eq!(entries(at).len(), 1);
    for wrong in ["1", "automatic", "", "99999999999"] {
        assert_eq!(code(at, &[&two[..], &[wrong]].concat()), 2, "{wrong}");
    }
}

/// Each part has the reference of its runs, the whole that of all.
#[test]
fn parts_of_a_grid() {
    let folder = folder();
    let at = folder.path();
    for (part, samples) in [("1/2", vec![32]), ("2/2", vec![32])] {
        assert_eq!(code(at, &[&GRID[..], &["--shard", part]].concat()), 0);
        assert_eq!(reference_samples(at), samples, "{part}");
    }
    assert_eq!(code(at, &GRID), 0);
    assert_eq!(reference_samples(at), [32, 64]);
    assert_eq!(report(at)["references"][0]["samples"], 64);
}

#[test]
fn a_reference_that_cannot_be_made_costs_no_run() {
    let folder = folder();
    let at = folder.path();
    fs::create_dir_all(at.join("out")).expect("a folder");
    fs::write(at.join("out/reference"), "in the way").expect("a file");
    assert_eq!(code(at, &GRID), 75);
    assert_eq!(entries(at).len(), 12);
    let words = findings(&report(at));
    assert!(words.contains("The reference was not made"), "{words}");
    assert!(words.contains("Without bias and error"), "{words}");
    fs::remove_file(at.join("out/reference")).expect("a file");
    assert_eq!(code(at, &GRID), 0);
    assert_eq!((entries(at).len(), references(at).len()), (12, 1));
    assert_eq!(report(at)["groups"][0]["reference"], 0);
}

#[cfg(unix)]
#[test]
fn a_signal_during_the_reference_leaves_a_report() {
    let folder = folder();
    let at = folder.path();
    let long = ["--set", "render.samples=2,4", "--reference", "2000000"];
    let mut child = start(at, &long);
    wait_for(at, 2);
    std::thread::sleep(std::time::Duration::from_millis(300));
    let signal = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(signal.expect("kill runs").success());
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    assert_eq!((entries(at).len(), references(at).len()), (2, 0));
    let words = findings(&report(at));
    assert!(words.contains("was stopped early"), "{words}");
    assert_eq!(code(at, &[&long[..3], &["16"]].concat()), 0);
    assert_eq!((entries(at).len(), references(at).len()), (2, 1));
}

#[test]
fn the_report_holds_the_groups_against_the_reference() {
    let folder = folder();
    let at = folder.path();
    let reference = Command::new(env!("CARGO_BIN_EXE_lampray"))
        .current_dir(at)
        .args([
            "render", "s.toml", "--device", "cpu", "-q", "-o", "r.exr", "-s", "4096", "--seed", "9",
        ])
        .status();
    assert!(reference.expect("the program runs").success());
    // One without bias, and one that a clamp darkens.
    let swept = [
        "--set",
        "render.clamp=off,2",
        "--set",
        "render.samples=64",
        "--seeds",
        "4",
        "--reference",
        "r.exr",
    ];
    assert_eq!(code(at, &swept), 0);
    let report = report(at);
    assert_eq!(report["runs"].as_array().map(Vec::len), Some(8));
    let groups = report["groups"].as_array().expect("groups");
    let verdict = |group: &Value| {
        group["regions"][0]["verdict"]
            .as_str()
            .unwrap_or_default()
            .to_string()
    };
    assert_eq!(groups.len(), 2);
    assert_ne!(verdict(&groups[0]), "different");
    assert_eq!(verdict(&groups[1]), "different");
    assert!(
        groups[1]["regions"][0]["bias"]["high"]
            .as_f64()
            .is_some_and(|high| high < 0.0)
    );
    let first = report["findings"][0].as_str().unwrap_or_default();
    assert!(
        first.contains("is biased") && first.contains("too dark"),
        "{first}"
    );
    // What is no EXR is refused, before any run is made.
    assert_eq!(
        code(
            at,
            &[&swept[..6], &["--reference", "out/table.csv"]].concat()
        ),
        65
    );
    // So is one of another size.
    let output = sweep(at, &[&swept[..], &["--width", "8"]].concat());
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{words}");
    assert!(
        words.contains("has 16 x 16 pixels, the runs have 8 x 16"),
        "{words}"
    );
    assert_eq!(entries(at).len(), 8);
}
