//! The faults in `tests/mutants/`, each a patch, and the table of what catches them.
//!
//! A proof that cannot fail proves nothing (DeMillo, Lipton and Sayward, "Hints on Test Data
//! Selection", 1978). `tests/mutants/run` puts each fault into a copy of the tree and runs the gates;
//! that takes long. Here it is checked that every patch still fits the code as it is, that it puts the
//! fault into both devices, and that the table is of these very patches and has a catch for each.

use lampray::shader::{self, Kernel, SceneArrays};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Fewest mutants that the gates must be tried on.
const FEWEST: usize = 12;

/// Lines of a file before and after.
#[derive(Debug, Default)]
struct Hunk {
    before: Vec<String>,
    after: Vec<String>,
}

#[derive(Debug)]
struct FilePatch {
    path: String,
    hunks: Vec<Hunk>,
}

#[derive(Debug)]
struct Patch {
    name: String,
    /// What is wrong with the renderer, in a sentence.
    why: String,
    files: Vec<FilePatch>,
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// A unified diff with a sentence above it.
fn parse(name: &str, text: &str) -> Patch {
    let mut patch = Patch {
        name: name.into(),
        why: String::new(),
        files: Vec::new(),
    };
    for line in text.lines() {
        let hunk = patch
            .files
            .last_mut()
            .and_then(|file| file.hunks.last_mut());
        if let Some(path) = line.strip_prefix("+++ b/") {
            let (path, hunks) = (path.to_string(), Vec::new());
            patch.files.push(FilePatch { path, hunks });
        } else if line.starts_with("--- a/") {
            continue;
        } else if line.starts_with("@@ ") {
            let file = patch.files.last_mut().expect("a hunk stands under a file");
            file.hunks.push(Hunk::default());
        } else if let Some(hunk) = hunk {
            let (sign, rest) = line.split_at(1.min(line.len()));
            if sign != "+" {
                hunk.before.push(rest.into());
            }
            if sign != "-" {
                hunk.after.push(rest.into());
            }
        } else {
            patch.why += line;
        }
    }
    patch
}

fn patches() -> Vec<Patch> {
    let folder = std::fs::read_dir(root().join("tests/mutants")).unwrap();
    let mut paths: Vec<_> = folder.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|end| end == "patch"));
    paths.sort();
    let patch = |path: &PathBuf| {
        let name = path.file_stem().unwrap().to_str().unwrap();
        parse(name, &std::fs::read_to_string(path).unwrap())
    };
    paths.iter().map(patch).collect()
}

/// Line at which some lines stand in a text, from `first` on; none where they stand nowhere.
fn find(text: &[&str], wanted: &[String], first: usize) -> Option<usize> {
    let fits = |at: &usize| text[*at..].iter().zip(wanted).all(|(a, b)| a == b);
    (first..(text.len() + 1).saturating_sub(wanted.len())).find(fits)
}

/// A file with a patch in it; or which hunk has no place there.
fn applied(text: &str, file: &FilePatch) -> Result<String, String> {
    let lines: Vec<_> = text.lines().collect();
    let (mut out, mut next) = (Vec::new(), 0);
    for (number, hunk) in file.hunks.iter().enumerate() {
        let at = find(&lines, &hunk.before, next);
        let at = at.ok_or_else(|| format!("{}: hunk {} has no place", file.path, number + 1))?;
        if find(&lines, &hunk.before, at + 1).is_some() {
            return Err(format!("{}: hunk {} has two places", file.path, number + 1));
        }
        out.extend(lines[next..at].iter().map(ToString::to_string));
        out.extend(hunk.after.iter().cloned());
        next = at + hunk.before.len();
    }
    out.extend(lines[next..].iter().map(ToString::to_string));
    Ok(out.join("\n") + "\n")
}

/// What is wrong with a patch; nothing where it fits.
fn fault(patch: &Patch) -> Option<String> {
    for file in &patch.files {
        let text = read(&file.path);
        match applied(&text, file) {
            Err(fault) => return Some(fault),
            Ok(changed) if changed == text => return Some(format!("{} stays", file.path)),
            Ok(_) => {}
        }
    }
    let stems = |folder: &str, end: &str| {
        let paths = patch.files.iter().map(|file| file.path.as_str());
        let inside = paths.filter_map(|path| path.strip_prefix(folder)?.strip_suffix(end));
        inside.map(String::from).collect::<BTreeSet<_>>()
    };
    // Which samples are taken, and what is denoised of them, is decided for both devices in one place.
    let of_both = |file: &FilePatch| {
        let rooms = ["src/render/", "src/denoise/"];
        rooms.iter().any(|room| file.path.starts_with(room))
    };
    if patch.files.iter().all(of_both) && !patch.files.is_empty() {
        return None;
    }
    let (shaders, mut twins) = (stems("shaders/", ".wgsl"), stems("src/cpu/", ".rs"));
    // The twin meets bodies four at a time by a copy of these.
    let four = twins.remove("four");
    let copied = ["ray", "sphere", "box"]
        .iter()
        .any(|name| twins.contains(*name));
    if shaders.is_empty() || shaders != twins {
        return Some(format!("it changes shaders {shaders:?}, twins {twins:?}"));
    }
    (copied != four).then(|| "it changes but one copy of what `four` copies".into())
}

