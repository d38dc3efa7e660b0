//! `lampray diff` as scripts meet it: exit codes, JSON, maps, references, and pictures from strangers.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

const SCENE: &str = r#"version = 1
camera = { position = [0.0, 1.0, 3.4], look_at = [0.0, 0.8, 0.0], fov = 40 }
image = { width = 32, height = 32 }
background = { emission = [0.2, 0.3, 0.4] }
boxes = [{ min = [-1.5, -0.2, -1.5], max = [1.5, 0.0, 1.5], material = "white" }]
spheres = [
    { center = [0.0, 2.0, 0.0], radius = 0.4, material = "lamp" },
    { center = [0.3, 0.5, 0.0], radius = 0.5, material = "white" },
]
[materials.white]
albedo = [0.7, 0.6, 0.5]
[materials.lamp]
emission = [9.0, 9.0, 9.0]
"#;

fn lampray(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command.current_dir(folder).args(arguments);
    command.output().expect("the program runs")
}

/// Exit code, stdout, stderr.
fn diff(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = lampray(folder, &[&["diff"], arguments].concat());
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert!(
        !err.contains("panicked") && !err.contains("internal"),
        "{arguments:?}: {err}"
    );
    (output.status.code().expect("an exit code"), out, err)
}

fn json(folder: &Path, arguments: &[&str]) -> (i32, Value) {
    let (code, out, err) = diff(folder, &[arguments, &["--json"]].concat());
    let value = serde_json::from_str(&out).unwrap_or_else(|error| panic!("{error}: {out}{err}"));
    (code, value)
}

/// A folder with the scene, and pictures of it: name, samples, seed, `--set`s.
fn folder(pictures: &[(&str, u32, u32, &[&str])]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("s.toml"), SCENE).expect("the scene");
    for (name, samples, seed, sets) in pictures {
        let (samples, seed) = (samples.to_string(), seed.to_string());
        let mut arguments = vec!["render", "s.toml", "-q", "--device", "cpu", "-o", name];
        arguments.extend(["--samples", &samples, "--seed", &seed]);
        arguments.extend(sets.iter().flat_map(|set| ["--set", set]));
        let output = lampray(folder.path(), &arguments);
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    folder
}

#[test]
fn the_verdict_is_the_exit_code() {
    let darker: &[&str] = &["materials.white.albedo=[0.6, 0.5, 0.4]"];
    let folder = folder(&[
        ("a.exr", 512, 1, &[]),
        ("b.exr", 512, 2, &[]),
        ("darker.exr", 512, 3, darker),
        ("few.exr", 4, 4, &[]),
    ]);
    let at = folder.path();
    let (code, same) = json(at, &["a.exr", "b.exr"]);
    assert_eq!((code, &same["conclusion"]), (0, &"same".into()));
    assert_eq!(same["verdict"]["outcome"], "same");
    assert!(
        same["verdict"]["supported_margin"]
            .as_f64()
            .is_some_and(|margin| margin < 0.01)
    );
    let (code, different) = json(at, &["a.exr", "darker.exr"]);
    assert_eq!((code, &different["conclusion"]), (1, &"different".into()));
    assert_eq!(
        different["kinship"]["knobs"][0]["knob"],
        "materials.white.albedo"
    );
    let (code, unsure) = json(at, &["a.exr", "few.exr"]);
    assert_eq!(
        (code, &unsure["conclusion"]),
        (3, &"not-enough-samples".into())
    );
    assert!(
        unsure["verdict"]["needed"]["test"]
            .as_u64()
            .is_some_and(|n| n > 4)
    );
    // In words, too.
    let (_, words, _) = diff(at, &["a.exr", "b.exr"]);
    assert!(words.contains("verdict: same expected image"), "{words}");
    let (_, words, _) = diff(at, &["a.exr", "darker.exr"]);
    assert!(
        words.contains("verdict: different") && words.contains(" ± "),
        "{words}"
    );
    let (_, words, _) = diff(at, &["a.exr", "few.exr"]);
    assert!(
        words.contains("not enough samples to tell") && words.contains("about "),
        "{words}"
    );
    // A wide margin is enough for few samples; alpha and tolerance move the verdict as well.
    assert_eq!(diff(at, &["a.exr", "few.exr", "--margin", "0.5"]).0, 0);
    assert_eq!(
        diff(at, &["a.exr", "darker.exr", "--tolerance", "0.9"]).0,
        3
    );
}

