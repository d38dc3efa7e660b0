//! The doctor: every canary passes on every device here, one that fails is seen and has its consequences,
//! and the cache of verdicts may be anything. `LAMPRAY_TEST_FAIL_CANARY` wipes a canary's answer.

mod support;

use lampray::cpu::Cpu;
use lampray::doctor::{NAMES, examine, table};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const SCENE: &str = "version = 1\n[camera]\nposition = [0.0, 0.0, 0.0]\nlook_at = [0.0, 0.0, -1.0]\n\
    [image]\nwidth = 4\nheight = 4\n[render]\nsamples = 1\n[background]\nemission = [1.0, 1.0, 1.0]\n";

const FAIL: &str = "LAMPRAY_TEST_FAIL_CANARY";
const CACHE: &str = "LAMPRAY_CACHE_DIR";

/// A folder to run in, and in it one for the cache.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("s.toml"), SCENE).unwrap();
        Self(folder)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn cache(&self) -> PathBuf {
        self.path().join("cache")
    }

    /// Verdicts that are kept.
    fn verdicts(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.cache()).into_iter().flatten();
        let paths = entries.map(|entry| entry.unwrap().path());
        let is_verdict = |path: &PathBuf| path.to_string_lossy().contains("doctor-");
        paths.filter(is_verdict).collect()
    }

    fn lampray(&self, arguments: &[&str], environment: &[(&str, &str)]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
        command
            .current_dir(self.path())
            .env(CACHE, self.cache())
            .env_remove(FAIL)
            .envs(environment.iter().copied())
            .args(arguments);
        command.output().unwrap()
    }

    /// Renders on a software driver; its exit code and what it says.
    fn render(&self, environment: &[(&str, &str)]) -> (i32, String) {
        let arguments = ["render", "s.toml", "--device", "software", "-o", "s.exr"];
        ended(&self.lampray(&arguments, environment))
    }
}

fn ended(output: &Output) -> (i32, String) {
    let words = String::from_utf8(output.stderr.clone()).unwrap();
    assert!(!words.contains("panicked"), "{words}");
    (output.status.code().expect("an exit code"), words)
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).expect("one JSON object")
}

/// Whether there is a software driver, which the tests of this program's own devices use.
fn software(what: &str) -> bool {
    let found = lampray::render::devices();
    let found = found
        .iter()
        .any(|info| info.kind == lampray::device::DeviceKind::Software);
    // Fails where a graphics device is required, and says what is not run where none is.
    found || support::gpu(what).is_some_and(|_| false)
}

#[test]
fn the_twin_passes_what_concerns_it() {
    let examination = examine(&mut Cpu::new()).unwrap();
    assert!(examination.ok, "{}", table(&examination));
    let applies: Vec<_> = examination
        .canaries
        .iter()
        .filter(|finding| finding.applies)
        .map(|finding| finding.name)
        .collect();
    assert_eq!(
        applies,
        ["random", "finite", "denormals", "floats", "picture"]
    );
    assert!(table(&examination).contains("loops       -       not applicable"));
}

#[test]
fn a_graphics_device_passes_all() {
    let Some(mut gpu) = support::gpu("the canaries") else {
        return;
    };
    let examination = examine(&mut *gpu).unwrap();
    let page = table(&examination);
    assert!(examination.ok, "{page}");
    assert!(examination.canaries.iter().all(|finding| finding.applies));
    assert!(examination.limits.is_some());
    assert!(page.contains("12 canaries, all as expected"), "{page}");
}

#[test]
fn json_is_one_object() {
    let place = Place::new();
    let output = place.lampray(&["doctor", "--device", "cpu", "--json"], &[]);
    let (code, words) = ended(&output);
    assert_eq!(code, 0, "{words}");
    let page = json(&output);
    assert_eq!(page["ok"], true);
    assert_eq!(page["device"]["kind"], "cpu");
    assert_eq!(page["limits"], Value::Null);
    let canaries = page["canaries"].as_array().unwrap();
    let names: Vec<_> = canaries.iter().map(|row| &row["name"]).collect();
    assert_eq!(names, NAMES);
    for row in canaries {
        assert_eq!(row["ok"], true);
        assert!(row["expected"].is_string() && row["found"].is_string());
    }
}

#[test]
fn every_canary_can_fail() {
    let place = Place::new();
    let graphics = software("a canary that fails");
    for name in NAMES {
        let device = if graphics { "software" } else { "cpu" };
        let arguments = ["doctor", "--device", device, "--json"];
        let output = place.lampray(&arguments, &[(FAIL, name)]);
        let (code, words) = ended(&output);
        let page = json(&output);
        let canaries = page["canaries"].as_array().unwrap();
        let failed: Vec<_> = canaries.iter().filter(|row| row["ok"] == false).collect();
        let applies = canaries
            .iter()
            .any(|row| row["name"] == *name && row["applies"] == true);
        if !applies {
            assert_eq!((code, failed.len()), (0, 0), "{name}");
            continue;
        }
        assert_eq!(code, 69, "{name}: {words}");
        assert_eq!(failed.len(), 1, "{name}: {failed:?}");
        assert_eq!(failed[0]["name"], *name);
        assert_eq!(page["ok"], false);
        let line = words.lines().last().unwrap();
        assert!(line.contains(&format!("canary {name}")), "{words}");
    }
    assert_eq!(
        place.verdicts(),
        [] as [PathBuf; 0],
        "nothing forced is kept"
    );
}

