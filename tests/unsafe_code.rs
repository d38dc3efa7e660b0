//! `unsafe` stands in one place. The compiler forbids it in every room that says so; this holds that every
//! room does.

use std::fs;
use std::path::{Path, PathBuf};

const EXCEPTION: &str = "src/gpu/disk_cache.rs";

/// The modules that a file declares without forbidding unsafe code in them.
fn unguarded(text: &str) -> Vec<&str> {
    let lines: Vec<_> = text.lines().collect();
    let declared = |line: &str| {
        let name = line
            .strip_prefix("pub ")
            .unwrap_or(line)
            .strip_prefix("mod ");
        name.is_some_and(|name| name.ends_with(';'))
    };
    let is_open = |place: usize| lines[..place].last() != Some(&"#[forbid(unsafe_code)]");
    let all = lines.iter().enumerate();
    all.filter(|(place, line)| declared(line) && is_open(*place))
        .map(|(_, line)| *line)
        .collect()
}

#[test]
fn every_room_but_one_forbids_unsafe_code() {
    assert_eq!(unguarded(include_str!("../src/lib.rs")), ["pub mod gpu;"]);
    let gpu = include_str!("../src/gpu/mod.rs");
    assert_eq!(unguarded(gpu), ["mod disk_cache;"]);
    assert!(include_str!("../src/main.rs").starts_with("#![forbid(unsafe_code)]\n"));
    // A room without its guard would show.
    let without = gpu.replacen("#[forbid(unsafe_code)]\n", "", 1);
    assert_eq!(unguarded(&without), ["mod adapter;", "mod disk_cache;"]);
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .flat_map(|path| match path.is_dir() {
            true => files(&path),
            false => vec![path],
        })
        .collect()
}

#[test]
fn unsafe_code_stands_in_one_place_and_says_why_it_is_sound() {
    let mut found = Vec::new();
    for file in files(Path::new("src")) {
        let text = fs::read_to_string(&file).unwrap_or_default();
        let blocks = text.matches("unsafe {").count();
        if blocks > 0 {
            assert_eq!(text.matches("// SAFETY:").count(), blocks, "{file:?}");
            found.push((file, blocks));
        }
    }
    assert_eq!(found, [(PathBuf::from(EXCEPTION), 1)]);
}