#[test]
fn records_say_which_pictures_are_paired_and_what_else_differs() {
    let one: &[&str] = &["materials.white.albedo=[0.71, 0.6, 0.5]"];
    let two: &[&str] = &[
        "materials.white.albedo=[0.71, 0.6, 0.5]",
        "light.strategy=sample",
    ];
    let folder = folder(&[
        ("a.exr", 16, 1, &[]),
        ("one.exr", 16, 1, one),
        ("two.exr", 16, 1, two),
        ("later.exr", 16, 2, two),
    ]);
    let at = folder.path();
    let (code, paired) = json(at, &["a.exr", "one.exr"]);
    assert_eq!((code, &paired["verdict"]["paired"]), (1, &true.into()));
    assert_eq!(paired["kinship"]["mixed"], false);
    let (_, mixed) = json(at, &["a.exr", "two.exr"]);
    assert_eq!(mixed["kinship"]["mixed"], true);
    let (_, words, _) = diff(at, &["a.exr", "two.exr"]);
    assert!(
        words.contains("warning: more differs than one knob"),
        "{words}"
    );
    assert!(
        words.contains("knob light.strategy: \"mis\" -> \"sample\""),
        "{words}"
    );
    let (_, independent) = json(at, &["a.exr", "later.exr"]);
    assert_eq!(independent["verdict"]["paired"], false);
    // The same samples: nothing differs at all.
    let (code, same) = json(at, &["a.exr", "a.exr"]);
    assert_eq!((code, &same["identical"]), (0, &true.into()));
}

#[test]
fn limits_pass_and_fail() {
    let folder = folder(&[
        ("a.png", 16, 1, &[]),
        ("b.png", 16, 2, &[]),
        ("a.exr", 16, 1, &[]),
    ]);
    let at = folder.path();
    for (limits, code) in [
        (&["--metric", "mse", "--max", "0"][..], 1),
        (&["--metric", "mse", "--max", "1"], 0),
        (
            &[
                "--metric", "psnr", "--min", "5", "--metric", "ssim", "--min", "0.1",
            ],
            0,
        ),
        (
            &[
                "--metric", "psnr", "--min", "5", "--metric", "ssim", "--min", "0.999",
            ],
            1,
        ),
        (&["--metric", "flip", "--max", "0.5"], 0),
        (
            &["--metric", "mae", "--max", "0.001", "--allow-pixels", "1"],
            1,
        ),
        (
            &[
                "--metric",
                "mae",
                "--max",
                "0.001",
                "--allow-pixels",
                "100%",
            ],
            0,
        ),
        (&["--metric", "rmse"], 1),
        // Mistakes.
        (&["--max", "1"], 2),
        (&["--metric", "psnr", "--max", "1"], 2),
        (&["--metric", "mse", "--min", "1"], 2),
        (&["--metric", "mse", "--max", "nan"], 2),
        (&["--metric", "mse", "--max", "1", "--max", "2"], 2),
        (
            &["--metric", "psnr", "--min", "1", "--allow-pixels", "4"],
            2,
        ),
        (
            &["--metric", "mse", "--max", "1", "--allow-pixels", "many"],
            2,
        ),
        (&["--metric", "hdr-flip", "--max", "1"], 2),
        (&["--metric", "nonsense"], 2),
        (&["--alpha", "0"], 2),
        (&["--ppd", "0"], 2),
        (&["--exposures", "1,0,3"], 2),
        (&["--crop", "0,0,33,32"], 2),
    ] {
        let found = diff(at, &[&["a.png", "b.png"], limits].concat());
        assert_eq!(found.0, code, "{limits:?}: {}{}", found.1, found.2);
    }
    let (_, words, _) = diff(at, &["a.png", "b.png", "--metric", "mae", "--max", "0"]);
    assert!(
        words.contains("FAILS") && words.contains("pixels beyond each limit of mae"),
        "{words}"
    );
    let (code, failed) = json(at, &["a.png", "b.png", "--metric", "mae", "--max", "0"]);
    assert_eq!(code, 1);
    assert!(
        failed["gates"][0]["curve"]
            .as_array()
            .is_some_and(|curve| curve.len() > 3)
    );
    // A PNG beside the EXR of the same render: the rounding to 8 bits, and what is cut off at white.
    assert_eq!(
        diff(at, &["a.exr", "a.png", "--metric", "flip", "--max", "0.02"]).0,
        0
    );
}

#[test]
fn hdr_flip_s_exposures_are_stored_and_given_again() {
    let folder = folder(&[("a.exr", 16, 1, &[]), ("b.exr", 16, 2, &[])]);
    let hdr = ["a.exr", "b.exr", "--metric", "hdr-flip"];
    let (_, first) = json(folder.path(), &hdr);
    let stored = &first["exposures"];
    let text = format!("{},{},{}", stored["start"], stored["stop"], stored["count"]);
    let again = [&hdr[..], &["--exposures", &text]].concat();
    assert_eq!(json(folder.path(), &again).1["figures"], first["figures"]);
    let other = [&hdr[..], &["--exposures", "-1,1,2"]].concat();
    assert_ne!(json(folder.path(), &other).1["figures"], first["figures"]);
}

