//! Devices that are lost, and those that are not there.

use super::stage::{ENDLESS, GRAPHICS, KEPT, LONG, RESUMED, SAVED, SHORT, Stage};
use super::table::Left::{Checkpoint, Old, Part, Same, Whole};
use super::table::{Row, hold};
use lampray::gpu::adapters;
use serde_json::Value;
use std::fs;
use std::process::Output;

/// Names the blocks after which a device is destroyed.
const LOSE: &str = "LAMPRAY_TEST_LOSE_DEVICE";
/// No driver answers.
const NO_DRIVERS: &[(&str, &str)] = &[
    ("VK_DRIVER_FILES", "/nonexistent.json"),
    ("VK_ICD_FILENAMES", "/nonexistent.json"),
];

const LOST: &[Row] = &[
    Row {
        done: "the device is lost once",
        act: |at| at.run_with(&[(LOSE, "5")], &[LONG, GRAPHICS]),
        exit: 0,
        left: &[Same("o.exr")],
        says: "going on with it opened anew",
    },
    Row {
        done: "it is lost, and its successor at once; `--device` names it",
        act: |at| {
            at.old("o.exr").run_with(
                &[(LOSE, "20,0")],
                &[ENDLESS, GRAPHICS, SAVED, &["--time", "60"]],
            )
        },
        exit: 75,
        left: &[Part("o.exr"), Checkpoint("c")],
        says: "--resume goes on from",
    },
    Row {
        done: "the same, and then `--resume`",
        act: |at| {
            let lost = at.run_with(&[(LOSE, "5,0")], &[LONG, GRAPHICS, SAVED]);
            assert_eq!(lost.status.code(), Some(75), "{lost:?}");
            at.run(&[LONG, GRAPHICS, RESUMED])
        },
        exit: 0,
        left: &[Same("o.exr")],
        says: "",
    },
    Row {
        done: "it and its successor are lost before they have done anything",
        act: |at| {
            at.old("o.exr")
                .run_with(&[(LOSE, "0,0")], &[LONG, GRAPHICS, KEPT])
        },
        exit: 75,
        left: &[Old("o.exr")],
        says: "was lost",
    },
    Row {
        done: "lost twice under `--device auto`: the CPU twin goes on, and the record names both",
        act: |at| {
            let output = at.run_with(&[(LOSE, "5,0")], &[LONG, &["--json"]]);
            assert_eq!(kinds(&output).len(), 2, "{output:?}");
            assert_eq!(kinds(&output)[1], "cpu");
            output
        },
        exit: 0,
        left: &[Whole("o.exr")],
        says: "rendering with the built-in CPU renderer",
    },
    Row {
        done: "lost at once under `--device auto`",
        act: |at| at.run_with(&[(LOSE, "0,0")], &[LONG]),
        exit: 0,
        left: &[Whole("o.exr")],
        says: "rendering with the built-in CPU renderer",
    },
    Row {
        done: "a checkpoint of the device is resumed by `--device cpu`",
        act: |at| {
            at.stopped(&[ENDLESS, GRAPHICS, KEPT])
                .run(&[ENDLESS, &["--device", "cpu"], RESUMED])
        },
        exit: 65,
        left: &[Part("o.exr"), Checkpoint("c"), Checkpoint("c.previous")],
        says: "the device is",
    },
    Row {
        done: "a device that `lampray devices` lists is gone when a render asks for it by name",
        act: |at| {
            let name = adapters().infos().next().map(|info| info.name.clone());
            let name = name.expect("a graphics device");
            at.old("o.exr")
                .run_with(NO_DRIVERS, &[SHORT, &["--device", &name]])
        },
        exit: 69,
        left: &[Old("o.exr")],
        says: "in its name",
    },
    Row {
        done: "`LP_NUM_THREADS=0`",
        act: |at| at.run_with(&[("LP_NUM_THREADS", "0")], &[LONG, GRAPHICS]),
        exit: 0,
        left: &[Same("o.exr")],
        says: "",
    },
    Row {
        done: "`HOME` is read-only, and so drivers cannot keep what they compiled",
        act: |at| {
            at.run_with(
                &[("HOME", "/proc"), ("XDG_CACHE_HOME", "/proc")],
                &[LONG, GRAPHICS],
            )
        },
        exit: 0,
        left: &[Same("o.exr")],
        says: "",
    },
    Row {
        done: "there is no `HOME`",
        act: |at| {
            let mut command = at.command(&[LONG, GRAPHICS]);
            let command = command.env_remove("HOME").env_remove("XDG_CACHE_HOME");
            command.output().expect("the program runs")
        },
        exit: 0,
        left: &[Same("o.exr")],
        says: "",
    },
];

