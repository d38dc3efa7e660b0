//! The folder that the studies were rendered to, read back.

use super::study::{Effort, Study, studies};
use crate::analysis::{Against, Analysis, Group, Quantity};
use crate::device::DeviceInfo;
use crate::error::{Error, Result};
use crate::place::Place;
use crate::shader::library_hash;
use crate::sweep::{Answer, Entry, Experiment, ReferenceRule};
use crate::wording::named;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The paper's three cases (section 2.2), in its order and by the knob's names.
pub const CASES: [&str; 3] = ["uniform-angles", "inverse-cosine", "gaussian"];

/// Points that figure 6 shows of each case.
pub const POINTS: u32 = 800;

/// What was rendered of the figures, with what, by their numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Made(pub BTreeMap<u32, MadeFigure>);

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MadeFigure {
    pub effort: Effort,
    pub device: DeviceInfo,
    /// Version of lampray and hash of its shaders: others render other runs.
    pub version: String,
    pub shaders: String,
}

impl MadeFigure {
    /// By this program.
    pub fn new(effort: Effort, device: DeviceInfo) -> Self {
        Self {
            effort,
            device,
            version: env!("CARGO_PKG_VERSION").into(),
            shaders: library_hash(),
        }
    }

    fn is_of_this_program(&self) -> bool {
        *self == Self::new(self.effort, self.device.clone())
    }
}

/// Everything that the figures are made of.
pub struct Data {
    pub made: Made,
    /// Figures that another version of lampray rendered, and that are left out.
    pub old: Vec<u32>,
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

/// Where it keeps what was rendered.
fn made_file(folder: &Path) -> PathBuf {
    folder.join("data").join("made.json")
}

impl Made {
    /// Numbers of figures that another version rendered, taken out.
    pub fn without_old(&mut self) -> Vec<u32> {
        let old = self.0.iter().filter(|(_, of)| !of.is_of_this_program());
        let old: Vec<u32> = old.map(|(number, _)| *number).collect();
        self.0.retain(|number, _| !old.contains(number));
        old
    }

    /// What a folder has; nothing where it is not there.
    ///
    /// # Errors
    /// [`Error::Data`] for a file that is something else.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = made_file(folder);
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Self::default()),
            Err(source) => return Err(Error::Input { path, source }),
        };
        serde_json::from_str(&text).map_err(|error| Error::Data {
            path,
            reason: error.to_string(),
        })
    }

    /// # Errors
    /// Those of writing the file.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(self);
        let text = text.map_err(|error| Error::Internal(error.to_string()))?;
        let place = Place::prepare(made_file(folder))?;
        place.write(|sink| sink.write_all((text + "\n").as_bytes()))
    }
}

impl Data {
    /// Reads what was rendered; renders nothing.
    ///
    /// # Errors
    /// [`Error::Usage`] where nothing was, [`Error::Input`] where a file is not there, [`Error::Data`] where
    /// it is not what it should be.
    pub fn read(folder: &Path) -> Result<Self> {
        let mut made = Made::read(folder)?;
        let old = made.without_old();
        if let (true, [_, ..]) = (made.0.is_empty(), old.as_slice()) {
            return Err(Error::Usage(format!(
                "{}: another version of lampray rendered this; lampray figures renders it again",
                named(folder)
            )));
        }
        if made.0.is_empty() {
            let path = made_file(folder);
            let source = std::io::Error::new(
                ErrorKind::NotFound,
                "no figure was rendered into this folder yet",
            );
            return Err(Error::Input { path, source });
        }
        let mut answers = Vec::new();
        for (number, of) in &made.0 {
            for study in studies(of.effort)
                .into_iter()
                .filter(|study| study.figure == *number)
            {
                let experiment = study.experiment(&of.device)?;
                let folder = study_folder(folder, &study);
                answers.push((study, Answer::read(&folder, &experiment, &mut |_, _| {})?));
            }
        }
        let read = |case: &str| match made.0.contains_key(&6) {
            true => points(&points_file(folder, case)),
            false => Ok(Vec::new()),
        };
        let [first, second, third] = CASES.map(read);
        Ok(Self {
            points: [first?, second?, third?],
            old,
            made,
            answers,
        })
    }

    /// Name of the device that traced a figure.
    pub fn device(&self, figure: u32) -> &str {
        self.made.0.get(&figure).map_or("", |of| &of.device.name)
    }

    /// Pages of a figure's sweeps, beside the page of the figures.
    pub fn pages(&self, figure: u32) -> Vec<String> {
        let mine = self
            .answers
            .iter()
            .filter(|(study, _)| study.figure == figure);
        mine.map(|(study, _)| format!("data/{}/report.html", study.name))
            .collect()
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
        let found = answer.analysis.as_ref();
        found.ok_or_else(|| missing(study, "no run can be read", answer))
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
            let what = format!("no run of {} can be read", list.join(", "));
            match self.answer(study) {
                Ok(answer) => missing(study, &what, answer),
                Err(error) => error,
            }
        })
    }

    /// What a group's error costs, region by region.
    ///
    /// # Errors
    /// As [`Data::group`].
    pub fn against(&self, study: &str, values: &[(&str, &str)]) -> Result<&[Against]> {
        let (place, _) = self.place(study, values)?;
        Ok(&self.analysis(study)?.against[place])
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

fn missing(study: &str, what: &str, answer: &Answer) -> Error {
    let why = answer.left_out.join(" ");
    Error::Usage(format!(
        "data/{study}: {what}. {why} lampray figures makes again what is missing, --draw-only does not."
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
