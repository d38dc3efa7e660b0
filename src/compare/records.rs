//! What the records of two pictures say of how they are related.

use super::verdict::Relation;
use crate::film::Record;
use serde::Serialize;
use serde_json::Value;

/// Knobs that say which samples were taken, not of what.
const SAMPLING: [&str; 2] = ["render.samples", "render.seed"];

/// Knobs that change how the image is estimated, by the beginnings of their names.
const ESTIMATOR: [&str; 4] = ["light.", "scatter.", "interruption.", "image.filter"];

/// A knob that the two pictures have with two values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KnobDifference {
    pub knob: String,
    pub reference: Value,
    pub test: Value,
}

/// How two pictures are related.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Kinship {
    /// Knobs that differ, but for how many samples were taken and with which seed.
    pub knobs: Vec<KnobDifference>,
    /// What else differs: scene, shaders, device, crop.
    pub others: Vec<String>,
    /// Whether they were made of the same random numbers: same seed, and samples that both have.
    pub paired: bool,
    /// Whether they come from the same estimator: no knob of sampling differs.
    pub same_estimator: bool,
    /// Whether more differs than one knob under study.
    pub mixed: bool,
}

impl Kinship {
    /// What the verdict has to know of it.
    pub fn relation(&self) -> Relation {
        Relation {
            paired: self.paired,
            same_estimator: self.same_estimator,
        }
    }
}

/// Compares two records.
pub fn kinship(reference: &Record, test: &Record) -> Kinship {
    let knobs = differing_knobs(reference, test);
    let others = other_differences(reference, test);
    // Another device is not another picture. Of another text nobody knows whether it is more than the
    // knob that was changed in it.
    let confounds = [
        knobs.len() > 1,
        reference.shader_hash != test.shader_hash,
        reference.crop != test.crop,
    ];
    let samples = |knob: &KnobDifference| ESTIMATOR.iter().any(|part| knob.knob.starts_with(part));
    Kinship {
        same_estimator: !knobs.iter().any(samples),
        paired: reference.seed == test.seed && overlap(reference, test),
        mixed: confounds.contains(&true),
        knobs,
        others,
    }
}

fn differing_knobs(reference: &Record, test: &Record) -> Vec<KnobDifference> {
    let (a, b) = (&reference.knobs, &test.knobs);
    let only_b = b.keys().filter(|knob| !a.contains_key(*knob));
    let paths = a.keys().chain(only_b);
    let studied = paths.filter(|knob| !SAMPLING.contains(&knob.as_str()));
    let value = |knobs: &serde_json::Map<String, Value>, knob: &str| {
        knobs.get(knob).cloned().unwrap_or(Value::Null)
    };
    studied
        .filter(|knob| a.get(*knob) != b.get(*knob))
        .map(|knob| KnobDifference {
            knob: knob.clone(),
            reference: value(a, knob),
            test: value(b, knob),
        })
        .collect()
}

fn other_differences(reference: &Record, test: &Record) -> Vec<String> {
    let (a, b) = (reference, test);
    let device = |record: &Record| format!("{} ({})", record.device.name, record.device.driver);
    let crop = |record: &Record| {
        record
            .crop
            .map_or("none".into(), |crop| format!("{crop:?}"))
    };
    let denoised = |record: &Record| match &record.denoised {
        None => "no".to_string(),
        Some(denoised) => serde_json::to_string(&denoised.by).unwrap_or_default(),
    };
    let fields = [
        ("denoised", denoised(a), denoised(b)),
        ("shaders", a.shader_hash.clone(), b.shader_hash.clone()),
        ("lampray", a.version.clone(), b.version.clone()),
        ("device", device(a), device(b)),
        ("crop", crop(a), crop(b)),
    ];
    let differ = fields.into_iter().filter(|(_, a, b)| a != b);
    let text = (a.scene_hash != b.scene_hash)
        .then(|| "scene text: differs; spheres and boxes are not compared".to_string());
    text.into_iter()
        .chain(differ.map(|(what, a, b)| format!("{what}: {a} -> {b}")))
        .collect()
}

/// Whether some sample is in both. The ranges of a record stand in order and apart; a file may hold millions.
fn overlap(reference: &Record, test: &Record) -> bool {
    let others = test.ranges();
    let shares = |a: &[u64; 2]| {
        let next = others.partition_point(|b| b[1] <= a[0]);
        let mut next = others[next..].iter().skip_while(|b| b[0] == b[1]);
        a[0] < a[1] && next.next().is_some_and(|b| b[0] < a[1])
    };
    reference.ranges().iter().any(shares)
}
