//! What a sweep would make, and about how long that takes.

use super::super::{Output, print};
use super::words::spelled;
use crate::device::Device;
use crate::error::{Result, counted};
use crate::film::Stop;
use crate::render::{self, Task};
use crate::scene::Scene;
use crate::sweep::Experiment;
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
    let paths: u64 = runs.iter().map(|run| run.paths).sum();
    let more: u64 = references.iter().map(|reference| reference.paths).sum();
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
    let about = spelled(Duration::from_secs_f64(seconds));
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

/// Seconds that a path takes, by a small part of a render: the first time it is compiled, too.
fn time_a_path(scene: &Scene, device: &mut dyn Device) -> Result<f64> {
    const LONGEST: Duration = Duration::from_secs(2);
    let mut task = Task::one_of_many(scene);
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
