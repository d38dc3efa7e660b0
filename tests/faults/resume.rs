//! Checkpoints that are damaged, of another render, or in the way.

use super::stage::{CPU, ENDLESS, KEPT, LONG, RESUMED, SHORT, Stage, fifo};
use super::table::Left::{Checkpoint, Else, Old, Part, Same};
use super::table::{Left, Row, hold};
use std::fs;
use std::os::unix::fs::symlink;
use std::process::Output;

/// What a render leaves that was stopped.
const STOPPED: &[Left] = &[Part("o.exr"), Checkpoint("c"), Checkpoint("c.previous")];
const DAMAGED: &[Left] = &[
    Part("o.exr"),
    Else("c", "the damaged checkpoint"),
    Else("c.previous", "the damaged checkpoint before"),
];

/// Stops a render, and asks to go on with another.
fn resume_other(at: &Stage, more: &[&str]) -> Output {
    at.stopped(&[LONG, CPU, KEPT])
        .run(&[LONG, CPU, RESUMED, more])
}

const OTHERS: &[Row] = &[
    Row {
        done: "`--resume` with another seed",
        act: |at| resume_other(at, &["--seed", "1"]),
        exit: 65,
        left: STOPPED,
        says: "c: seed is 0 in the checkpoint, and 1 now",
    },
    Row {
        done: "with a scene that has changed",
        act: |at| {
            at.stopped(&[LONG, CPU, KEPT]).change_scene();
            at.run(&[LONG, CPU, RESUMED])
        },
        exit: 65,
        left: STOPPED,
        says: "c: scene_hash is",
    },
    Row {
        done: "with another knob",
        act: |at| resume_other(at, &["--set", "materials.white.albedo=[0.5, 0.5, 0.5]"]),
        exit: 65,
        left: STOPPED,
        says: "c: materials.white.albedo is [0.7,0.7,0.7] in the checkpoint",
    },
    Row {
        done: "with another target error",
        act: |at| resume_other(at, &["--target-error", "0.5"]),
        exit: 65,
        left: STOPPED,
        says: "c: the target error is none in the checkpoint, and 0.5 now",
    },
    Row {
        done: "with another size",
        act: |at| resume_other(at, &["--width", "25"]),
        exit: 65,
        left: STOPPED,
        says: "c: width is 24 in the checkpoint, and 25 now",
    },
    Row {
        done: "with a crop of the same size",
        act: |at| {
            let crop = ["--width", "30", "--crop", "0,0,24,16"];
            at.stopped(&[LONG, CPU, KEPT, &crop]);
            at.run(&[
                LONG,
                CPU,
                RESUMED,
                &["--width", "30", "--crop", "6,0,30,16"],
            ])
        },
        exit: 65,
        left: STOPPED,
        says: "c: crop is Some([0, 0, 24, 16]) in the checkpoint",
    },
    Row {
        done: "with another number of samples",
        act: |at| {
            resume_other(
                at,
                &["--set", "render.clamp=off", "--sample-range", "0..9001"],
            )
        },
        exit: 65,
        left: STOPPED,
        says: "c: the range of samples is 0..12000 in the checkpoint, and 0..9001 now",
    },
    Row {
        done: "with other samples (`-s`)",
        act: |at| {
            let long = [&LONG[..LONG.len() - 1], &["9001"]].concat();
            at.stopped(&[LONG, CPU, KEPT]).run(&[&long, CPU, RESUMED])
        },
        exit: 65,
        left: STOPPED,
        says: "c: render.samples is 12000 in the checkpoint, and 9001 now",
    },
];

