//! Making the runs of a plan, one after another, on one device.

use super::ledger::{Entry, Ledger, Status};
use super::plan::{Base, Plan, Planned};
use crate::device::Device;
use crate::error::{Error, Result};
use crate::film::{Picture, Target};
use crate::render::{self, Task};
use crate::scene::Scene;
use serde_json::{Map, Value, json};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What is done about runs that fail.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rules {
    /// Stop at the first.
    pub fail_fast: bool,
    /// Try each so many times more.
    pub retries: u32,
    /// Give a run up after so long.
    pub timeout: Option<Duration>,
}

/// Where a sweep is.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Runs that are finished, those of earlier calls included, and all.
    pub done: usize,
    pub total: usize,
    /// The one in hand.
    pub run: &'a Planned,
    /// By the speed so far; none before the first run of this call.
    pub left: Option<Duration>,
}

/// How a sweep ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Runs made now, runs that were there already, and runs that failed.
    pub made: usize,
    pub skipped: usize,
    pub failed: usize,
    /// Whether it was stopped before its end.
    pub stopped: bool,
}

/// Gets a device, at the start and after one was lost.
type Open<'a> = dyn FnMut() -> Result<Box<dyn Device>> + 'a;
/// Hears how far the sweep is, and may stop it.
type Watch<'a> = dyn FnMut(Progress) -> ControlFlow<()> + 'a;

/// A plan with the folder that it goes to.
pub struct Sweep<'a> {
    base: &'a Base,
    plan: &'a Plan,
    images: PathBuf,
    ledger: Ledger,
    rules: Rules,
}

/// How one attempt at a run ended.
enum Attempt {
    Ok(Box<Picture>),
    Bad(Status, String),
    Stopped,
}

impl<'a> Sweep<'a> {
    /// Makes the folder where it is not there.
    ///
    /// # Errors
    /// [`Error::Create`], or [`Error::Input`] for a ledger that cannot be read.
    pub fn new(base: &'a Base, plan: &'a Plan, folder: &Path, rules: Rules) -> Result<Self> {
        let images = folder.join("images");
        fs::create_dir_all(&images).map_err(|source| Error::Create {
            path: images.clone(),
            source,
        })?;
        Ok(Self {
            base,
            plan,
            images,
            ledger: Ledger::open(folder)?,
            rules,
        })
    }

    /// Everything that the folder's ledger holds.
    ///
    /// # Errors
    /// [`Error::Input`].
    pub fn entries(&self) -> Result<Vec<Entry>> {
        self.ledger.entries()
    }

    /// Makes every run that is not finished yet.
    ///
    /// # Errors
    /// Those of the outputs, which concern all runs, and of opening a device. A run that fails by
    /// itself is an entry in the ledger.
    pub fn go(&mut self, open: &mut Open, watch: &mut Watch) -> Result<Summary> {
        let started = Instant::now();
        let mut summary = Summary::default();
        let mut device = None;
        let (mut paths_made, total) = (0, self.plan.runs.len());
        for (index, run) in self.plan.runs.iter().enumerate() {
            if self.ledger.has(&run.id)? {
                summary.skipped += 1;
                continue;
            }
            let paths_left: u64 = self.plan.runs[index..].iter().map(|run| run.paths).sum();
            let rate = started.elapsed().as_secs_f64() / paths_made as f64;
            let progress = Progress {
                done: index,
                total,
                run,
                left: (paths_made > 0).then(|| Duration::from_secs_f64(rate * paths_left as f64)),
            };
            if watch(progress).is_break() {
                summary.stopped = true;
                break;
            }
            match self.make(run, &mut device, open, &mut || watch(progress))? {
                Some(Status::Ok) => summary.made += 1,
                Some(_) => summary.failed += 1,
                None => summary.stopped = true,
            }
            paths_made += run.paths;
            if summary.stopped || (summary.failed > 0 && self.rules.fail_fast) {
                break;
            }
        }
        Ok(summary)
    }

