//! What is said of a sweep.

use crate::knobs::short;
use crate::scene::Unbounded;
use crate::sweep::{Experiment, Progress, ReferenceSummary, Step, Summary};
use crate::wording::{counted, counted_as, named, were_there};
use std::path::Path;
use std::time::Duration;

/// What is said where not all runs can be analysed together.
pub(super) fn several_sizes(experiment: &Experiment) -> Option<String> {
    let [width, height] = experiment.size;
    let mut runs = experiment.plan.runs.iter();
    runs.any(|run| run.size != experiment.size).then(|| {
        format!(
            "lampray: the runs have several sizes; the report analyses those of {width} x {height}"
        )
    })
}

/// A warning of each material whose variance has no bound, once for all runs of the grid.
pub(super) fn unbounded(experiment: &Experiment) -> Vec<String> {
    let all = experiment.plan.unbounded.iter();
    let warn = |(name, (worst, runs)): (&String, &(Unbounded, usize))| {
        format!(
            "lampray: warning: materials.{}: survival is not above the square of its albedo in {}; at worst, {} and {:.4}, {}; `lampray check` tells more of each",
            short(name),
            counted(*runs, "run"),
            worst.survival,
            worst.albedo * worst.albedo,
            worst.effect(None)
        )
    };
    all.map(warn).collect()
}

/// Why references are missing.
pub(super) fn not_made(references: &ReferenceSummary) -> Vec<String> {
    let failed = references.failed.iter();
    let mut sentences: Vec<String> = failed
        .map(|(name, reason)| format!("The {name} was not made: {reason}."))
        .collect();
    if references.stopped {
        sentences.push("The sweep was stopped early; the same command goes on with it.".into());
    }
    sentences
}

pub(super) fn title(scene: &Path) -> String {
    let stem = scene.file_stem().unwrap_or_default();
    named(stem)
}

/// As it was typed, for a shell.
pub(crate) fn command_line() -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+".contains(c);
    let quoted = |word: String| match word.chars().all(plain) && !word.is_empty() {
        true => word,
        false => format!("'{}'", word.replace('\'', "'\\''")),
    };
    let words = std::env::args().skip(1).map(quoted);
    std::iter::once("lampray".to_string())
        .chain(words)
        .collect::<Vec<_>>()
        .join(" ")
}

/// Which run of how many it is, and what it is of.
pub(crate) fn describe(progress: &Progress) -> String {
    let place = format!("{}/{}", progress.done + 1, progress.total);
    match progress.step {
        Step::Reference(reference) => {
            let samples = counted_as(reference.samples, "sample a pixel", "samples a pixel");
            format!("[reference {place}] {samples}")
        }
        Step::Run(run) => {
            let values = run.point.values.iter();
            let values: Vec<String> = values
                .map(|(path, value)| format!("{path}={value}"))
                .collect();
            let repeat = match run.point.repeat {
                0 => String::new(),
                repeat => format!(" seed +{repeat}"),
            };
            format!("[{place}] {}{repeat}", values.join(" "))
        }
    }
}

/// Seconds, minutes or hours.
pub(crate) fn spelled(duration: Duration) -> String {
    let seconds = duration.as_secs_f64();
    match seconds {
        ..90.0 => format!("{seconds:.0} s"),
        ..5400.0 => format!("{:.0} min", seconds / 60.0),
        _ => format!("{:.1} h", seconds / 3600.0),
    }
}

/// One line on what was made.
pub(super) fn ended(folder: &Path, runs: Summary, references: &ReferenceSummary) -> String {
    let Summary {
        made,
        skipped,
        failed,
        stopped,
    } = runs;
    let state = match stopped || references.stopped {
        true => " (stopped early)",
        false => "",
    };
    let own = match (references.made, references.found) {
        (0, 0) => String::new(),
        (made, found) => format!("; references: {made} made, {}", were_there(found)),
    };
    let (folder, made, skipped) = (named(folder), counted(made, "run"), were_there(skipped));
    format!("{folder}: {made} made{state}, {skipped}, {failed} failed{own}")
}
