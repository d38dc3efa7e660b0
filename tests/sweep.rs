//! `lampray sweep` as scripts meet it: which runs are made, which are made again, and what a kill, a
//! second process or a run that cannot be made leaves behind.

use serde_json::Value;
use std::collections::HashSet;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const SCENE: &str = r#"version = 1
camera = { position = [0.0, 1.0, 3.4], look_at = [0.0, 0.8, 0.0], fov = 40 }
image = { width = 16, height = 16 }
render = { seed = 40 }
boxes = [{ min = [-1.5, -0.2, -1.5], max = [1.5, 0.0, 1.5], material = "white" }]
spheres = [{ center = [0.0, 2.0, 0.0], radius = 0.4, material = "lamp" }]
[materials.white]
[materials.lamp]
emission = [9.0, 9.0, 9.0]
"#;

fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("s.toml"), SCENE).expect("the scene");
    folder
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command.current_dir(folder);
    command
        .args(["sweep", "s.toml", "--device", "cpu", "-o", "out"])
        .args(arguments);
    command
}

fn sweep(folder: &Path, arguments: &[&str]) -> Output {
    let output = command(folder, arguments)
        .output()
        .expect("the program runs");
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(!words.contains("panicked"), "{arguments:?}: {words}");
    output
}

fn code(folder: &Path, arguments: &[&str]) -> i32 {
    sweep(folder, arguments)
        .status
        .code()
        .expect("an exit code")
}

/// The ledger's lines that are whole.
fn entries(folder: &Path) -> Vec<Value> {
    let text = fs::read_to_string(folder.join("out/runs.jsonl")).unwrap_or_default();
    text.lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .collect()
}

fn ids(folder: &Path) -> HashSet<String> {
    entries(folder)
        .iter()
        .map(|entry| entry["id"].to_string())
        .collect()
}

const GRID: [&str; 6] = [
    "--set",
    "light.sampler=cone,gaussian",
    "--set",
    "render.samples=2..8*2",
    "--seeds",
    "2",
];

#[test]
fn a_grid_is_made_once() {
    let folder = folder();
    let at = folder.path();
    assert_eq!(code(at, &GRID), 0);
    let made = entries(at);
    assert_eq!((made.len(), ids(at).len()), (12, 12));
    for entry in &made {
        assert_eq!(entry["status"], "ok");
        assert_eq!(
            entry["knobs"]["light.sampler"],
            entry["swept"]["light.sampler"]
        );
        let seed = 40 + entry["repeat"].as_u64().expect("a repeat");
        assert_eq!(
            (
                entry["seed"].as_u64(),
                entry["knobs"]["render.seed"].as_u64()
            ),
            (Some(seed), Some(seed))
        );
        for extension in ["exr", "png"] {
            let name = format!(
                "out/images/{}.{extension}",
                entry["id"].as_str().expect("an id")
            );
            assert!(at.join(&name).exists(), "{name}");
        }
    }
    // Each point's runs differ in their seed alone, and the strategy changes once.
    let samplers: Vec<_> = made
        .iter()
        .map(|entry| entry["swept"]["light.sampler"].to_string())
        .collect();
    assert_eq!(
        samplers
            .windows(2)
            .filter(|pair| pair[0] != pair[1])
            .count(),
        1
    );
    let table = fs::read_to_string(at.join("out/table.csv")).expect("a table");
    assert_eq!(table.lines().count(), 13);
    assert!(table.starts_with("id,status,") && table.contains(",light.sampler,"));
    // Again, and more of it: only what is new is made.
    assert_eq!(code(at, &GRID), 0);
    assert_eq!(entries(at).len(), 12);
    assert_eq!(code(at, &[&GRID[..5], &["3"]].concat()), 0);
    assert_eq!((entries(at).len(), ids(at).len()), (18, 18));
}

/// A run of a sweep is the render of the same knobs, byte for byte.
#[test]
fn a_run_is_the_render_of_its_knobs() {
    let folder = folder();
    let at = folder.path();
    assert_eq!(
        code(
            at,
            &[
                "--set",
                "light.sampler=gaussian",
                "--set",
                "render.samples=4",
                "--seeds",
                "2"
            ]
        ),
        0
    );
    let second = &entries(at)[1];
    let output = Command::new(env!("CARGO_BIN_EXE_lampray"))
        .current_dir(at)
        .args([
            "render", "s.toml", "--device", "cpu", "-q", "-o", "one.exr", "-s", "4", "--seed", "41",
        ])
        .args(["--set", "light.sampler=gaussian"])
        .status();
    assert!(output.expect("the program runs").success());
    let read = |path: &Path| lampray::film::read_exr(path).expect("a picture");
    let name = format!("out/images/{}.exr", second["id"].as_str().expect("an id"));
    assert_eq!(read(&at.join(name)).mean, read(&at.join("one.exr")).mean);
}