const DAMAGES: &[Row] = &[
    Row {
        done: "the checkpoint is cut short",
        act: |at| {
            at.stopped(&[LONG, CPU, KEPT]).cut_in_half("c");
            at.run(&[LONG, CPU, RESUMED])
        },
        exit: 0,
        left: &[Same("o.exr")],
        says: "cut short; going on from c.previous",
    },
    Row {
        done: "a bit of it is another",
        act: |at| {
            at.stopped(&[LONG, CPU, KEPT]).flip_bit("c");
            at.run(&[LONG, CPU, RESUMED])
        },
        exit: 0,
        left: &[Same("o.exr")],
        says: "the checkpoint is damaged: ",
    },
    Row {
        done: "it is gone, and the one before is there",
        act: |at| {
            fs::remove_file(at.stopped(&[LONG, CPU, KEPT]).join("c")).expect("it is there");
            at.run(&[LONG, CPU, RESUMED])
        },
        exit: 0,
        left: &[Same("o.exr")],
        says: "going on from c.previous",
    },
    Row {
        done: "a bit of both is another",
        act: |at| {
            at.stopped(&[LONG, CPU, KEPT]).flip_bit("c");
            at.flip_bit("c.previous");
            at.run(&[LONG, CPU, RESUMED])
        },
        exit: 65,
        left: DAMAGED,
        says: "c: the checkpoint is damaged: ",
    },
    Row {
        done: "both are empty",
        act: |at| {
            at.stopped(&[LONG, CPU, KEPT]);
            for name in ["c", "c.previous"] {
                fs::write(at.join(name), "").expect("an empty file");
            }
            at.run(&[LONG, CPU, RESUMED])
        },
        exit: 65,
        left: DAMAGED,
        says: "c: not a checkpoint",
    },
];

