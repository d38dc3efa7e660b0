//! Where the packages come from that lampray is built of, and under which licences: the lists of deny.toml, held
//! without cargo-deny.

use serde_json::Value;
use std::io::Write;
use std::path::Path;
use std::process::Command;

const LOCKS: [&str; 2] = ["Cargo.lock", "fuzz/Cargo.lock"];
/// As lockfiles name it.
const REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";

fn read(file: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(root.join(file)).unwrap()
}

/// A key's text in a package of a lockfile.
fn value<'t>(package: &'t str, key: &str) -> Option<&'t str> {
    let start = format!("{key} = \"");
    let line = package.lines().find_map(|line| line.strip_prefix(&start))?;
    line.strip_suffix('"')
}

/// Packages that are neither a part of this repository nor from crates.io with a checksum.
fn strangers(lock: &str) -> Vec<&str> {
    let packages = lock.split("[[package]]\n").skip(1);
    let own = |package: &str| {
        let name = value(package, "name");
        name == Some("lampray") || name == Some("lampray-fuzz")
    };
    let known = |package: &str| match value(package, "source") {
        None => own(package),
        Some(source) => {
            let checksum = value(package, "checksum");
            source == REGISTRY && checksum.is_some_and(|sum| sum.len() == 64)
        }
    };
    packages.filter(|package| !known(package)).collect()
}

#[test]
fn every_package_is_from_crates_io_with_its_checksum() {
    for file in LOCKS {
        let lock = read(file);
        assert!(lock.matches("[[package]]").count() > 100, "{file}");
        assert_eq!(strangers(&lock), [""; 0], "{file}");
    }
}

#[test]
fn packages_from_elsewhere_are_seen() {
    let sum = "0".repeat(64);
    let package = |name: &str, source: &str, sum: &str| {
        format!(
            "[[package]]\nname = \"{name}\"\nversion = \"1.0.0\"\n{source}checksum = \"{sum}\"\n\n"
        )
    };
    let from = |source: &str| format!("source = \"{source}\"\n");
    assert!(strangers(&package("a", &from(REGISTRY), &sum)).is_empty());
    for other in [
        package("a", &from("git+https://github.com/a/a"), &sum),
        package("a", &from("registry+https://example.org/index"), &sum),
        package("a", &from(REGISTRY), "00"),
        package("a", "", &sum),
    ] {
        assert_eq!(strangers(&other).len(), 1, "{other}");
    }
}

/// The licences that deny.toml allows.
fn allowed() -> Vec<String> {
    let text = read("deny.toml");
    let (_, rest) = text.split_once("allow = [").unwrap();
    let (list, _) = rest.split_once(']').unwrap();
    let names = list.split(',').map(|name| name.trim().trim_matches('"'));
    names
        .filter(|name| !name.is_empty())
        .map(String::from)
        .collect()
}

/// Whether an SPDX expression can be met by these licences. A slash is an old way to write OR.
fn is_met(expression: &str, allowed: &[String]) -> bool {
    let spaced = expression
        .replace('/', " OR ")
        .replace('(', " ( ")
        .replace(')', " ) ");
    let mut words = spaced.split_whitespace().peekable();
    let met = any(&mut words, allowed);
    met && words.next().is_none()
}

type Words<'w> = std::iter::Peekable<std::str::SplitWhitespace<'w>>;

fn any(words: &mut Words, allowed: &[String]) -> bool {
    let mut met = all(words, allowed);
    while words.next_if_eq(&"OR").is_some() {
        met |= all(words, allowed);
    }
    met
}

fn all(words: &mut Words, allowed: &[String]) -> bool {
    let mut met = one(words, allowed);
    while words.next_if_eq(&"AND").is_some() {
        met &= one(words, allowed);
    }
    met
}

fn one(words: &mut Words, allowed: &[String]) -> bool {
    match words.next() {
        Some("(") => any(words, allowed) && words.next() == Some(")"),
        Some(name) => {
            let name = match words.next_if_eq(&"WITH").and_then(|_| words.next()) {
                Some(exception) => format!("{name} WITH {exception}"),
                None => name.to_string(),
            };
            allowed.contains(&name)
        }
        None => false,
    }
}

#[test]
fn licences_are_read_as_spdx_has_them() {
    let allowed: Vec<String> = ["MIT", "Apache-2.0"].map(String::from).into();
    for fine in [
        "MIT",
        "MIT OR GPL-3.0-only",
        "GPL-3.0-only/Apache-2.0",
        "(MIT OR GPL-3.0-only) AND Apache-2.0",
        "ISC AND ISC OR MIT AND Apache-2.0",
        "Apache-2.0 WITH LLVM-exception OR MIT",
    ] {
        assert!(is_met(fine, &allowed), "{fine}");
    }
    for not in [
        "",
        "GPL-3.0-only",
        "MIT AND GPL-3.0-only",
        "(MIT OR ISC) AND Unicode-3.0",
        "Apache-2.0 WITH LLVM-exception",
        "(MIT",
        "MIT MIT",
    ] {
        assert!(!is_met(not, &allowed), "{not}");
    }
}

/// What cargo knows of all packages; without the network, of those for this machine at least.
fn metadata() -> Value {
    let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
    let ask = |more: &[&str]| {
        let mut command = Command::new(&cargo);
        command.current_dir(env!("CARGO_MANIFEST_DIR"));
        command.args(["metadata", "--format-version", "1", "--locked", "--offline"]);
        command.args(more).output().unwrap()
    };
    let mut output = ask(&[]);
    if !output.status.success() {
        let host = format!("{}-unknown-linux-gnu", std::env::consts::ARCH);
        output = ask(&["--filter-platform", &host]);
        // Not eprintln!, which the test harness swallows for tests that pass.
        let _ = writeln!(
            std::io::stderr(),
            "NOT CHECKED: licences of packages for other systems, which are not on this machine (cargo fetch brings them)"
        );
    }
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn every_licence_is_allowed_and_every_allowed_one_is_needed() {
    let allowed = allowed();
    let metadata = metadata();
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > 50);
    let licence = |package: &Value| package["license"].as_str().unwrap_or_default().to_string();
    for package in packages {
        let licence = licence(package);
        assert!(
            is_met(&licence, &allowed),
            "{}: {licence:?}",
            package["name"]
        );
    }
    for one in &allowed {
        let others: Vec<_> = allowed
            .iter()
            .filter(|other| *other != one)
            .cloned()
            .collect();
        let needed = packages
            .iter()
            .any(|package| !is_met(&licence(package), &others));
        assert!(needed, "no package needs {one}");
    }
}