    /// One run, with its retries; `None` if it was stopped, which leaves no trace of it.
    fn make(
        &mut self,
        run: &Planned,
        device: &mut Option<Box<dyn Device>>,
        open: &mut Open,
        watch: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Option<Status>> {
        let scene = self.base.scene(&run.point)?;
        let mut attempts = 0;
        loop {
            attempts += 1;
            let mut on = match device.take() {
                Some(device) => device,
                None => open()?,
            };
            let attempt = self.attempt(&scene, on.as_mut(), watch);
            let lost = matches!(attempt, Attempt::Bad(Status::DeviceLost, _));
            // A lost device does not come back, but another one may.
            *device = (!lost).then_some(on);
            match attempt {
                Attempt::Stopped => return Ok(None),
                Attempt::Bad(..) if attempts <= self.rules.retries => {}
                Attempt::Bad(status, error) => {
                    let entry = entry(run, &scene, None, status, Some(error), attempts);
                    self.ledger.append(&entry)?;
                    return Ok(Some(status));
                }
                Attempt::Ok(picture) => {
                    let record = self.write(run, *picture)?;
                    let entry = entry(run, &scene, Some(record), Status::Ok, None, attempts);
                    self.ledger.append(&entry)?;
                    return Ok(Some(Status::Ok));
                }
            }
        }
    }

    fn attempt(
        &self,
        scene: &Scene,
        device: &mut dyn Device,
        watch: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Attempt {
        let started = Instant::now();
        let task = Task::new(scene);
        let (mut stopped, mut late) = (false, false);
        let rendering = render::render(device, &task, &mut |_| {
            late = self
                .rules
                .timeout
                .is_some_and(|limit| started.elapsed() > limit);
            stopped = watch().is_break();
            if late || stopped {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        match rendering {
            Ok(rendering) if rendering.complete => {
                let mut picture = render::picture(&task, device.info(), &rendering, &[]);
                picture.record.seconds.total = started.elapsed().as_secs_f64();
                Attempt::Ok(Box::new(picture))
            }
            Ok(_) if stopped => Attempt::Stopped,
            Ok(_) => {
                let seconds = self.rules.timeout.unwrap_or_default().as_secs_f64();
                Attempt::Bad(Status::Timeout, format!("not done after {seconds} s"))
            }
            Err(error @ Error::DeviceLost(_)) => {
                Attempt::Bad(Status::DeviceLost, error.to_string())
            }
            Err(error) => Attempt::Bad(Status::Failed, error.to_string()),
        }
    }

    /// Writes both files and returns the record.
    fn write(&self, run: &Planned, mut picture: Picture) -> Result<Map<String, Value>> {
        let names = ["exr", "png"].map(|extension| format!("{}.{extension}", run.id));
        picture.record.outputs = names.iter().map(|name| format!("images/{name}")).collect();
        for name in names {
            Target::prepare(self.images.join(name))?.write(&picture)?;
        }
        match serde_json::to_value(&picture.record) {
            Ok(Value::Object(record)) => Ok(record),
            other => Err(Error::Internal(format!(
                "a record that is no object: {other:?}"
            ))),
        }
    }
}

/// A line of the ledger. A run without a picture has its knobs all the same.
fn entry(
    run: &Planned,
    scene: &Scene,
    record: Option<Map<String, Value>>,
    status: Status,
    error: Option<String>,
    attempts: u32,
) -> Entry {
    let value = |path: &str, text: &str| {
        scene
            .knobs
            .get(path)
            .cloned()
            .unwrap_or_else(|| text.into())
    };
    let swept: Map<String, Value> = run
        .point
        .values
        .iter()
        .map(|(path, text)| (path.clone(), value(path, text)))
        .collect();
    let mut entry = Map::new();
    entry.insert("id".into(), run.id.as_str().into());
    entry.insert("status".into(), status.name().into());
    entry.insert("error".into(), json!(error));
    entry.insert("attempts".into(), attempts.into());
    entry.insert("run".into(), run.number.into());
    entry.insert("repeat".into(), run.point.repeat.into());
    entry.insert("swept".into(), Value::Object(swept));
    match record {
        Some(record) => entry.extend(record),
        None => {
            entry.insert("knobs".into(), Value::Object(scene.knobs.clone()));
            entry.insert("seed".into(), scene.settings.render.seed.into());
        }
    }
    entry
}
