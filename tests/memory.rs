//! Whether a render takes the memory that it is refused by.
#![cfg(target_os = "linux")]

use lampray::render::{Task, memory_estimate};
use lampray::scene::{Assignment, Scene};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

const SCENE: &str = "scenes/cornell.toml";
/// Large enough that the pixels, and not the program, take most of it.
const SIDES: [u32; 2] = [2560, 2048];

/// The most memory that the program holds while it renders so many pixels on the CPU twin, and what was
/// estimated before, in bytes.
fn peak_and_estimate([width, height]: [u32; 2], layers: bool) -> (u64, u64) {
    let folder = tempfile::tempdir().unwrap();
    let (width, height) = (
        format!("image.width={width}"),
        format!("image.height={height}"),
    );
    let sets = [
        width.as_str(),
        height.as_str(),
        "render.samples=1",
        "render.max_bounces=1",
    ];
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command.args(["render", SCENE, "-q", "--device", "cpu"]);
    command.args(sets.iter().flat_map(|set| ["--set", set]));
    for name in ["a.exr", "a.png"] {
        command.arg("-o").arg(folder.path().join(name));
    }
    if layers {
        command.args(["--aov", "normal,depth,albedo,id"]);
    }
    let mut child = command.stdin(Stdio::null()).spawn().unwrap();
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0;
    while child.try_wait().unwrap().is_none() {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kibibytes = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse::<u64>().ok());
        peak = peak.max(kibibytes.unwrap_or(0) * 1024);
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(child.wait().unwrap().success());
    let knobs: Vec<_> = sets
        .iter()
        .map(|set| Assignment::parse(set).unwrap())
        .collect();
    let scene = Scene::load(Path::new(SCENE), &knobs).unwrap();
    let task = Task {
        features: layers,
        ..Task::new(&scene)
    };
    (peak, memory_estimate(&task))
}

/// Neither too little, which would let a render be killed, nor so much that what fits is refused: what the
/// estimate adds for pixels is at most one and a half times what they take.
#[test]
fn the_estimate_is_kept_and_not_by_far() {
    let small = peak_and_estimate([64, 64], false);
    for layers in [false, true] {
        let (peak, estimate) = peak_and_estimate(SIDES, layers);
        assert!(peak <= estimate, "{peak} of {estimate}, layers: {layers}");
        let (taken, planned) = (peak - small.0, estimate - small.1);
        // Blocks of results are planned for at their largest.
        let blocks = 10 * (32 << 20);
        let ratio = (planned - blocks) as f64 / taken as f64;
        assert!(
            (0.7..1.5).contains(&ratio),
            "{taken} taken of {planned}: {ratio}"
        );
    }
}
