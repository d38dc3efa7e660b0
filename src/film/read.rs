//! What lampray wrote: pictures to add up, records to render again.

use super::input::{Input, Kind};
use super::{Picture, Record, bytes, exr, png};
use crate::error::Result;
use std::path::Path;

/// Reads a picture from an EXR file that lampray wrote.
pub fn read_exr(path: impl AsRef<Path>) -> Result<Picture> {
    let path = path.as_ref();
    let mut input = Input::open(path)?;
    match input.kind(path)? {
        Kind::Exr => exr::read_picture(path, &mut input),
        Kind::Png => Err(bytes::data(
            path,
            "a PNG; sums and variances are in the EXR only",
        )),
    }
}

/// Reads the record, and the scene's text if it is there, from an EXR or PNG that lampray wrote.
pub fn read_record(path: impl AsRef<Path>) -> Result<(Record, Option<String>)> {
    let path = path.as_ref();
    let mut input = Input::open(path)?;
    match input.kind(path)? {
        Kind::Exr => exr::read_record(path, &mut input.reader),
        Kind::Png => png::read_record(path, &mut input.reader),
    }
}

/// Whether a file is a PNG and no EXR.
pub fn is_png(path: impl AsRef<Path>) -> Result<bool> {
    let path = path.as_ref();
    Ok(matches!(Input::open(path)?.kind(path)?, Kind::Png))
}
