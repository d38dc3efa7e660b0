//! What a benchmark found, as `--json` prints it and `--against` reads it.

use super::against::Against;
use super::machine::Machine;
use super::measure::Measured;
use super::order::{Axis, Cell, Order};
use super::spread::{Spread, ratios};
use super::subject::Subject;
use crate::device::DeviceInfo;
use crate::error::{Error, Result};
use crate::shader::Library;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A whole benchmark's outcome.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Version of lampray.
    pub version: String,
    pub shader_hash: String,
    /// The shaders themselves, so that a later build can measure them beside its own; absent in older reports.
    #[serde(default)]
    pub shaders: Option<Library>,
    pub machine: Machine,
    /// Measurements that count, of each row that was finished.
    pub repeats: u32,
    /// About how long each was meant to take.
    pub seconds: f64,
    /// Knobs over what each scene says, as `PATH=VALUE`.
    pub set: Vec<String>,
    /// False where it was stopped early.
    pub complete: bool,
    pub rows: Vec<Row>,
    pub ratios: Vec<Ratio>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub against: Option<Against>,
}

/// What became of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    Measured,
    /// The device cannot trace this scene.
    Refused,
    /// The device was lost.
    Failed,
    /// Stopped before the first measurement that counts.
    Stopped,
}

/// One scene on one device by one preset and kernel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub scene: String,
    /// Spheres and boxes.
    pub primitives: usize,
    /// The device's short name in this run.
    pub device: String,
    pub device_info: DeviceInfo,
    pub preset: String,
    /// Absent where the renderer chose.
    pub kernel: Option<String>,
    /// `then` or `now`, where an earlier build's shaders were measured beside this one's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shaders: Option<String>,
    pub status: Status,
    /// Why it was not measured.
    pub reason: Option<String>,
    #[serde(flatten)]
    pub figures: Option<Figures>,
}

/// A measured row's numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// The kernel that traced; empty in older reports.
    #[serde(default)]
    pub traced_by: String,
    pub width: u32,
    pub height: u32,
    /// Paths a pixel of each measurement.
    pub samples: u64,
    pub rays_per_sample: f64,
    /// Millions a second of tracing.
    pub mrays: Spread,
    pub msamples: Spread,
    /// Seconds from the scene to flat buffers.
    pub pack: Spread,
    /// Seconds of pipelines, upload and first dispatch on a fresh device.
    pub compile: Spread,
    /// The same at the first time of all, before the driver's cache can have had it from this run.
    pub first_compile: f64,
    /// Share of a render that is not tracing.
    pub outside: Spread,
    /// Bytes that the process held at most; absent where the system does not say.
    pub peak: Option<Spread>,
}

/// One value of an axis against its first, all else equal, within this run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ratio {
    pub scene: String,
    pub axis: Axis,
    pub of: String,
    pub to: String,
    /// The values of the other axes, of those that have several.
    pub at: Vec<String>,
    /// Of rays a second, turn by turn.
    pub mrays: Spread,
    /// Of paths a second.
    pub msamples: Spread,
}

/// What was gathered of a cell: the measurements of each turn, and why there are no more.
#[derive(Clone, Debug)]
pub(super) struct Gathered {
    pub cell: Cell,
    /// The load of the first try.
    pub first_compile: f64,
    pub turns: Vec<Option<Measured>>,
    pub trouble: Option<(Status, String)>,
}

impl Report {
    /// A report without rows.
    pub(super) fn new(order: &Order) -> Self {
        let set = order.assignments.iter();
        Self {
            version: env!("CARGO_PKG_VERSION").into(),
            shader_hash: crate::shader::library_hash(),
            shaders: Some(Library::default()),
            machine: Machine::here(),
            repeats: order.repeats,
            seconds: order.seconds,
            set: set
                .map(|set| format!("{}={}", set.path, set.value))
                .collect(),
            complete: true,
            rows: Vec::new(),
            ratios: Vec::new(),
            against: None,
        }
    }

