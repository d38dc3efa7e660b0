//! From a folder's ledger and pictures to `report.html`.

use super::grid::Grid;
use super::ledger::{Entry, Status};
use crate::analysis::{Analysis, Question, Reference, Region, Runs, picture_image};
use crate::compare::verdict::Terms;
use crate::error::{Error, Result};
use crate::film::{Picture, read_exr};
use crate::report::ReportData;
use crate::report::data::{AxisData, RunData};
use serde_json::{Map, Value};
use std::collections::HashSet;
use std::path::Path;

/// Pictures of single runs that a report shows, and the bytes that they may take; those of groups come
/// besides.
const MOST_IMAGES: usize = 64;
const MOST_BYTES: usize = 8 << 20;
/// What a pixel takes in the page: three half floats in base64.
const PIXEL: usize = 8;

/// What the report is about.
pub struct About<'a> {
    pub title: String,
    /// The command that makes the sweep again.
    pub command: String,
    pub grid: &'a Grid,
    /// Ids of the runs that belong to it; the folder may hold others.
    pub ids: HashSet<&'a str>,
    pub regions: Vec<Region>,
    pub reference: Option<Reference>,
}

/// Reads the pictures one after another and analyses them.
///
/// # Errors
/// [`Error::Usage`] for a reference or a region that does not fit. Groups that cannot be analysed are
/// left out, and a finding says so.
pub fn report_data(folder: &Path, entries: &[Entry], about: About) -> Result<ReportData> {
    let mut data = ReportData {
        title: about.title,
        question: question(about.grid),
        command: about.command,
        version: env!("CARGO_PKG_VERSION").into(),
        axes: about.grid.axes.iter().map(axis).collect(),
        ..ReportData::default()
    };
    let mut mine: Vec<&Entry> = entries
        .iter()
        .filter(|entry| about.ids.contains(text(entry, "id")))
        .collect();
    mine.sort_by_key(|entry| entry.get("run").and_then(Value::as_u64));
    let mut groups = gather(&mine, &mut data);
    let left_out = analyse(
        folder,
        &mine,
        &mut groups,
        about.regions,
        about.reference,
        &mut data,
    )?;
    data.findings.extend(left_out);
    Ok(data)
}

fn question(grid: &Grid) -> String {
    let paths: Vec<&str> = grid.axes.iter().map(|axis| axis.path.as_str()).collect();
    match paths.as_slice() {
        [] => "How much does the seed change?".into(),
        paths => format!("What do {} change?", paths.join(" and ")),
    }
}

fn axis(axis: &super::axis::Axis) -> AxisData {
    AxisData {
        path: axis.path.clone(),
        values: axis.values.clone(),
    }
}

fn text<'e>(entry: &'e Entry, key: &str) -> &'e str {
    entry.get(key).and_then(Value::as_str).unwrap_or_default()
}

fn is_ok(entry: &Entry) -> bool {
    text(entry, "status") == Status::Ok.name()
}

/// Runs that differ in their seed alone.
struct Gathered {
    name: String,
    values: Map<String, Value>,
    /// Indices into the runs.
    runs: Vec<usize>,
}

/// Fills the rows of the runs, and says which belong together.
fn gather(entries: &[&Entry], data: &mut ReportData) -> Vec<Gathered> {
    let mut groups: Vec<Gathered> = Vec::new();
    for (number, entry) in entries.iter().enumerate() {
        let values = entry
            .get("swept")
            .and_then(Value::as_object)
            .cloned()
            .unwrap_or_default();
        let mut shared = values.clone();
        shared.shift_remove("render.seed");
        let place = match groups.iter().position(|group| group.values == shared) {
            Some(place) => place,
            None => {
                groups.push(Gathered {
                    name: name(&shared),
                    values: shared,
                    runs: Vec::new(),
                });
                groups.len() - 1
            }
        };
        groups[place].runs.push(number);
        data.runs.push(run(entry, values));
    }
    groups
}

