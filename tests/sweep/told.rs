//! What a sweep says on standard output.

use super::bench::*;
use serde_json::Value;

fn told(folder: &std::path::Path, arguments: &[&str]) -> (String, String) {
    let output = sweep(folder, arguments);
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (text(&output.stdout), text(&output.stderr))
}

/// The answer is the report's, in words and as JSON.
#[test]
fn the_findings_are_the_answer() {
    let folder = folder();
    let at = folder.path();
    let table = "[sweep.regions]\nfloor = [0, 8, 16, 16]\n";
    std::fs::write(at.join("s.toml"), format!("{SCENE}{table}")).expect("the scene");
    let arguments = [
        "--set",
        "render.clamp=off,2",
        "--set",
        "render.samples=64",
        "--seeds",
        "4",
    ];
    let (words, _) = told(at, &arguments);
    let report = report(at);
    assert_eq!(words, findings(&report) + "\n");
    assert!(
        words.starts_with("2 is biased: the whole picture is "),
        "{words}"
    );
    assert!(words.contains("render.clamp: 2 has 0."), "{words}");
    assert!(words.contains(" times the variance of off"), "{words}");
    let (json, _) = told(at, &[&arguments[..], &["--json"]].concat());
    let json: Value = serde_json::from_str(&json).expect("JSON alone");
    assert_eq!(json["findings"], report["findings"]);
    assert_eq!(json["skipped"], 8);
    let groups = json["groups"].as_array().expect("groups");
    assert_eq!(groups.len(), 2);
    let clamped = &groups[1];
    assert_eq!(clamped["name"], "2");
    assert_eq!(clamped["values"]["render.samples"], 64);
    assert_eq!(
        (&clamped["runs"], &clamped["samples"]),
        (&4.into(), &64.into())
    );
    assert_eq!(clamped["verdict"], "different");
    assert_eq!(clamped["reference"], "reference");
    for key in ["mean", "bias", "variance", "mse"] {
        assert_eq!(
            clamped[key], report["groups"][1]["regions"][0][key],
            "{key}"
        );
        let end = |end: &str| clamped[key][end].as_f64().expect("a number");
        assert!(
            end("low") < end("value") && end("value") < end("high"),
            "{key}"
        );
    }
    assert!(clamped["seconds"]["value"].is_f64());
    let floor = &clamped["regions"]["floor"];
    assert_eq!(floor["bias"], report["groups"][1]["regions"][1]["bias"]);
    assert_eq!(
        clamped["regions"].as_object().map(serde_json::Map::len),
        Some(1)
    );
}

/// Numbers have one form, one is not called many, and axes of one value are in no name.
#[test]
fn names_and_counts() {
    let folder = folder();
    let at = folder.path();
    let one = ["--set", "render.samples=8", "--set", "light.pole=[0,1,0]"];
    let (_, words) = told(at, &one);
    assert!(words.contains("out: 1 run made, 0 were there"), "{words}");
    assert!(
        words.contains("references: 1 made, 0 were there"),
        "{words}"
    );
    assert_eq!(report(at)["groups"][0]["name"], "8, [0,1,0]");
    let (words, _) = told(at, &[&one[..], &["--dry-run"]].concat());
    assert!(words.starts_with("1 run, "), "{words}");
    let albedo = "materials.white.albedo=[0.0,0.0,0.0],[0.50,0.5,0.5]";
    let (_, words) = told(at, &[&one[..2], &["--set", albedo]].concat());
    assert!(words.contains("2 runs made, 0 were there"), "{words}");
    let report = report(at);
    let names = |of: &str| -> Vec<String> {
        let all = report[of].as_array().expect("it").iter();
        all.map(|one| one["name"].as_str().expect("a name").to_string())
            .collect()
    };
    assert_eq!(names("groups"), ["[0,0,0]", "[0.5,0.5,0.5]"]);
    let both = ["[0,0,0]", "[0.5,0.5,0.5]"];
    let expected = both.map(|value| format!("reference for materials.white.albedo {value}"));
    assert_eq!(names("references"), expected);
    assert_eq!(
        report["question"],
        "What does materials.white.albedo change?"
    );
}

/// Many knobs in step are a list of variants, each called by what it changes.
#[test]
fn variants_are_called_by_what_they_change() {
    let folder = folder();
    let at = folder.path();
    let sets = [
        "light.sampler=inverse-cosine,cone,inverse-cosine",
        "interruption.rule=survival,survival,none",
        "scatter.diffuse=cosine,uniform,cosine",
        "light.strategy=mis",
    ];
    let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
    told(at, &[&sets[..], &["--zip"]].concat());
    let report = report(at);
    let groups = report["groups"].as_array().expect("groups").iter();
    let names: Vec<_> = groups
        .map(|group| group["name"].as_str().expect("a name"))
        .collect();
    let expected = [
        "the first step",
        "light.sampler=cone, scatter.diffuse=uniform",
        "interruption.rule=none",
    ];
    assert_eq!(names, expected);
}
