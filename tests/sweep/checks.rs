//! What is said before anything is rendered.

use super::bench::*;
use serde_json::Value;
use std::fs;

#[test]
fn mistakes_are_said_before_anything_is_made() {
    let folder = folder();
    let at = folder.path();
    for (arguments, expected) in [
        (&["--set", "light.sampler=cone,nonsense"][..], 2),
        (&["--set", "light.smapler=cone"], 2),
        (&["--set", "render.samples=8..2"], 2),
        (
            &[
                "--set",
                "render.samples=1,2,3",
                "--set",
                "render.max_bounces=1,2",
                "--zip",
            ],
            2,
        ),
        (&["--set", "render.seed=1,2", "--seeds", "2"], 2),
        (&["--set", "render.samples=1..1000", "--seeds", "10000"], 2),
        (&["--set", "render.samples=1,2", "--spp", "4"], 2),
        (&["--set", "render.preset=paper", "--preset", "paper"], 2),
        (&["--set", "render.seed=1,2", "--seed", "4"], 2),
        (&["--set", "image.width=8,9", "--width", "8"], 2),
        (&["--set", "image.height=8,9", "--height", "8"], 2),
        (
            &["--set", "render.max_bounces=1,2", "--max-bounces", "4"],
            2,
        ),
        (&["--timeout", "0"], 2),
        (&["--reference", "none.exr"], 66),
        (&["--reference", "s.toml"], 65),
    ] {
        let output = sweep(at, arguments);
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        let code = output.status.code().expect("an exit code");
        assert_eq!(code, expected, "{arguments:?}: {words}");
        assert!(!at.join("out").exists(), "{arguments:?}");
    }
    let told = sweep(at, &[&GRID[..], &["--dry-run", "--json"]].concat());
    let told: Value = serde_json::from_slice(&told.stdout).expect("JSON");
    assert_eq!(told["runs"], 12);
    assert_eq!(told["paths"], 16 * 16 * (2 + 4 + 8) * 4);
    assert_eq!(told["references"], 1);
    assert_eq!(told["reference_paths"], 16 * 16 * 64);
    let words = sweep(at, &[&GRID[..], &["--dry-run"]].concat()).stdout;
    let words = String::from_utf8_lossy(&words).into_owned();
    assert!(words.contains("1 reference of 16384 paths"), "{words}");
    let none = [&GRID[..], &["--dry-run", "--json", "--reference", "none"]].concat();
    let told: Value = serde_json::from_slice(&sweep(at, &none).stdout).expect("JSON");
    assert_eq!(told["references"], 0);
    assert!(!at.join("out").exists());
}

#[test]
fn a_scene_says_itself_what_to_sweep() {
    let folder = folder();
    let at = folder.path();
    let table = "[sweep]\nset = [\"light.sampler=cone,gaussian\", \"render.samples=2,4\"]\nzip = true\nseeds = 3\n[sweep.regions]\nfloor = [0, 8, 16, 16]\n";
    fs::write(at.join("s.toml"), format!("{SCENE}{table}")).expect("the scene");
    assert_eq!(code(at, &[]), 0);
    assert_eq!(ids(at).len(), 6);
    // The command line comes first.
    assert_eq!(
        code(
            at,
            &[
                "--set",
                "light.sampler=cone,gaussian",
                "--set",
                "render.samples=2,4",
                "--seeds",
                "1"
            ]
        ),
        0
    );
    assert_eq!(ids(at).len(), 8);
    for (wrong, reason) in [
        ("[sweep]\nsets = []", "did you mean `set`?"),
        ("[sweep]\nset = [1]", "`sweep.set` must be"),
        ("[sweep]\nseeds = 0", "`sweep.seeds` must be"),
        ("[sweep]\nzip = 1", "`sweep.zip` must be"),
        ("[sweep]\nreference = []", "`sweep.reference` must be"),
        (
            "[sweep.regions]\na = [4, 4, 4, 8]",
            "`sweep.regions.a` must be",
        ),
    ] {
        fs::write(at.join("s.toml"), format!("{SCENE}{wrong}\n")).expect("the scene");
        let output = sweep(at, &[]);
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(65), "{words}");
        assert!(
            words.contains(reason) && words.contains("s.toml:"),
            "{words}"
        );
    }
}