/// `cone, 16`: the values, for a reader who knows the axes.
fn name(values: &Map<String, Value>) -> String {
    let plain = |value: &Value| match value {
        Value::String(text) => text.clone(),
        value => value.to_string(),
    };
    let all: Vec<String> = values.values().map(plain).collect();
    if all.is_empty() {
        "all runs".into()
    } else {
        all.join(", ")
    }
}

fn run(entry: &Entry, values: Map<String, Value>) -> RunData {
    let number = |key: &str| entry.get(key).and_then(Value::as_u64).unwrap_or(0);
    let triple = |key: &str| {
        let at = |index: usize| {
            entry
                .get(key)
                .and_then(|value| value.get(index))
                .and_then(Value::as_f64)
        };
        [0, 1, 2].map(|index| at(index).unwrap_or(0.0))
    };
    let inside = |key: &str, name: &str| entry.get(key).and_then(|value| value.get(name));
    RunData {
        id: text(entry, "id").into(),
        status: text(entry, "status").into(),
        error: entry.get("error").and_then(Value::as_str).map(String::from),
        values,
        seed: number("seed"),
        samples: number("samples"),
        device: inside("device", "name")
            .and_then(Value::as_str)
            .unwrap_or_default()
            .into(),
        seconds: inside("seconds", "render")
            .and_then(Value::as_f64)
            .unwrap_or(0.0),
        paths: number("paths"),
        rays: number("rays"),
        mean: triple("mean"),
        standard_error: triple("standard_error"),
        group: None,
        image: None,
    }
}

/// Answers the question for every group whose pictures allow it; returns what is to be said of the others.
fn analyse(
    folder: &Path,
    entries: &[&Entry],
    groups: &mut Vec<Gathered>,
    regions: Vec<Region>,
    reference: Option<Reference>,
    data: &mut ReportData,
) -> Result<Vec<String>> {
    let mut left_out = Vec::new();
    let mut collected: Vec<(Runs, Vec<usize>)> = Vec::new();
    for group in groups.drain(..) {
        match collect(folder, entries, &group, data) {
            Ok(runs) => collected.push((runs, group.runs)),
            Err(error) => left_out.push(format!("Not analysed: {error}.")),
        }
    }
    let Some(size) = data.images.first().map(|image| [image.width, image.height]) else {
        return Ok(left_out);
    };
    let question = Question::new(size, reference, regions, Terms::default(), collected.len())?;
    let mut answered = Vec::new();
    for (runs, members) in collected {
        let name = runs.name.clone();
        match question.answer(runs) {
            Ok(group) => {
                members
                    .iter()
                    .for_each(|run| data.runs[*run].group = Some(answered.len()));
                answered.push(group);
            }
            Err(error) => left_out.push(format!("Not analysed: {name}: {error}.")),
        }
    }
    if !answered.is_empty() {
        Analysis::new(question, answered, None)?.fill(data);
    }
    Ok(left_out)
}

/// Reads a group's pictures, one after another.
fn collect(
    folder: &Path,
    entries: &[&Entry],
    group: &Gathered,
    data: &mut ReportData,
) -> Result<Runs> {
    let mut runs = Runs::new(&group.name, group.values.clone());
    for &number in group.runs.iter().filter(|run| is_ok(entries[**run])) {
        let picture = picture(folder, entries[number])?;
        let row = &mut data.runs[number];
        runs.add(&picture, row.seconds)?;
        let room = (MOST_BYTES / (PIXEL * picture.pixels())).min(MOST_IMAGES);
        if data.images.len() < room.max(1) {
            row.image = Some(data.images.len());
            let name = format!("{}, seed {}", group.name, row.seed);
            data.images.push(picture_image(&name, &picture));
        }
    }
    if runs.is_empty() {
        return Err(Error::Usage(format!("{}: no run is finished", group.name)));
    }
    Ok(runs)
}

fn picture(folder: &Path, entry: &Entry) -> Result<Picture> {
    read_exr(
        folder
            .join("images")
            .join(format!("{}.exr", text(entry, "id"))),
    )
}