#[test]
fn shards_are_the_whole_and_share_nothing() {
    let whole = folder();
    code(whole.path(), &GRID);
    let parts = folder();
    let mut counts = Vec::new();
    for part in ["1/3", "2/3", "3/3"] {
        assert_eq!(
            code(parts.path(), &[&GRID[..], &["--shard", part]].concat()),
            0
        );
        counts.push(entries(parts.path()).len());
    }
    assert_eq!(counts, [4, 8, 12]);
    assert_eq!(ids(parts.path()), ids(whole.path()));
    for wrong in ["0/3", "4/3", "1", "a/b"] {
        assert_eq!(
            code(parts.path(), &[&GRID[..], &["--shard", wrong]].concat()),
            2,
            "{wrong}"
        );
    }
}

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
                "render.samples=1,2",
                "--set",
                "render.max_bounces=1",
                "--zip",
            ],
            2,
        ),
        (&["--set", "render.seed=1,2", "--seeds", "2"], 2),
        (&["--set", "render.samples=1..1000", "--seeds", "10000"], 2),
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
    assert!(!at.join("out").exists());
}

/// What is written into the page, as the page reads it.
fn report(folder: &Path) -> Value {
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

#[test]
fn a_run_that_takes_too_long_is_tried_again_next_time() {
    let folder = folder();
    let at = folder.path();
    let long = ["--set", "render.samples=2,2000000", "--timeout", "0.3"];
    assert_eq!(code(at, &[&long[..], &["--retry", "1"]].concat()), 75);
    let status = |entry: &Value| entry["status"].as_str().unwrap_or_default().to_string();
    let made = entries(at);
    assert_eq!(
        made.iter().map(status).collect::<Vec<_>>(),
        ["ok", "timeout"]
    );
    assert_eq!(made[1]["attempts"], 2);
    assert_eq!(made[1]["knobs"]["render.samples"], 2_000_000);
    assert_eq!(code(at, &long), 75);
    assert_eq!((entries(at).len(), ids(at).len()), (3, 2));
    let table = fs::read_to_string(at.join("out/table.csv")).expect("a table");
    assert_eq!(table.lines().count(), 3);
    assert!(table.contains(",timeout,not done after 0.3 s,"), "{table}");
}

fn start(folder: &Path, arguments: &[&str]) -> Child {
    let mut command = command(folder, arguments);
    command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program runs")
}

/// Waits until the ledger has so many lines.
fn wait_for(folder: &Path, lines: usize) {
    let started = Instant::now();
    while entries(folder).len() < lines {
        assert!(
            started.elapsed() < Duration::from_secs(60),
            "no run after a minute"
        );
        thread::sleep(Duration::from_millis(2));
    }
}

#[cfg(unix)]
#[test]
fn a_kill_loses_the_run_in_hand_at_most() {
    let folder = folder();
    let at = folder.path();
    let long = ["--set", "render.samples=2000..2011"];
    let mut child = start(at, &long);
    wait_for(at, 3);
    // SIGKILL.
    child.kill().expect("a child");
    child.wait().expect("an end");
    let before = ids(at);
    assert!((3..12).contains(&before.len()), "{}", before.len());
    assert_eq!(code(at, &long), 0);
    assert_eq!((entries(at).len(), ids(at).len()), (12, 12));
    assert!(before.is_subset(&ids(at)));
}

#[test]
fn two_processes_on_one_folder_leave_it_whole() {
    let folder = folder();
    let at = folder.path();
    let both = [start(at, &GRID), start(at, &GRID)];
    for mut child in both {
        assert!(child.wait().expect("an end").success());
    }
    let text = fs::read_to_string(at.join("out/runs.jsonl")).expect("a ledger");
    assert_eq!(text.lines().count(), entries(at).len());
    assert_eq!(ids(at).len(), 12);
    assert_eq!(
        fs::read_to_string(at.join("out/table.csv"))
            .expect("a table")
            .lines()
            .count(),
        13
    );
}
