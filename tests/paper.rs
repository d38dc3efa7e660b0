//! `lampray figures`: what it measures agrees with theory, and drawing it again renders nothing.

mod support;

use lampray::figures::page::markdown;
use lampray::figures::{About, Figure};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use support::chance::chi_square_above;

fn figures(folder: &Path, more: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command.arg("figures").arg("-o").arg(folder).args(more);
    command.output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Rows of a CSV without quoted commas but in the pole's own.
fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let text = fs::read_to_string(path).unwrap();
    let cells = |line: &str| {
        let mut quoted = false;
        let split = line.split(|c| {
            quoted ^= c == '"';
            c == ',' && !quoted
        });
        split
            .map(|cell| cell.trim_matches('"').to_string())
            .collect::<Vec<_>>()
    };
    let mut lines = text.lines();
    let head = cells(lines.next().unwrap());
    let row = |line| head.iter().cloned().zip(cells(line)).collect();
    lines.map(row).collect()
}

fn number(row: &BTreeMap<String, String>, key: &str) -> f64 {
    row[key]
        .parse()
        .unwrap_or_else(|_| panic!("{key}: {:?}", row[key]))
}

/// Chance of what rows measured, if a column had the truth. Intervals are 1.96 standard errors wide on
/// either side, somewhat more for few degrees of freedom.
fn chance<'r>(
    rows: impl Iterator<Item = &'r BTreeMap<String, String>>,
    measured: &str,
    truth: &str,
) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for row in rows {
        let error = (number(row, "high") - number(row, "low")) / (2.0 * 1.96);
        if error > 0.0 {
            sum += ((number(row, measured) - number(row, truth)) / error).powi(2);
            count += 1.0;
        }
    }
    assert!(count >= 5.0, "{measured} against {truth}: {count} rows");
    chi_square_above(sum, count)
}

/// What agrees with theory has a chance above this; what does not, far below.
const LEVEL: f64 = 1e-4;

fn penumbrae(folder: &Path) {
    let rows = rows(&folder.join("fig7-penumbra.csv"));
    let inside = |rules: &'static str| {
        let fits = move |row: &&BTreeMap<String, String>| {
            row["rules"] == rules && number(row, "h").abs() < 0.9
        };
        rows.iter().filter(fits)
    };
    assert!(chance(inside("as published"), "share", "predicted") > LEVEL);
    assert!(chance(inside("corrected"), "share", "truth") > LEVEL);
    // The published profiles are not the truth, and the gate sees it.
    assert!(chance(inside("as published"), "share", "truth") < 1e-12);
}

fn one_lamp(folder: &Path) {
    let rows = rows(&folder.join("fig7-one-lamp.csv"));
    let of = |quantity: &'static str| rows.iter().filter(move |row| row["quantity"] == quantity);
    assert!(chance(of("published bias"), "measured", "predicted") > LEVEL);
    assert!(chance(of("corrected relative variance"), "measured", "predicted") > LEVEL);
    // The order of the cases' variances for a far lamp: pole toward, even by area, pole sideways.
    let variance = |sampler: &str, pole: &str| {
        let mut found = of("corrected relative variance");
        let row = found
            .find(|row| row["sampler"] == sampler && row["pole"] == pole && row["q"] == "0.17");
        number(row.unwrap(), "measured")
    };
    let [toward, even, sideways] = [
        variance("uniform-angles", "[0,1,0]"),
        variance("inverse-cosine", "[0,0,1]"),
        variance("uniform-angles", "[0,0,1]"),
    ];
    assert!(
        toward < even && even < sideways,
        "{toward} {even} {sideways}"
    );
}

fn spheres(folder: &Path) {
    let rows = rows(&folder.join("fig9-energy.csv"));
    let ball = |rules: &'static str| {
        rows.iter()
            .filter(move |row| row["scene"] == "hollow ball" && row["rules"] == rules)
    };
    assert!(chance(ball("as published"), "share", "predicted") > LEVEL);
    assert!(chance(ball("corrected"), "share", "predicted") > LEVEL);
}

/// Every file of a folder but those of the sweeps.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let files = entries.filter(|entry| entry.path().is_file());
    files
        .map(|entry| {
            (
                entry.file_name().to_string_lossy().into_owned(),
                fs::read(entry.path()).unwrap(),
            )
        })
        .collect()
}

