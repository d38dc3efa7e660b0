//! Making the runs of an experiment and their references, one after another, on one device.

use super::attempt::{Attempt, persist};
use super::expected::PlannedReference;
use super::experiment::{Experiment, reference_file};
use super::ledger::{Entry, Ledger, Status};
use super::plan::Planned;
use super::progress::{Pace, Progress, Step};
use crate::device::Device;
use crate::error::{Error, Result};
use crate::film::{Picture, Target, read_exr, read_record};
use crate::place::Place;
use crate::scene::Scene;
use serde_json::{Map, Value, json};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What is done about runs that fail.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rules {
    /// Stop at the first.
    pub fail_fast: bool,
    /// Try each so many times more; references, too.
    pub retries: u32,
    /// Give a run up after so long; a reference has its time.
    pub timeout: Option<Duration>,
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

/// What became of the references.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReferenceSummary {
    pub made: usize,
    /// Those that were there already.
    pub found: usize,
    /// Name and reason of each that could not be made.
    pub failed: Vec<(String, String)>,
    pub stopped: bool,
}

/// Gets a device, at the start and after one was lost.
pub type Open<'a> = dyn FnMut() -> Result<Box<dyn Device>> + 'a;
/// Hears how far the sweep is, and may stop it.
pub type Watch<'a> = dyn FnMut(Progress) -> ControlFlow<()> + 'a;

/// An experiment with the folder that it goes to.
pub struct Sweep<'a> {
    experiment: &'a Experiment,
    folder: PathBuf,
    ledger: Ledger,
    rules: Rules,
    device: Option<Box<dyn Device>>,
    pace: Pace,
}

impl<'a> Sweep<'a> {
    /// Makes the folder where it is not there.
    ///
    /// # Errors
    /// [`Error::Create`], or [`Error::Input`] for a ledger that cannot be read.
    pub fn new(experiment: &'a Experiment, folder: &Path, rules: Rules) -> Result<Self> {
        let images = folder.join("images");
        fs::create_dir_all(&images).map_err(|source| Error::Create {
            path: images,
            source,
        })?;
        let ledger = Ledger::open(folder)?;
        let open = experiment.plan.runs.iter();
        let runs = open
            .filter(|run| !ledger.knows(&run.id))
            .map(|run| run.paths);
        let references = experiment.references(&|_| true)?;
        let is_open = |reference: &&PlannedReference| !is_there(folder, &reference.id);
        let references = references.iter().filter(is_open);
        let paths = runs.chain(references.map(|reference| reference.paths));
        Ok(Self {
            pace: Pace::new(paths.fold(0, u64::saturating_add)),
            experiment,
            folder: folder.into(),
            ledger,
            rules,
            device: None,
        })
    }

    /// Paths of the runs and references that are not there yet.
    pub fn paths(&self) -> u64 {
        self.pace.all()
    }

    /// The device that is open, for the next sweep: its pipelines are kept.
    pub fn into_device(self) -> Option<Box<dyn Device>> {
        self.device
    }

    /// Everything that the folder's ledger holds.
    ///
    /// # Errors
    /// [`Error::Input`].
    pub fn entries(&self) -> Result<Vec<Entry>> {
        self.ledger.entries()
    }

    /// Writes `table.csv` of everything that the folder holds.
    ///
    /// # Errors
    /// Those of reading the ledger and of writing the file.
    pub fn write_table(&self) -> Result<()> {
        let text = super::table(&self.entries()?);
        let place = Place::prepare(self.folder.join("table.csv"))?;
        place.write(|sink| sink.write_all(text.as_bytes()))
    }

