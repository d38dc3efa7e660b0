//! `--denoise` as its users meet it, and what the other commands make of its pictures.

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn lampray(folder: &Path, line: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    let output = command
        .current_dir(folder)
        .args(line.split(' '))
        .output()
        .unwrap();
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(!words.contains("panicked"), "{line}: {words}");
    output
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout)
}

/// A folder with pictures of cornell in it, with and without `--denoise`.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/cornell.toml");
    std::fs::copy(scene, folder.path().join("s.toml")).unwrap();
    let common = "render s.toml --device cpu --width 20 --height 16 --spp 4 --no-times";
    for more in ["-o plain.exr", "--denoise -o a.exr -o a.png --json"] {
        let output = lampray(folder.path(), &format!("{common} {more}"));
        assert_eq!(output.status.code(), Some(0), "{}", words(&output));
        if more.contains("json") {
            let record: Value = serde_json::from_slice(&output.stdout).unwrap();
            let outputs = ["a.exr", "a.png", "a.denoised.exr", "a.denoised.png"];
            assert_eq!(record["outputs"], serde_json::json!(outputs));
            assert_eq!(record.get("denoised"), None);
        }
    }
    folder
}

#[test]
fn the_plain_picture_stays_and_another_stands_beside_it() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let [plain, beside] =
        ["plain.exr", "a.exr"].map(|name| lampray::film::read_exr(path(name)).unwrap());
    assert_eq!(
        (&plain.mean, &plain.variance),
        (&beside.mean, &beside.variance)
    );
    assert_eq!(plain.record.denoised, None);
    for name in ["a.denoised.exr", "a.denoised.png"] {
        let (record, _) = lampray::film::read_record(path(name)).unwrap();
        let denoised = record.denoised.unwrap();
        assert_eq!(denoised.by, lampray::film::Denoising::USUAL);
        assert_eq!(denoised.mean_before, plain.record.mean);
        assert_ne!(record.mean, plain.record.mean);
        assert_eq!(record.outputs, ["a.denoised.exr", "a.denoised.png"]);
    }
}

#[test]
fn a_single_sample_is_warned_of() {
    let folder = folder();
    let common = "render s.toml --device cpu --width 20 --height 16 --denoise";
    for (samples, unknown) in [(1, 320), (2, 0)] {
        let output = lampray(folder.path(), &format!("{common} --spp {samples} -o w.exr"));
        let said = "warning: 320 pixels of one sample, of whose variance nothing is known";
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(stderr.contains(said), unknown > 0, "{stderr}");
        let (record, _) = lampray::film::read_record(folder.path().join("w.denoised.exr")).unwrap();
        let denoised = record.denoised.unwrap();
        assert_eq!(denoised.unknown_variance, unknown);
        let kept = denoised
            .warnings
            .iter()
            .any(|text| text.starts_with(&said[9..]));
        assert_eq!(kept, unknown > 0, "{:?}", denoised.warnings);
    }
}

#[test]
fn readers_know_a_denoised_picture() {
    let folder = folder();
    let merged = lampray(folder.path(), "merge a.exr a.denoised.exr -o m.exr");
    assert_eq!(merged.status.code(), Some(65));
    assert!(words(&merged).contains("denoised"), "{}", words(&merged));
    let refused = lampray(
        folder.path(),
        "sweep s.toml --set render.samples=1,2 --reference a.denoised.exr --width 20 --height 16 -o d",
    );
    assert_eq!(refused.status.code(), Some(65), "{}", words(&refused));
    assert!(words(&refused).contains("denoised"), "{}", words(&refused));
    for (pair, name) in [("a.exr a.denoised.exr", "B"), ("a.denoised.exr a.exr", "A")] {
        let output = lampray(folder.path(), &format!("diff {pair} --json"));
        let told: Value = serde_json::from_slice(&output.stdout).unwrap();
        let why = told["no_verdict"].as_str().unwrap();
        assert!(why.starts_with(&format!("{name} was denoised")), "{why}");
        assert_eq!(told["verdict"], Value::Null);
        assert!(
            told["kinship"]["others"][0]
                .as_str()
                .unwrap()
                .starts_with("denoised: "),
            "{told}"
        );
    }
}

#[test]
fn a_rerun_makes_both_again() {
    let folder = folder();
    for name in ["a.denoised.png", "a.denoised.exr"] {
        let output = lampray(folder.path(), &format!("rerun {name} -o again.exr"));
        assert_eq!(output.status.code(), Some(0), "{}", words(&output));
        for (one, other) in [
            ("a.exr", "again.exr"),
            ("a.denoised.exr", "again.denoised.exr"),
        ] {
            let same = lampray(folder.path(), &format!("diff {one} {other} --json"));
            let told: Value = serde_json::from_slice(&same.stdout).unwrap();
            assert_eq!(told["identical"], true, "{one} {other}: {told}");
        }
    }
}

#[test]
fn what_cannot_be_written_is_refused_first() {
    let folder = folder();
    let refused = |line: &str, code: i32, word: &str| {
        let output = lampray(folder.path(), line);
        assert_eq!(
            output.status.code(),
            Some(code),
            "{line}: {}",
            words(&output)
        );
        assert!(words(&output).contains(word), "{line}: {}", words(&output));
    };
    refused("render s.toml --denoise -o /dev/stdout", 2, "--denoise");
    refused(
        "render s.toml --denoise -o x.png -o x.denoised.png",
        2,
        "given twice",
    );
    refused("render s.toml --denoise-passes 3", 2, "--denoise");
    refused(
        "render s.toml --denoise --denoise-passes 0",
        2,
        "--denoise-passes",
    );
    refused("render s.toml --denoise --denoise-light -1", 2, "0.001");
    std::fs::create_dir(folder.path().join("y.denoised.png")).unwrap();
    refused("render s.toml --denoise -o y.png", 73, "y.denoised.png");
    assert!(!folder.path().join("y.png").exists());
}

/// A megapixel takes seconds to denoise: a signal that comes when the plain picture is there comes in the midst of it.
#[cfg(unix)]
#[test]
fn a_signal_leaves_the_plain_picture_and_the_checkpoint() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let line = "render s.toml --device cpu --width 1000 --height 1000 --max-bounces 0 --spp 2 --denoise -o big.exr --checkpoint c";
    let mut child = Command::new(env!("CARGO_BIN_EXE_lampray"))
        .current_dir(folder.path())
        .args(line.split(' '))
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let began = std::time::Instant::now();
    while !path("big.exr").exists() {
        assert!(began.elapsed().as_secs() < 300, "no picture");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &id])
            .status()
            .unwrap()
            .success(),
        "the signal was sent"
    );
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(path("big.exr").exists() && path("c").exists());
    assert!(!path("big.denoised.exr").exists());
}
