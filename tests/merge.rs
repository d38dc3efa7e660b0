//! Sums of pictures that hold different samples of one render.

#[path = "film/sample.rs"]
mod sample;

use lampray::Error;
use lampray::film::{Picture, merge, read_exr, read_record};
use sample::{Folder, device, picture, write};
use serde_json::json;
use std::path::PathBuf;
use std::process::{Command, Output};

/// Writes pictures as 0.exr, 1.exr, ...
fn write_all(folder: &Folder, pictures: &[Picture]) -> Vec<PathBuf> {
    let name = |(number, picture): (usize, &Picture)| {
        let path = folder.join(format!("{number}.exr"));
        write(picture, &path);
        path
    };
    pictures.iter().enumerate().map(name).collect()
}

fn refusal(pictures: &[Picture]) -> String {
    let folder = Folder::new();
    match merge(&write_all(&folder, pictures), false) {
        Err(error @ Error::Data { .. }) => error.to_string(),
        other => panic!("{other:?}"),
    }
}

fn assert_close(a: &[[f32; 3]], b: &[[f32; 3]]) {
    assert_eq!(a.len(), b.len());
    for (a, b) in a.as_flattened().iter().zip(b.as_flattened()) {
        assert!((a - b).abs() <= 1e-6 * b.abs(), "{a} {b}");
    }
}

/// One sample tells nothing of its noise, two do; so do two randomisations.
#[test]
fn an_error_that_is_not_known_is_null() {
    let json = |picture: &Picture| -> serde_json::Value {
        serde_json::from_str(&picture.record.to_json()).unwrap()
    };
    let parts = [picture(0..1), picture(1..2)];
    for part in &parts {
        assert_eq!(part.record.standard_error, None);
        assert!(json(part)["standard_error"].is_null());
    }
    let merged = merge(&write_all(&Folder::new(), &parts), false).unwrap();
    let whole = picture(0..2).record.standard_error.unwrap();
    let errors = merged.record.standard_error.unwrap();
    for (merged, whole) in errors.into_iter().zip(whole) {
        assert!(whole > 0.0 && (merged - whole).abs() <= 1e-6 * whole);
    }
    assert!(json(&merged)["standard_error"].is_array());
}

#[test]
fn halves_make_the_whole() {
    let folder = Folder::new();
    let halves = [picture(0..40), picture(40..64)];
    let merged = merge(&write_all(&folder, &halves), false).unwrap();
    let whole = picture(0..64);
    assert_close(&merged.mean, &whole.mean);
    assert_close(&merged.variance, &whole.variance);
    assert_eq!(merged.samples, whole.samples);
    assert_eq!(merged.features, whole.features);
    assert_eq!(merged.scene_text, whole.scene_text);
    for channel in 0..3 {
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-6 * b;
        assert!(close(
            merged.record.mean[channel],
            whole.record.mean[channel]
        ));
        assert!(close(
            merged.record.standard_error.unwrap()[channel],
            whole.record.standard_error.unwrap()[channel]
        ));
    }
    // Merging moves the variance: the plain average of the halves' is not it.
    let average = |a: f32, b: f32| (40.0 * a + 24.0 * b) / 64.0;
    let naive = average(halves[0].variance[0][0], halves[1].variance[0][0]);
    assert!((naive - whole.variance[0][0]).abs() > 1e-4 * naive);
}

#[test]
fn the_record_adds_up() {
    let folder = Folder::new();
    let mut halves = [picture(0..40), picture(40..64)];
    halves[1].record.complete = false;
    halves[1].record.non_finite = 5;
    let merged = merge(&write_all(&folder, &halves), false).unwrap().record;
    let whole = picture(0..64).record;
    assert_eq!((merged.samples, merged.sample_range), (64, [0, 64]));
    assert!(merged.sample_ranges.is_empty());
    assert_eq!(
        (merged.paths, merged.rays, merged.non_finite),
        (whole.paths, whole.rays, 5)
    );
    assert_eq!(merged.seconds.setup, 0.5);
    assert_eq!(merged.seconds.total, 1.4);
    assert!(!merged.complete);
    assert_eq!(merged.knobs["render.samples"], json!(64));
    assert!(merged.outputs.is_empty());
}

