//! From a folder's answer to `report.html`.

use super::answer::{Answer, text};
use super::experiment::Experiment;
use super::grid::Grid;
use super::ledger::Entry;
use crate::analysis::picture_image;
use crate::error::Result;
use crate::film::Picture;
use crate::report::ReportData;
use crate::report::data::{AxisData, ImageData, RunData};
use serde_json::Value;
use std::path::Path;

/// Pictures of single runs that a report shows, and the bytes that they may take; those of groups come
/// besides.
const MOST_IMAGES: usize = 64;
const MOST_BYTES: usize = 8_000_000;
/// What a pixel takes in the page: three half floats in base64.
const PIXEL: usize = 8;

/// What the report is about.
#[derive(Clone, Debug, Default)]
pub struct About {
    pub title: String,
    /// The command that makes the sweep again.
    pub command: String,
    /// What is to be said beside what the data say, after it.
    pub findings: Vec<String>,
}

/// Reads the folder's pictures and says what they say.
///
/// # Errors
/// Those of [`Answer::read`].
pub fn report_data(folder: &Path, experiment: &Experiment, about: About) -> Result<ReportData> {
    let mut shown = Vec::new();
    let mut look = |entry: usize, picture: &Picture| {
        let room = (MOST_BYTES / (PIXEL * picture.pixels())).min(MOST_IMAGES);
        if shown.len() < room {
            shown.push((entry, picture_image("", picture)));
        }
    };
    let answer = Answer::read(folder, experiment, &mut look)?;
    let grid = &experiment.grid;
    let mut data = ReportData {
        title: about.title,
        question: question(grid),
        command: about.command,
        version: env!("CARGO_PKG_VERSION").into(),
        axes: grid.axes.iter().map(axis).collect(),
        runs: answer.entries.iter().map(run).collect(),
        ..ReportData::default()
    };
    for (group, members) in answer.members.iter().enumerate() {
        members
            .iter()
            .for_each(|run| data.runs[*run].group = Some(group));
    }
    show(shown, &answer, &mut data);
    if let Some(analysis) = &answer.analysis {
        analysis.fill(&mut data);
    }
    data.findings.extend(answer.left_out);
    data.findings.extend(about.findings);
    Ok(data)
}

/// Names the pictures of single runs and puts them first.
fn show(shown: Vec<(usize, ImageData)>, answer: &Answer, data: &mut ReportData) {
    for (entry, image) in shown {
        let run = &mut data.runs[entry];
        let groups = answer.analysis.iter().flat_map(|all| &all.groups);
        let group = run.group.and_then(|group| groups.clone().nth(group));
        let name = group.map_or("not analysed", |group| &group.name);
        run.image = Some(data.images.len());
        data.images.push(ImageData {
            name: format!("{name}, seed {}", run.seed),
            ..image
        });
    }
}

fn question(grid: &Grid) -> String {
    let paths: Vec<&str> = grid.telling().map(|axis| axis.path.as_str()).collect();
    match paths.as_slice() {
        [] => "How much does the seed change?".into(),
        [path] => format!("What does {path} change?"),
        paths => format!("What do {} change?", paths.join(" and ")),
    }
}

fn axis(axis: &super::axis::Axis) -> AxisData {
    AxisData {
        path: axis.path.clone(),
        values: axis.values.clone(),
    }
}

fn run(entry: &Entry) -> RunData {
    let number = |key: &str| entry.get(key).and_then(Value::as_u64).unwrap_or(0);
    let triple = |key: &str| {
        let all = entry.get(key)?;
        let at = |index: usize| all.get(index).and_then(Value::as_f64);
        Some([at(0)?, at(1)?, at(2)?])
    };
    let inside = |key: &str, name: &str| entry.get(key).and_then(|value| value.get(name));
    let swept = entry.get("swept").and_then(Value::as_object);
    RunData {
        id: text(entry, "id").into(),
        status: text(entry, "status").into(),
        error: entry.get("error").and_then(Value::as_str).map(String::from),
        values: swept.cloned().unwrap_or_default(),
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
        mean: triple("mean").unwrap_or_default(),
        standard_error: triple("standard_error"),
        group: None,
        image: None,
    }
}
