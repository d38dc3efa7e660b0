//! Making the runs of an experiment and their references, one after another, on one device.

use super::attempt::{Attempt, persist};
use super::entry::entry;
use super::expected::PlannedReference;
use super::experiment::{Experiment, reference_file};
use super::ledger::{Entry, HASH, Ledger, Status};
use super::plan::Planned;
use super::progress::{Pace, Progress, Step};
use super::summary::{ReferenceSummary, Rules, Summary};
use super::walk::Walk;
use super::whole;
use crate::device::Device;
use crate::error::{Error, Result};
use crate::film::{Picture, Target, read_exr, read_record};
use crate::place::Place;
use serde_json::{Map, Value};
use std::fs;
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// What became of one run.
enum Outcome {
    Made,
    /// Another process wrote it at the same time, and its line was first.
    MadeTwice,
    /// It was in the ledger by then, by a line of another process.
    ByAnother,
    Failed,
    Stopped,
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
    damaged: Vec<String>,
}

impl<'a> Sweep<'a> {
    /// Makes the folder where it is not there, and reads the picture of every run that is finished: one that
    /// is lost or damaged makes its run an open one.
    ///
    /// # Errors
    /// [`Error::Create`], or [`Error::Input`] for a ledger that cannot be read.
    pub fn new(experiment: &'a Experiment, folder: &Path, rules: Rules) -> Result<Self> {
        if folder.is_file() {
            let reason = "it is a file, and a sweep goes to a folder";
            return Err(Error::Create {
                path: folder.into(),
                source: io::Error::new(io::ErrorKind::NotADirectory, reason),
            });
        }
        let images = folder.join("images");
        fs::create_dir_all(&images).map_err(|source| Error::Create {
            path: images,
            source,
        })?;
        let mut ledger = Ledger::open(folder)?;
        let damaged = whole::forget_damaged(&mut ledger, folder, experiment);
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
            damaged,
        })
    }

    /// Paths of the runs and references that are not there yet.
    pub fn paths(&self) -> u64 {
        self.pace.all()
    }

    /// What is wrong with the pictures of runs that were finished and are made again, a sentence each.
    pub fn damaged(&self) -> &[String] {
        &self.damaged
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
        let mut walk = Walk::new(runs.len());
        while let Some(place) = walk.next() {
            let run = &runs[place];
            if self.ledger.has(&run.id)? {
                summary.skipped += 1;
                continue;
            }
            let step = (summary.count(), runs.len(), Step::Run(run));
            if watch(self.pace.progress(step, 0)).is_break() {
                summary.stopped = true;
                break;
            }
            let outcome = self.make(run, step, open, watch)?;
            match outcome {
                Outcome::Made | Outcome::MadeTwice => summary.made += 1,
                Outcome::ByAnother => summary.skipped += 1,
                Outcome::Failed => summary.failed += 1,
                Outcome::Stopped => summary.stopped = true,
            }
            if matches!(outcome, Outcome::MadeTwice | Outcome::ByAnother) {
                let is_finished = |place: usize| self.ledger.knows(&runs[place].id);
                summary.skipped += walk.leap(is_finished);
            }
            self.pace.add(run.paths);
            if summary.stopped || (summary.failed > 0 && self.rules.fail_fast) {
                break;
            }
        }
        Ok(summary)
    }

    /// One run, with its retries. One that was stopped leaves no trace, nor does one that another process has
    /// finished meanwhile.
    fn make(
        &mut self,
        run: &Planned,
        step: (usize, usize, Step),
        open: &mut Open,
        watch: &mut Watch,
    ) -> Result<Outcome> {
        let scene = self.experiment.base.scene(&run.point)?;
        let pace = self.pace;
        let mut hear = |paths| watch(pace.progress(step, paths));
        let (attempt, attempts) = persist(&scene, &mut self.device, open, self.rules, &mut hear)?;
        let (outcome, entry) = match attempt {
            Attempt::Stopped => return Ok(Outcome::Stopped),
            _ if self.ledger.has(&run.id)? => return Ok(Outcome::ByAnother),
            Attempt::Bad(status, error) => {
                let entry = entry(run, &scene, None, status, Some(error), attempts);
                (Outcome::Failed, entry)
            }
            Attempt::Ok(picture) => {
                let mut record = self.write("images", &run.id, *picture)?;
                let hash = whole::hash(&whole::image_file(&self.folder, &run.id))?;
                record.insert(HASH.into(), hash.into());
                let entry = entry(run, &scene, Some(record), Status::Ok, None, attempts);
                (Outcome::Made, entry)
            }
        };
        self.ledger.append(&entry)?;
        self.ledger.refresh()?;
        let first = self.ledger.hashes(&run.id).first();
        let own = entry.get(HASH).and_then(Value::as_str);
        Ok(match (outcome, first) {
            (Outcome::Made, Some(first)) if Some(first.as_str()) != own => Outcome::MadeTwice,
            (outcome, _) => outcome,
        })
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
