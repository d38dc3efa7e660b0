//! The program as its users and scripts meet it: outputs, exit codes, signals.

use lampray::film::{Picture, read_exr};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

const SCENE: &str = r#"version = 1
[camera]
position = [0.0, 1.0, 3.4]
look_at = [0.0, 1.0, 0.0]
[image]
width = 24
height = 16
[render]
samples = 8
max_bounces = 4
[materials.white]
albedo = [0.7, 0.7, 0.7]
[materials.mirror]
scatter = "mirror"
[materials.lamp]
emission = [20.0, 20.0, 20.0]
[[spheres]]
center = [0.0, 1.7, 0.0]
radius = 0.15
material = "lamp"
[[spheres]]
center = [-0.45, 0.4, -0.4]
radius = 0.4
material = "mirror"
[[boxes]]
min = [-1.1, -0.1, -1.1]
max = [1.1, 0.0, 1.1]
material = "white"
"#;

/// A folder with the scene in it.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("s.toml"), SCENE).expect("the scene");
    folder
}

fn lampray(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command
        .current_dir(folder)
        .args(arguments)
        .output()
        .expect("the program runs")
}

fn code(folder: &Path, arguments: &[&str]) -> i32 {
    let output = lampray(folder, arguments);
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(!words.contains("panicked"), "{arguments:?}: {words}");
    output.status.code().expect("an exit code")
}

/// Renders on the CPU twin and reads the EXR back.
fn render(folder: &Path, name: &str, more: &[&str]) -> Picture {
    let file = format!("{name}.exr");
    let arguments = [
        &[
            "render",
            "s.toml",
            "--device",
            "cpu",
            "-q",
            "-o",
            file.as_str(),
        ],
        more,
    ]
    .concat();
    assert_eq!(code(folder, &arguments), 0, "{arguments:?}");
    read_exr(folder.join(file)).expect("an EXR")
}

/// Mean squared difference over pixels and channels.
fn mse(a: &Picture, b: &Picture) -> f64 {
    let pairs = a.mean.as_flattened().iter().zip(b.mean.as_flattened());
    let squares: f64 = pairs
        .map(|(x, y)| (f64::from(*x) - f64::from(*y)).powi(2))
        .sum();
    squares / a.mean.as_flattened().len() as f64
}

#[test]
fn default_outputs_stand_in_the_current_folder() {
    let folder = folder();
    let output = lampray(
        folder.path(),
        &["render", "s.toml", "--device", "cpu", "--json"],
    );
    let record: Value = serde_json::from_slice(&output.stdout).expect("JSON and nothing else");
    assert_eq!(record["outputs"], serde_json::json!(["s.png", "s.exr"]));
    assert_eq!(record["paths"], 24 * 16 * 8);
    assert!(folder.path().join("s.png").exists() && folder.path().join("s.exr").exists());
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        3,
        "no temporary is left"
    );
}

#[test]
fn the_seed_decides_the_pixels() {
    let folder = folder();
    let first = render(folder.path(), "a", &["--seed", "7"]);
    let again = render(folder.path(), "b", &["--seed", "7"]);
    let other = render(folder.path(), "c", &["--seed", "8"]);
    assert_eq!(first.mean, again.mean);
    assert_eq!(first.variance, again.variance);
    assert!(mse(&first, &other) > 0.0);
}

#[test]
fn merged_ranges_are_the_whole() {
    let folder = folder();
    let whole = render(folder.path(), "whole", &["--samples", "64"]);
    render(
        folder.path(),
        "p0",
        &["--samples", "64", "--sample-range", "0..24"],
    );
    render(
        folder.path(),
        "p1",
        &["--samples", "64", "--sample-range", "24..64"],
    );
    assert_eq!(
        code(folder.path(), &["merge", "p1.exr", "p0.exr", "-o", "m.exr"]),
        0
    );
    let merged = read_exr(folder.path().join("m.exr")).unwrap();
    assert!(mse(&whole, &merged) < 1e-10);
    assert_eq!(merged.record.sample_range, [0, 64]);
    assert_eq!(
        code(
            folder.path(),
            &["merge", "p0.exr", "p0.exr", "-o", "bad.exr"]
        ),
        65
    );
    assert!(!folder.path().join("bad.exr").exists());
}

#[test]
fn a_crop_is_a_part_of_the_whole() {
    let folder = folder();
    let whole = render(folder.path(), "whole", &[]);
    let part = render(folder.path(), "part", &["--crop", "8,4,20,12"]);
    assert_eq!((part.width, part.height), (12, 8));
    for y in 0..8 {
        for x in 0..12 {
            assert_eq!(
                part.mean[y * 12 + x],
                whole.mean[(y + 4) * 24 + x + 8],
                "{x},{y}"
            );
        }
    }
}

#[test]
fn pictures_render_again_from_their_records() {
    let folder = folder();
    let knobs = [
        "--preset",
        "paper",
        "--set",
        "spheres.0.radius=0.2",
        "--seed",
        "18446744073709551615",
    ];
    let first = render(
        folder.path(),
        "a",
        &[&knobs[..], &["--sample-range", "5..40", "-o", "a.png"]].concat(),
    );
    std::fs::remove_file(folder.path().join("s.toml")).unwrap();
    for image in ["a.exr", "a.png"] {
        assert_eq!(
            code(folder.path(), &["rerun", image, "-o", "again.exr", "-q"]),
            0,
            "{image}"
        );
        let again = read_exr(folder.path().join("again.exr")).unwrap();
        assert_eq!(first.mean, again.mean, "{image}");
        assert_eq!(first.record.knobs, again.record.knobs, "{image}");
    }
}

