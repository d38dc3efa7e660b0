//! Checkpoints of a render: when they are written, and what a render goes on from.

use super::note;
use crate::error::{Error, Result};
use crate::film::{Checkpoint, Record, previous};
use crate::place::{Place, follow};
use crate::render::{self, Rendering, Task};
use crate::wording::named;
use clap::Args;
use std::fs::{self, File, Metadata, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Saving a render on its way.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct KeepOptions {
    /// Save the raw sums to FILE now and then and when the render stops; it goes when the render is done
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// How often
    #[arg(
        long,
        value_name = "SECONDS",
        default_value = "60",
        requires = "checkpoint",
        value_parser = super::options::seconds,
        allow_negative_numbers = true
    )]
    checkpoint_every: Duration,
    /// Go on from the checkpoint: the picture is that of a render that never stopped, byte for byte. Without one
    /// there begin anew
    #[arg(long, requires = "checkpoint")]
    resume: bool,
}

/// Writes the checkpoints of one render.
pub(crate) struct Keeper {
    path: PathBuf,
    every: Duration,
    samples: [u64; 2],
    last: Instant,
    /// Paths that the last checkpoint holds.
    kept: u64,
    /// The checkpoint that this render wrote last or goes on from, locked as long as the render lives; before
    /// there is one an empty file in its place.
    held: Option<File>,
    /// Whether that is such an empty file, and nothing was saved yet.
    claims: bool,
}

impl KeepOptions {
    /// The keeper of a task's checkpoints, where they are wanted, and what there is to go on from. `wanted` is
    /// the record of the task with nothing done.
    ///
    /// # Errors
    /// [`Error::Create`] where a checkpoint cannot be written or one would be lost, [`Error::Data`] for a
    /// damaged one or one of another render.
    pub(crate) fn keeper(
        &self,
        task: &Task,
        wanted: &Record,
        outputs: Vec<PathBuf>,
    ) -> Result<Option<(Keeper, Rendering)>> {
        let Some(path) = &self.checkpoint else {
            return Ok(None);
        };
        if path.as_os_str() == "-" {
            return Err(Error::Usage(
                "--checkpoint -: sums are kept in a file, not on standard output; a file of that name is ./-".into(),
            ));
        }
        // Where links lead: the checkpoint before lies beside this one, and both can be removed.
        let path = &follow(path).map_err(|source| Error::Create {
            path: path.clone(),
            source,
        })?;
        let mut keeper = Keeper {
            path: path.clone(),
            every: self.checkpoint_every,
            samples: [task.samples.start, task.samples.end],
            last: Instant::now(),
            kept: 0,
            held: None,
            claims: false,
        };
        keeper.refuse_place(&outputs)?;
        let found = if self.resume {
            keeper.hold()?;
            Checkpoint::newest(path)?
        } else {
            keeper.refuse_to_lose()?;
            None
        };
        match keeper.held {
            // One that a killed render left: as if it were this one's, so that it never takes the place of the one before.
            Some(_) => keeper.claims = is_empty(path),
            None => keeper.claim()?,
        }
        let Some((checkpoint, remark)) = found else {
            if self.resume {
                note(&format!(
                    "lampray: no checkpoint at {}: beginning anew",
                    named(path)
                ));
            }
            return Ok(Some((keeper, Rendering::new(task))));
        };
        if let Some(remark) = remark {
            note(&format!("lampray: {remark}"));
        }
        checkpoint.refuse_other(path, wanted, keeper.samples)?;
        let rendering = Rendering::of_checkpoint(task, checkpoint).ok_or_else(|| Error::Data {
            path: path.clone(),
            reason: "the checkpoint holds no sums of this render".into(),
        })?;
        Ok(Some((keeper, rendering)))
    }
}

impl Keeper {
    /// A checkpoint may hold hours: only who says --resume or removes it does without.
    fn refuse_to_lose(&self) -> Result<()> {
        for path in [self.path.clone(), previous(&self.path)] {
            if path.exists() && !is_empty(&path) {
                let source = io::Error::other(match Checkpoint::is_one(&path) {
                    true => "a checkpoint is there; add --resume to go on from it, or remove it",
                    false => {
                        "a file is there that is no checkpoint; give --checkpoint another name"
                    }
                });
                return Err(Error::Create { path, source });
            }
        }
        Ok(())
    }

