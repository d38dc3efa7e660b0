//! A sweep's folder read back: what its ledger and its pictures say. Nothing is rendered here.

use super::experiment::{Experiment, ReferenceOf, reference_file};
use super::grid::Grid;
use super::ledger::{Entry, Ledger, Status};
use super::plan::Planned;
use super::whole::image_file;
use crate::analysis::words::plain;
use crate::analysis::{Analysis, Question, Reference, Runs};
use crate::compare::verdict::Terms;
use crate::error::{Error, Result};
use crate::film::{Picture, read_exr};
use serde_json::{Map, Value};
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// What a folder holds of an experiment.
#[derive(Clone, Debug, Default)]
pub struct Answer {
    /// The ledger's lines of the experiment's runs, in the order of its grid, which `run`, `repeat` and `swept`
    /// follow, too: `seconds.render`, `paths` and `rays` of a run are here.
    pub entries: Vec<Entry>,
    /// None where no group could be analysed.
    pub analysis: Option<Analysis>,
    /// For each group of the analysis the entries that it is of: indices into `entries`.
    pub members: Vec<Vec<usize>>,
    /// What could not be analysed and why, in sentences.
    pub left_out: Vec<String>,
}

/// Sees the pictures of the runs, each with the index of its entry, as they are read.
pub type Look<'a> = dyn FnMut(usize, &Picture) + 'a;

impl Answer {
    /// Reads ledger, references and pictures, every file once and one picture of a run at a time: memory holds
    /// the references and three maps of each group.
    ///
    /// # Errors
    /// [`Error::Input`] for a ledger that cannot be read. A picture that cannot be read or does not belong to
    /// the others leaves its group out, and `left_out` says so.
    pub fn read(folder: &Path, experiment: &Experiment, look: &mut Look) -> Result<Self> {
        let of_id: HashMap<&str, &Planned> = experiment
            .plan
            .runs
            .iter()
            .map(|run| (run.id.as_str(), run))
            .collect();
        let mut entries = Ledger::open(folder)?.entries()?;
        entries.retain_mut(|entry| match of_id.get(text(entry, "id")) {
            Some(run) => {
                place(entry, run);
                true
            }
            None => false,
        });
        entries.sort_by_key(|entry| entry.get("run").and_then(Value::as_u64));
        let mut answer = Self {
            entries,
            ..Self::default()
        };
        let references = References::read(folder, experiment, &mut answer)?;
        let mut groups = gather(&answer.entries, &experiment.grid);
        for group in &mut groups {
            let first = group.runs.first().map(|run| &answer.entries[*run]);
            group.reference = first.and_then(|entry| references.of(text(entry, "id")));
        }
        answer.analyse(folder, experiment, groups, references.all, look)?;
        Ok(answer)
    }

    /// The entries of a group's runs.
    pub fn runs(&self, group: usize) -> impl Iterator<Item = &Entry> {
        self.members[group].iter().map(|run| &self.entries[*run])
    }

    /// Answers the question for every group whose pictures allow it.
    fn analyse(
        &mut self,
        folder: &Path,
        experiment: &Experiment,
        groups: Vec<Gathered>,
        references: Vec<Reference>,
        look: &mut Look,
    ) -> Result<()> {
        let sized = self.take_sized(groups, experiment.size);
        let regions = experiment.regions.clone();
        let terms = Terms::default();
        let question = Question::new(experiment.size, references, regions, terms, sized.len())?;
        let mut answered = Vec::new();
        for group in sized {
            let runs = collect(folder, &self.entries, &group, look);
            match runs.and_then(|runs| question.answer(runs, group.reference)) {
                Ok(one) => {
                    answered.push(one);
                    self.members.push(group.runs);
                }
                Err(error) => self.left_out.push(format!("Not analysed: {error}.")),
            }
        }
        if !answered.is_empty() {
            self.analysis = Some(Analysis::new(question, answered, None)?);
        }
        Ok(())
    }

    /// The groups that have finished runs of the size that is analysed; says which have not.
    fn take_sized(&mut self, groups: Vec<Gathered>, [width, height]: [u32; 2]) -> Vec<Gathered> {
        let (mut sized, mut unfinished, mut others) = (Vec::new(), Vec::new(), Vec::new());
        let side = |run: usize, key: &str| self.entries[run].get(key).and_then(Value::as_u64);
        for group in groups {
            match group.runs.first() {
                None => unfinished.push(group.name),
                Some(&run)
                    if side(run, "width") == Some(width.into())
                        && side(run, "height") == Some(height.into()) =>
                {
                    sized.push(group);
                }
                Some(_) => others.push(group.name),
            }
        }
        let size = format!("their pictures are not of the first run's size, {width} x {height}");
        for (names, reason) in [(unfinished, "no run is finished"), (others, &size)] {
            if !names.is_empty() {
                self.left_out
                    .push(format!("Not analysed, for {reason}: {}.", few(&names)));
            }
        }
        sized
    }
}

/// Some of the names, and how many more there are.
fn few(names: &[String]) -> String {
    const MOST: usize = 6;
    let shown = names[..names.len().min(MOST)].join("; ");
    match names.len().saturating_sub(MOST) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

/// Puts an entry where this plan has its run: another grid, which shares the folder, may have made it.
fn place(entry: &mut Entry, run: &Planned) {
    let knobs = entry.get("knobs").and_then(Value::as_object);
    let value = |path: &str| knobs.and_then(|knobs| knobs.get(path)).cloned();
    let axes = run.point.values.iter();
    let swept: Map<String, Value> = axes
        .map(|(path, text)| {
            let value = value(path).unwrap_or_else(|| text.as_str().into());
            (path.clone(), value)
        })
        .collect();
    entry.insert("swept".into(), Value::Object(swept));
    entry.insert("run".into(), run.number.into());
    entry.insert("repeat".into(), run.point.repeat.into());
}

/// The references that are there, and which of them each of the plan's runs has.
struct References<'e> {
    all: Vec<Reference>,
    of_run: HashMap<&'e str, usize>,
}