const IN_THE_WAY: &[Row] = &[
    Row {
        done: "a checkpoint is there, and `--resume` is not given",
        act: |at| {
            let before = at.stopped(&[LONG, CPU, KEPT]).read("c");
            let output = at.run(&[LONG, CPU, KEPT]);
            assert!(at.read("c") == before, "the checkpoint was touched");
            output
        },
        exit: 73,
        left: STOPPED,
        says: "add --resume to go on from it",
    },
    Row {
        done: "only the one before is there, and `--resume` is not given",
        act: |at| {
            fs::remove_file(at.stopped(&[LONG, CPU, KEPT]).join("c")).expect("it is there");
            at.run(&[LONG, CPU, KEPT])
        },
        exit: 73,
        left: &[Part("o.exr"), Checkpoint("c.previous")],
        says: "add --resume to go on from it",
    },
    Row {
        done: "`--resume` without a checkpoint",
        act: |at| at.run(&[LONG, CPU, RESUMED]),
        exit: 0,
        left: &[Same("o.exr")],
        says: "no checkpoint at c: beginning anew",
    },
    Row {
        done: "`--checkpoint` names a folder",
        act: |at| {
            fs::create_dir(at.old("o.exr").join("c")).expect("a folder");
            at.run(&[SHORT, CPU, RESUMED])
        },
        exit: 73,
        left: &[Old("o.exr"), Else("c", "the folder")],
        says: "cannot create c",
    },
    Row {
        done: "`--checkpoint` names a file in a missing folder",
        act: |at| {
            at.old("o.exr")
                .run(&[SHORT, CPU, &["--checkpoint", "no/c"]])
        },
        exit: 73,
        left: &[Old("o.exr")],
        says: "cannot create no/c",
    },
    Row {
        done: "`--checkpoint` names a FIFO",
        act: |at| {
            fifo(&at.old("o.exr").join("c"));
            let output = at.run(&[SHORT, CPU, KEPT]);
            assert_eq!(output.status.code(), Some(2), "{output:?}");
            at.run(&[SHORT, CPU, RESUMED])
        },
        exit: 2,
        left: &[Old("o.exr"), Else("c", "the FIFO")],
        says: "a checkpoint must be a file",
    },
    Row {
        done: "`--checkpoint` names the output",
        act: |at| {
            at.old("o.exr")
                .run(&[SHORT, CPU, &["--checkpoint", "./o.exr"]])
        },
        exit: 2,
        left: &[Old("o.exr")],
        says: "the picture would be written there, too",
    },
    Row {
        done: "`--resume` from a checkpoint that another render is writing",
        act: |at| {
            let other = at.start(&[LONG, CPU, KEPT]);
            at.wait_for_checkpoints(&other);
            let output = at.run(&[LONG, CPU, RESUMED]);
            super::stage::send("TERM", &other);
            assert_eq!(other.end().status.code(), Some(143));
            output
        },
        exit: 73,
        left: STOPPED,
        says: "another render is writing it",
    },
    Row {
        done: "a second render with the checkpoint of one that has saved nothing yet",
        act: |at| {
            let other = at.start(&[ENDLESS, CPU, &["--checkpoint", "c"]]);
            at.wait_for("c");
            // It is locked a moment after it is there; nobody can look whether it is without locking it.
            std::thread::sleep(std::time::Duration::from_millis(500));
            let output = at.run(&[LONG, CPU, RESUMED]);
            super::stage::send("KILL", &other);
            other.end();
            output
        },
        exit: 73,
        left: &[Else("c", "an empty file: the name is taken")],
        says: "another render is writing it",
    },
    Row {
        done: "SIGKILL before anything was saved, then the same command again",
        act: |at| {
            let killed = at.start(&[ENDLESS, CPU, &["--checkpoint", "c"]]);
            at.wait_for("c");
            super::stage::send("KILL", &killed);
            killed.end();
            at.run(&[LONG, CPU, &["--checkpoint", "c"]])
        },
        exit: 0,
        left: &[Same("o.exr")],
        says: "",
    },
    Row {
        done: "an empty file is there and the one before; `--resume`, and one save at `--time`",
        act: |at| {
            let kept = at.stopped(&[LONG, CPU, KEPT]).read("c");
            fs::write(at.join("c.previous"), &kept).expect("the one before");
            fs::write(at.join("c"), "").expect("an empty file");
            let output = at.run(&[
                LONG,
                CPU,
                &["--checkpoint", "c", "--resume", "--time", "0.001"],
            ]);
            assert!(
                at.read("c.previous") == kept,
                "the checkpoint before was touched"
            );
            output
        },
        exit: 0,
        left: STOPPED,
        says: "going on from c.previous",
    },
    Row {
        done: "`--checkpoint /dev/null`",
        act: |at| {
            at.old("o.exr")
                .run(&[SHORT, CPU, &["--checkpoint", "/dev/null"]])
        },
        exit: 2,
        left: &[Old("o.exr")],
        says: "a checkpoint must be a file",
    },
    Row {
        done: "`--checkpoint` is a link to another file system; SIGTERM, then `--resume`",
        act: |at| {
            let elsewhere = elsewhere();
            symlink(elsewhere.path().join("sums"), at.join("c")).expect("a link");
            let stopped = at.start(&[LONG, CPU, KEPT]);
            let before = elsewhere.path().join("sums.previous");
            at.wait_until("the checkpoint before", || before.exists());
            super::stage::send("TERM", &stopped);
            let stopped = stopped.end();
            assert_eq!(stopped.status.code(), Some(143), "{stopped:?}");
            let output = at.run(&[LONG, CPU, RESUMED]);
            let left = fs::read_dir(elsewhere.path()).expect("a folder").count();
            assert_eq!(left, 0, "checkpoints of a render that is done");
            output
        },
        exit: 0,
        left: &[Same("o.exr"), Else("c", "the link")],
        says: "",
    },
];

/// A folder on another file system, where there is one that everybody may write to.
fn elsewhere() -> tempfile::TempDir {
    let shared = tempfile::tempdir_in("/dev/shm");
    shared.or_else(|_| tempfile::tempdir()).expect("a folder")
}

#[test]
fn other_renders_are_refused() {
    hold("Checkpoints of another render", OTHERS);
}

#[test]
fn damage_is_found() {
    hold("Damaged checkpoints", DAMAGES);
}

#[test]
fn what_is_there_stays() {
    hold("What is where a checkpoint is to be", IN_THE_WAY);
}
