//! A sweep's answer as `--json` has it.

use crate::report::ReportData;
use crate::report::data::GroupData;
use crate::sweep::{ReferenceSummary, Summary};
use serde_json::{Map, Value, json};
use std::path::Path;

pub(super) fn json(
    folder: &Path,
    runs: Summary,
    references: &ReferenceSummary,
    data: &ReportData,
) -> Value {
    let own = json!({
        "made": references.made, "found": references.found, "failed": references.failed.len(),
    });
    let groups: Vec<Value> = data.groups.iter().map(|one| group(one, data)).collect();
    json!({
        "folder": folder, "made": runs.made, "skipped": runs.skipped, "failed": runs.failed,
        "stopped": runs.stopped || references.stopped, "references": own,
        "findings": data.findings, "groups": groups,
    })
}

/// What is of the whole picture stands beside the group's own numbers, what is of the other regions under their
/// names.
fn group(group: &GroupData, data: &ReportData) -> Value {
    let reference = group
        .reference
        .and_then(|number| data.references.get(number));
    let figures = group.regions.iter().map(|figures| json!(figures));
    let named = data.regions.iter().map(|region| region.name.clone());
    let mut regions: Map<String, Value> = named.zip(figures).skip(1).collect();
    let mut all = json!({
        "name": group.name, "values": group.values, "runs": group.runs, "samples": group.samples,
        "seconds": group.seconds, "reference": reference.map(|one| &one.name),
    });
    if let (Some(all), Some(Value::Object(whole))) = (
        all.as_object_mut(),
        group.regions.first().map(|whole| json!(whole)),
    ) {
        all.extend(whole);
        all.insert(
            "regions".into(),
            Value::Object(std::mem::take(&mut regions)),
        );
    }
    all
}
