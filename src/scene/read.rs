//! From TOML to a draft: which keys there are, and what each value is.

use super::draft::{Draft, Entry, Group};
use super::faults::{Faults, Origin};
use crate::knobs::{Knob, REPEATED, a, in_section, nearest, sections, short};
use std::collections::HashMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Spheres and boxes together.
pub const MOST_PRIMITIVES: usize = 1 << 20;
/// Longer texts are searched for their first syntax error only: each further one costs memory.
const RECOVERED: usize = 1 << 20;

type Keyed<'t, 's> = (
    &'t Spanned<toml::de::DeString<'s>>,
    &'t Spanned<DeValue<'s>>,
);

/// Reads the text of a scene file; what is wrong with it goes to `faults`. The flag says whether
/// all of the text is TOML, so that nothing of it is lost.
pub(crate) fn read(text: &str, faults: &mut Faults<'_>) -> (Draft, bool) {
    let mut draft = Draft::default();
    let Some(table) = parse(text, faults) else {
        return (draft, false);
    };
    let whole = faults.is_empty();
    let mut reader = Reader {
        faults,
        whole,
        primitives: 0,
    };
    reader.version(&table);
    for (key, value) in ordered(&table) {
        reader.top(key, value, &mut draft);
    }
    (draft, whole)
}

fn parse<'t>(text: &'t str, faults: &mut Faults<'_>) -> Option<DeTable<'t>> {
    let (table, errors) = if text.len() <= RECOVERED {
        let (table, errors) = DeTable::parse_recoverable(text);
        (Some(table.into_inner()), errors)
    } else {
        match DeTable::parse(text) {
            Ok(table) => (Some(table.into_inner()), Vec::new()),
            Err(error) => (None, vec![error]),
        }
    };
    let mut errors: Vec<_> = errors
        .into_iter()
        .map(|error| (error.span().unwrap_or(0..0), error.message().to_string()))
        .collect();
    errors.sort_by_key(|(span, _)| span.start);
    for (span, message) in errors {
        // The parser says what it would have liked; for a bare word that is the wrong advice.
        let message = message.replace(", expected literal string", "");
        faults.add_syntax(span, format!("this is not TOML: {message}"));
    }
    table
}

/// A table's entries in the order in which they were written.
fn ordered<'t, 's>(table: &'t DeTable<'s>) -> Vec<Keyed<'t, 's>> {
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    entries
}

struct Reader<'f, 'a> {
    faults: &'f mut Faults<'a>,
    /// Whether the whole text is TOML; if not, what seems to be missing may be in what was lost.
    whole: bool,
    primitives: usize,
}

impl Reader<'_, '_> {
    fn version(&mut self, table: &DeTable<'_>) {
        let Some(value) = table.get("version") else {
            if self.whole {
                self.faults.add(Origin::File(0..0), || {
                    let note = "write `version = 1` as the first line".to_string();
                    ("the scene has no version".into(), Some(note))
                });
            }
            return;
        };
        let one = value
            .get_ref()
            .as_integer()
            .is_some_and(|number| i128::from_str_radix(number.as_str(), number.radix()) == Ok(1));
        if !one {
            self.faults.add(Origin::File(value.span()), || {
                (
                    "`version` must be 1".into(),
                    Some("this lampray reads version 1 alone".into()),
                )
            });
        }
    }

    fn top(
        &mut self,
        key: &Spanned<toml::de::DeString<'_>>,
        value: &Spanned<DeValue<'_>>,
        draft: &mut Draft,
    ) {
        let name = key.get_ref().as_ref();
        if name == "version" {
            return;
        }
        let Some(section) = sections().into_iter().find(|section| *section == name) else {
            self.unknown_top(key);
            return;
        };
        match section {
            "materials" => self.materials(value, draft),
            shapes if REPEATED.contains(&shapes) => self.shapes(shapes, value, draft),
            _ => {
                let origin = Origin::File(value.span());
                draft.headers.push((section, origin));
                self.group(section, section, value, &mut draft.singles);
            }
        }
    }

    fn unknown_top(&mut self, key: &Spanned<toml::de::DeString<'_>>) {
        let name = key.get_ref().as_ref();
        self.faults.add(Origin::File(key.span()), || {
            let known = sections();
            let near = nearest(name, known.iter().copied().chain(["version"]));
            let note = match (near, owner(name)) {
                (Some(near), _) => format!("did you mean `{near}`?"),
                (None, Some(knob)) => format!("did you mean `{}`?", knob.path),
                (None, None) => format!("a scene holds version, {}", known.join(", ")),
            };
            (format!("unknown key `{}`", short(name)), Some(note))
        });
    }

    fn materials(&mut self, value: &Spanned<DeValue<'_>>, draft: &mut Draft) {
        let DeValue::Table(table) = value.get_ref() else {
            self.wrong_shape(
                value,
                "materials",
                "a table of materials: write [materials.NAME]",
            );
            return;
        };
        for (key, value) in ordered(table) {
            let name = key.get_ref().to_string();
            if let Some(reason) = bad_name(&name) {
                let message = format!("a material's name {reason}");
                self.faults
                    .add(Origin::File(key.span()), || (message, None));
            }
            let mut group = Group::new(name, Origin::File(value.span()));
            let path = format!("materials.{}", group.name);
            self.group("materials", &path, value, &mut group);
            draft.materials.push(group);
        }
    }