#[test]
fn gaps_are_listed_and_can_be_filled() {
    let folder = Folder::new();
    let parts = [
        picture(0..8),
        picture(16..24),
        picture(24..32),
        picture(8..16),
    ];
    let paths = write_all(&folder, &parts);
    let gappy = merge(&paths[..3], false).unwrap();
    assert_eq!(gappy.record.sample_range, [0, 32]);
    assert_eq!(gappy.record.sample_ranges, [[0, 8], [16, 32]]);
    assert_eq!(gappy.record.samples, 24);

    write(&gappy, &folder.join("gappy.exr"));
    let both = [folder.join("gappy.exr"), paths[3].clone()];
    let full = merge(&both, false).unwrap();
    assert_eq!(full.record.sample_range, [0, 32]);
    assert!(full.record.sample_ranges.is_empty());
    assert_close(&full.mean, &picture(0..32).mean);

    let twice = [folder.join("gappy.exr"), paths[1].clone()];
    assert!(matches!(merge(&twice, false), Err(Error::Data { .. })));
}

#[test]
fn the_order_of_inputs_does_not_matter() {
    let folder = Folder::new();
    let paths = write_all(&folder, &[picture(0..5), picture(5..16), picture(16..64)]);
    let mut results = Vec::new();
    for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
        let merged = merge(&order.map(|number| paths[number].clone()), false).unwrap();
        let out = folder.join("out.exr");
        write(&merged, &out);
        results.push(std::fs::read(out).unwrap());
    }
    assert_eq!(results[0], results[1]);
    assert_eq!(results[0], results[2]);
}

#[test]
fn pixels_with_single_and_with_no_samples() {
    let folder = Folder::new();
    let mut empty = picture(2..3);
    empty.samples.fill(0.0);
    empty.mean.fill([0.0; 3]);
    let paths = write_all(&folder, &[picture(0..1), picture(1..2), empty]);
    let merged = merge(&paths, false).unwrap();
    assert_close(&merged.mean, &picture(0..2).mean);
    assert_eq!(merged.samples[0], 2.0);
}

#[test]
fn overlaps_are_refused_by_name() {
    let message = refusal(&[picture(0..40), picture(39..64)]);
    assert!(
        message.contains("0..40") && message.contains("39..64"),
        "{message}"
    );
    assert!(
        message.contains("0.exr") && message.contains("1.exr"),
        "{message}"
    );
    assert!(refusal(&[picture(0..8), picture(0..8)]).contains("overlap"));
    assert!(refusal(&[picture(0..64), picture(8..9)]).contains("overlap"));
}

#[test]
fn other_renders_are_refused_by_what_differs() {
    type Change = fn(&mut Picture);
    let changes: [(&str, Change); 6] = [
        ("scene_hash", |picture| {
            picture.record.scene_hash = "other".into()
        }),
        ("shader_hash", |picture| {
            picture.record.shader_hash = "other".into()
        }),
        ("crop", |picture| picture.record.crop = Some([0, 0, 37, 21])),
        ("seed", |picture| picture.record.seed = 3),
        ("camera.fov", |picture| {
            picture
                .record
                .knobs
                .insert("camera.fov".into(), json!(45.000_000_000_000_02));
        }),
        ("light.pole", |picture| {
            picture
                .record
                .knobs
                .insert("light.pole".into(), json!("receiver"));
        }),
    ];
    for (name, change) in changes {
        let mut other = picture(8..16);
        change(&mut other);
        let message = refusal(&[picture(0..8), other]);
        assert!(message.contains(name), "{name}: {message}");
        assert!(
            message.contains("0.exr") && message.contains("1.exr"),
            "{message}"
        );
    }
}

#[test]
fn devices_are_mixed_only_on_request() {
    let folder = Folder::new();
    let mut other = picture(8..16);
    other.record.device = device("H200");
    let message = refusal(&[picture(0..8), other.clone()]);
    assert!(
        message.contains("llvmpipe") && message.contains("H200"),
        "{message}"
    );
    assert!(message.contains("--allow-mixed"), "{message}");

    let merged = merge(&write_all(&folder, &[picture(0..8), other.clone()]), true).unwrap();
    assert_eq!(merged.record.devices, [device("llvmpipe"), device("H200")]);
    assert!(refusal(&[merged, picture(16..24)]).contains("--allow-mixed"));

    // The same device in another slot is the same device.
    other.record.device = device("llvmpipe");
    other.record.device.pci = "0000:01:00.0".into();
    assert!(merge(&write_all(&folder, &[picture(0..8), other]), false).is_ok());
}

