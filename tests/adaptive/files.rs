//! What the program writes, and does with what it has written.

use lampray::film::{Picture, Stop, read_exr};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command.args(arguments).current_dir(folder);
    command.output().expect("the program runs")
}

fn ran(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {told}");
    String::from_utf8_lossy(&output.stdout).into_owned() + &told
}

fn refused(folder: &Path, arguments: &[&str], code: i32) -> String {
    let output = run(folder, arguments);
    assert_eq!(
        output.status.code(),
        Some(code),
        "{arguments:?}: {output:?}"
    );
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A small Cornell box in a folder of its own.
fn stage() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string("scenes/cornell-small-lamp.toml").expect("a scene");
    std::fs::write(folder.path().join("s.toml"), text).expect("a scene");
    folder
}

const RENDER: &[&str] = &[
    "render",
    "s.toml",
    "--device",
    "cpu",
    "--width",
    "48",
    "--height",
    "48",
    "--max-bounces",
    "4",
    "--spp",
    "5000",
    "--target-error",
    "0.06",
];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [RENDER, more].concat()
}

fn read(folder: &Path, name: &str) -> Picture {
    read_exr(folder.join(name)).expect("a picture")
}

/// The plane of counts, the record and the totals are of one piece, and what is rendered again is the same.
#[test]
fn the_picture_says_how_it_was_sampled() {
    let stage = stage();
    let folder = stage.path();
    let told = ran(folder, &with(&["-o", "a.exr", "--json"]));
    let json: Value = serde_json::from_str(told.lines().next().expect("JSON")).expect("JSON");
    assert_eq!(json["adaptive"]["rule"], "shape");
    let picture = read(folder, "a.exr");
    let record = &picture.record;
    let adaptive = record.adaptive.as_ref().expect("it is adaptive");
    let counts = || picture.samples.iter().map(|count| *count as u64);
    assert_eq!(record.target_error, Some(0.06));
    assert_eq!(Some(record.samples), counts().min());
    assert_eq!(Some(record.sample_range[1]), counts().max());
    assert_eq!(record.paths, counts().sum::<u64>());
    assert!(
        record.samples < record.sample_range[1],
        "all pixels have the same"
    );
    assert_eq!(adaptive.allowed, [[0, 5000]]);
    assert!(adaptive.scout_paths > 0 && adaptive.scout_rays > adaptive.scout_paths);
    assert!(record.stopped == Some(Stop::TargetError) && !record.complete);
    let pixels = picture.pixels() as f64;
    for channel in 0..3 {
        let of_pixel =
            |pixel: usize| f64::from(picture.variance[pixel][channel] / picture.samples[pixel]);
        let variance: f64 = (0..picture.pixels()).map(of_pixel).sum();
        let stated = record.standard_error.unwrap()[channel];
        assert!(
            (variance.sqrt() / pixels / stated - 1.0).abs() < 1e-4,
            "{stated}"
        );
    }

    ran(folder, &["rerun", "a.exr", "-o", "b.exr"]);
    let again = read(folder, "b.exr");
    assert_eq!(again.mean, picture.mean);
    assert_eq!(again.variance, picture.variance);
    assert_eq!(again.samples, picture.samples);
    assert_eq!(again.record.adaptive, picture.record.adaptive);
}

/// Even sampling is there to be asked for, takes the first samples of each pixel as the other does, and `diff` finds
/// the two to be of one expectation, by other seeds, too.
#[test]
fn even_sampling_is_a_choice() {
    let stage = stage();
    let folder = stage.path();
    ran(folder, &with(&["-o", "even.exr", "--even"]));
    let even = read(folder, "even.exr");
    assert!(even.record.adaptive.is_none());
    assert!(even.samples.iter().all(|count| *count == even.samples[0]));
    ran(folder, &["rerun", "even.exr", "-o", "again.exr"]);
    let again = read(folder, "again.exr");
    assert!(again.mean == even.mean && again.samples == even.samples);
    // Its 5000 samples were not all taken this time either.
    assert!(again.record.stopped == Some(Stop::TargetError) && !again.record.complete);
    assert_eq!(again.record.target_error, Some(0.06));
    ran(folder, &with(&["-o", "a.exr", "--seed", "7"]));
    let told = ran(folder, &["diff", "even.exr", "a.exr", "--margin", "0.05"]);
    assert!(told.contains(" to ") && told.contains("samples"), "{told}");
    let told = refused(folder, &["render", "s.toml", "--even"], 2);
    assert!(told.contains("--target-error"), "{told}");
}