    fn shapes(&mut self, section: &'static str, value: &Spanned<DeValue<'_>>, draft: &mut Draft) {
        let items = match value.get_ref() {
            DeValue::Array(items) => items,
            _ => {
                self.wrong_shape(value, section, &format!("a list: write [[{section}]]"));
                return;
            }
        };
        let room = MOST_PRIMITIVES - self.primitives;
        if let Some(first) = items.get(room) {
            self.faults.add(Origin::File(first.span()), || {
                let message = format!("more than {MOST_PRIMITIVES} spheres and boxes");
                (message, Some("a scene holds 2^20 of them at most".into()))
            });
        }
        self.primitives += items.len().min(room);
        let list = draft.list(section);
        list.reserve(items.len().min(room));
        for (number, item) in items.iter().take(room).enumerate() {
            let mut group = Group::new(number.to_string(), Origin::File(item.span()));
            let path = format!("{section}.{number}");
            self.group(section, &path, item, &mut group);
            list.push(group);
        }
    }

    fn wrong_shape(&mut self, value: &Spanned<DeValue<'_>>, path: &str, wanted: &str) {
        self.faults.add(Origin::File(value.span()), || {
            let found = a(value.get_ref());
            (
                format!("`{}` must be {wanted}, not {found}", short(path)),
                None,
            )
        });
    }

    /// Reads the knobs of one table; `path` is where it stands, for messages.
    fn group(
        &mut self,
        section: &'static str,
        path: &str,
        value: &Spanned<DeValue<'_>>,
        group: &mut Group,
    ) {
        let DeValue::Table(table) = value.get_ref() else {
            let wanted = match section {
                "spheres" | "boxes" => format!("a table: write [[{section}]]"),
                _ => format!("a table: write [{}]", short(path)),
            };
            self.wrong_shape(value, path, &wanted);
            return;
        };
        for (key, value) in ordered(table) {
            let name = key.get_ref().as_ref();
            match in_section(section).find(|knob| knob.key() == name) {
                Some(knob) => self.entry(knob, path, value, group),
                None => self.unknown(section, path, key),
            }
        }
    }

    fn entry(
        &mut self,
        knob: &'static Knob,
        path: &str,
        value: &Spanned<DeValue<'_>>,
        group: &mut Group,
    ) {
        let origin = Origin::File(value.span());
        let value = match knob.read(value) {
            Ok(value) => Some(value),
            Err(refusal) => {
                let path = format!("{}.{}", short(path), knob.key());
                self.faults.add(Origin::File(refusal.span), || {
                    (format!("`{path}` {}", refusal.reason), refusal.note)
                });
                None
            }
        };
        group.set(Entry {
            knob,
            value,
            origin,
        });
    }

    fn unknown(&mut self, section: &str, path: &str, key: &Spanned<toml::de::DeString<'_>>) {
        let name = key.get_ref().as_ref();
        self.faults.add(Origin::File(key.span()), || {
            let known: Vec<_> = in_section(section).map(Knob::key).collect();
            let note = match (nearest(name, known.iter().copied()), owner(name)) {
                (Some(near), _) => format!("did you mean `{near}`?"),
                (None, Some(knob)) => format!("did you mean `{}`?", knob.path),
                (None, None) => format!("the keys here are {}", known.join(", ")),
            };
            let message = format!("unknown key `{}` in `{}`", short(name), short(path));
            (message, Some(note))
        });
    }
}

/// The knob of another table that has this key.
fn owner(key: &str) -> Option<&'static Knob> {
    crate::knobs::KNOBS.iter().find(|knob| knob.key() == key)
}

/// Why a material cannot have this name, if it cannot.
fn bad_name(name: &str) -> Option<&'static str> {
    if name.is_empty() {
        return Some("must not be empty");
    }
    if name.chars().count() > 256 {
        return Some("must have at most 256 characters");
    }
    // `--set materials.NAME.albedo=...` could not reach it, and messages would break.
    let unusable = |c: char| c == '=' || c.is_control();
    name.contains(unusable)
        .then_some("must not hold `=` or control characters")
}

/// Where each material, sphere, box and table stands, for warnings.
#[derive(Debug, Default)]
pub(crate) struct Places {
    pub(crate) tables: HashMap<String, std::ops::Range<usize>>,
}

impl Places {
    pub(crate) fn of(text: &str) -> Self {
        let mut tables = HashMap::new();
        let Ok(root) = DeTable::parse(text) else {
            return Self::default();
        };
        for (section, value) in root.get_ref() {
            let section = section.get_ref();
            tables.insert(section.to_string(), value.span());
            match value.get_ref() {
                DeValue::Table(table) => {
                    for (key, value) in table {
                        tables.insert(format!("{section}.{}", key.get_ref()), value.span());
                    }
                }
                DeValue::Array(items) => {
                    for (number, item) in items.iter().enumerate() {
                        tables.insert(format!("{section}.{number}"), item.span());
                    }
                }
                _ => {}
            }
        }
        Self { tables }
    }
}