#[test]
fn exit_codes_say_what_went_wrong() {
    let folder = folder();
    let at = folder.path();
    std::fs::write(
        at.join("bad.toml"),
        SCENE.replace("radius = 0.15", "radius = -0.15"),
    )
    .unwrap();
    std::fs::write(at.join("no.exr"), "no picture").unwrap();
    let cases: &[(&[&str], i32)] = &[
        (&["render", "none.toml"], 66),
        (&["render", "."], 66),
        (&["render", "bad.toml"], 65),
        (&["check", "bad.toml"], 65),
        (&["render", "s.toml", "-o", "no/such/folder/x.png"], 73),
        (&["render", "s.toml", "-o", "x.jpg"], 2),
        (&["render", "s.toml", "-o", "x.png", "-o", "./x.png"], 2),
        (&["render", "s.toml", "--set", "light.smapler=cone"], 2),
        (&["render", "s.toml", "--spp", "0"], 2),
        (&["render", "s.toml", "--crop", "0,0,99,1"], 2),
        (&["render", "s.toml", "--sample-range", "9..9"], 2),
        (&["render", "s.toml", "--no-such-flag"], 2),
        (&["render", "s.toml", "--device", "99"], 69),
        (&["knobs", "light.smapler"], 2),
        (&["points", "light", "-n", "0"], 2),
        (&["rerun", "no.exr", "-o", "x.exr"], 65),
        (&["merge", "no.exr", "no.exr", "-o", "x.exr"], 65),
    ];
    for (arguments, wanted) in cases {
        assert_eq!(code(at, arguments), *wanted, "{arguments:?}");
    }
    assert_eq!(
        std::fs::read_dir(at).unwrap().count(),
        3,
        "nothing was written"
    );
}

#[test]
fn a_scene_without_lamps_is_black_but_valid() {
    let folder = folder();
    let dark = SCENE.replace(
        "emission = [20.0, 20.0, 20.0]",
        "emission = [0.0, 0.0, 0.0]",
    );
    std::fs::write(folder.path().join("s.toml"), dark).unwrap();
    let picture = render(folder.path(), "dark", &[]);
    assert!(
        picture
            .mean
            .as_flattened()
            .iter()
            .all(|value| *value == 0.0)
    );
    let check = lampray(folder.path(), &["check", "s.toml"]);
    assert!(check.status.success());
    assert!(String::from_utf8_lossy(&check.stderr).contains("warning"));
}

#[test]
fn every_command_has_help_with_an_example() {
    let folder = folder();
    for command in [
        "render", "check", "knobs", "devices", "doctor", "points", "rerun", "merge", "bench",
    ] {
        let output = lampray(folder.path(), &[command, "--help"]);
        assert!(
            String::from_utf8_lossy(&output.stdout).contains("Example"),
            "{command}"
        );
    }
}

#[test]
fn points_come_as_data_and_as_plots() {
    let folder = folder();
    for sampler in ["uniform-angles", "inverse-cosine", "gaussian", "cone"] {
        let set = format!("light.sampler={sampler}");
        let output = lampray(
            folder.path(),
            &[
                "points", "light", "-n", "200", "--set", &set, "--device", "cpu", "-q",
            ],
        );
        let text = String::from_utf8(output.stdout).unwrap();
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!(rows[0], ["x", "y", "z", "density", "counts"]);
        assert_eq!(rows.len(), 201, "{sampler}");
        for row in &rows[1..] {
            let size: f64 = row[..3]
                .iter()
                .map(|v| v.parse::<f64>().unwrap().powi(2))
                .sum();
            assert!((size - 1.0).abs() < 1e-5, "{sampler}: {row:?}");
        }
    }
    for file in ["p.png", "p.svg", "p.csv"] {
        assert_eq!(
            code(
                folder.path(),
                &["points", "scatter", "-o", file, "--device", "cpu"]
            ),
            0
        );
        assert!(
            std::fs::metadata(folder.path().join(file)).unwrap().len() > 1000,
            "{file}"
        );
    }
}

/// Before every pixel has a sample there is no picture to save, and the old one stays.
#[cfg(unix)]
#[test]
fn an_early_interrupt_keeps_the_old_file() {
    let folder = folder();
    std::fs::write(folder.path().join("s.exr"), "old").unwrap();
    let size = ["--width", "16000", "--height", "16000", "--spp", "1000"];
    let arguments = [
        &["render", "s.toml", "--device", "cpu", "-q", "-o", "s.exr"],
        &size[..],
    ]
    .concat();
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    let mut child = command
        .current_dir(folder.path())
        .args(arguments)
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(1500));
    Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(std::fs::read(folder.path().join("s.exr")).unwrap(), b"old");
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        2,
        "no temporary is left"
    );
}

/// The first signal saves what is done and leaves no temporary behind.
#[cfg(unix)]
#[test]
fn an_interrupt_saves_what_is_done() {
    let folder = folder();
    let arguments = [
        "render",
        "s.toml",
        "--device",
        "cpu",
        "-q",
        "--spp",
        "100000000",
        "-o",
        "s.exr",
    ];
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    let mut child = command
        .current_dir(folder.path())
        .args(arguments)
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(1500));
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(kill.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let picture = read_exr(folder.path().join("s.exr")).unwrap();
    assert!(!picture.record.complete && picture.record.samples > 0);
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        2,
        "no temporary is left"
    );
}
