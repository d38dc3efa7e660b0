//! Outputs that cannot be written, or must not be replaced.

use super::stage::{CPU, LONG, SHORT, Stage, fifo, words};
use super::table::Left::{Checkpoint, Else, Old, Same, Whole};
use super::table::{Row, hold};
use lampray::film::read_exr;
use std::ffi::OsStr;
use std::fs::{self, File, Permissions};
use std::io::Write;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
use std::path::Path;
use std::process::{Output, Stdio};

/// Large enough for a limit of 4 KiB.
const LARGE: &[&str] = &["--width", "100", "--height", "100"];
const SAVED: &[&str] = &["--checkpoint", "c"];

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
    let users = match super::stage::is_root() {
        true => "",
        false => "--user --map-root-user",
    };
    let command = command.env("USERS", users).env("INNER", inner);
    command.output().expect("sh runs")
}

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

const STREAMS: &[Row] = &[
    Row {
        done: "the output is `/dev/null`",
        act: |at| {
            let output = at.run(&[&SHORT[..2], CPU, &["-o", "/dev/null"]]);
            let kind = fs::metadata("/dev/null").expect("a device").file_type();
            assert!(kind.is_char_device());
            output
        },
        exit: 0,
        left: &[],
        says: "",
    },
    Row {
        done: "the output is `/dev/stdout`, a pipe",
        act: |at| {
            let output = at.run(&[&SHORT[..2], CPU, &["-o", "/dev/stdout"]]);
            assert!(output.stdout.starts_with(b"\x89PNG"), "{output:?}");
            output
        },
        exit: 0,
        left: &[],
        says: "",
    },
    Row {
        done: "the output is `/dev/stdout`, the end of a file",
        act: |at| {
            let file = File::options()
                .append(true)
                .create(true)
                .open(at.join("log"));
            let mut file = file.expect("a file");
            file.write_all(b"old").expect("a line");
            let mut command = at.command(&[&SHORT[..2], CPU, &["-o", "/dev/stdout"]]);
            let output = command.stdout(file).stderr(Stdio::piped()).output();
            assert!(at.read("log").starts_with(b"old\x89PNG"));
            output.expect("the program runs")
        },
        exit: 0,
        left: &[Else("log", "the file, the picture behind what it held")],
        says: "",
    },
    Row {
        done: "the output is a FIFO",
        act: |at| {
            fifo(&at.join("o.exr"));
            let path = at.join("o.exr");
            let reader = std::thread::spawn(move || fs::read(path));
            let output = at.run(&[SHORT, CPU]);
            let read = reader.join().expect("a reader").expect("a pipe");
            assert!(
                fs::metadata(at.join("o.exr"))
                    .expect("a pipe")
                    .file_type()
                    .is_fifo()
            );
            fs::write(at.join("read.exr"), read).expect("what was read");
            output
        },
        exit: 0,
        left: &[Else("o.exr", "the FIFO"), Whole("read.exr")],
        says: "",
    },
    Row {
        done: "SIGHUP while the output is `/dev/stdout`: its reader gets one picture",
        act: |at| {
            let file = File::create(at.join("log")).expect("a file");
            let parts: &[&[&str]] = &[
                &["render", "s.toml", "--spp", "8000"],
                CPU,
                &["-o", "/dev/stdout", "-o", "o.exr"],
            ];
            let mut command = at.command(parts);
            let child = super::stage::Running::start(command.stdout(file));
            std::thread::sleep(std::time::Duration::from_millis(300));
            super::stage::send("HUP", &child);
            at.wait_for("o.exr");
            let output = child.end();
            let pictures = at
                .read("log")
                .windows(8)
                .filter(|b| *b == b"\x89PNG\r\n\x1a\n")
                .count();
            assert_eq!(pictures, 1);
            output
        },
        exit: 0,
        left: &[Else("log", "one picture"), Whole("o.exr")],
        says: "going on",
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

#[test]
fn places_are_as_they_are() {
    hold("Places", PLACES);
}

#[test]
fn streams_are_written_into() {
    hold("Devices and pipes as outputs", STREAMS);
}
