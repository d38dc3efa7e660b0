//! `lampray bench`: what it prints, refuses and does when it is stopped. Times are never tested.

mod support;

use serde_json::Value;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output};

fn bench(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command
        .current_dir(folder)
        .arg("bench")
        .args(arguments)
        .output()
        .expect("the program runs")
}

/// Tiny measurements on the CPU twin.
fn tiny(folder: &Path, more: &[&str]) -> Output {
    let few = ["--device", "cpu", "--seconds", "0.001", "--repeats", "2"];
    bench(folder, &[&few[..], more].concat())
}

fn json(output: &Output) -> Value {
    let words = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{words}");
    serde_json::from_slice(&output.stdout).expect("JSON and nothing else")
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

#[test]
fn json_has_a_row_for_each_scene_and_all_its_numbers() {
    let folder = folder();
    let all = ["--primitives", "cornell,8,1k", "--json", "-q"];
    let output = tiny(folder.path(), &all);
    assert!(output.stderr.is_empty(), "-q says nothing");
    let report = json(&output);
    let rows = report["rows"].as_array().unwrap();
    let scenes: Vec<_> = rows
        .iter()
        .map(|row| row["scene"].as_str().unwrap())
        .collect();
    assert_eq!(scenes, ["cornell", "room-8", "room-1000"]);
    assert_eq!(rows[2]["primitives"], 1006);
    for row in rows {
        assert_eq!(row["status"], "measured");
        assert_eq!(row["preset"], "reference");
        assert_eq!(row["device_info"]["kind"], "cpu");
        for spread in ["mrays", "msamples", "compile", "pack", "outside"] {
            let of = &row[spread];
            assert_eq!(of["values"].as_array().unwrap().len(), 2, "{spread}");
            let [low, high] = [0, 1].map(|end| of["quartiles"][end].as_f64().unwrap());
            let median = of["median"].as_f64().unwrap();
            assert!(
                low <= median && median <= high && low >= 0.0,
                "{spread}: {of}"
            );
        }
        assert!(row["rays_per_sample"].as_f64().unwrap() > 1.0);
        assert!(row["samples"].as_u64().unwrap() >= 1);
    }
    assert_eq!(report["complete"], true);
    assert_eq!(
        report["ratios"],
        serde_json::json!([]),
        "one value of each axis"
    );
    assert!(report["machine"]["threads"].as_u64().unwrap() >= 1);
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        0,
        "no file is written"
    );
}

#[test]
fn axes_are_paired_with_their_first_value() {
    let folder = folder();
    let two = [
        "--primitives",
        "8",
        "--preset",
        "reference,paper",
        "--device",
        "cpu",
        "--json",
    ];
    let report = json(&tiny(folder.path(), &two));
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 4, "two devices, two presets");
    let ratios = report["ratios"].as_array().unwrap();
    let of = |axis: &str| ratios.iter().filter(|ratio| ratio["axis"] == axis).count();
    assert_eq!((of("device"), of("preset"), of("kernel")), (2, 2, 0));
    for ratio in ratios {
        assert_eq!(ratio["mrays"]["values"].as_array().unwrap().len(), 2);
        assert!(ratio["mrays"]["median"].as_f64().unwrap() > 0.0);
    }
    let paper = ratios
        .iter()
        .find(|ratio| ratio["axis"] == "preset")
        .unwrap();
    assert_eq!(
        (&paper["of"], &paper["to"]),
        (&"paper".into(), &"reference".into())
    );
}