impl<'e> References<'e> {
    fn of(&self, id: &str) -> Option<usize> {
        self.of_run.get(id).copied()
    }

    fn read(folder: &Path, experiment: &'e Experiment, answer: &mut Answer) -> Result<Self> {
        let finished: HashSet<&str> = answer
            .entries
            .iter()
            .filter(|entry| is_ok(entry))
            .map(|entry| text(entry, "id"))
            .collect();
        let planned = experiment.own_references(&|run| finished.contains(run.id.as_str()))?;
        let (mut all, mut places, mut missing) = (Vec::new(), Vec::new(), Vec::new());
        for planned in &planned {
            let Some(planned) = planned else {
                places.push(None);
                continue;
            };
            let picture = read_exr(reference_file(folder, &planned.id, "exr"));
            match picture.and_then(|picture| Reference::new(&planned.name, picture)) {
                Ok(reference) => {
                    places.push(Some(all.len()));
                    all.push(reference);
                }
                Err(_) => {
                    places.push(None);
                    missing.push(planned.name.clone());
                }
            }
        }
        answer.left_out.extend(not_there(&missing));
        let of_run = experiment.reference_of_runs();
        let given = of_run.iter().flatten().find_map(|of| match of {
            ReferenceOf::Given(reference) => Some(*reference),
            ReferenceOf::Own(_) => None,
        });
        all.extend(given.cloned());
        let place = |of: &Option<ReferenceOf>| match of {
            Some(ReferenceOf::Given(_)) => Some(0),
            Some(ReferenceOf::Own(place)) => places[*place],
            None => None,
        };
        let runs = experiment.plan.runs.iter().zip(&of_run);
        Ok(Self {
            of_run: runs
                .filter_map(|(run, of)| Some((run.id.as_str(), place(of)?)))
                .collect(),
            all,
        })
    }
}

/// What is said of references that have not been made.
fn not_there(names: &[String]) -> Option<String> {
    let list = few(names);
    (!names.is_empty()).then(|| {
        format!(
            "Without bias and error, for it is not there yet: {list}; the same command makes it."
        )
    })
}

pub(super) fn text<'e>(entry: &'e Entry, key: &str) -> &'e str {
    entry.get(key).and_then(Value::as_str).unwrap_or_default()
}

fn is_ok(entry: &Entry) -> bool {
    text(entry, "status") == Status::Ok.name()
}

/// Runs that differ in their seed alone.
struct Gathered {
    name: String,
    values: Map<String, Value>,
    /// The finished ones: indices into the entries.
    runs: Vec<usize>,
    reference: Option<usize>,
}

/// More axes in step than this are a list of variants, and a group is called by what it changes.
const FEW: usize = 2;

/// Says which runs belong together.
fn gather(entries: &[Entry], grid: &Grid) -> Vec<Gathered> {
    let telling: Vec<&str> = grid.telling().map(|axis| axis.path.as_str()).collect();
    let variants = grid.zip && telling.len() > FEW;
    let mut groups: Vec<Gathered> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    for (number, entry) in entries.iter().enumerate() {
        let swept = entry.get("swept").and_then(Value::as_object);
        let mut shared = swept.cloned().unwrap_or_default();
        shared.shift_remove("render.seed");
        let key = Value::Object(shared.clone()).to_string();
        let place = *places.entry(key).or_insert_with(|| {
            let first = groups.first().map(|group| &group.values);
            groups.push(Gathered {
                name: match variants {
                    true => variant(&shared, first),
                    false => name(&shared, &telling),
                },
                values: shared,
                runs: Vec::new(),
                reference: None,
            });
            groups.len() - 1
        });
        if is_ok(entry) {
            groups[place].runs.push(number);
        }
    }
    groups
}

/// `cone, 16`: the values of the axes that tell groups apart, for a reader who knows the axes.
fn name(values: &Map<String, Value>, telling: &[&str]) -> String {
    let values = values.iter();
    let told = values.filter(|(path, _)| telling.contains(&path.as_str()));
    let all: Vec<String> = told.map(|(_, value)| plain(value)).collect();
    match all.is_empty() {
        true => "all runs".into(),
        false => all.join(", "),
    }
}

/// Of many knobs in step, those that have another value than in the first step.
fn variant(values: &Map<String, Value>, first: Option<&Map<String, Value>>) -> String {
    let Some(first) = first else {
        return "the first step".into();
    };
    let values = values.iter();
    let changed = values.filter(|(path, value)| first.get(*path) != Some(value));
    let all: Vec<String> = changed
        .map(|(path, value)| format!("{path}={}", plain(value)))
        .collect();
    all.join(", ")
}

/// Reads a group's pictures, one after another.
fn collect(folder: &Path, entries: &[Entry], group: &Gathered, look: &mut Look) -> Result<Runs> {
    let mut runs = Runs::new(&group.name, group.values.clone());
    for &number in &group.runs {
        let entry = &entries[number];
        let picture = read_exr(image_file(folder, text(entry, "id")))?;
        let seconds = entry.get("seconds").and_then(|all| all.get("render"));
        let seconds = seconds.and_then(Value::as_f64).unwrap_or(0.0);
        runs.add(&picture, seconds)?;
        look(number, &picture);
    }
    if runs.is_empty() {
        return Err(Error::Usage(format!("{}: no run is finished", group.name)));
    }
    Ok(runs)
}
