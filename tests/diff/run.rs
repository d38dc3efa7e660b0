//! A folder with pictures in it, and the program run there.

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

pub fn lampray(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command.current_dir(folder).args(arguments);
    command.output().expect("the program runs")
}

/// Exit code, stdout, stderr.
pub fn diff(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = lampray(folder, &[&["diff"], arguments].concat());
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert!(
        !err.contains("panicked") && !err.contains("internal"),
        "{arguments:?}: {err}"
    );
    (output.status.code().expect("an exit code"), out, err)
}

pub fn json(folder: &Path, arguments: &[&str]) -> (i32, Value) {
    let (code, out, err) = diff(folder, &[arguments, &["--json"]].concat());
    let value = serde_json::from_str(&out).unwrap_or_else(|error| panic!("{error}: {out}{err}"));
    (code, value)
}

/// A folder with the scene, and pictures of it: name, samples, seed, `--set`s.
pub fn folder(pictures: &[(&str, u32, u32, &[&str])]) -> TempDir {
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
