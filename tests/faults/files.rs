//! Outputs that cannot be created, or are there already.

use super::stage::{CPU, LONG, SAVED, SHORT, Stage};
use super::table::Left::{Else, Old, Same, Whole};
use super::table::{Row, hold};
use lampray::film::read_exr;
use std::ffi::OsStr;
use std::fs::{self, Permissions};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Output;

const PLACES: &[Row] = &[
    Row {
        done: "a folder in which nobody creates files (`/proc`)",
        act: |at| at.run(&[SHORT, CPU, &["-o", "/proc/lampray.exr"]]),
        exit: 73,
        left: &[],
        says: "cannot create /proc/lampray.exr",
    },
    Row {
        done: "a read-only folder",
        act: |at| {
            fs::create_dir(at.join("locked")).expect("a folder");
            set_mode(&at.join("locked"), 0o555);
            at.run_as_anybody(&[&SHORT[..2], CPU, &["-o", "locked/o.exr"]])
        },
        exit: 73,
        left: &[Else("locked", "the folder, empty")],
        says: "Permission denied",
    },
    Row {
        done: "a read-only file",
        act: |at| {
            set_mode(&at.old("o.exr").join("o.exr"), 0o444);
            at.run_as_anybody(&[SHORT, CPU])
        },
        exit: 73,
        left: &[Old("o.exr")],
        says: "Permission denied",
    },
    Row {
        done: "a missing folder",
        act: |at| at.run(&[SHORT, CPU, &["-o", "no/such/o.exr"]]),
        exit: 73,
        left: &[],
        says: "cannot create no/such/o.exr",
    },
    Row {
        done: "the output is a folder",
        act: |at| {
            fs::create_dir(at.join("o.exr")).expect("a folder");
            at.run(&[SHORT, CPU])
        },
        exit: 73,
        left: &[Else("o.exr", "the folder")],
        says: "cannot create o.exr",
    },
    Row {
        done: "the output exists, readable for its group",
        act: |at| {
            set_mode(&at.old("o.exr").join("o.exr"), 0o640);
            let output = at.run(&[LONG, CPU]);
            assert_eq!(mode(&at.join("o.exr")), 0o640);
            output
        },
        exit: 0,
        left: &[Same("o.exr")],
        says: "",
    },
    Row {
        done: "`umask 027`",
        act: |at| {
            let output = at.run_limited("umask 027", &[SHORT, CPU, SAVED]);
            assert_eq!(mode(&at.join("o.exr")), 0o640);
            output
        },
        exit: 0,
        left: &[Whole("o.exr")],
        says: "",
    },
    Row {
        done: "the output is a link to a file in another folder",
        act: |at| through_link(at, Some("old")),
        exit: 0,
        left: &[
            Else("o.exr", "the link"),
            Else("sub", "in it the whole picture, where the link leads"),
        ],
        says: "",
    },
    Row {
        done: "a link that leads to no file yet",
        act: |at| through_link(at, None),
        exit: 0,
        left: &[
            Else("o.exr", "the link"),
            Else("sub", "in it the whole picture, where the link leads"),
        ],
        says: "",
    },
    Row {
        done: "a name with the end of a line, and one that is no UTF-8",
        act: |at| {
            let names = [&b"a\nb.exr"[..], b"\xff\xfe.exr"].map(OsStr::from_bytes);
            let mut command = at.command(&[&SHORT[..2], CPU]);
            let output = command
                .arg("-o")
                .arg(names[0])
                .arg("-o")
                .arg(names[1])
                .output();
            fs::rename(at.join(names[0]), at.join("line.exr")).expect("its picture");
            fs::rename(at.join(names[1]), at.join("bytes.exr")).expect("its picture");
            output.expect("the program runs")
        },
        exit: 0,
        left: &[Whole("line.exr"), Whole("bytes.exr")],
        says: "",
    },
    Row {
        done: "two processes write one file, ten times",
        act: two_write_one,
        exit: 0,
        left: &[Else("o.exr", "the whole picture of one of them")],
        says: "",
    },
];

fn mode(path: &Path) -> u32 {
    fs::metadata(path).expect("a file").permissions().mode() & 0o777
}

fn set_mode(path: &Path, mode: u32) {
    fs::set_permissions(path, Permissions::from_mode(mode)).expect("its mode");
}

/// Renders to a link that leads to a file in another folder.
fn through_link(at: &Stage, old: Option<&str>) -> Output {
    fs::create_dir(at.join("sub")).expect("a folder");
    if let Some(old) = old {
        fs::write(at.join("sub/file"), old).expect("an old file");
    }
    symlink("sub/file", at.join("o.exr")).expect("a link");
    let output = at.run(&[SHORT, CPU]);
    assert!(at.join("o.exr").is_symlink());
    assert!(read_exr(at.join("sub/file")).is_ok_and(|picture| picture.record.complete));
    assert_eq!(fs::read_dir(at.join("sub")).expect("a folder").count(), 1);
    output
}

fn two_write_one(at: &Stage) -> Output {
    let of = |seed| Stage::elsewhere(&[SHORT, CPU, &["--no-times", "--seed", seed]]);
    let either = [of("1"), of("2")];
    assert!(either[0] != either[1]);
    let mut last = None;
    for _ in 0..10 {
        let start = |seed| at.start(&[SHORT, CPU, &["--no-times", "--seed", seed]]);
        for child in [start("1"), start("2")] {
            let output = child.end();
            assert!(output.status.success(), "{output:?}");
            last = Some(output);
        }
        assert!(either.contains(&at.read("o.exr")), "a picture of neither");
    }
    last.expect("ten rounds")
}

#[test]
fn places_are_as_they_are() {
    hold("Places", PLACES);
}
