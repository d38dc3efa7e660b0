//! `table.csv`: one row a run, every knob a column, also those that are the same in all.

use super::ledger::Entry;
use serde_json::Value;
use std::collections::BTreeSet;

/// Columns of the record, after the sweep's own and before the knobs.
const FIELDS: [&str; 13] = [
    "scene",
    "scene_hash",
    "shader_hash",
    "version",
    "preset",
    "biased",
    "complete",
    "width",
    "height",
    "samples",
    "paths",
    "rays",
    "non_finite",
];
const CHANNELS: [&str; 3] = ["r", "g", "b"];

/// The table of a ledger's entries, in the order of the grid.
pub fn table(entries: &[Entry]) -> String {
    let mut entries: Vec<&Entry> = entries.iter().collect();
    entries.sort_by_key(|entry| entry.get("run").and_then(Value::as_u64));
    let knobs: BTreeSet<&str> = entries.iter().flat_map(|entry| knobs_of(entry)).collect();
    let mut text = row(header(&knobs).iter().map(String::as_str));
    for entry in entries {
        text += &row(cells(entry, &knobs).iter().map(String::as_str));
    }
    text
}

fn knobs_of(entry: &Entry) -> impl Iterator<Item = &str> {
    let knobs = entry.get("knobs").and_then(Value::as_object);
    knobs
        .into_iter()
        .flat_map(|knobs| knobs.keys().map(String::as_str))
}

fn header(knobs: &BTreeSet<&str>) -> Vec<String> {
    let mut names: Vec<String> = ["id", "status", "error", "attempts", "repeat"]
        .map(String::from)
        .into();
    names.extend(FIELDS.map(String::from));
    for field in ["mean", "standard_error"] {
        names.extend(CHANNELS.map(|channel| format!("{field}.{channel}")));
    }
    names.extend(["setup", "render", "total"].map(|name| format!("seconds.{name}")));
    names.extend(["kind", "name", "driver"].map(|name| format!("device.{name}")));
    names.extend(knobs.iter().map(|knob| (*knob).to_string()));
    names
}

fn cells(entry: &Entry, knobs: &BTreeSet<&str>) -> Vec<String> {
    let at = |path: &[&str]| {
        let first = entry.get(path[0]);
        path[1..].iter().fold(first, |value, key| match value {
            Some(Value::Array(items)) => items.get(CHANNELS.iter().position(|c| c == key)?),
            Some(value) => value.get(key),
            None => None,
        })
    };
    let mut cells: Vec<Option<&Value>> = ["id", "status", "error", "attempts", "repeat"]
        .iter()
        .map(|name| at(&[name]))
        .collect();
    cells.extend(FIELDS.iter().map(|name| at(&[name])));
    for field in ["mean", "standard_error"] {
        cells.extend(CHANNELS.iter().map(|channel| at(&[field, channel])));
    }
    cells.extend(
        ["setup", "render", "total"]
            .iter()
            .map(|name| at(&["seconds", name])),
    );
    cells.extend(
        ["kind", "name", "driver"]
            .iter()
            .map(|name| at(&["device", name])),
    );
    cells.extend(knobs.iter().map(|knob| at(&["knobs", knob])));
    cells.into_iter().map(plain).collect()
}

/// Text without its quotes; nothing for what is not there.
fn plain(value: Option<&Value>) -> String {
    match value {
        None | Some(Value::Null) => String::new(),
        Some(Value::String(text)) => text.clone(),
        Some(value) => value.to_string(),
    }
}

/// RFC 4180.
fn row<'a>(cells: impl Iterator<Item = &'a str>) -> String {
    let quoted = |cell: &str| match cell.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", cell.replace('"', "\"\"")),
        false => cell.to_string(),
    };
    cells.map(quoted).collect::<Vec<_>>().join(",") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn every_knob_is_a_column_and_every_run_a_row() {
        let entries: Vec<Entry> = [
            json!({"id": "b", "run": 1, "status": "failed", "error": "a \"bad\", thing", "knobs": {"x.y": [1, 2]}}),
            json!({"id": "a", "run": 0, "status": "ok", "mean": [0.5, 1, 2], "knobs": {"w": null}}),
        ]
        .into_iter()
        .filter_map(|value| value.as_object().cloned())
        .collect();
        let text = table(&entries);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(lines[0].starts_with("id,status,error,") && lines[0].ends_with(",w,x.y"));
        assert!(lines[1].starts_with("a,ok,,") && lines[1].contains(",0.5,1,2,"));
        assert!(
            lines[2].starts_with("b,failed,\"a \"\"bad\"\", thing\",")
                && lines[2].ends_with(",,\"[1,2]\"")
        );
    }
}
