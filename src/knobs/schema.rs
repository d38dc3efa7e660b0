//! A JSON Schema of the scene file, for editors that check TOML as it is typed.

use super::find::{REPEATED, in_section, sections};
use super::kind::{Kind, Range, Value};
use super::table::Knob;
use serde_json::{Map, Value as Json, json};

/// JSON Schema, draft 2020-12, made from the table of knobs.
pub fn schema() -> Json {
    let mut properties = Map::new();
    let version = json!({ "const": 1, "description": "version of the scene format" });
    properties.insert("version".into(), version);
    for section in sections() {
        let entry = match section {
            "materials" => json!({
                "type": "object",
                "description": "surfaces by name",
                "propertyNames": { "minLength": 1, "maxLength": 256 },
                "additionalProperties": object(section),
            }),
            shapes if REPEATED.contains(&shapes) => json!({
                "type": "array",
                "maxItems": 1 << 20,
                "items": object(section),
            }),
            _ => object(section),
        };
        properties.insert(section.into(), entry);
    }
    properties.insert("sweep".into(), sweep());
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "lampray scene",
        "description": "A scene file of lampray, a headless path tracer. Shapes are two-sided; y is up.",
        "type": "object",
        "properties": properties,
        "required": ["version", "camera"],
        "additionalProperties": false,
    })
}

/// `[sweep]`, which holds no knobs.
fn sweep() -> Json {
    let rect = json!({ "type": "array", "items": { "type": "integer", "minimum": 0 }, "minItems": 4, "maxItems": 4 });
    json!({
        "type": "object",
        "description": "what lampray sweep renders, where the command line does not say",
        "properties": {
            "set": { "type": "array", "items": { "type": "string" }, "description": "PATH=VALUES, as --set takes them" },
            "zip": { "type": "boolean", "description": "the values in step instead of every combination" },
            "seeds": { "type": "integer", "minimum": 1, "maximum": 1_000_000, "description": "repeats of each point" },
            "reference": { "type": ["string", "integer"], "description": "auto, none, samples a pixel, or an EXR: what runs are held against" },
            "regions": { "type": "object", "additionalProperties": rect, "description": "x0, y0, x1, y1 by name, in pixels of the size that the file states" },
        },
        "additionalProperties": false,
    })
}

/// A table of the scene file that holds the knobs of one section.
fn object(section: &str) -> Json {
    let properties: Map<_, _> = in_section(section)
        .map(|knob| (knob.key().to_string(), property(knob)))
        .collect();
    let required: Vec<_> = in_section(section)
        .filter(|knob| knob.default().is_none())
        .map(Knob::key)
        .collect();
    let mut object = json!({
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
    });
    if !required.is_empty() {
        object["required"] = json!(required);
    }
    object
}

fn property(knob: &Knob) -> Json {
    let mut property = kind(&knob.kind);
    property["description"] = match knob.unit {
        "" => json!(knob.meaning),
        unit => json!(format!("{} ({unit})", knob.meaning)),
    };
    property["default"] = match knob.default() {
        // A scene file says "off"; it has no null.
        Some(Value::Off) => json!("off"),
        Some(value) => value.to_json(),
        None => return property,
    };
    property
}

fn kind(kind: &Kind) -> Json {
    match kind {
        Kind::Integer { least, most } => {
            json!({ "type": "integer", "minimum": least, "maximum": most })
        }
        Kind::Number(range) => number(range),
        Kind::OptionalNumber(range) => {
            json!({ "anyOf": [number(range), { "enum": ["off", "absent"] }] })
        }
        Kind::Triple(range) => triple(range),
        Kind::Choice(names) => json!({ "enum": names }),
        Kind::Pole => json!({ "anyOf": [triple(&Range::ANY), { "const": "receiver" }] }),
        Kind::Material => json!({ "type": "string", "minLength": 1 }),
    }
}

fn number(range: &Range) -> Json {
    if range.open {
        json!({ "type": "number", "exclusiveMinimum": range.least, "exclusiveMaximum": range.most })
    } else {
        json!({ "type": "number", "minimum": range.least, "maximum": range.most })
    }
}

fn triple(range: &Range) -> Json {
    json!({ "type": "array", "items": number(range), "minItems": 3, "maxItems": 3 })
}
