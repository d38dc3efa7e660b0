//! Pictures as files: the format goes by the extension.

use super::exr::write_exr;
use super::png::write_png;
use super::{Picture, Record};
use crate::error::{Error, Result};
use crate::place::Place;
use crate::wording::named;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Png,
    Exr,
}

impl Format {
    /// By the extension, in upper or lower case.
    pub fn of(path: &Path) -> Option<Format> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "png" => Some(Format::Png),
            "exr" => Some(Format::Exr),
            _ => None,
        }
    }
}

/// An output that has been found writable. Dropping it unwritten leaves no trace.
#[derive(Debug)]
pub struct Target {
    place: Place,
    format: Format,
}

impl Target {
    /// Checks that `path` can be written, and holds a place for it in its folder. Devices and pipes
    /// without an extension get PNG.
    ///
    /// # Errors
    /// [`Error::Create`], or [`Error::Usage`] for any other extension than png and exr.
    pub fn prepare(path: impl AsRef<Path>) -> Result<Target> {
        let path = path.as_ref();
        let format = Format::of(path);
        if format.is_none() && path.extension().is_some() {
            return Err(unknown_format(path));
        }
        let place = Place::prepare(path)?;
        let format = format.or(place.is_stream().then_some(Format::Png));
        let format = format.ok_or_else(|| unknown_format(path))?;
        Ok(Target { place, format })
    }

    /// Prepares several outputs, no two of which may be the same file.
    ///
    /// # Errors
    /// As [`Target::prepare`]; [`Error::Usage`] for an output given twice.
    pub fn prepare_all<P: AsRef<Path>>(paths: &[P]) -> Result<Vec<Target>> {
        let targets: Vec<Target> = paths.iter().map(Target::prepare).collect::<Result<_>>()?;
        let mut seen = HashSet::new();
        match targets
            .iter()
            .find(|target| !seen.insert(target.place.identity()))
        {
            Some(twice) => {
                let message = format!("output {} is given twice", named(twice.path()));
                Err(Error::Usage(message))
            }
            None => Ok(targets),
        }
    }

    /// The path as it was given.
    pub fn path(&self) -> &Path {
        self.place.path()
    }

    /// What tells two outputs apart: see [`Place::identity`].
    pub fn identity(&self) -> PathBuf {
        self.place.identity()
    }

    pub fn format(&self) -> Format {
        self.format
    }

    /// Whether this is a device or a pipe, which holds what was written before too.
    pub fn is_stream(&self) -> bool {
        self.place.is_stream()
    }

    /// Writes the picture.
    ///
    /// # Errors
    /// [`Error::Write`]; a file that was there before is as it was then.
    pub fn write(self, picture: &Picture) -> Result<()> {
        if let Some(fault) = picture.fault() {
            return Err(Error::Internal(fault));
        }
        self.place.write(|sink| match self.format {
            Format::Png => write_png(picture, sink),
            Format::Exr => write_exr(picture, sink),
        })
    }
}

fn unknown_format(path: &Path) -> Error {
    let path = named(path);
    Error::Usage(format!(
        "output {path} must end in .png or .exr, which are the formats there are"
    ))
}

/// Names the outputs in a record, as they were given.
pub fn name_outputs(record: &mut Record, targets: &[Target]) {
    let name = |target: &Target| target.path().to_string_lossy().into_owned();
    record.outputs = targets.iter().map(name).collect();
}
