//! From TOML to a draft: which keys there are, and what each value is.

use super::draft::{Draft, Entry, Group};
use super::faults::{Faults, Origin};
use super::sweep;
use crate::knobs::{KNOBS, Knob, REPEATED, a, in_section, nearest, sections, short};
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

/// Spheres and boxes together.
pub const MOST_PRIMITIVES: usize = 1 << 20;
/// Materials: as many as a device numbers in 16 bits, and few enough to be told apart by name in no time.
pub const MOST_MATERIALS: usize = 1 << 16;
/// Longer texts are searched for their first syntax error only: each further one costs memory.
const RECOVERED: usize = 1 << 20;

type Key<'s> = Spanned<DeString<'s>>;

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
pub(super) fn ordered<'t, 's>(
    table: &'t DeTable<'s>,
) -> Vec<(&'t Key<'s>, &'t Spanned<DeValue<'s>>)> {
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

    fn top(&mut self, key: &Key<'_>, value: &Spanned<DeValue<'_>>, draft: &mut Draft) {
        let name = key.get_ref().as_ref();
        match name {
            "version" => return,
            "sweep" => {
                draft.sweep = sweep::read(value, self.faults);
                return;
            }
            _ => {}
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
                self.group(section, value, &mut draft.singles);
            }
        }
    }

    fn unknown_top(&mut self, key: &Key<'_>) {
        let name = key.get_ref().as_ref();
        self.faults.add(Origin::File(key.span()), || {
            let known = sections();
            let near = nearest(name, known.iter().copied().chain(["version", "sweep"]));
            let keys = KNOBS.iter().map(Knob::key);
            let elsewhere = nearest(name, keys).and_then(owner).map(|knob| knob.path);
            let note = suggestion([near, elsewhere.filter(|_| near.is_none())])
                .unwrap_or_else(|| format!("a scene holds version, sweep, {}", known.join(", ")));
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
        if table.len() > MOST_MATERIALS {
            let start = value.span().start;
            self.faults.add(Origin::File(start..start), || {
                let message = format!("more than {MOST_MATERIALS} materials");
                (message, Some("a scene holds 2^16 of them at most".into()))
            });
            return;
        }
        for (key, value) in ordered(table) {
            let name = key.get_ref().to_string();
            if let Some(reason) = bad_name(&name) {
                let message = format!("a material's name {reason}");
                self.faults
                    .add(Origin::File(key.span()), || (message, None));
            }
            let mut group = Group::new(name, Origin::File(value.span()));
            self.group("materials", value, &mut group);
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
            // Nothing else is said of such a list: a million faults would hide this one.
            self.faults.add(Origin::File(first.span()), || {
                let message = format!("more than {MOST_PRIMITIVES} spheres and boxes");
                (message, Some("a scene holds 2^20 of them at most".into()))
            });
            return;
        }
        self.primitives += items.len();
        let list = draft.list(section);
        list.reserve(items.len());
        for (number, item) in items.iter().enumerate() {
            let mut group = Group::new(number.to_string(), Origin::File(item.span()));
            self.group(section, item, &mut group);
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

    /// Reads the knobs of one table.
    fn group(&mut self, section: &'static str, value: &Spanned<DeValue<'_>>, group: &mut Group) {
        let DeValue::Table(table) = value.get_ref() else {
            let path = path(section, group);
            let wanted = match section {
                "spheres" | "boxes" => format!("a table: write [[{section}]]"),
                _ => format!("a table: write [{}]", short(&path)),
            };
            self.wrong_shape(value, &path, &wanted);
            return;
        };
        for (key, value) in ordered(table) {
            let name = key.get_ref().as_ref();
            match in_section(section).find(|knob| knob.key() == name) {
                Some(knob) => self.entry(knob, value, group),
                None => self.unknown(section, group, key),
            }
        }
    }

    fn entry(&mut self, knob: &'static Knob, value: &Spanned<DeValue<'_>>, group: &mut Group) {
        let origin = Origin::File(value.span());
        let value = match knob.read(value) {
            Ok(value) => Some(value),
            Err(refusal) => {
                self.faults.add(Origin::File(refusal.span), || {
                    let path = short(&path(knob.section(), group));
                    let message = format!("`{path}.{}` {}", knob.key(), refusal.reason);
                    (message, refusal.note)
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

    fn unknown(&mut self, section: &'static str, group: &Group, key: &Key<'_>) {
        let name = key.get_ref().as_ref();
        self.faults.add(Origin::File(key.span()), || {
            let known: Vec<_> = in_section(section).map(Knob::key).collect();
            let near = nearest(name, known.iter().copied());
            let elsewhere = owner(name).map(|knob| knob.path);
            let note = suggestion([near, elsewhere])
                .unwrap_or_else(|| format!("the keys here are {}", known.join(", ")));
            let path = short(&path(section, group));
            let message = format!("unknown key `{}` in `{path}`", short(name));
            (message, Some(note))
        });
    }
}

/// Where a group stands, for messages.
fn path(section: &str, group: &Group) -> String {
    if group.name.is_empty() {
        section.into()
    } else {
        format!("{section}.{}", group.name)
    }
}

/// The knob of another table that has this key.
fn owner(key: &str) -> Option<&'static Knob> {
    KNOBS.iter().find(|knob| knob.key() == key)
}

fn suggestion(names: [Option<&str>; 2]) -> Option<String> {
    match names {
        [Some(one), Some(two)] if one != two => {
            Some(format!("did you mean `{one}`, or the knob `{two}`?"))
        }
        [Some(one), _] | [None, Some(one)] => Some(format!("did you mean `{one}`?")),
        [None, None] => None,
    }
}

/// Why a material or a region cannot have this name, if it cannot.
pub(super) fn bad_name(name: &str) -> Option<&'static str> {
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
