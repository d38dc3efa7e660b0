//! Renders that are told to stop, or killed.

use super::stage::{CPU, ENDLESS, KEPT, LONG, RESUMED, Stage, send};
use super::table::Left::{Checkpoint, Else, Old, Part, Same, Whole};
use super::table::{Row, hold};
use lampray::film::{Checkpoint as Saved, Stop, read_exr, read_record};
use std::fs;
use std::process::{Command, Output};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// In how long the first signal must have ended the program.
const PROMPT: Duration = Duration::from_secs(2);

const SIGNALS: &[Row] = &[
    Row {
        done: "SIGINT",
        act: |at| promptly(at, "INT"),
        exit: 130,
        left: &[Part("o.exr"), Checkpoint("c"), Checkpoint("c.previous")],
        says: "(stopped)",
    },
    Row {
        done: "SIGTERM",
        act: |at| promptly(at, "TERM"),
        exit: 143,
        left: &[Part("o.exr"), Checkpoint("c"), Checkpoint("c.previous")],
        says: "(stopped)",
    },
    Row {
        done: "SIGINT before every pixel has a sample",
        act: |at| {
            let large = ["--width", "1000", "--height", "1000"];
            let child = at.old("o.exr").start(&[ENDLESS, CPU, KEPT, &large]);
            at.wait_until("a checkpoint", || at.is_checkpoint("c"));
            send("INT", &child);
            let output = child.end();
            // How many there were by then is chance.
            let _ = fs::remove_file(at.join("c.previous"));
            output
        },
        exit: 130,
        left: &[Old("o.exr"), Checkpoint("c")],
        says: "no picture is written",
    },
    Row {
        done: "SIGTERM twice, the second at some moment after the first, ten times",
        act: |at| twice(at, "TERM"),
        exit: 143,
        left: &[
            Else("o.exr", "the old picture or the whole new one"),
            Checkpoint("c"),
            Checkpoint("c.previous"),
        ],
        says: "",
    },
    Row {
        done: "SIGINT twice, the same",
        act: |at| twice(at, "INT"),
        exit: 130,
        left: &[
            Else("o.exr", "the old picture or the whole new one"),
            Checkpoint("c"),
            Checkpoint("c.previous"),
        ],
        says: "",
    },
    Row {
        done: "SIGHUP: the picture so far is written, and the render goes on",
        act: |at| {
            let child = at.start(&[LONG, CPU, KEPT]);
            at.wait_for_checkpoints(&child);
            send("HUP", &child);
            at.wait_for("o.exr");
            let record = read_record(at.join("o.exr")).expect("a picture").0;
            assert!(!record.complete && record.samples > 0, "{record:?}");
            child.end()
        },
        exit: 0,
        left: &[Same("o.exr")],
        says: "so far",
    },
    Row {
        done: "the reader of standard output goes away (SIGPIPE)",
        act: |at| {
            let script = "{ lampray render s.toml --device cpu -o o.exr --spp 4 --json -q; echo $? >code; } | true; exit $(cat code)";
            let output = at.script(script).output().expect("sh runs");
            fs::remove_file(at.join("code")).expect("its code");
            assert!(output.stderr.is_empty(), "{output:?}");
            output
        },
        exit: 0,
        left: &[Whole("o.exr")],
        says: "",
    },
    Row {
        done: "a reader that takes one line of many",
        act: |at| {
            at.script("lampray knobs | head -1")
                .output()
                .expect("sh runs")
        },
        exit: 0,
        left: &[],
        says: "",
    },
    Row {
        done: "SIGKILL",
        act: |at| at.old("o.exr").stop("KILL", &[ENDLESS, CPU, KEPT]),
        exit: 137,
        left: &[Old("o.exr"), Checkpoint("c"), Checkpoint("c.previous")],
        says: "",
    },
    Row {
        done: "SIGKILL at twenty moments, each time `--resume`, then to the end",
        act: |at| {
            for round in 0..20 {
                let child = at.start(&[LONG, CPU, RESUMED]);
                sleep(Duration::from_millis(20 + 7 * round));
                send("KILL", &child);
                child.end();
            }
            at.run(&[LONG, CPU, RESUMED])
        },
        exit: 0,
        left: &[Same("o.exr")],
        says: "",
    },
    Row {
        done: "SIGTERM, then `--resume`",
        act: |at| at.stopped(&[LONG, CPU, KEPT]).run(&[LONG, CPU, RESUMED]),
        exit: 0,
        left: &[Same("o.exr")],
        says: "",
    },
];