    /// Adds what was gathered of one scene.
    pub(super) fn add(
        &mut self,
        order: &Order,
        subject: &Subject,
        primitives: usize,
        cells: &[Gathered],
    ) {
        for found in cells {
            self.rows.push(row(order, subject, primitives, found));
        }
        for axis in Axis::ALL {
            let paired = cells.iter().filter_map(|found| {
                let base = found.cell.base(axis)?;
                let base = cells.iter().find(|other| other.cell == base)?;
                ratio(order, subject, axis, found, base)
            });
            self.ratios.extend(paired);
        }
    }

    /// Reads what `--json` printed.
    ///
    /// # Errors
    /// [`Error::Input`]; [`Error::Data`] where it is something else.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|source| Error::Input {
            path: path.into(),
            source,
        })?;
        serde_json::from_str(&text).map_err(|fault| Error::Data {
            path: path.into(),
            reason: format!("not what `lampray bench --json` prints: {fault}"),
        })
    }

    /// One page of JSON.
    pub fn to_json(&self) -> String {
        // Keys are strings and no value can fail to be written, so there is no error to report.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

fn row(order: &Order, subject: &Subject, primitives: usize, found: &Gathered) -> Row {
    let device = &order.devices[found.cell.device];
    let figures = figures(found);
    let (status, reason) = match (&found.trouble, &figures) {
        (Some((status, reason)), _) => (*status, Some(reason.clone())),
        (None, Some(_)) => (Status::Measured, None),
        (None, None) => (Status::Stopped, None),
    };
    Row {
        scene: subject.name(),
        primitives,
        device: device.label.clone(),
        device_info: device.info.clone(),
        preset: order.presets[found.cell.preset].to_string(),
        kernel: order.kernels[found.cell.kernel].clone(),
        shaders: order
            .several(Axis::Shaders)
            .then(|| order.label(found.cell, Axis::Shaders))
            .flatten(),
        status,
        reason,
        figures,
    }
}

fn figures(found: &Gathered) -> Option<Figures> {
    let kept: Vec<&Measured> = found.turns.iter().flatten().collect();
    let of = |value: fn(&Measured) -> f64| Spread::of(kept.iter().map(|one| value(one)).collect());
    let peaks: Option<Vec<f64>> = kept
        .iter()
        .map(|one| one.peak.map(|bytes| bytes as f64))
        .collect();
    let one = kept.first()?;
    Some(Figures {
        traced_by: one.kernel.to_string(),
        width: one.effort.width,
        height: one.effort.height,
        samples: one.effort.samples,
        rays_per_sample: one.rays as f64 / one.paths as f64,
        mrays: of(Measured::mrays)?,
        msamples: of(Measured::msamples)?,
        pack: of(|one| one.pack)?,
        compile: of(|one| one.load)?,
        first_compile: found.first_compile,
        outside: of(Measured::outside)?,
        peak: peaks.and_then(Spread::of),
    })
}

fn ratio(
    order: &Order,
    subject: &Subject,
    axis: Axis,
    found: &Gathered,
    base: &Gathered,
) -> Option<Ratio> {
    let of = |value: fn(&Measured) -> f64| {
        let values = |found: &Gathered| -> Vec<Option<f64>> {
            found
                .turns
                .iter()
                .map(|one| one.as_ref().map(value))
                .collect()
        };
        Spread::of(ratios(&values(found), &values(base)))
    };
    let name = |cell, axis| order.label(cell, axis);
    let others = Axis::ALL.into_iter();
    let others = others.filter(|other| *other != axis && order.several(*other));
    Some(Ratio {
        scene: subject.name(),
        axis,
        of: name(found.cell, axis)?,
        to: name(base.cell, axis)?,
        at: others.filter_map(|other| name(found.cell, other)).collect(),
        mrays: of(Measured::mrays)?,
        msamples: of(Measured::msamples)?,
    })
}
