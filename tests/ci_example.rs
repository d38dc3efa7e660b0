//! `scenes/ci-example`, which users copy: its check passes as it ships, fails for a scene that is a
//! little brighter, and its workflow names what is there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

mod support;

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/ci-example")
}

/// A copy of the folder, in which the scene may be changed.
fn copy(change: impl Fn(String) -> String) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["check.sh", "reference.exr"] {
        fs::copy(shipped().join(name), folder.path().join(name)).expect("a copy");
    }
    let scene = fs::read_to_string(shipped().join("scene.toml")).expect("the scene");
    fs::write(folder.path().join("scene.toml"), change(scene)).expect("the scene");
    folder
}

fn check(folder: &Path) -> (Option<i32>, String) {
    let software = support::gpu("the example of CI").is_some();
    let output = Command::new("bash")
        .arg("check.sh")
        .current_dir(folder)
        .env("LAMPRAY", env!("CARGO_BIN_EXE_lampray"))
        .env("DEVICE", if software { "0" } else { "cpu" })
        .output()
        .expect("bash runs");
    let text = [output.stdout, output.stderr].concat();
    (
        output.status.code(),
        String::from_utf8_lossy(&text).into_owned(),
    )
}

#[test]
fn the_check_passes_as_it_ships_and_fails_for_one_percent() {
    let folder = copy(|scene| scene);
    let (code, words) = check(folder.path());
    assert_eq!(code, Some(0), "{words}");
    assert!(words.contains("verdict: same expected image"), "{words}");
    for name in [
        "out/new.exr",
        "out/new.png",
        "out/difference.png",
        "out/verdict.txt",
    ] {
        assert!(folder.path().join(name).exists(), "{name}");
    }
    let brighter = copy(|scene| {
        let changed = scene.replace("[16.0, 14.5, 12.0]", "[16.16, 14.645, 12.12]");
        assert_ne!(changed, scene);
        changed
    });
    let (code, words) = check(brighter.path());
    assert_eq!(code, Some(1), "{words}");
}

#[test]
fn the_workflow_names_what_is_there() {
    let workflow = fs::read_to_string(shipped().join("render-check.yml")).expect("the workflow");
    for named in [
        "CHECK: scenes/ci-example",
        "$CHECK/check.sh",
        "mesa-vulkan-drivers",
    ] {
        assert!(workflow.contains(named), "{named}");
    }
    let size = fs::metadata(shipped().join("reference.exr"))
        .expect("the reference")
        .len();
    assert!(size < 300_000, "{size} bytes");
}