    /// Makes every run that is not finished yet.
    ///
    /// # Errors
    /// Those of the outputs, which concern all runs, and of opening a device. A run that fails by
    /// itself is an entry in the ledger.
    pub fn go(&mut self, open: &mut Open, watch: &mut Watch) -> Result<Summary> {
        let mut summary = Summary::default();
        let runs = &self.experiment.plan.runs;
        for (done, run) in runs.iter().enumerate() {
            if self.ledger.has(&run.id)? {
                summary.skipped += 1;
                continue;
            }
            let step = (done, runs.len(), Step::Run(run));
            if watch(self.pace.progress(step, 0)).is_break() {
                summary.stopped = true;
                break;
            }
            match self.make(run, step, open, watch)? {
                Some(Status::Ok) => summary.made += 1,
                Some(_) => summary.failed += 1,
                None => summary.stopped = true,
            }
            self.pace.add(run.paths);
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
        step: (usize, usize, Step),
        open: &mut Open,
        watch: &mut Watch,
    ) -> Result<Option<Status>> {
        let scene = self.experiment.base.scene(&run.point)?;
        let pace = self.pace;
        let mut hear = |paths| watch(pace.progress(step, paths));
        let (attempt, attempts) = persist(&scene, &mut self.device, open, self.rules, &mut hear)?;
        let (status, entry) = match attempt {
            Attempt::Stopped => return Ok(None),
            Attempt::Bad(status, error) => {
                let entry = entry(run, &scene, None, status, Some(error), attempts);
                (status, entry)
            }
            Attempt::Ok(picture) => {
                let record = self.write("images", &run.id, *picture)?;
                let entry = entry(run, &scene, Some(record), Status::Ok, None, attempts);
                (Status::Ok, entry)
            }
        };
        self.ledger.append(&entry)?;
        Ok(Some(status))
    }

    /// Makes the references of the finished runs that are not there yet. One that cannot be made is a line of
    /// the summary: it costs no run.
    ///
    /// # Errors
    /// [`Error::Input`] for a ledger that cannot be read.
    pub fn references(&mut self, open: &mut Open, watch: &mut Watch) -> Result<ReferenceSummary> {
        let mut summary = ReferenceSummary::default();
        // Another process may have made some of the runs.
        self.ledger.refresh()?;
        let ledger = &self.ledger;
        let all = self.experiment.references(&|run| ledger.knows(&run.id))?;
        for (done, reference) in all.iter().enumerate() {
            // Read to its end: one that was damaged is made again.
            if read_exr(reference_file(&self.folder, &reference.id, "exr")).is_ok() {
                summary.found += 1;
                continue;
            }
            let step = (done, all.len(), Step::Reference(reference));
            if watch(self.pace.progress(step, 0)).is_break() {
                summary.stopped = true;
                break;
            }
            match self.make_reference(reference, step, open, watch) {
                Ok(true) => summary.made += 1,
                Ok(false) => {
                    summary.stopped = true;
                    break;
                }
                Err(error) => summary
                    .failed
                    .push((reference.name.clone(), error.to_string())),
            }
            self.pace.add(reference.paths);
        }
        Ok(summary)
    }

    /// False if it was stopped.
    fn make_reference(
        &mut self,
        reference: &PlannedReference,
        step: (usize, usize, Step),
        open: &mut Open,
        watch: &mut Watch,
    ) -> Result<bool> {
        let pace = self.pace;
        let mut hear = |paths| watch(pace.progress(step, paths));
        let rules = Rules {
            timeout: None,
            ..self.rules
        };
        let scene = &reference.scene;
        match persist(scene, &mut self.device, open, rules, &mut hear)?.0 {
            Attempt::Stopped => Ok(false),
            Attempt::Bad(_, error) => Err(Error::DeviceLost(error)),
            Attempt::Ok(picture) => {
                let folder = self.folder.join("reference");
                fs::create_dir_all(&folder).map_err(|source| Error::Create {
                    path: folder,
                    source,
                })?;
                self.write("reference", &reference.id, *picture)?;
                Ok(true)
            }
        }
    }

    /// Writes both files and returns the record. The EXR comes last: what has one is whole.
    fn write(&self, room: &str, id: &str, mut picture: Picture) -> Result<Map<String, Value>> {
        let names = ["exr", "png"].map(|extension| format!("{room}/{id}.{extension}"));
        picture.record.outputs = names.to_vec();
        for name in names.iter().rev() {
            Target::prepare(self.folder.join(name))?.write(&picture)?;
        }
        match serde_json::to_value(&picture.record) {
            Ok(Value::Object(record)) => Ok(record),
            other => Err(Error::Internal(format!(
                "a record that is no object: {other:?}"
            ))),
        }
    }
}

/// Whether a reference has been made, as far as its head tells.
fn is_there(folder: &Path, id: &str) -> bool {
    let record = read_record(reference_file(folder, id, "exr"));
    record.is_ok_and(|(record, _)| record.complete)
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
