//! A folder with a small scene, the program run in it, and what it leaves behind.

use serde_json::Value;
use std::collections::HashSet;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

pub const SCENE: &str = r#"version = 1
camera = { position = [0.0, 1.0, 3.4], look_at = [0.0, 0.8, 0.0], fov = 40 }
image = { width = 16, height = 16 }
render = { seed = 40 }
boxes = [{ min = [-1.5, -0.2, -1.5], max = [1.5, 0.0, 1.5], material = "white" }]
spheres = [{ center = [0.0, 2.0, 0.0], radius = 0.4, material = "lamp" }]
[materials.white]
[materials.lamp]
emission = [9.0, 9.0, 9.0]
"#;

pub fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("s.toml"), SCENE).expect("the scene");
    folder
}

pub fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command.current_dir(folder);
    command
        .args(["sweep", "s.toml", "--device", "cpu", "-o", "out"])
        .args(arguments);
    command
}

pub fn sweep(folder: &Path, arguments: &[&str]) -> Output {
    let output = command(folder, arguments)
        .output()
        .expect("the program runs");
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(!words.contains("panicked"), "{arguments:?}: {words}");
    output
}

pub fn code(folder: &Path, arguments: &[&str]) -> i32 {
    sweep(folder, arguments)
        .status
        .code()
        .expect("an exit code")
}

/// The ledger's lines that are whole.
pub fn entries(folder: &Path) -> Vec<Value> {
    let text = fs::read_to_string(folder.join("out/runs.jsonl")).unwrap_or_default();
    text.lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .collect()
}

pub fn ids(folder: &Path) -> HashSet<String> {
    entries(folder)
        .iter()
        .map(|entry| entry["id"].to_string())
        .collect()
}

pub const GRID: [&str; 6] = [
    "--set",
    "light.sampler=cone,gaussian",
    "--set",
    "render.samples=2..8*2",
    "--seeds",
    "2",
];

/// What is written into the page, as the page reads it.
pub fn report(folder: &Path) -> Value {
    let page = fs::read_to_string(folder.join("out/report.html")).expect("a report");
    // The names of SVG and its like are addresses that nobody fetches.
    let without_names = page.replace("http://www.w3.org/", "");
    let addresses = ["http://", "https://", "//cdn"];
    assert!(
        !addresses.iter().any(|part| without_names.contains(part)),
        "it asks for nothing outside"
    );
    let start = page.find("{\"title\"").expect("the data");
    let mut values = serde_json::Deserializer::from_str(&page[start..]).into_iter::<Value>();
    values.next().expect("the data").expect("JSON")
}

pub fn start(folder: &Path, arguments: &[&str]) -> Child {
    let mut command = command(folder, arguments);
    command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program runs")
}

/// Waits until the ledger has so many lines.
pub fn wait_for(folder: &Path, lines: usize) {
    let started = Instant::now();
    while entries(folder).len() < lines {
        assert!(
            started.elapsed() < Duration::from_secs(60),
            "no run after a minute"
        );
        thread::sleep(Duration::from_millis(2));
    }
}

/// Names of the references' EXR files.
pub fn references(folder: &Path) -> Vec<String> {
    let Ok(files) = fs::read_dir(folder.join("out/reference")) else {
        return Vec::new();
    };
    let names = files.map(|file| file.expect("a file").file_name());
    let names = names.map(|name| name.to_string_lossy().into_owned());
    names.filter(|name| name.ends_with(".exr")).collect()
}

/// Samples of each reference, from the least on.
pub fn reference_samples(folder: &Path) -> Vec<u64> {
    let of = |name: &String| {
        let file = folder.join("out/reference").join(name);
        let (record, _) = lampray::film::read_record(file).expect("a record");
        record.samples
    };
    let mut samples: Vec<u64> = references(folder).iter().map(of).collect();
    samples.sort_unstable();
    samples
}

/// The report's findings in one text.
pub fn findings(report: &Value) -> String {
    let findings = report["findings"].as_array().expect("findings").iter();
    let findings: Vec<_> = findings.filter_map(Value::as_str).collect();
    findings.join("\n")
}

/// The verdict of each group over the whole picture.
pub fn verdicts(report: &Value) -> Vec<String> {
    let groups = report["groups"].as_array().expect("groups").iter();
    let verdict = |group: &Value| group["regions"][0]["verdict"].as_str().map(String::from);
    groups
        .map(|group| verdict(group).unwrap_or_default())
        .collect()
}
