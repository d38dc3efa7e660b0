//! The folder that the studies were rendered to, read back.

use super::study::{Effort, Study, studies};
use crate::analysis::{Analysis, Group, Quantity};
use crate::device::DeviceInfo;
use crate::error::{Error, Result};
use crate::sweep::{Answer, Entry, Experiment, ReferenceRule};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// The paper's three cases (section 2.2), in its order and by the knob's names.
pub const CASES: [&str; 3] = ["uniform-angles", "inverse-cosine", "gaussian"];

/// Points that figure 6 shows of each case.
pub const POINTS: u32 = 800;

/// Everything that the figures are made of.
pub struct Data {
    pub effort: Effort,
    pub device: DeviceInfo,
    /// Points of the paper's cases on the unit sphere.
    pub points: [Vec<[f64; 3]>; 3],
    answers: Vec<(Study, Answer)>,
}

impl Study {
    /// # Errors
    /// [`Error::Usage`] or [`Error::Scene`] where the table of studies has a mistake.
    pub fn experiment(&self, device: &DeviceInfo) -> Result<Experiment> {
        let rule = match self.reference {
            true => ReferenceRule::Auto,
            false => ReferenceRule::None,
        };
        Experiment::new(self.base()?, self.grid()?, device, &rule, None)
    }
}

/// Where a folder of figures keeps a study's sweep.
pub fn study_folder(folder: &Path, study: &Study) -> PathBuf {
    folder.join("data").join(study.name)
}

/// Where it keeps the points of a case.
pub fn points_file(folder: &Path, case: &str) -> PathBuf {
    folder.join("data").join(format!("fig6-{case}.csv"))
}

/// Where it keeps which device traced.
pub fn device_file(folder: &Path) -> PathBuf {
    folder.join("data").join("device.json")
}

impl Data {
    /// Reads what was rendered for some of the figures; renders nothing.
    ///
    /// # Errors
    /// [`Error::Input`] where a file is not there, [`Error::Data`] where it is not what it should be.
    pub fn read(folder: &Path, effort: Effort, figures: &[u32]) -> Result<Self> {
        let path = device_file(folder);
        let text = read(&path)?;
        let device: DeviceInfo = serde_json::from_str(&text).map_err(|error| Error::Data {
            path,
            reason: error.to_string(),
        })?;
        let answer = |study: Study| {
            let experiment = study.experiment(&device)?;
            let answer = Answer::read(&study_folder(folder, &study), &experiment, &mut |_, _| {})?;
            Ok((study, answer))
        };
        let wanted = |study: &Study| figures.contains(&study.figure);
        let read = |case: &str| match figures.contains(&6) {
            true => points(&points_file(folder, case)),
            false => Ok(Vec::new()),
        };
        let [first, second, third] = CASES.map(read);
        Ok(Self {
            effort,
            points: [first?, second?, third?],
            answers: studies(effort)
                .into_iter()
                .filter(wanted)
                .map(answer)
                .collect::<Result<_>>()?,
            device,
        })
    }

    /// Tracing time of all runs.
    pub fn seconds(&self) -> f64 {
        let entries = self.answers.iter().flat_map(|(_, answer)| &answer.entries);
        entries.filter_map(seconds).sum()
    }

    /// The commands of a figure's studies.
    pub fn commands(&self, figure: u32) -> Vec<String> {
        let mine = self
            .answers
            .iter()
            .filter(|(study, _)| study.figure == figure);
        mine.map(|(study, _)| study.command()).collect()
    }

    fn answer(&self, study: &str) -> Result<&Answer> {
        let found = self.answers.iter().find(|(each, _)| each.name == study);
        found
            .map(|(_, answer)| answer)
            .ok_or_else(|| Error::Internal(format!("no study is called {study}")))
    }

    /// What a study's pictures say.
    ///
    /// # Errors
    /// [`Error::Usage`] where it has none.
    pub fn analysis(&self, study: &str) -> Result<&Analysis> {
        let answer = self.answer(study)?;
        answer
            .analysis
            .as_ref()
            .ok_or_else(|| missing(study, "any run"))
    }

