//! Everything that a folder of figures holds.

use crate::error::Result;
use crate::figures::{About, Figure, page};
use crate::place::Place;
use std::path::Path;

/// A file's name and its bytes.
pub type NamedBytes = (String, Vec<u8>);

/// Every file, in the order in which they are written: the same figures make the same bytes.
///
/// # Errors
/// [`crate::Error::Internal`] where something cannot be encoded.
pub fn all(figures: &[Figure], about: &About) -> Result<Vec<NamedBytes>> {
    Ok(vec![
        (
            "index.html".into(),
            page::html(figures, about)?.into_bytes(),
        ),
        (
            "claims.md".into(),
            page::markdown(figures, about).into_bytes(),
        ),
    ])
}

/// Writes every file into a folder that is there, each whole or not at all; returns their names.
///
/// # Errors
/// [`crate::Error::Create`] or [`crate::Error::Write`] with the file, or what [`all`] says.
pub fn write(folder: &Path, figures: &[Figure], about: &About) -> Result<Vec<String>> {
    let files = all(figures, about)?;
    let mut places = Vec::with_capacity(files.len());
    for (name, _) in &files {
        places.push(Place::prepare(folder.join(name))?);
    }
    for (place, (_, bytes)) in places.into_iter().zip(&files) {
        place.write(|sink| sink.write_all(bytes))?;
    }
    Ok(files.into_iter().map(|(name, _)| name).collect())
}