    /// Finds out before anything is read, which a pipe would wait for, or rendered, whether a checkpoint can be
    /// written, and is nobody's output.
    fn refuse_place(&self, outputs: &[PathBuf]) -> Result<()> {
        let place = Place::prepare(&self.path)?;
        let own = [place.identity(), previous(&place.identity())];
        let refused = |why: &str| {
            let path = named(&self.path);
            Err(Error::Usage(format!("--checkpoint {path}: {why}")))
        };
        if place.is_stream() {
            return refused("a checkpoint must be a file");
        }
        if own.iter().any(|path| outputs.contains(path)) {
            return refused(
                "the picture would be written there, too; give one of them another name",
            );
        }
        Ok(())
    }

    /// Locks the checkpoint that is there, so that no other render goes on from it or removes it. The lock is the
    /// system's, and ends with the program. Where there are no locks there is none.
    fn hold(&mut self) -> Result<()> {
        let Ok(file) = File::open(&self.path) else {
            return Ok(());
        };
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(self.another("another render is writing it"));
        }
        self.held = Some(file);
        Ok(())
    }

    /// Takes the name of the checkpoint for this render, by an empty file that is locked: a second render that is to
    /// be saved there is told so before it renders anything. One that a killed render left is nobody's.
    fn claim(&mut self) -> Result<()> {
        let create = |source| Error::Create {
            path: self.path.clone(),
            source,
        };
        let mut options = OpenOptions::new();
        let file = options.write(true).create(true).truncate(false);
        let file = file.open(&self.path).map_err(create)?;
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(self.another("another render is writing it"));
        }
        self.held = Some(file);
        self.claims = true;
        // Between being opened and locked it may have become another's.
        match self.is_own() && is_empty(&self.path) {
            true => Ok(()),
            false => Err(self.another("another render has written it since")),
        }
    }

    /// Whether all that is there is this render's claim.
    fn only_claims(&self) -> bool {
        self.claims && self.is_own() && is_empty(&self.path)
    }

    fn another(&self, why: &'static str) -> Error {
        Error::Create {
            path: self.path.clone(),
            source: io::Error::other(why),
        }
    }

    /// Whether the checkpoint that is there is this render's own.
    fn is_own(&self) -> bool {
        let there = fs::metadata(&self.path);
        let held = self.held.as_ref().map(File::metadata);
        matches!((there, held), (Ok(there), Some(Ok(held))) if same_file(&there, &held))
    }

    /// Saves where it is time to. A checkpoint that cannot be written is said and no more: the render goes on.
    pub(crate) fn save_if_due(&mut self, task: &Task, rendering: &Rendering) {
        if self.last.elapsed() < self.every {
            return;
        }
        if let Err(error) = self.save(task, rendering) {
            note(&format!("lampray: warning: {error}; the render goes on"));
        }
    }

    /// Saves what is done, if any of it is new.
    pub(crate) fn save(&mut self, task: &Task, rendering: &Rendering) -> Result<()> {
        self.last = Instant::now();
        let Some(device) = rendering.devices.first() else {
            return Ok(());
        };
        if rendering.traced() == self.kept {
            return Ok(());
        }
        if self.path.exists() && !self.is_own() {
            return Err(self.another("another render has written it since"));
        }
        let mut record = render::record(task, device, rendering);
        record.devices = rendering.devices.clone();
        rendering.film.describe(&mut record);
        let (film, scouts) = (&rendering.film, rendering.scouts.as_ref());
        if self.only_claims() {
            // Else it would be kept as the checkpoint before.
            let _ = fs::remove_file(&self.path);
        }
        Checkpoint::save(&self.path, &record, self.samples, film, scouts)?;
        self.kept = rendering.traced();
        self.claims = false;
        self.hold()
    }

    /// The render is done and its pictures are written: nobody needs the checkpoints any more.
    pub(crate) fn remove(&self) {
        if self.path.exists() && !self.is_own() {
            return;
        }
        for path in [self.path.clone(), previous(&self.path)] {
            // One that cannot be removed is whole, and going on from it gives the same picture.
            let _ = fs::remove_file(path);
        }
    }

    /// Where there is something to go on from.
    pub(crate) fn kept(&self) -> Option<&PathBuf> {
        (self.kept > 0).then_some(&self.path)
    }
}

/// A render that ends without a checkpoint leaves none, not even an empty one.
impl Drop for Keeper {
    fn drop(&mut self) {
        if self.only_claims() {
            let _ = fs::remove_file(&self.path);
        }
    }
}

fn is_empty(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|found| found.is_file() && found.len() == 0)
}

/// Whether two names are of one file; not every system tells.
#[cfg(unix)]
fn same_file(a: &Metadata, b: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

#[cfg(not(unix))]
fn same_file(a: &Metadata, b: &Metadata) -> bool {
    (a.len(), a.modified().ok()) == (b.len(), b.modified().ok())
}
