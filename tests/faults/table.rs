//! Rows of what goes wrong, how each is judged, and how they are shown.

use super::stage::{Stage, undisturbed, words};
use lampray::film::read_exr;
use std::fs;
use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::process::Output;

/// Something that goes wrong.
pub struct Row {
    /// What was done, in words.
    pub done: &'static str,
    pub act: fn(&Stage) -> Output,
    pub exit: i32,
    /// Everything that must be in the folder beside the scene.
    pub left: &'static [Left],
    /// What the program must have said.
    pub says: &'static str,
}

/// What is left of something.
#[derive(Clone, Copy, Debug)]
pub enum Left {
    /// The file that was there before, as it was.
    Old(&'static str),
    /// A picture with all of its samples.
    Whole(&'static str),
    /// A picture with the samples that there were when it ended.
    Part(&'static str),
    /// The picture of a render that nothing disturbed, byte for byte.
    Same(&'static str),
    /// A whole checkpoint.
    Checkpoint(&'static str),
    /// What the row itself has looked at: its name, and what it is.
    Else(&'static str, &'static str),
}

impl Left {
    fn name(&self) -> &'static str {
        match self {
            Left::Old(name)
            | Left::Whole(name)
            | Left::Part(name)
            | Left::Same(name)
            | Left::Checkpoint(name)
            | Left::Else(name, _) => name,
        }
    }

    fn words(&self) -> String {
        match self {
            Left::Old(_) => "the old picture".into(),
            Left::Whole(_) => "the whole picture".into(),
            Left::Part(_) => "the picture so far".into(),
            Left::Same(_) => "the undisturbed picture, byte for byte".into(),
            Left::Checkpoint("c.previous") => "the checkpoint before".into(),
            Left::Checkpoint(_) => "a checkpoint".into(),
            Left::Else(_, words) => (*words).into(),
        }
    }

    /// Whether that is what is there.
    fn is_there(&self, stage: &Stage) -> bool {
        let path = stage.join(self.name());
        let picture = |complete: bool| {
            read_exr(&path).is_ok_and(|picture| {
                picture.record.complete == complete && picture.record.samples > 0
            })
        };
        match self {
            Left::Old(name) => stage.read(name) == b"old",
            Left::Whole(_) => picture(true),
            Left::Part(_) => picture(false),
            Left::Same(name) => stage.read(name) == undisturbed(&path),
            Left::Checkpoint(name) => stage.is_checkpoint(name),
            Left::Else(..) => path.symlink_metadata().is_ok(),
        }
    }
}

impl Row {
    /// What is wrong with how it ended.
    fn judge(&self, stage: &Stage, output: &Output) -> Vec<String> {
        let mut faults = Vec::new();
        let signal = output.status.signal();
        // Only SIGKILL may end the program without an exit code of its own; shells then say 137.
        let killed = (signal == Some(9)).then_some(137);
        if output.status.code().or(killed) != Some(self.exit) {
            faults.push(format!(
                "exit {:?}, signal {signal:?}",
                output.status.code()
            ));
        }
        let words = words(output);
        for panic in ["panicked", "RUST_BACKTRACE", "internal error"] {
            if words.contains(panic) {
                faults.push("it panicked".into());
            }
        }
        if !words.contains(self.says) {
            faults.push(format!("it does not say \"{}\"", self.says));
        }
        for left in self.left {
            if !left.is_there(stage) {
                faults.push(format!("no {left:?}"));
            }
        }
        let wanted = |name: &String| name == "s.toml" || self.left.iter().any(|l| l.name() == name);
        for name in names(stage).iter().filter(|name| !wanted(name)) {
            faults.push(format!("{name} is left over"));
        }
        if !faults.is_empty() {
            faults.push(format!("it said: {words}"));
        }
        faults
    }

    fn shown(&self) -> String {
        let left: Vec<_> = self.left.iter().map(Left::words).collect();
        let left = match left.as_slice() {
            [] => "nothing".into(),
            some => some.join(", "),
        };
        format!("| {} | {} | {left} |\n", self.done, self.exit)
    }
}

/// Everything in a folder.
fn names(stage: &Stage) -> Vec<String> {
    let entries = fs::read_dir(stage.path()).expect("the folder");
    let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
    let mut names: Vec<_> = entries.flatten().map(name).collect();
    names.sort();
    names
}

/// Does what each row says, shows them, and fails for those that end otherwise.
pub fn hold(title: &str, rows: &[Row]) {
    let mut shown =
        format!("\n**{title}**\n\n| what was done | exit | what is left |\n|---|---|---|\n");
    let mut faults = Vec::new();
    for row in rows {
        let stage = Stage::new();
        let output = (row.act)(&stage);
        let found = row.judge(&stage, &output);
        if !found.is_empty() {
            faults.push(format!("{}: {}", row.done, found.join("; ")));
        }
        shown += &row.shown();
    }
    // Whole, whatever other tests print at the same time.
    let _ = std::io::stdout().write_all(shown.as_bytes());
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

/// A table that cannot fail proves nothing.
#[test]
fn rows_that_end_otherwise_are_found() {
    use super::stage::{CPU, SHORT};
    let row = |left: &'static [Left], exit, says| Row {
        done: "",
        act: |stage| stage.run(&[SHORT, CPU]),
        exit,
        left,
        says,
    };
    let faults = |row: Row| {
        let stage = Stage::new();
        let output = (row.act)(&stage);
        row.judge(&stage, &output).len()
    };
    assert_eq!(faults(row(&[Left::Whole("o.exr")], 0, "built-in")), 0);
    let wrong = [
        row(&[Left::Whole("o.exr")], 74, ""),
        row(&[Left::Whole("o.exr")], 0, "opened anew"),
        row(&[], 0, ""),
        row(&[Left::Part("o.exr")], 0, ""),
        row(&[Left::Old("o.exr")], 0, ""),
        row(&[Left::Same("o.exr")], 0, ""),
        row(&[Left::Checkpoint("o.exr")], 0, ""),
        row(&[Left::Whole("o.exr"), Left::Else("pipe", "")], 0, ""),
    ];
    for (place, row) in wrong.into_iter().enumerate() {
        // The fault, and what the program said.
        assert_eq!(faults(row), 2, "row {place}");
    }
}