#[test]
fn the_figures_agree_with_theory_and_are_drawn_again_without_rendering() {
    let folder = tempfile::tempdir().unwrap();
    let order = ["--quick", "--only", "6,7,9", "--json", "-q"];
    let made = figures(folder.path(), &order);
    assert!(made.status.success(), "{}", text(&made.stderr));
    let told: Value = serde_json::from_slice(&made.stdout).unwrap();
    let verdicts: Vec<_> = told["figures"].as_array().unwrap().iter().collect();
    let holds = |place: usize| verdicts[place]["verdict"]["holds"].as_str().unwrap();
    assert_eq!(
        [holds(0), holds(1), holds(2)],
        ["yes", "partly", "yes"],
        "{told}"
    );
    assert!(told["made"].as_u64() > Some(200));
    penumbrae(folder.path());
    one_lamp(folder.path());
    spheres(folder.path());
    drawn_again(folder.path());
    one_more_figure_keeps_the_others(folder.path());
    a_lost_run_is_named(folder.path());
}

/// The same bytes.
fn drawn_again(folder: &Path) {
    let ledger = folder.join("data/fig7-penumbra/runs.jsonl");
    let (before, runs) = (files(folder), fs::read(&ledger).unwrap());
    let again = figures(folder, &["--draw-only", "--json", "-q"]);
    assert!(again.status.success(), "{}", text(&again.stderr));
    let told: Value = serde_json::from_slice(&again.stdout).unwrap();
    assert_eq!(
        (told["made"].as_u64(), told["found"].as_u64()),
        (Some(0), Some(0))
    );
    assert_eq!(fs::read(&ledger).unwrap(), runs);
    let after = files(folder);
    assert_eq!(
        before.keys().collect::<Vec<_>>(),
        after.keys().collect::<Vec<_>>()
    );
    for (name, bytes) in &before {
        assert!(after[name] == *bytes, "{name}");
    }
}

/// Figure 6 again: the page still has all three.
fn one_more_figure_keeps_the_others(folder: &Path) {
    let again = figures(folder, &["--quick", "--only", "6", "--json", "-q"]);
    assert!(again.status.success(), "{}", text(&again.stderr));
    let told: Value = serde_json::from_slice(&again.stdout).unwrap();
    let numbers: Vec<_> = told["figures"]
        .as_array()
        .unwrap()
        .iter()
        .map(|figure| figure["number"].as_u64())
        .collect();
    assert_eq!(numbers, [6, 7, 9].map(Some));
}

fn a_lost_run_is_named(folder: &Path) {
    let images = folder.join("data/fig9-sphere/images");
    for entry in fs::read_dir(&images).unwrap() {
        fs::remove_file(entry.unwrap().path()).unwrap();
    }
    let refused = figures(folder, &["--draw-only"]);
    assert_eq!(refused.status.code(), Some(2), "{}", text(&refused.stderr));
    let said = text(&refused.stderr);
    assert!(
        said.contains("fig9-sphere") && said.contains("--draw-only"),
        "{said}"
    );
    let mended = figures(folder, &["--quick", "--only", "9"]);
    let said = text(&mended.stderr);
    assert!(mended.status.success(), "{said}");
    assert!(said.contains("made again"), "{said}");
}

#[test]
fn nothing_to_draw() {
    let folder = tempfile::tempdir().unwrap();
    let refused = figures(folder.path(), &["--draw-only"]);
    assert_eq!(refused.status.code(), Some(66), "{}", text(&refused.stderr));
    assert!(files(folder.path()).is_empty());
    let refused = figures(folder.path(), &["--only", "4"]);
    assert_eq!(refused.status.code(), Some(2), "{}", text(&refused.stderr));
    let file = folder.path().join("file");
    fs::write(&file, "x").unwrap();
    let refused = figures(&file, &["--quick", "--only", "6"]);
    assert_eq!(refused.status.code(), Some(73), "{}", text(&refused.stderr));
    assert_eq!(fs::read(&file).unwrap(), b"x");
}

/// `docs/make` measures; from its numbers the page is made again here.
#[test]
fn the_page_in_docs_is_made_of_its_numbers() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let numbers: Value =
        serde_json::from_slice(&fs::read(docs.join("figures.json")).unwrap()).unwrap();
    let figures: Vec<Figure> = serde_json::from_value(numbers["figures"].clone()).unwrap();
    let about: About = serde_json::from_value(numbers["about"].clone()).unwrap();
    let page = fs::read_to_string(docs.join("claims.md")).unwrap();
    assert!(
        page == markdown(&figures, &about),
        "run docs/make --draw-only"
    );
    for name in page
        .split(['(', ')'])
        .filter(|word| word.ends_with(".png") || word.ends_with(".svg"))
    {
        assert!(docs.join(name).exists(), "{name}");
    }
}