#[test]
fn a_canary_that_there_is_none_of_is_a_mistake() {
    let place = Place::new();
    let output = place.lampray(&["doctor", "--device", "cpu"], &[(FAIL, "parrot")]);
    let (code, words) = ended(&output);
    assert_eq!(code, 2);
    assert!(
        words.contains("parrot") && words.contains("denormals"),
        "{words}"
    );
}

#[test]
fn a_device_that_fails_is_refused_or_passed_over() {
    let place = Place::new();
    if !software("a device that fails") {
        return;
    }
    // A verdict that is kept does not save it.
    assert_eq!(place.render(&[]).0, 0);
    assert_eq!(place.verdicts().len(), 1);
    let fails = [(FAIL, "random")];
    let (code, words) = place.render(&fails);
    assert_eq!(code, 69, "{words}");
    assert_eq!(words.lines().count(), 1, "{words}");
    assert!(
        words.contains("canary random") && words.contains("lampray doctor"),
        "{words}"
    );
    let required = place.lampray(
        &["render", "s.toml", "--require", "software", "-o", "s.exr"],
        &fails,
    );
    let (code, words) = ended(&required);
    assert!(code == 69 && words.contains("canary random"), "{words}");
    // Where any device will do the next one is taken, down to the twin, and one line says why.
    let output = place.lampray(&["render", "s.toml", "-o", "s.exr", "--json"], &fails);
    let (code, words) = ended(&output);
    assert_eq!(code, 0, "{words}");
    assert_eq!(json(&output)["device"]["kind"], "cpu");
    let about: Vec<_> = words
        .lines()
        .filter(|line| line.contains("canary"))
        .collect();
    assert_eq!(about.len(), 1, "{words}");
    assert!(
        about[0].contains("canary random") && about[0].contains("built-in CPU"),
        "{words}"
    );
}

#[test]
fn a_verdict_is_kept_and_may_be_damaged() {
    let place = Place::new();
    if !software("verdicts that are kept") {
        return;
    }
    assert_eq!(place.render(&[]).0, 0);
    let verdicts = place.verdicts();
    let [verdict] = verdicts.as_slice() else {
        panic!("{verdicts:?}");
    };
    let whole = fs::read(verdict).unwrap();
    let written = || fs::metadata(verdict).unwrap().modified().unwrap();
    let first = written();
    assert_eq!(place.render(&[]).0, 0);
    assert_eq!(
        written(),
        first,
        "a verdict that is there is not found again"
    );
    for damage in [
        &whole[..10],
        b"",
        b"something else that is long enough for a checksum",
    ] {
        fs::write(verdict, damage).unwrap();
        let (code, words) = place.render(&[]);
        assert_eq!(code, 0, "{words}");
        assert_eq!(fs::read(verdict).unwrap(), whole, "it is found again");
    }
    // The doctor takes the trust back of a device that it finds ill, unless that was forced.
    let doctor = ["doctor", "--device", "software"];
    place.lampray(&doctor, &[(FAIL, "loops")]);
    assert_eq!(place.verdicts().len(), 1);
    fs::remove_dir_all(place.cache()).unwrap();
    assert_eq!(ended(&place.lampray(&doctor, &[])).0, 0);
    assert_eq!(place.verdicts().len(), 1, "the doctor's own verdict counts");
}

/// Where nothing can be kept, everything goes on as if there were no cache.
#[test]
fn a_cache_that_cannot_be_used_is_no_fault() {
    let place = Place::new();
    if !software("a cache that cannot be used") {
        return;
    }
    let file = place.path().join("file");
    fs::write(&file, "a file").unwrap();
    let inside = file.join("cache");
    let paths = [&file, &inside].map(|path| path.to_str().unwrap());
    let quiet = place.render(&[]).1.lines().count();
    for cache in ["", "/proc/nothing/here", paths[0], paths[1]] {
        let (code, words) = place.render(&[(CACHE, cache)]);
        assert_eq!(code, 0, "{cache}: {words}");
        assert_eq!(words.lines().count(), quiet, "{cache}: {words}");
    }
    assert_eq!(fs::read_to_string(&file).unwrap(), "a file");
}

/// Without a HOME and with one that nobody can write to. (Root writes everywhere but in /proc.)
#[cfg(target_os = "linux")]
#[test]
fn a_home_is_not_needed() {
    let place = Place::new();
    if !software("a missing HOME") {
        return;
    }
    for home in [None, Some(""), Some("/proc"), Some("relative")] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
        command
            .current_dir(place.path())
            .env_remove(CACHE)
            .env_remove("XDG_CACHE_HOME")
            .env_remove("HOME")
            .envs(home.map(|home| ("HOME", home)))
            .args(["render", "s.toml", "--device", "software", "-o", "s.exr"]);
        let (code, words) = ended(&command.output().unwrap());
        assert_eq!(code, 0, "{home:?}: {words}");
    }
    // Drivers may keep things of their own in a relative HOME.
    for folder in [".cache/lampray", "relative/.cache/lampray", "lampray"] {
        assert!(!place.path().join(folder).exists(), "{folder}");
    }
}

#[test]
fn the_cache_is_where_the_system_keeps_caches() {
    let place = Place::new();
    if !cfg!(unix) || !software("the place of the cache") {
        return;
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command
        .current_dir(place.path())
        .env_remove(CACHE)
        .env("XDG_CACHE_HOME", place.path().join("xdg"))
        .args(["render", "s.toml", "--device", "software", "-o", "s.exr"]);
    assert_eq!(ended(&command.output().unwrap()).0, 0);
    assert_eq!(
        fs::read_dir(place.path().join("xdg/lampray"))
            .unwrap()
            .count(),
        1
    );
}