#[test]
fn the_table_is_for_reading() {
    let folder = folder();
    let output = tiny(
        folder.path(),
        &["--primitives", "8,32", "--device", "cpu", "-q"],
    );
    let text = String::from_utf8(output.stdout).unwrap();
    for part in [
        "scene",
        "room-8",
        "room-32",
        "Mrays/s",
        "cpu #2 : cpu",
        "ratios inside this run",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(
        text.lines().all(|line| line.chars().count() <= 120),
        "{text}"
    );
}

#[test]
fn an_earlier_run_is_marked_as_one() {
    let folder = folder();
    let first = tiny(folder.path(), &["--primitives", "8", "--json"]);
    std::fs::write(folder.path().join("then.json"), &first.stdout).unwrap();
    let more = ["--primitives", "8,32", "--against", "then.json"];
    let text = String::from_utf8(tiny(folder.path(), &more).stdout).unwrap();
    assert!(
        text.contains("DIFFERENT RUNS") && text.contains("the same machine"),
        "{text}"
    );
    assert!(text.contains("1 rows have no counterpart"), "{text}");
    let report = json(&tiny(folder.path(), &[&more[..], &["--json"]].concat()));
    let comparisons = report["against"]["comparisons"].as_array().unwrap();
    assert_eq!(comparisons.len(), 1);
    assert_eq!(comparisons[0]["same_device"], true);
}

/// A report of this build, as one of another build whose shader `name` has `from` for `to`.
fn other_build(folder: &Path, (name, from, to): (&str, &str, &str)) {
    let first = tiny(folder, &["--primitives", "8", "--json"]);
    let mut report = json(&first);
    let text = report["shaders"][name].as_str().expect("the shader's text");
    assert!(text.contains(from), "{name} has no {from}");
    report["shaders"][name] = text.replace(from, to).into();
    std::fs::write(folder.join("then.json"), report.to_string()).unwrap();
}

/// Rows by their device and shaders.
fn row<'a>(report: &'a Value, kind: &str, shaders: &str) -> &'a Value {
    let mut rows = report["rows"].as_array().unwrap().iter();
    rows.find(|row| {
        row["shaders"] == shaders && (row["device_info"]["kind"] == "cpu") == (kind == "cpu")
    })
    .expect("a row")
}

#[test]
fn an_earlier_builds_shaders_are_measured_in_turns_where_they_fit() {
    let Some(_gpu) = support::gpu("shaders of an earlier build") else {
        return;
    };
    let folder = folder();
    let against = [
        "--primitives",
        "8",
        "--device",
        "0",
        "--against",
        "then.json",
        "--json",
    ];
    // A build whose paths ended at the first reflection.
    let ends = (
        "trace",
        "(*path).vertex >= job.max_bounces",
        "(*path).vertex >= 1u",
    );
    other_build(folder.path(), ends);
    let report = json(&tiny(folder.path(), &against));
    let rays = |kind, shaders| row(&report, kind, shaders)["rays_per_sample"].as_f64();
    assert!(rays("gpu", "then").unwrap() < 0.7 * rays("gpu", "now").unwrap());
    // The clock decides how many samples each device takes: of 256 paths and more, means a tenth apart.
    let [twin, gpu] = ["cpu", "gpu"].map(|kind| rays(kind, "now").unwrap());
    assert!((twin - gpu).abs() < 0.1 * twin, "{twin} {gpu}");
    let twin = row(&report, "cpu", "then");
    assert_eq!(
        (&twin["status"], rays("cpu", "then")),
        (&"refused".into(), None)
    );
    let ratios = report["ratios"].as_array().unwrap();
    let paired = |ratio: &&Value| ratio["axis"] == "shaders";
    let paired: Vec<_> = ratios.iter().filter(paired).collect();
    assert_eq!(paired.len(), 1);
    assert_eq!(
        (&paired[0]["of"], &paired[0]["to"]),
        (&"now".into(), &"then".into())
    );

    for (fault, words) in [
        (
            (
                "camera",
                "struct Camera {\n",
                "struct Camera {\n    extra: vec4<f32>,\n",
            ),
            "laid out otherwise",
        ),
        (
            ("light", "struct Cone", "struct struct Cone"),
            "light.wgsl:",
        ),
        (
            (
                "camera",
                "struct Camera",
                "override GONE: u32;\nfn gone() -> u32 { return GONE; }\nstruct Camera",
            ),
            "GONE",
        ),
    ] {
        other_build(folder.path(), fault);
        let report = json(&tiny(folder.path(), &against));
        let then = row(&report, "gpu", "then");
        let reason = then["reason"].as_str().unwrap();
        assert!(
            then["status"] == "refused" && reason.contains(words),
            "{reason}"
        );
        assert!(
            !reason.contains("report it"),
            "it is no fault of this build: {reason}"
        );
        assert_eq!(row(&report, "gpu", "now")["status"], "measured");
    }
}

#[test]
fn own_scenes_and_knobs() {
    let folder = folder();
    let room = bench(folder.path(), &["--print-room", "3"]);
    std::fs::write(folder.path().join("mine.toml"), &room.stdout).unwrap();
    let set = ["mine.toml", "--set", "render.max_bounces=0", "--json"];
    let report = json(&tiny(folder.path(), &set));
    let rows = report["rows"].as_array().unwrap();
    assert_eq!((rows.len(), &rows[0]["scene"]), (1, &"mine".into()));
    assert_eq!(rows[0]["rays_per_sample"], 1.0, "the knob holds");
    assert_eq!(report["set"][0], "render.max_bounces=0");
}