#[test]
fn layers_that_differ_are_dropped() {
    let folder = Folder::new();
    let mut other = picture(8..16);
    other.features.as_mut().unwrap().depth.as_mut().unwrap()[3] += 1.0;
    let merged = merge(&write_all(&folder, &[picture(0..8), other]), false).unwrap();
    let features = merged.features.unwrap();
    assert!(features.depth.is_none());
    assert!(features.normal.is_some() && features.albedo.is_some() && features.id.is_some());
}

#[test]
fn pixels_that_are_not_finite_are_refused() {
    let mut other = picture(8..16);
    other.mean[5][1] = f32::NAN;
    assert!(refusal(&[picture(0..8), other]).contains("1.exr"));
}

fn lampray(folder: &Folder, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lampray"));
    command
        .current_dir(folder.path())
        .arg("merge")
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn the_command_merges_and_says_so() {
    let folder = Folder::new();
    write_all(&folder, &[picture(0..8), picture(8..16)]);
    let output = lampray(
        &folder,
        &["1.exr", "0.exr", "-o", "sum.exr", "-o", "sum.png", "--json"],
    );
    assert!(output.status.success());
    assert_eq!(String::from_utf8(output.stderr).unwrap().lines().count(), 1);
    let record: lampray::film::Record = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(record.outputs, ["sum.exr", "sum.png"]);
    assert_eq!(read_exr(folder.join("sum.exr")).unwrap().record, record);
    assert_eq!(read_record(folder.join("sum.png")).unwrap().0, record);

    let quiet = lampray(&folder, &["0.exr", "1.exr", "-o", "sum.exr", "-q"]);
    assert!(quiet.status.success() && quiet.stdout.is_empty() && quiet.stderr.is_empty());
}

#[test]
fn exit_codes() {
    let folder = Folder::new();
    write_all(&folder, &[picture(0..8), picture(8..16), picture(4..12)]);
    let cases: [(&[&str], i32); 7] = [
        (&["0.exr", "-o", "sum.exr"], 2),
        (&["0.exr", "1.exr"], 2),
        (&["0.exr", "1.exr", "-o", "sum.jpg"], 2),
        (&["0.exr", "1.exr", "-o", "sum.exr", "-o", "./sum.exr"], 2),
        (&["0.exr", "2.exr", "-o", "sum.exr"], 65),
        (&["0.exr", "9.exr", "-o", "sum.exr"], 66),
        (&["0.exr", "1.exr", "-o", "missing/sum.exr"], 73),
    ];
    for (arguments, code) in cases {
        let output = lampray(&folder, arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        assert!(!output.stderr.is_empty() && output.stdout.is_empty());
    }
    assert_eq!(folder.names(), ["0.exr", "1.exr", "2.exr"]);
    let help = lampray(&folder, &["--help"]).stdout;
    assert!(String::from_utf8(help).unwrap().contains("Example:"));
}

/// A limit on the size of files stands in for a full disk; the signal that comes with it is
/// ignored, so that writing fails as it does there.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_the_old_file() {
    let folder = Folder::new();
    write_all(&folder, &[picture(0..8), picture(8..16)]);
    for name in ["sum.exr", "sum.png"] {
        std::fs::write(folder.join(name), "old").unwrap();
        let script = "trap '' XFSZ; ulimit -f 1; exec \"$0\" merge 0.exr 1.exr -o \"$1\"";
        let output = Command::new("sh")
            .args(["-c", script, env!("CARGO_BIN_EXE_lampray"), name])
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(74), "{output:?}");
        assert_eq!(std::fs::read(folder.join(name)).unwrap(), b"old");
    }
    assert_eq!(folder.names(), ["0.exr", "1.exr", "sum.exr", "sum.png"]);
}
