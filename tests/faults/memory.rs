//! Too little memory. A limit of addresses stages it, which any user may set.

use super::stage::{CPU, ENDLESS, SHORT, Stage};
use super::table::Left::{Else, Old, Whole};
use super::table::{Row, hold};
use std::fs;
use std::process::Output;

const ROWS: &[Row] = &[
    Row {
        done: "32768 x 8192 pixels with layers take 40 GiB, and there are 8 (`ulimit -v`)",
        act: |at| {
            let size = [
                "--width",
                "32768",
                "--height",
                "8192",
                "--aov",
                "normal,depth,albedo,id",
            ];
            at.old("o.exr")
                .run_limited("ulimit -v 8388608", &[SHORT, CPU, &size])
        },
        exit: 65,
        left: &[Old("o.exr")],
        says: "take about 39.8 GiB of memory, and the limit of this process (ulimit -v) is 8.0 GiB",
    },
    Row {
        done: "a megapixel in 400 MiB of addresses",
        act: |at| {
            at.old("o.exr")
                .run_limited("ulimit -v 409600", &[SHORT, CPU, MEGAPIXEL])
        },
        exit: 65,
        left: &[Old("o.exr")],
        says: "of memory, and the limit of this process",
    },
    Row {
        done: "a megapixel in just as much as it is said to take",
        act: |at| at.run_limited("ulimit -v 630000", &[SHORT, CPU, MEGAPIXEL]),
        exit: 0,
        left: &[Whole("o.exr")],
        says: "",
    },
    Row {
        done: "too few addresses for a graphics driver",
        act: |at| at.run_limited("ulimit -v 600000", &[SHORT]),
        exit: 0,
        left: &[Whole("o.exr")],
        says: "rendering with the built-in CPU renderer",
    },
    Row {
        done: "the same, and `--device software`",
        act: |at| {
            at.old("o.exr")
                .run_limited("ulimit -v 600000", &[SHORT, &["--device", "software"]])
        },
        exit: 69,
        left: &[Old("o.exr")],
        says: "graphics drivers may need",
    },
    Row {
        done: "a checkpoint of 100 KB that announces 14 GiB, in 400 MiB of addresses",
        act: resume_a_bomb,
        exit: 65,
        left: &[Old("o.exr"), Else("c", "the checkpoint as it was")],
        says: "the checkpoint is damaged: it is cut short",
    },
];

const MEGAPIXEL: &[&str] = &["--width", "1024", "--height", "1024"];

/// A checkpoint whose head says that it is of a larger picture than it holds.
fn resume_a_bomb(at: &Stage) -> Output {
    let stopped = at.run(&[ENDLESS, CPU, &["--checkpoint", "c", "--time", "1"]]);
    assert!(stopped.status.success(), "{stopped:?}");
    let bytes = at.read("c");
    let length = u64::from_le_bytes(bytes[8..16].try_into().expect("eight bytes")) as usize;
    let head = String::from_utf8(bytes[16..16 + length].to_vec()).expect("a head");
    let larger = head.replace("\"region\":[0,0,24,16]", "\"region\":[0,0,32768,8192]");
    assert_ne!(head, larger);
    let length = (larger.len() as u64).to_le_bytes();
    let filled = vec![0; 100_000];
    let bomb = [&bytes[..8], &length, larger.as_bytes(), &filled].concat();
    fs::write(at.join("c"), &bomb).expect("a bomb");
    let resumed = ["--checkpoint", "c", "--resume"];
    let output = at
        .old("o.exr")
        .run_limited("ulimit -v 409600", &[SHORT, CPU, &resumed]);
    assert!(at.read("c") == bomb, "the checkpoint was touched");
    output
}

#[test]
fn memory_is_short() {
    hold("Too little memory", ROWS);
}

/// Between far too little and enough there is no limit at which the program dies of a signal.
#[test]
fn no_limit_of_addresses_ends_the_program_unheard() {
    let stage = Stage::new();
    for mebibytes in (60..1400).step_by(67) {
        let limit = format!("ulimit -v {}", mebibytes * 1024);
        for device in ["cpu", "software", "auto"] {
            let output = stage.run_limited(&limit, &[SHORT, &["--device", device]]);
            let code = output.status.code();
            let known = matches!(code, Some(0 | 65 | 69));
            assert!(known, "{mebibytes} MiB, {device}: {output:?}");
        }
    }
}