const MISSING: &[Row] = &[
    Row {
        done: "no graphics device",
        act: |at| at.run_with(NO_DRIVERS, &[SHORT]),
        exit: 0,
        left: &[Whole("o.exr")],
        says: "no Vulkan device: rendering with the built-in CPU renderer",
    },
    Row {
        done: "no graphics device, and `--require software`",
        act: |at| {
            at.old("o.exr")
                .run_with(NO_DRIVERS, &[SHORT, &["--require", "software"]])
        },
        exit: 69,
        left: &[Old("o.exr")],
        says: "there is no software Vulkan device",
    },
    Row {
        done: "no graphics device, and `--require hardware`",
        act: |at| {
            at.old("o.exr")
                .run_with(NO_DRIVERS, &[SHORT, &["--require", "hardware"]])
        },
        exit: 69,
        left: &[Old("o.exr")],
        says: "there is no hardware Vulkan device",
    },
    Row {
        done: "`--device 99`",
        act: |at| at.old("o.exr").run(&[SHORT, &["--device", "99"]]),
        exit: 69,
        left: &[Old("o.exr")],
        says: "there is no device 99",
    },
    Row {
        done: "the driver's file is no JSON",
        act: |at| run_with_driver(at, "garbage", &[]),
        exit: 0,
        left: &[Whole("o.exr")],
        says: "built-in CPU renderer",
    },
    Row {
        done: "it names a library that is not there",
        act: |at| run_with_driver(at, &driver("/no/such/library.so"), &[]),
        exit: 0,
        left: &[Whole("o.exr")],
        says: "built-in CPU renderer",
    },
    Row {
        done: "it names a library that is no driver",
        act: |at| run_with_driver(at, &driver("libm.so.6"), &[]),
        exit: 0,
        left: &[Whole("o.exr")],
        says: "built-in CPU renderer",
    },
    Row {
        done: "the same, and `--device software`",
        act: |at| {
            run_with_driver(
                at.old("o.exr"),
                &driver("libm.so.6"),
                &["--device", "software"],
            )
        },
        exit: 69,
        left: &[Old("o.exr")],
        says: "there is no software Vulkan device",
    },
];

/// A driver's file, as the Vulkan loader reads them.
fn driver(library: &str) -> String {
    let icd = serde_json::json!({ "library_path": library, "api_version": "1.3.0" });
    serde_json::json!({ "file_format_version": "1.0.0", "ICD": icd }).to_string()
}

fn run_with_driver(at: &Stage, text: &str, more: &[&str]) -> Output {
    let file = tempfile::NamedTempFile::with_suffix(".json").expect("a file");
    fs::write(file.path(), text).expect("the driver's file");
    let name = file.path().to_str().expect("a plain name");
    let variables = [("VK_DRIVER_FILES", name), ("VK_ICD_FILENAMES", name)];
    at.run_with(&variables, &[SHORT, more])
}

/// The kinds of the devices in the record on stdout.
fn kinds(output: &Output) -> Vec<String> {
    let record: Value = serde_json::from_slice(&output.stdout).expect("a record");
    let devices = record["devices"].as_array().cloned().unwrap_or_default();
    let kind = |device: &Value| device["kind"].as_str().unwrap_or_default().to_string();
    devices.iter().map(kind).collect()
}

#[test]
fn devices_are_lost() {
    // Says so where there is none, and fails where there has to be one.
    if crate::support::gpu("devices that are lost").is_some() {
        hold("Devices that are lost", LOST);
    }
}

#[test]
fn devices_are_missing() {
    hold("Devices that are not there", MISSING);
}