    /// The group whose swept knobs have these values.
    ///
    /// # Errors
    /// [`Error::Usage`] where no run of it is finished.
    pub fn group(&self, study: &str, values: &[(&str, &str)]) -> Result<&Group> {
        Ok(self.place(study, values)?.1)
    }

    fn place(&self, study: &str, values: &[(&str, &str)]) -> Result<(usize, &Group)> {
        let fits = |group: &Group| {
            let mut values = values.iter();
            values.all(|(path, wanted)| group.values.get(*path).is_some_and(|has| is(has, wanted)))
        };
        let mut groups = self.analysis(study)?.groups.iter().enumerate();
        groups.find(|(_, group)| fits(group)).ok_or_else(|| {
            let list: Vec<_> = values.iter().map(|(_, value)| *value).collect();
            missing(study, &list.join(", "))
        })
    }

    /// Sum of a number of the records over the runs of a group, such as `rays`.
    ///
    /// # Errors
    /// As [`Data::group`].
    pub fn sum(&self, study: &str, values: &[(&str, &str)], key: &str) -> Result<f64> {
        let (place, _) = self.place(study, values)?;
        let of = |entry: &Entry| entry.get(key).and_then(Value::as_f64).unwrap_or(0.0);
        Ok(self.answer(study)?.runs(place).map(of).sum())
    }

    /// Tracing time of each run of a group, seconds.
    ///
    /// # Errors
    /// As [`Data::group`].
    pub fn times(&self, study: &str, values: &[(&str, &str)]) -> Result<Vec<f64>> {
        let (place, _) = self.place(study, values)?;
        Ok(self
            .answer(study)?
            .runs(place)
            .filter_map(seconds)
            .collect())
    }

    /// Index of a region by its name.
    ///
    /// # Errors
    /// [`Error::Internal`] for a scene that has none of that name.
    pub fn region(&self, study: &str, name: &str) -> Result<usize> {
        let mut regions = self.analysis(study)?.question.regions().iter();
        regions
            .position(|region| region.name == name)
            .ok_or_else(|| Error::Internal(format!("{study} has no region called {name}")))
    }
}

fn seconds(entry: &Entry) -> Option<f64> {
    entry.get("seconds")?.get("render")?.as_f64()
}

/// Mean of the channels of a group's mean radiance in a region.
pub fn mean(group: &Group, region: usize) -> Quantity {
    Quantity::over(&group.regions[region].mean)
}

/// Mean of the channels of the variance of one sample.
pub fn variance(group: &Group, region: usize) -> Quantity {
    Quantity::over(&group.regions[region].variance)
}

fn missing(study: &str, what: &str) -> Error {
    Error::Usage(format!(
        "data/{study} lacks finished runs of {what}: run lampray figures without --draw-only"
    ))
}

/// Whether a knob's value in a record is the one that a text means.
fn is(value: &Value, wanted: &str) -> bool {
    match value {
        Value::String(text) => text == wanted,
        value => serde_json::from_str(wanted).is_ok_and(|wanted: Value| alike(value, &wanted)),
    }
}

/// Equality of numbers and lists of numbers, whether they are written as 1 or as 1.0.
fn alike(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| alike(a, b))
        }
        (a, b) => a == b || (a.as_f64().is_some() && a.as_f64() == b.as_f64()),
    }
}

fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).map_err(|source| Error::Input {
        path: path.into(),
        source,
    })
}

/// The first three columns of a CSV of `lampray points`.
fn points(path: &Path) -> Result<Vec<[f64; 3]>> {
    let text = read(path)?;
    let row = |line: &str| {
        let numbers = line.split(',').take(3).map(|cell| cell.parse().ok());
        let numbers: Option<Vec<f64>> = numbers.collect();
        numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok())
    };
    let rows: Option<Vec<_>> = text.lines().skip(1).map(row).collect();
    rows.filter(|rows| !rows.is_empty())
        .ok_or_else(|| Error::Data {
            path: path.into(),
            reason: "this is not a table of points".into(),
        })
}
