//! Everything that a folder of figures holds.

use super::{About, Block, Figure, names, page, plot, sheet};
use crate::error::{Error, Result};
use crate::place::Place;
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::Path;

/// A file's name and its bytes.
pub type NamedBytes = (String, Vec<u8>);

/// Everything as data: the figures, and what made them.
#[derive(Serialize)]
struct Everything<'a> {
    about: &'a About,
    figures: &'a [Figure],
}

/// Every file, in the order in which they are written: the same figures make the same bytes.
///
/// # Errors
/// [`Error::Internal`] where something cannot be encoded, or two files would have one name.
pub fn all(figures: &[Figure], about: &About) -> Result<Vec<NamedBytes>> {
    let json = serde_json::to_string_pretty(&Everything { about, figures })
        .map_err(|error| Error::Internal(error.to_string()))?;
    let mut files: Vec<NamedBytes> = vec![
        (
            "index.html".into(),
            page::html(figures, about)?.into_bytes(),
        ),
        (
            "claims.md".into(),
            page::markdown(figures, about).into_bytes(),
        ),
        ("figures.json".into(), format!("{json}\n").into_bytes()),
    ];
    for figure in figures {
        files.extend(of_figure(figure)?);
    }
    let mut seen = BTreeSet::new();
    match files.iter().find(|(name, _)| !seen.insert(name)) {
        Some((name, _)) => Err(Error::Internal(format!("two files of figures are {name}"))),
        None => Ok(files),
    }
}

/// Sheets of pictures, plots and data.
fn of_figure(figure: &Figure) -> Result<Vec<NamedBytes>> {
    let mut files = Vec::new();
    for (block, names) in figure.blocks.iter().zip(names::of_blocks(figure)) {
        match block {
            Block::Pictures(pictures) => {
                let sheet = sheet::sheet(pictures)?;
                files.extend(names.into_iter().map(|name| (name, sheet.clone())));
            }
            Block::Plots(plots) => {
                let drawn = plots.plots.iter().map(|each| plot::svg(each).into_bytes());
                files.extend(names.into_iter().zip(drawn));
            }
            Block::Table(_) => {}
        }
    }
    let data = figure.data.iter();
    files.extend(data.map(|file| (names::of_data(file), file.csv.clone().into_bytes())));
    Ok(files)
}

/// Writes every file into a folder that is there, each whole or not at all; returns their names.
///
/// # Errors
/// [`Error::Create`] or [`Error::Write`] with the file, or what [`all`] says.
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