/// Two ranges of samples, each adaptive, add up by their counts; which samples a part could take is not forgotten.
#[test]
fn ranges_add_up() {
    let stage = stage();
    let folder = stage.path();
    for (name, range) in [("a.exr", "0..5000"), ("b.exr", "5000..10000")] {
        ran(folder, &with(&["-o", name, "--sample-range", range]));
    }
    ran(folder, &["merge", "a.exr", "b.exr", "-o", "c.exr"]);
    let [a, b, both] = ["a.exr", "b.exr", "c.exr"].map(|name| read(folder, name));
    for pixel in 0..a.pixels() {
        let (n, m) = (f64::from(a.samples[pixel]), f64::from(b.samples[pixel]));
        assert_eq!(f64::from(both.samples[pixel]), n + m);
        let mean = (n * f64::from(a.mean[pixel][1]) + m * f64::from(b.mean[pixel][1])) / (n + m);
        assert!((f64::from(both.mean[pixel][1]) - mean).abs() <= 1e-6 * mean);
    }
    let adaptive = both.record.adaptive.expect("its parts are adaptive");
    assert_eq!(adaptive.allowed, [[0, 5000], [5000, 10000]]);
    assert_eq!(both.record.target_error, Some(0.06));
    let told = refused(folder, &["rerun", "c.exr", "-o", "d.exr"], 65);
    assert!(told.contains("render its parts one by one"), "{told}");
}

/// Of a part that was sampled evenly the sum says what it took, and of two target errors neither.
#[test]
fn an_even_part_is_said_to_have_had_what_it_took() {
    let stage = stage();
    let folder = stage.path();
    ran(folder, &with(&["-o", "a.exr"]));
    let even = ["0.2", "--even", "--sample-range", "5000..10000"];
    let even = [&RENDER[..RENDER.len() - 1], &even, &["-o", "b.exr"]].concat();
    ran(folder, &even);
    ran(folder, &["merge", "a.exr", "b.exr", "-o", "c.exr"]);
    let [b, sum] = ["b.exr", "c.exr"].map(|name| read(folder, name).record);
    assert!(b.sample_range[1] < 10000 && b.stopped == Some(Stop::TargetError));
    let allowed = sum.adaptive.expect("one part is adaptive").allowed;
    assert_eq!(allowed, [[0, 5000], b.sample_range]);
    assert_eq!(sum.stopped, Some(Stop::TargetError));
    assert_eq!(sum.target_error, None);
}

/// Counts that are all alike are said once, and small numbers are short.
#[test]
fn the_line_that_is_printed_is_short() {
    let stage = stage();
    let small =
        "render s.toml --device cpu --width 16 --height 16 --spp 80 --target-error 1e-300 -o a.exr";
    let told = ran(stage.path(), &small.split(' ').collect::<Vec<_>>());
    let record = read(stage.path(), "a.exr").record;
    assert!(record.adaptive.is_some() && record.sample_range == [0, 80]);
    assert!(told.contains("16x16, 80 samples a pixel in "), "{told}");
    assert!(told.contains("--target-error 1e-300 is not"), "{told}");
}

#[test]
fn no_checkpoint_of_the_other_kind_is_gone_on_from() {
    let stage = stage();
    let folder = stage.path();
    let long = [
        "--target-error",
        "0.001",
        "--time",
        "0.5",
        "--checkpoint",
        "c",
        "-o",
        "o.exr",
    ];
    ran(folder, &[&RENDER[..RENDER.len() - 2], &long].concat());
    let told = refused(
        folder,
        &[&RENDER[..RENDER.len() - 2], &long, &["--resume", "--even"]].concat(),
        65,
    );
    assert!(
        told.contains("how the samples are shared out is shape in the checkpoint, and even now"),
        "{told}"
    );
}

#[test]
fn no_error_at_all_is_refused() {
    let stage = stage();
    for error in ["0", "-0.1", "1", "nan", "inf"] {
        let told = refused(
            stage.path(),
            &["render", "s.toml", "--target-error", error],
            2,
        );
        assert!(told.contains("above 0 and below 1"), "{told}");
    }
}

/// Samples that are not independent cannot be shared out, and both ways out are said.
#[test]
fn sequences_are_sampled_evenly() {
    let stage = stage();
    let folder = stage.path();
    let sobol = [
        "render",
        "s.toml",
        "--device",
        "cpu",
        "--width",
        "16",
        "--height",
        "16",
        "--set",
        "render.sequence=sobol",
        "--target-error",
        "0.5",
    ];
    let told = refused(folder, &sobol, 2);
    assert!(
        told.contains("add --even") && told.contains("render.sequence=independent"),
        "{told}"
    );
    ran(folder, &[&sobol[..], &["--even"]].concat());
}