const RULES: &[Row] = &[
    Row {
        done: "`--time` is up",
        act: |at| {
            let output = at.run(&[ENDLESS, CPU, &["--checkpoint", "c", "--time", "1"]]);
            assert_eq!(stopped(at), Some(Stop::Time));
            output
        },
        exit: 0,
        left: &[Part("o.exr"), Checkpoint("c")],
        says: "(time is up)",
    },
    Row {
        done: "`--target-error` is reached",
        act: |at| {
            let output = at.run(&[ENDLESS, CPU, NOISY, &["--checkpoint", "c"]]);
            assert_eq!(stopped(at), Some(Stop::TargetError));
            output
        },
        exit: 0,
        left: &[Part("o.exr")],
        says: "(error as asked for)",
    },
    Row {
        done: "`--target-error` in one go, and stopped and resumed three times: equal bytes",
        act: |at| {
            let parts: &[&[&str]] = &[ENDLESS, CPU, NOISY, &["--no-times"]];
            let in_one_go = Stage::elsewhere(parts);
            for round in 0..3 {
                let more: &[&str] = if round == 0 { KEPT } else { RESUMED };
                let before = saved_paths(at);
                let child = at.start(&[&parts.concat(), more]);
                at.wait_until("more samples", || {
                    saved_paths(at) > before || child.has_ended()
                });
                send("KILL", &child);
                child.end();
            }
            let output = at.run(&[&parts.concat(), RESUMED]);
            assert!(at.read("o.exr") == in_one_go, "other bytes");
            output
        },
        exit: 0,
        left: &[Part("o.exr")],
        says: "(error as asked for)",
    },
];

/// An error that takes about a second to reach.
const NOISY: &[&str] = &["--target-error", "0.015", "--even"];

fn stopped(at: &Stage) -> Option<Stop> {
    let picture = read_exr(at.join("o.exr")).expect("a picture");
    picture.record.stopped
}

/// Paths that the checkpoint holds.
fn saved_paths(at: &Stage) -> u64 {
    Saved::read(&at.join("c")).map_or(0, |checkpoint| {
        let scouts = checkpoint.scouts.map_or(0, |scouts| scouts.film.paths);
        checkpoint.film.paths + scouts
    })
}

/// Stops a render by a signal, which may take so long only; on a machine that has much else to do, in one of
/// three times.
fn promptly(at: &Stage, signal: &str) -> Output {
    let mut took = Duration::MAX;
    for _ in 0..3 {
        let _ = fs::remove_file(at.join("c"));
        let _ = fs::remove_file(at.join("c.previous"));
        let child = at.start(&[ENDLESS, CPU, KEPT]);
        at.wait_for_checkpoints(&child);
        let sent = Instant::now();
        send(signal, &child);
        let output = child.end();
        took = took.min(sent.elapsed());
        if took <= PROMPT {
            return output;
        }
    }
    panic!("SIG{signal} took {took:?}");
}

/// Ends renders by a second signal soon after the first.
fn twice(at: &Stage, signal: &str) -> Output {
    let mut last = None;
    let mut ended_at_once = 0;
    for round in 0..10 {
        at.old("o.exr");
        let _ = fs::remove_file(at.join("c"));
        let _ = fs::remove_file(at.join("c.previous"));
        let child = at.start(&[ENDLESS, CPU, KEPT]);
        at.wait_for_checkpoints(&child);
        let both = format!(
            "kill -{signal} {0}; sleep 0.0{round}; kill -{signal} {0} 2>&-",
            child.id()
        );
        let _ = Command::new("sh")
            .args(["-c", &both])
            .status()
            .expect("sh runs");
        let output = child.end();
        let old = at.read("o.exr") == b"old";
        ended_at_once += usize::from(old);
        assert!(
            old || read_exr(at.join("o.exr")).is_ok(),
            "a damaged picture"
        );
        last = Some(output);
    }
    assert!(
        ended_at_once > 0,
        "no second signal came before the picture"
    );
    last.expect("ten rounds")
}

#[test]
fn signals_stop_and_lose_nothing() {
    hold("Signals", SIGNALS);
}

#[test]
fn rules_stop() {
    hold("Stop rules", RULES);
}