/// The scene says it, the command line may say otherwise, and a file that it names is beside it.
#[test]
fn a_scene_says_what_to_hold_runs_against() {
    let folder = folder();
    let at = folder.path();
    let with = |reference: &str| format!("{SCENE}[sweep]\nreference = {reference}\n");
    for (reference, made) in [("\"none\"", 0), ("32", 1), ("\"auto\"", 2)] {
        fs::write(at.join("s.toml"), with(reference)).expect("the scene");
        assert_eq!(code(at, &["-s", "4"]), 0);
        assert_eq!(references(at).len(), made, "{reference}");
    }
    fs::write(at.join("s.toml"), with("\"none\"")).expect("the scene");
    assert_eq!(code(at, &["-s", "4", "--reference", "48"]), 0);
    assert_eq!(reference_samples(at), [16, 32, 48]);
    fs::write(at.join("s.toml"), with("\"far.exr\"")).expect("the scene");
    let from = tempfile::tempdir().expect("a folder");
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_lampray"))
        .current_dir(from.path())
        .args(["sweep", "--device", "cpu", "-o", "out"])
        .arg(at.join("s.toml"))
        .output()
        .expect("the program runs");
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(66), "{words}");
    let beside = at.join("far.exr").to_string_lossy().into_owned();
    assert!(words.contains(&beside), "{words}");
}

/// Regions are of the size that the file states.
#[test]
fn regions_go_with_the_size() {
    let folder = folder();
    let at = folder.path();
    let with = |rect: &str| format!("{SCENE}[sweep.regions]\nfloor = {rect}\n");
    fs::write(at.join("s.toml"), with("[0, 8, 15, 16]")).expect("the scene");
    assert_eq!(code(at, &["-s", "4", "--width", "40", "--height", "8"]), 0);
    let region = &report(at)["regions"][1];
    assert_eq!(region["rect"], serde_json::json!([0, 4, 38, 8]));
    fs::write(at.join("s.toml"), with("[0, 8, 17, 16]")).expect("the scene");
    for size in ["16", "64"] {
        let output = sweep(at, &["-s", "5", "--width", size]);
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{words}");
        assert!(
            words.contains("region floor") && words.contains("16 x 16"),
            "{words}"
        );
    }
    assert_eq!(entries(at).len(), 1);
}

/// The first size is analysed; the others are made, and the report says what it leaves out.
#[test]
fn several_sizes() {
    let folder = folder();
    let at = folder.path();
    let sizes = ["--set", "image.width=16,24", "--set", "render.samples=8"];
    let output = sweep(at, &sizes);
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{words}");
    assert!(words.contains("several sizes"), "{words}");
    assert_eq!((entries(at).len(), references(at).len()), (2, 1));
    let report = report(at);
    assert_eq!(report["groups"].as_array().map(Vec::len), Some(1));
    let words = findings(&report);
    assert!(words.contains("first run's size, 16 x 16: 24."), "{words}");
}

/// What is swept and has a short flag, too: the message names both.
#[test]
fn a_knob_is_swept_or_set() {
    let folder = folder();
    let at = folder.path();
    let words = |arguments: &[&str]| {
        let output = sweep(at, arguments);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let both = words(&["--set", "render.samples=8,16", "-s", "4"]);
    let expected = "render.samples is swept, and --samples sets it: one of the two";
    assert!(both.contains(expected), "{both}");
    // The scene's own table is no other.
    let table = "[sweep]\nset = [\"render.max_bounces=1,2\"]\n";
    fs::write(at.join("s.toml"), format!("{SCENE}{table}")).expect("the scene");
    let both = words(&["--max-bounces", "4"]);
    assert!(both.contains("--max-bounces sets it"), "{both}");
    assert!(!at.join("out").exists());
}

#[test]
fn a_file_is_no_folder() {
    let folder = folder();
    fs::write(folder.path().join("out"), "a file").expect("it");
    let output = sweep(folder.path(), &["-s", "4"]);
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(73), "{words}");
    assert!(words.contains("cannot create out: it is a file"), "{words}");
}

/// The file that was there before is none of standard output's.
#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output() {
    let folder = folder();
    let full = fs::OpenOptions::new().write(true).open("/dev/full");
    let output = command(folder.path(), &["-s", "4", "--dry-run"])
        .stdout(full.expect("a device"))
        .output()
        .expect("the program runs");
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(74), "{words}");
    assert!(words.contains("cannot write to standard output"), "{words}");
    assert!(!words.contains("untouched"), "{words}");
}