#[test]
fn every_patch_fits_and_changes_both_twins() {
    let all = patches();
    assert!(all.len() >= FEWEST, "{} mutants", all.len());
    let faults: Vec<_> = all
        .iter()
        .filter_map(|patch| Some(format!("{}: {}", patch.name, fault(patch)?)))
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    for patch in &all {
        let why = &patch.why;
        assert!(
            why.ends_with('.') && why.len() > 30,
            "{}: {why}",
            patch.name
        );
    }
}

/// Patched shaders are still shaders: every gate would catch one that does not compile, by no merit of
/// its own. (The twin's half is built by the script, which stops where it cannot.)
#[test]
fn every_patched_shader_compiles() {
    let arrays = SceneArrays {
        materials: 4,
        spheres: 4,
        boxes: 4,
        lamps: 2,
        ..SceneArrays::default()
    };
    let with_tree = SceneArrays {
        nodes: 100,
        outside_spheres: 1,
        outside_boxes: 1,
        ..arrays
    };
    for patch in patches() {
        let by_tree = patch
            .files
            .iter()
            .any(|file| file.path == "shaders/bvh.wgsl");
        let arrays = if by_tree { with_tree } else { arrays };
        let denoises = patch
            .files
            .iter()
            .any(|file| file.path == "shaders/denoise.wgsl");
        let kernel = if denoises {
            Kernel::Denoise
        } else {
            Kernel::Trace
        };
        let mut joined = shader::source(kernel, arrays).unwrap();
        for file in &patch.files {
            if file.path.starts_with("shaders/") {
                joined.text = applied(&joined.text, file).unwrap();
            }
        }
        let module = shader::parse(&joined);
        let checked = module.and_then(|module| shader::validate(&joined, &module));
        assert!(checked.is_ok(), "{}: {}", patch.name, checked.unwrap_err());
    }
}

const HALF: &str =
    "Nothing.\n\n--- a/shaders/random.wgsl\n+++ b/shaders/random.wgsl\n@@ -1,1 +1,1 @@\n";

#[test]
fn a_patch_that_does_not_fit_is_refused() {
    let line = read("shaders/random.wgsl")
        .lines()
        .next()
        .unwrap()
        .to_string();
    let fits = parse("fits", &format!("{HALF}-{line}\n+{line}!\n"));
    assert!(
        fault(&fits).unwrap().contains("twins {}"),
        "{:?}",
        fault(&fits)
    );
    let stale = parse("stale", &format!("{HALF}-{line}?\n+{line}!\n"));
    assert!(fault(&stale).unwrap().contains("no place"));
    let idle = parse("idle", &format!("{HALF} {line}\n"));
    assert!(fault(&idle).unwrap().contains("stays"));
    let vague = parse("vague", &format!("{HALF}-}}\n+}} \n"));
    assert!(fault(&vague).unwrap().contains("two places"));
}

/// The rows of a table in Markdown: cells without their blanks.
fn rows(text: &str) -> Vec<Vec<String>> {
    let cells = |line: &str| {
        let inner = line.trim().trim_matches('|');
        inner
            .split('|')
            .map(|cell| cell.trim().to_string())
            .collect()
    };
    let lines = text.lines().filter(|line| line.starts_with('|'));
    lines.map(cells).collect()
}

/// Mutants of a table, and those that no gate catches.
fn table(text: &str) -> (Vec<String>, Vec<String>, Vec<String>) {
    let all = rows(text);
    let gates = all[0][1..].to_vec();
    let body = &all[2..];
    let idle = |cell: &String| ["-", "too long"].contains(&cell.as_str());
    let free = body.iter().filter(|row| row[1..].iter().all(idle));
    let names =
        |rows: &mut dyn Iterator<Item = &Vec<String>>| rows.map(|row| row[0].clone()).collect();
    (gates, names(&mut body.iter()), names(&mut { free }))
}

#[test]
fn the_table_lists_every_mutant_and_a_gate_that_catches_it() {
    let (gates, listed, free) = table(&read("tests/mutants/TABLE.md"));
    for gate in &gates {
        let path = format!("tests/{gate}.rs");
        assert!(Path::exists(&root().join(&path)), "{path} is not there");
    }
    let names: Vec<_> = patches().into_iter().map(|patch| patch.name).collect();
    assert_eq!(listed, names, "run tests/mutants/run");
    assert!(free.is_empty(), "no gate catches {free:?}");
}

#[test]
fn a_mutant_without_a_catch_is_seen() {
    let text = "| mutant | twin | scenes |\n|---|---|---|\n| a | - | 2 |\n| b | - | too long |\n";
    let (gates, listed, free) = table(text);
    assert_eq!(gates, ["twin", "scenes"]);
    assert_eq!(
        (listed, free),
        (vec!["a".into(), "b".into()], vec!["b".to_string()])
    );
}
