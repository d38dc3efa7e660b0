//! Everything that the fuzzer found worth keeping, through the bodies that it runs.

#[path = "../fuzz/bodies/mod.rs"]
mod bodies;

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// Bytes of the whole corpus; it is there to be quick.
const MOST_BYTES: usize = 300 << 10;

fn corpus(target: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus");
    let entries = fs::read_dir(folder.join(target)).unwrap();
    let mut files: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

#[test]
fn no_kept_input_breaks_a_promise() {
    let mut bytes = 0;
    for (target, run) in bodies::TARGETS {
        let files = corpus(target);
        assert!(files.len() >= 10, "{target} has {} inputs", files.len());
        for file in files {
            let input = fs::read(&file).unwrap();
            bytes += input.len();
            let outcome = catch_unwind(|| run(&input));
            assert!(outcome.is_ok(), "{} breaks {target}", file.display());
        }
    }
    assert!(bytes <= MOST_BYTES, "{bytes} bytes");
}

/// The fuzzer's list of targets is that of the bodies.
#[test]
fn every_body_is_a_target() {
    let manifest = include_str!("../fuzz/Cargo.toml");
    let named = manifest.matches("[[bin]]").count();
    assert_eq!(named, bodies::TARGETS.len());
    for (target, _) in bodies::TARGETS {
        assert!(manifest.contains(&format!(
            "name = \"{target}\"\npath = \"targets/{target}.rs\""
        )));
    }
}

/// A body says so when a promise is broken.
#[test]
fn bodies_see_what_breaks_a_promise() {
    use lampray::Error;
    let refused =
        |error: Error| catch_unwind(AssertUnwindSafe(|| bodies::support::refusal(&error))).is_err();
    assert!(!refused(Error::Usage("the sides must be positive".into())));
    assert!(refused(Error::Usage(" ".into())));
    assert!(refused(Error::Usage("a\u{1b}[2Jb".into())));
    assert!(refused(Error::Usage("x".repeat(1 << 20))));
    assert!(refused(Error::Internal("the sides".into())));
}