#[test]
fn maps_are_written_whole_or_not_at_all() {
    let folder = folder(&[
        ("a.exr", 16, 1, &[]),
        ("b.exr", 16, 2, &[]),
        ("a.png", 16, 1, &[]),
    ]);
    let at = folder.path();
    for kind in ["signed", "relative", "flip", "hdr-flip", "z"] {
        for name in [format!("{kind}.png"), format!("{kind}.exr")] {
            let arguments = ["a.exr", "b.exr", "--map", name.as_str(), "--map-kind", kind];
            assert!(diff(at, &arguments).0 != 2, "{name}");
            let raster = lampray::film::RasterFile::open(at.join(&name)).expect("a map");
            let wide = if name.ends_with("png") { 320 } else { 32 };
            assert_eq!(raster.width(), wide, "{name}");
            raster.read().expect("a map that can be read");
        }
    }
    assert_eq!(diff(at, &["a.exr", "b.exr", "--map", "m.jpg"]).0, 2);
    assert_eq!(
        diff(at, &["a.exr", "b.exr", "--map", "no/folder/m.png"]).0,
        73
    );
    assert_eq!(
        diff(at, &["a.png", "b.exr", "--map", "m.png", "--map-kind", "z"]).0,
        2
    );
    assert!(!at.join("m.png").exists());
}

#[test]
fn references_change_only_when_asked_to() {
    let folder = folder(&[
        ("a.exr", 64, 1, &[]),
        ("same.exr", 64, 2, &[]),
        ("other.exr", 64, 3, &["spheres.1.radius=0.3"]),
    ]);
    let at = folder.path();
    let bytes = |name: &str| fs::read(at.join(name)).expect("a file");
    let before = bytes("a.exr");
    assert_eq!(diff(at, &["a.exr", "other.exr"]).0, 1);
    assert_eq!(bytes("a.exr"), before);
    diff(at, &["a.exr", "same.exr", "--margin", "0.5", "--bless"]);
    assert_eq!(bytes("a.exr"), before);
    assert_eq!(diff(at, &["a.exr", "other.exr", "--bless"]).0, 0);
    assert_eq!(bytes("a.exr"), bytes("other.exr"));
    assert_eq!(diff(at, &["a.exr", "same.exr", "--bless=all"]).0, 0);
    assert_eq!(bytes("a.exr"), bytes("same.exr"));
    // A first reference.
    assert_eq!(diff(at, &["first.exr", "same.exr"]).0, 2);
    assert_eq!(diff(at, &["first.exr", "same.exr", "--bless"]).0, 0);
    assert_eq!(bytes("first.exr"), bytes("same.exr"));
    // Never by what is not a picture.
    assert_eq!(diff(at, &["new.exr", "s.toml", "--bless"]).0, 2);
    assert!(!at.join("new.exr").exists());
}

#[test]
fn calibrate_proposes_a_limit_that_good_pictures_keep() {
    let folder = folder(&[
        ("a.exr", 16, 1, &[]),
        ("b.exr", 16, 77, &[]),
        ("other.exr", 16, 3, &["materials.lamp.emission=[14,14,14]"]),
    ]);
    let at = folder.path();
    let calibrate = [
        "--calibrate",
        "s.toml",
        "--samples",
        "16",
        "--metric",
        "rmse",
        "--metric",
        "ssim",
        "--device",
        "cpu",
    ];
    let (code, found) = json(at, &calibrate);
    assert_eq!(code, 0);
    let limit = |index: usize| found["proposals"][index]["limit"].to_string();
    let gates = |test: &str| {
        let (rmse, ssim) = (limit(0), limit(1));
        let arguments = [
            "a.exr", test, "--metric", "rmse", "--max", &rmse, "--metric", "ssim", "--min", &ssim,
        ];
        diff(at, &arguments).0
    };
    assert_eq!((gates("b.exr"), gates("other.exr")), (0, 1), "{found}");
    assert_eq!(found["proposals"][0]["comparisons"], 6);
    // Against a file that stays.
    let (code, against) = json(at, &[&["a.exr"], &calibrate[..]].concat());
    assert_eq!(
        (code, &against["proposals"][0]["comparisons"]),
        (0, &12.into())
    );
    assert_eq!(diff(at, &["--calibrate", "none.toml"]).0, 2);
    assert_eq!(diff(at, &["--calibrate", "s.toml", "--seeds", "1"]).0, 2);
}

#[test]
fn what_is_not_a_pair_of_pictures_is_trouble() {
    let folder = folder(&[
        ("a.exr", 4, 1, &[]),
        ("wide.png", 4, 1, &["image.width=40"]),
    ]);
    let at = folder.path();
    fs::write(at.join("empty.png"), "").expect("a file");
    for (a, b, words) in [
        ("s.toml", "s.toml", "neither"),
        ("a.exr", "none.exr", "cannot read"),
        ("a.exr", "empty.png", "neither"),
        ("a.exr", "wide.png", "only pictures of one size"),
        ("a.exr", ".", "cannot read"),
    ] {
        let (code, _, message) = diff(at, &[a, b]);
        assert_eq!(code, 2, "{a} {b}: {message}");
        assert!(message.contains(words), "{a} {b}: {message}");
    }
    assert_eq!(diff(at, &["a.exr"]).0, 2);
    assert_eq!(diff(at, &[]).0, 2);
}
