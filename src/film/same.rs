//! Whether two records are of one render.

use super::record::Record;
use crate::knobs::short;
use serde_json::Value;

/// What two records do not agree in, and what each says.
pub(super) struct Difference {
    pub what: String,
    pub one: String,
    pub other: String,
}

/// The first thing, but for the knob `ignored`, in which two renders would trace other samples, whatever
/// their devices.
pub(super) fn difference(a: &Record, b: &Record, ignored: Option<&str>) -> Option<Difference> {
    let fields = [
        ("scene_hash", a.scene_hash.clone(), b.scene_hash.clone()),
        ("shader_hash", a.shader_hash.clone(), b.shader_hash.clone()),
        ("width", a.width.to_string(), b.width.to_string()),
        ("height", a.height.to_string(), b.height.to_string()),
        ("crop", format!("{:?}", a.crop), format!("{:?}", b.crop)),
        ("pilot", pilot(a), pilot(b)),
        ("seed", a.seed.to_string(), b.seed.to_string()),
    ];
    let field = fields.into_iter().find(|(_, one, other)| one != other);
    let field = field.map(|(what, one, other)| Difference {
        what: what.into(),
        one,
        other,
    });
    let found = field.or_else(|| knob(a, b, ignored))?;
    // It is for a message, and comes out of a file.
    Some(Difference {
        what: short(&found.what),
        one: short(&found.one),
        other: short(&found.other),
    })
}

fn pilot(record: &Record) -> String {
    let hash = record.pilot.as_ref().map(|pilot| pilot.hash.clone());
    hash.unwrap_or_else(|| "none".into())
}

fn knob(a: &Record, b: &Record, ignored: Option<&str>) -> Option<Difference> {
    let shown = |value: Option<&Value>| value.map_or("absent".into(), Value::to_string);
    let mut names = a.knobs.keys().chain(b.knobs.keys());
    let name = names
        .find(|name| Some(name.as_str()) != ignored && a.knobs.get(*name) != b.knobs.get(*name))?;
    Some(Difference {
        what: name.clone(),
        one: shown(a.knobs.get(name)),
        other: shown(b.knobs.get(name)),
    })
}
