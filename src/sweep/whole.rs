//! Whether the picture of a finished run is still what the ledger says of it.

use super::experiment::Experiment;
use super::ledger::Ledger;
use super::plan::Planned;
use crate::error::{Error, Result};
use crate::film::{Record, read_exr};
use crate::render::scene_hash;
use crate::scene::Scene;
use rayon::prelude::*;
use serde_json::json;
use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};

/// Where a folder keeps the picture of a run.
pub(super) fn image_file(folder: &Path, id: &str) -> PathBuf {
    folder.join("images").join(format!("{id}.exr"))
}

/// Reads all finished pictures, on all cores. Says what is wrong with those that do not pass, and takes their
/// runs for open.
pub(super) fn forget_damaged(
    ledger: &mut Ledger,
    folder: &Path,
    experiment: &Experiment,
) -> Vec<String> {
    let runs = experiment.plan.runs.par_iter();
    let finished = runs.filter(|run| ledger.knows(&run.id));
    let faults: Vec<(&str, Error)> = finished
        .filter_map(|run| {
            Some((
                run.id.as_str(),
                check(folder, run, ledger.hashes(&run.id)).err()?,
            ))
        })
        .collect();
    let mut told = Vec::new();
    for (id, error) in faults {
        // Two points of a plan may be one run.
        if ledger.knows(id) {
            told.push(error.to_string());
        }
        ledger.forget(id);
    }
    told
}

/// Whether a run's picture is one of those that the ledger has the hash of.
///
/// # Errors
/// [`Error::Input`] or [`Error::Data`] with the file and what is wrong with it.
pub(super) fn check(folder: &Path, run: &Planned, hashes: &[String]) -> Result<()> {
    if hashes.is_empty() {
        return check_by_itself(folder, run);
    }
    let path = image_file(folder, &run.id);
    match hashes.contains(&hash(&path)?) {
        true => Ok(()),
        false => Err(Error::Data {
            path,
            reason: "it is not as it was written".into(),
        }),
    }
}

/// Of a file's bytes.
///
/// # Errors
/// [`Error::Input`].
pub(super) fn hash(path: &Path) -> Result<String> {
    let mut hasher = blake3::Hasher::new();
    let read = File::open(path).and_then(|file| hasher.update_reader(file).map(|_| ()));
    read.map_err(|source| Error::Input {
        path: path.into(),
        source,
    })?;
    Ok(hasher.finalize().to_hex()[..32].into())
}

/// Where the ledger has no hash, reads the picture to its end: the blocks of pixels carry a checksum (Adler-32,
/// inside zlib) unless they are stored as they are, and the record has all that the id is a hash of.
///
/// # Errors
/// [`Error::Input`] or [`Error::Data`] with the file and what is wrong with it.
fn check_by_itself(folder: &Path, run: &Planned) -> Result<()> {
    let path = image_file(folder, &run.id);
    let record = read_exr(&path)?.record;
    let reason = if id_of(&record) != run.id {
        "its record is not of this run"
    } else if !record.complete || record.samples != run.samples || record.crop.is_some() {
        "it is only a part of the run's picture"
    } else {
        return Ok(());
    };
    Err(Error::Data {
        path,
        reason: reason.into(),
    })
}

/// What decides the pixels of a run.
pub(super) struct Inputs<'a> {
    pub scene_hash: String,
    pub knobs: &'a serde_json::Map<String, serde_json::Value>,
    pub shaders: String,
    pub version: &'a str,
    /// Name, driver and backend.
    pub device: [&'a str; 3],
}

impl<'a> Inputs<'a> {
    pub fn of_scene(scene: &'a Scene, device: &'a crate::device::DeviceInfo) -> Self {
        Self {
            scene_hash: scene_hash(&scene.source.text),
            knobs: &scene.knobs,
            shaders: crate::shader::library_hash(),
            version: env!("CARGO_PKG_VERSION"),
            device: [&device.name, &device.driver, &device.backend],
        }
    }

    pub fn id(&self) -> String {
        // Sorted: the order in which knobs were given says nothing.
        let knobs: BTreeMap<_, _> = self.knobs.iter().collect();
        let inputs = json!({
            "scene": self.scene_hash,
            "knobs": knobs,
            "shaders": self.shaders,
            "version": self.version,
            "device": self.device,
        });
        blake3::hash(inputs.to_string().as_bytes()).to_hex()[..20].into()
    }
}

/// The id that a picture's record has by what it says of itself.
fn id_of(record: &Record) -> String {
    let device = &record.device;
    let inputs = Inputs {
        scene_hash: record.scene_hash.clone(),
        knobs: &record.knobs,
        shaders: record.shader_hash.clone(),
        version: &record.version,
        device: [&device.name, &device.driver, &device.backend],
    };
    inputs.id()
}
