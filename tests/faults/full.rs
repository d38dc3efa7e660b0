//! Disks that are full.

use super::stage::{CPU, LONG, SAVED, SHORT, Stage, is_root, words};
use super::table::Left::{Checkpoint, Else, Old, Same, Whole};
use super::table::{Row, hold};
use std::fs::{self, File};
use std::io::Write;
use std::os::unix::fs::symlink;
use std::process::Output;

/// Large enough for a limit of 4 KiB.
const LARGE: &[&str] = &["--width", "100", "--height", "100"];

const FULL: &[Row] = &[
    Row {
        done: "no file may grow beyond 4 KiB (`ulimit -f`)",
        act: |at| {
            at.old("o.exr")
                .run_limited("ulimit -f 8", &[SHORT, CPU, LARGE])
        },
        exit: 74,
        left: &[Old("o.exr")],
        says: "the file that was there before, if any, is untouched",
    },
    Row {
        done: "the disk is full (`/dev/full`), the checkpoint is elsewhere",
        act: |at| {
            symlink("/dev/full", at.join("full.exr")).expect("a link");
            at.run(&[LONG, CPU, SAVED, &["-o", "full.exr"]])
        },
        exit: 74,
        // The other output is written all the same.
        left: &[
            Whole("o.exr"),
            Checkpoint("c"),
            Else("full.exr", "the link to the device"),
        ],
        says: "No space left on device",
    },
    Row {
        done: "then `--resume` with room for the picture",
        act: |at| {
            symlink("/dev/full", at.join("o.exr")).expect("a link");
            let full = at.run(&[LONG, CPU, SAVED]);
            assert_eq!(full.status.code(), Some(74), "{full:?}");
            fs::remove_file(at.join("o.exr")).expect("the link");
            at.run(&[LONG, CPU, SAVED, &["--resume"]])
        },
        exit: 0,
        left: &[Same("o.exr")],
        says: "",
    },
    Row {
        done: "standard output is full and wanted the record",
        act: |at| {
            let full = File::options()
                .write(true)
                .open("/dev/full")
                .expect("a device");
            let mut command = at.command(&[SHORT, CPU, &["--json"]]);
            command.stdout(full).output().expect("the program runs")
        },
        exit: 74,
        left: &[Whole("o.exr")],
        says: "cannot write to standard output",
    },
];

/// A file system of its own, which only some machines let a test mount.
const TMPFS: &[Row] = &[Row {
    done: "the picture's file system is full, the checkpoint is on another",
    act: |at| {
        let output = in_tmpfs(
            at,
            "lampray render s.toml --device cpu --spp 64 --width 200 --height 200 \
             -o full/o.exr --checkpoint c; code=$?; [ \"$(cat full/o.exr)\" = old ] || exit 1; \
             [ \"$(ls -A full)\" = o.exr ] || exit 2; exit $code",
        );
        assert!(
            words(&output).contains("--resume goes on from"),
            "{output:?}"
        );
        output
    },
    exit: 74,
    left: &[
        Checkpoint("c"),
        Else("full", "in it the old picture and nothing else"),
    ],
    says: "No space left on device",
}];

/// Runs a script with a file system of 64 KiB at `full`, an old picture on it.
fn in_tmpfs(at: &Stage, script: &str) -> Output {
    fs::create_dir_all(at.join("full")).expect("a folder");
    let mount = format!(
        "mount -t tmpfs -o size=64k tmpfs full || exit 99; printf old >full/o.exr; {script}"
    );
    // The name of the function is not known to the shell inside.
    let inner = format!("lampray() {{ \"$LAMPRAY\" \"$@\"; }}; {mount}");
    let mut command = at.script("exec unshare --mount $USERS sh -c \"$INNER\"");
    let users = match is_root() {
        true => "",
        false => "--user --map-root-user",
    };
    let command = command.env("USERS", users).env("INNER", inner);
    command.output().expect("sh runs")
}

#[test]
fn disks_are_full() {
    hold("Full disks", FULL);
    let stage = Stage::new();
    let trial = in_tmpfs(&stage, "exit 0");
    if trial.status.success() {
        hold("A full file system of its own", TMPFS);
    } else {
        let words = words(&trial);
        let line = format!("NOT RUN: a full tmpfs, which this machine mounts for no test: {words}");
        let _ = writeln!(std::io::stderr(), "{line}");
    }
}