/// lavapipe leaves a loop after 65,535 iterations: a scene that it cannot go through keeps its row.
#[test]
fn a_scene_that_a_device_cannot_trace_keeps_its_row() {
    let folder = folder();
    let devices = Command::new(env!("CARGO_BIN_EXE_lampray"))
        .args(["devices", "--json"])
        .output()
        .unwrap();
    let devices: Value = serde_json::from_slice(&devices.stdout).unwrap();
    let software = |device: &Value| device["info"]["kind"] == "software";
    if !devices.as_array().unwrap().iter().any(software) {
        let _ = writeln!(std::io::stderr(), "NOT RUN: no software device was found");
        return;
    }
    let both = [
        "--primitives",
        "1,200k",
        "--device",
        "software",
        "--kernel",
        "general",
        "--json",
    ];
    let few = ["--seconds", "0.001", "--repeats", "1"];
    let report = json(&bench(folder.path(), &[&both[..], &few].concat()));
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    assert_eq!(rows[0]["status"], "measured");
    if rows[1]["status"] != "measured" {
        assert_eq!(rows[1]["status"], "refused");
        assert!(rows[1]["reason"].as_str().unwrap().contains("--device cpu"));
        let alone = [
            "--primitives",
            "200k",
            "--device",
            "software",
            "--kernel",
            "general",
        ];
        let output = bench(folder.path(), &[&alone[..], &few].concat());
        assert_eq!(
            output.status.code(),
            Some(69),
            "nothing at all was measured"
        );
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains("cannot (1)"), "{text}");
    }
}

#[test]
fn mistakes_are_said_before_anything_is_measured() {
    let folder = folder();
    std::fs::write(folder.path().join("no.json"), "{}").unwrap();
    std::fs::write(folder.path().join("bad.toml"), "version = 2").unwrap();
    let cases: &[(&[&str], i32, &str)] = &[
        (&["--primitives", "many"], 2, "numbers of spheres"),
        (&["--primitives", "8,2M"], 2, "at most"),
        (&["--preset", "papr"], 2, "did you mean paper?"),
        (&["--seconds", "0"], 2, "above 0"),
        (&["--seconds", "nan"], 2, "above 0"),
        (&["--repeats", "0"], 2, "repeats"),
        (
            &["--set", "image.width=4"],
            2,
            "bench chooses image.width itself",
        ),
        (&["--set", "light.smapler=cone"], 2, "light.sampler"),
        (&["--device", "99"], 69, "no device 99"),
        (&["--against", "none.json"], 66, "none.json"),
        (&["--against", "no.json"], 65, "lampray bench --json"),
        (&["none.toml"], 66, "none.toml"),
        (&["bad.toml"], 65, "version"),
        (&["--print-room", "1M"], 2, "16 MiB"),
        (&["--print-room", "cornell"], 2, "number of spheres"),
    ];
    for (arguments, code, words) in cases {
        let quick = [&["--quick"], *arguments].concat();
        let output = bench(folder.path(), &quick);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(*code), "{arguments:?}: {said}");
        assert!(said.contains(words), "{arguments:?}: {said}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
}

#[test]
fn help_has_examples_and_names_the_options() {
    let folder = folder();
    let output = bench(folder.path(), &["--help"]);
    let text = String::from_utf8(output.stdout).unwrap();
    let examples: Vec<_> = text
        .lines()
        .filter(|line| line.starts_with("  lampray bench"))
        .collect();
    assert!(examples.len() >= 6, "{text}");
    for flag in [
        "--device",
        "--preset",
        "--kernel",
        "--primitives",
        "--repeats",
        "--seconds",
        "--against",
    ] {
        assert!(text.contains(flag), "{flag}");
    }
}

/// What is measured is printed, and the exit code says that it was stopped.
#[cfg(unix)]
#[test]
fn an_interrupt_prints_what_there_is() {
    let folder = folder();
    let out = std::fs::File::create(folder.path().join("out.json")).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_lampray"))
        .args([
            "bench",
            "--device",
            "cpu",
            "--primitives",
            "8",
            "--seconds",
            "0.5",
        ])
        .args(["--repeats", "1000", "--json", "-q"])
        .stdout(out)
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(4000));
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(kill.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let text = std::fs::read(folder.path().join("out.json")).unwrap();
    let report: Value = serde_json::from_slice(&text).expect("whole JSON");
    assert_eq!(report["complete"], false);
    let row = &report["rows"][0];
    assert!(
        ["measured", "stopped"].contains(&row["status"].as_str().unwrap()),
        "{row}"
    );
    assert!(
        row["mrays"]["values"]
            .as_array()
            .is_none_or(|values| values.len() < 1000)
    );
}
