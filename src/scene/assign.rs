//! Values from the command line, laid over those of the scene file.

use super::draft::{Draft, Entry, Group};
use super::faults::{Faults, Origin};
use crate::error::{Error, Result};
use crate::knobs::{Kind, Target, Value, find, nearest, short, unknown};
use std::collections::{HashMap, HashSet};
use toml::Spanned;
use toml::de::DeValue;

/// A knob that the command line or a record sets.
#[derive(Clone, Debug, PartialEq)]
pub struct Assignment {
    /// The knob's path, with names and numbers: `materials.white.albedo`.
    pub path: String,
    /// TOML, or a bare word.
    pub value: String,
    /// What the user typed, for messages: `--set light.sampler=cone`, `--width 64`.
    pub flag: String,
}

impl Assignment {
    /// An assignment by a flag of its own, such as `--width 64`.
    pub fn new(path: impl Into<String>, value: impl Into<String>, flag: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            value: value.into(),
            flag: flag.into(),
        }
    }

    /// Reads the `PATH=VALUE` of `--set`.
    pub fn parse(text: &str) -> Result<Self> {
        let Some((path, value)) = text.split_once('=') else {
            let message = format!(
                "--set {}: write PATH=VALUE, for example --set light.sampler=cone",
                short(text)
            );
            return Err(Error::Knob(message));
        };
        let flag = format!("--set {}", short(text));
        Ok(Self::new(path.trim(), value.trim(), flag))
    }

    /// A knob as a record holds it; null turns an optional number off.
    pub fn from_record(path: &str, value: &serde_json::Value) -> Self {
        let value = match value {
            serde_json::Value::Null => "off".into(),
            // JSON's own notation for text, numbers and lists of numbers is TOML too.
            other => other.to_string(),
        };
        let flag = format!("the record's {} = {}", short(path), short(&value));
        Self::new(path, value, flag)
    }
}

/// Lays the assignments over the draft, in order: the last one for a path holds.
pub(crate) fn apply(assignments: &[Assignment], draft: &mut Draft, faults: &mut Faults<'_>) {
    let mut target = Over {
        numbers: numbers(&draft.materials),
        set: HashSet::new(),
        draft,
    };
    for (number, assignment) in assignments.iter().enumerate() {
        let origin = Origin::Flag(number);
        if let Err((message, note)) = target.apply(assignment, origin.clone()) {
            faults.add(origin, || (message, note));
        }
    }
}

/// The draft, with what finds its parts at once: a record may hold a hundred thousand knobs.
struct Over<'d> {
    draft: &'d mut Draft,
    /// Materials by name.
    numbers: HashMap<String, usize>,
    /// What is in the draft's list of paths of shapes.
    set: HashSet<String>,
}

fn numbers(materials: &[Group]) -> HashMap<String, usize> {
    let named = materials.iter().enumerate();
    named
        .map(|(number, one)| (one.name.clone(), number))
        .collect()
}

/// A value, or a reason and perhaps a remedy.
type Attempt<T> = std::result::Result<T, (String, Option<String>)>;

impl Over<'_> {
    fn apply(&mut self, assignment: &Assignment, origin: Origin) -> Attempt<()> {
        let path = assignment.path.as_str();
        let target = find(path).ok_or_else(|| (unknown(path), None))?;
        let knob = target.knob;
        let refused = |(reason, note)| (format!("`{}` {reason}", short(path)), note);
        let Some(item) = target.item else {
            let value = Some(read(target, &assignment.value).map_err(refused)?);
            self.draft.singles.set(Entry {
                knob,
                value,
                origin,
            });
            return Ok(());
        };
        let section = knob.section();
        let group = self.item(section, item)?;
        let value = Some(read(target, &assignment.value).map_err(refused)?);
        group.set(Entry {
            knob,
            value,
            origin,
        });
        let path = format!("{section}.{}.{}", group.name, knob.key());
        if section != "materials" && self.set.insert(path.clone()) {
            self.draft.set_shapes.push(path);
        }
        Ok(())
    }

    /// The material of this name, or the sphere or box of this number.
    fn item(&mut self, section: &str, item: &str) -> Attempt<&mut Group> {
        let list = self.draft.list(section);
        let count = list.len();
        if section != "materials" {
            let number = item.parse::<usize>().ok().filter(|number| *number < count);
            return match number.and_then(|number| list.get_mut(number)) {
                Some(group) => Ok(group),
                None => Err((no_number(section, item, count), None)),
            };
        }
        match self.numbers.get(item) {
            Some(number) => Ok(&mut list[*number]),
            None => {
                let names = list.iter().map(|group| group.name.as_str());
                let note = match nearest(item, names.clone()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => there_are(names, count),
                };
                let message = format!("the scene has no material `{}`", short(item));
                Err((message, Some(note)))
            }
        }
    }
}

/// What a path may name instead of a material that is not there. Of many only the first are looked at: there may be a
/// hundred thousand such paths.
fn there_are<'n>(names: impl Iterator<Item = &'n str>, count: usize) -> String {
    const MOST: usize = 8;
    let names = names.take(MOST).map(|name| format!("`{}`", short(name)));
    let shown = names.collect::<Vec<_>>().join(", ");
    let remedy = "write new ones into the scene file";
    match count {
        0 => format!("it has none: {remedy}"),
        1..=MOST => format!("it has {shown}; {remedy}"),
        _ => format!("it has {shown} and {} more; {remedy}", count - MOST),
    }
}

fn no_number(section: &str, item: &str, count: usize) -> String {
    let item = short(item);
    match count {
        0 => format!("the scene has no {section}"),
        1 => format!("there is no {section}.{item}: the scene has one of them, number 0"),
        _ => format!(
            "there is no {section}.{item}: the scene has {count} of them, 0 to {}",
            count - 1
        ),
    }
}

/// The value in its knob's kind; where the knob takes names, a bare word is one.
fn read(target: Target<'_>, text: &str) -> Attempt<Value> {
    if text.is_empty() {
        return Err(("has no value".into(), None));
    }
    let parsed = DeValue::parse(text);
    let names = matches!(target.knob.kind, Kind::Choice(_) | Kind::Material);
    let value = match parsed {
        Ok(value) if value.get_ref().is_str() || !names => value,
        _ => Spanned::new(0..text.len(), DeValue::String(text.into())),
    };
    let refused = |refusal: crate::knobs::Refusal| (refusal.reason, refusal.note);
    target.knob.read(&value).map_err(refused)
}
