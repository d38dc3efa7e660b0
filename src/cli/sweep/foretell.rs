//! What a sweep would make, and about how long that takes.

use super::super::{Output, print};
use super::words::spelled;
use crate::device::Device;
use crate::error::Result;
use crate::film::Stop;
use crate::pack::Rect;
use crate::render::{self, Task};
use crate::scene::Scene;
use crate::sweep::Experiment;
use crate::wording::counted;
use serde_json::json;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// `--dry-run`.
pub(super) fn foretell(
    experiment: &Experiment,
    mut device: Box<dyn Device>,
    output: Output,
) -> Result<()> {
    let runs = &experiment.plan.runs;
    let references = experiment.references(&|_| true)?;
    // A million runs of the largest picture have more than u64 counts.
    let all = |sum: u64, paths| sum.saturating_add(paths);
    let paths = runs.iter().map(|run| run.paths).fold(0, all);
    let more = references.iter().map(|reference| reference.paths);
    let more = more.fold(0, all);
    let mut seconds = 0.0;
    if let Some(run) = runs.first() {
        let scene = experiment.base.scene(&run.point)?;
        seconds += paths as f64 * time_a_path(&scene, device.as_mut())?;
    }
    if let Some(reference) = references.first() {
        seconds += more as f64 * time_a_path(reference.scene(), device.as_mut())?;
    }
    if output.json {
        let told = json!({
            "runs": runs.len(), "paths": paths, "references": references.len(),
            "reference_paths": more, "seconds": seconds,
        });
        return print(&format!("{told}\n"));
    }
    let about = spelled(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
    let own = match references.len() {
        0 => String::new(),
        1 => format!(", 1 reference of {more} paths"),
        many => format!(", {many} references of {more} paths"),
    };
    print(&format!(
        "{}, {paths} paths{own}, about {about} on {}\n",
        counted(runs.len(), "run"),
        device.info().name
    ))
}

/// The middle of a picture, which may be too large to be kept for a guess.
fn middle(whole: Rect) -> Rect {
    const SIDE: u32 = 256;
    let part = |first: u32, end: u32| {
        let spare = (end - first).saturating_sub(SIDE) / 2;
        [first + spare, (first + spare + SIDE).min(end)]
    };
    let [x0, x1] = part(whole.x0, whole.x1);
    let [y0, y1] = part(whole.y0, whole.y1);
    Rect { x0, y0, x1, y1 }
}

/// Seconds that a path takes, by a small part of a render: the first time it is compiled, too.
fn time_a_path(scene: &Scene, device: &mut dyn Device) -> Result<f64> {
    const LONGEST: Duration = Duration::from_secs(2);
    let mut task = Task::one_of_many(scene);
    task.region = middle(task.region);
    task.samples.end = task.samples.end.min(4);
    let mut pilot = || {
        let started = Instant::now();
        let rendering =
            render::render(device, &task, &mut |_| match started.elapsed() > LONGEST {
                true => ControlFlow::Break(Stop::Time),
                false => ControlFlow::Continue(()),
            })?;
        let paths: u64 = rendering.film.counts.iter().sum();
        Ok(rendering.tracing.as_secs_f64() / paths.max(1) as f64)
    };
    pilot()?;
    pilot()
}
