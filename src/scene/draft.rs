//! A scene as it was written: every value that file or command line gave, with its origin, before
//! defaults and presets fill the rest.

use super::SweepTable;
use super::faults::Origin;
use crate::knobs::{Knob, Value, find};

/// Everything that was written.
#[derive(Debug, Default)]
pub(crate) struct Draft {
    /// Knobs that there is one of, from all tables together.
    pub(crate) singles: Group,
    /// The headers of their tables, to point at where something is missing.
    pub(crate) headers: Vec<(&'static str, Origin)>,
    pub(crate) materials: Vec<Group>,
    pub(crate) spheres: Vec<Group>,
    pub(crate) boxes: Vec<Group>,
    /// Paths below `spheres` and `boxes` that the command line set.
    pub(crate) set_shapes: Vec<String>,
    pub(crate) sweep: SweepTable,
}

/// The knobs of one table.
#[derive(Debug)]
pub(crate) struct Group {
    /// A material's name, a shape's number; empty for the singles.
    pub(crate) name: String,
    pub(crate) origin: Origin,
    pub(crate) entries: Vec<Entry>,
}

/// One knob as it was written.
#[derive(Debug)]
pub(crate) struct Entry {
    pub(crate) knob: &'static Knob,
    /// None if the value was refused; the fault has been noted.
    pub(crate) value: Option<Value>,
    pub(crate) origin: Origin,
}

impl Default for Group {
    fn default() -> Self {
        Self {
            name: String::new(),
            origin: Origin::Default,
            entries: Vec::new(),
        }
    }
}

impl Group {
    pub(crate) fn new(name: String, origin: Origin) -> Self {
        let entries = Vec::new();
        Self {
            name,
            origin,
            entries,
        }
    }

    pub(crate) fn entry(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.knob.key() == key)
    }

    /// The entry of a knob by its whole path; keys alone are not unique among the singles.
    pub(crate) fn by_path(&self, path: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.knob.path == path)
    }

    /// Where a key was set, or else where the group begins.
    pub(crate) fn origin(&self, key: &str) -> Origin {
        self.entry(key)
            .map_or(&self.origin, |entry| &entry.origin)
            .clone()
    }

    /// Lays a value over what is there.
    pub(crate) fn set(&mut self, new: Entry) {
        let old = |entry: &&mut Entry| std::ptr::eq(entry.knob, new.knob);
        match self.entries.iter_mut().find(old) {
            Some(entry) => *entry = new,
            None => self.entries.push(new),
        }
    }
}

impl Draft {
    /// Width and height as they stand here, or else the default.
    pub(crate) fn size(&self) -> [u32; 2] {
        ["image.width", "image.height"].map(|path| {
            let written = self.singles.by_path(path);
            let value = written.and_then(|entry| entry.value.as_ref());
            let default = find(path).and_then(|target| target.knob.default());
            let pixels = value.or(default).map_or(1, Value::integer);
            u32::try_from(pixels).unwrap_or(u32::MAX)
        })
    }

    pub(crate) fn list(&mut self, section: &str) -> &mut Vec<Group> {
        match section {
            "materials" => &mut self.materials,
            "spheres" => &mut self.spheres,
            _ => &mut self.boxes,
        }
    }
}
