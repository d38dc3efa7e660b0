//! Outputs that are no files.

use super::stage::{CPU, Running, SHORT, fifo, send};
use super::table::Left::{Else, Whole};
use super::table::{Row, hold};
use std::fs::{self, File};
use std::io::Write;
use std::os::unix::fs::FileTypeExt;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

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
                &["render", "s.toml", "--spp", "60000"],
                CPU,
                &["-o", "/dev/stdout", "-o", "o.exr"],
            ];
            let mut command = at.command(parts);
            let child = Running::start(command.stdout(file));
            sleep(Duration::from_millis(300));
            send("HUP", &child);
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

#[test]
fn streams_are_written_into() {
    hold("Devices and pipes as outputs", STREAMS);
}
