//! What the ledger says of a run.

use super::ledger::{Entry, Status};
use super::plan::Planned;
use crate::scene::Scene;
use serde_json::{Map, Value, json};

/// A line of the ledger. A run without a picture has its knobs all the same.
pub(super) fn entry(
    run: &Planned,
    scene: &Scene,
    record: Option<Map<String, Value>>,
    status: Status,
    error: Option<String>,
    attempts: u32,
) -> Entry {
    let value = |path: &str, text: &str| {
        scene
            .knobs
            .get(path)
            .cloned()
            .unwrap_or_else(|| text.into())
    };
    let swept: Map<String, Value> = run
        .point
        .values
        .iter()
        .map(|(path, text)| (path.clone(), value(path, text)))
        .collect();
    let mut entry = Map::new();
    entry.insert("id".into(), run.id.as_str().into());
    entry.insert("status".into(), status.name().into());
    entry.insert("error".into(), json!(error));
    entry.insert("attempts".into(), attempts.into());
    entry.insert("run".into(), run.number.into());
    entry.insert("repeat".into(), run.point.repeat.into());
    entry.insert("swept".into(), Value::Object(swept));
    match record {
        Some(record) => entry.extend(record),
        None => {
            entry.insert("knobs".into(), Value::Object(scene.knobs.clone()));
            entry.insert("seed".into(), scene.settings.render.seed.into());
        }
    }
    entry
}
