//! Which runs are made, which are made again, and what a kill or a second process leaves.

use super::bench::*;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

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

/// Runs that an earlier grid made take their place in a later one.
#[test]
fn another_grid_in_the_same_folder() {
    let folder = folder();
    let at = folder.path();
    let samples = ["--set", "render.samples=4", "--seeds", "2"];
    assert_eq!(code(at, &samples), 0);
    let both = [&["--set", "light.sampler=gaussian,cone"], &samples[..]].concat();
    assert_eq!(code(at, &both), 0);
    assert_eq!(entries(at).len(), 4);
    let report = report(at);
    let groups = report["groups"].as_array().expect("groups");
    let names: Vec<_> = groups.iter().map(|group| &group["name"]).collect();
    assert_eq!(names, ["gaussian", "cone"]);
    assert!(groups.iter().all(|group| group["runs"] == 2));
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

#[cfg(unix)]
#[test]
fn a_kill_loses_the_run_in_hand_at_most() {
    let folder = folder();
    let at = folder.path();
    let long = ["--set", "render.samples=2000..2011", "--reference", "none"];
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

/// A run counts as finished only while its picture reads back whole.
#[test]
fn a_picture_that_is_lost_or_damaged_is_made_again() {
    let folder = folder();
    let at = folder.path();
    let quick = [&GRID[..], &["--reference", "none"]].concat();
    assert_eq!(code(at, &quick), 0);
    let image = |index: usize| {
        let id = entries(at)[index]["id"]
            .as_str()
            .expect("an id")
            .to_string();
        at.join(format!("out/images/{id}.exr"))
    };
    let whole: Vec<Vec<u8>> = (0..12)
        .map(|run| fs::read(image(run)).expect("it"))
        .collect();
    let means: Vec<_> = (0..12)
        .map(|run| lampray::film::read_exr(image(run)).expect("it").mean)
        .collect();
    let damage = |whole: &[Vec<u8>]| {
        fs::remove_file(image(0)).expect("it was there");
        fs::write(image(1), &whole[1][..whole[1].len() - 1]).expect("cut short");
        // In the pixels' last block, in the record's seed, and another run's picture.
        let mut flipped = whole[2].clone();
        let last = flipped.len() - 40;
        flipped[last] ^= 0x10;
        fs::write(image(2), flipped).expect("flipped");
        let mut other = whole[3].clone();
        let knob = b"\"render.samples\":";
        let place = other.windows(knob.len()).position(|part| part == knob);
        other[place.expect("the record") + knob.len()] = b'9';
        fs::write(image(3), other).expect("flipped");
        fs::copy(image(5), image(4)).expect("copied");
    };
    damage(&whole);
    let output = sweep(at, &quick);
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{words}");
    assert!(words.contains("5 runs made, 7 were there"), "{words}");
    assert_eq!(words.matches("is made again").count(), 5, "{words}");
    let made: Vec<Value> = entries(at);
    assert_eq!((made.len(), ids(at).len()), (17, 12));
    for (run, mean) in means.iter().enumerate() {
        let name = image(run)
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        assert_eq!(words.contains(&name), run < 5, "{name}: {words}");
        assert_eq!(&lampray::film::read_exr(image(run)).expect("it").mean, mean);
    }
    assert!(!findings(&report(at)).contains("Not analysed"));
    // A ledger of an earlier version has no hashes: pictures are decoded, and tell by themselves.
    let ledger = fs::read_to_string(at.join("out/runs.jsonl")).expect("a ledger");
    fs::write(
        at.join("out/runs.jsonl"),
        ledger.replace("exr_hash", "other"),
    )
    .expect("it");
    let whole: Vec<Vec<u8>> = (0..5)
        .map(|run| fs::read(image(run)).expect("it"))
        .collect();
    damage(&whole);
    let words = String::from_utf8_lossy(&sweep(at, &quick).stderr).into_owned();
    assert!(words.contains("5 runs made, 7 were there"), "{words}");
}
