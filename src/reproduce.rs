//! Renders what the paper's figures are made of: the sweeps of [`crate::figures::studies`] and the points of
//! figure 6, into a folder from which the figures are drawn.

use crate::device::Device;
use crate::error::{Error, Result};
use crate::figures::{
    CASES, Effort, POINTS, Study, device_file, points_file, studies, study_folder,
};
use crate::place::Place;
use crate::points::{self, Kind, Request};
use crate::report::page;
use crate::scene::Assignment;
use crate::sweep::{About, Open, Progress, Rules, Sweep, Watch, report_data};
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

/// What is wanted, and where.
#[derive(Clone, Copy, Debug)]
pub struct Order<'a> {
    pub folder: &'a Path,
    pub effort: Effort,
    /// The figures: 5 to 9.
    pub figures: &'a [u32],
}

/// How it ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    pub made: usize,
    /// Runs that were there already.
    pub found: usize,
    pub failed: usize,
    pub stopped: bool,
}

/// Hears the study in hand and how far its sweep is, and may stop it.
pub type Hear<'a> = dyn FnMut(&Study, Progress) -> ControlFlow<()> + 'a;

/// Makes what is not there yet. Each study's folder gets a table and a report, as `lampray sweep` gives it.
///
/// # Errors
/// Those of the outputs and of opening a device; runs that fail are counted.
pub fn reproduce(order: Order, open: &mut Open, hear: &mut Hear) -> Result<Outcome> {
    let mut device = Some(open()?);
    let info = device.as_deref().map(|device| device.info().clone());
    let info = info.ok_or_else(|| Error::Internal("no device".into()))?;
    let data = order.folder.join("data");
    fs::create_dir_all(&data).map_err(|source| Error::Create { path: data, source })?;
    let text =
        serde_json::to_string_pretty(&info).map_err(|error| Error::Internal(error.to_string()))?;
    write(&device_file(order.folder), &(text + "\n"))?;
    if order.figures.contains(&6) {
        draw_points(order, device.as_deref_mut())?;
    }
    let mut outcome = Outcome::default();
    let mine = studies(order.effort)
        .into_iter()
        .filter(|study| order.figures.contains(&study.figure));
    for study in mine {
        let mut watch = |progress: Progress| hear(&study, progress);
        let mut again = || device.take().map_or_else(&mut *open, Ok);
        let experiment = study.experiment(&info)?;
        let folder = study_folder(order.folder, &study);
        let mut sweep = Sweep::new(&experiment, &folder, Rules::default())?;
        let (one, left) = run(&study, &mut sweep, &mut again, &mut watch)?;
        device = sweep.into_device().or(device.take());
        outcome.made += one.made;
        outcome.found += one.found;
        outcome.failed += one.failed;
        outcome.stopped = one.stopped;
        // Nothing new: the report is that of the call before.
        if one.made + left > 0 || !folder.join("report.html").exists() {
            let about = About {
                title: study.name.into(),
                command: study.command(),
                ..About::default()
            };
            let data = report_data(&folder, &experiment, about)?;
            write(&folder.join("report.html"), &page(&data)?)?;
        }
        if outcome.stopped {
            break;
        }
    }
    Ok(outcome)
}

/// One study's sweep, and how many references it made.
fn run(
    study: &Study,
    sweep: &mut Sweep,
    open: &mut Open,
    watch: &mut Watch,
) -> Result<(Outcome, usize)> {
    let summary = sweep.go(open, watch)?;
    let mut outcome = Outcome {
        made: summary.made,
        found: summary.skipped,
        failed: summary.failed,
        stopped: summary.stopped,
    };
    let mut references = 0;
    if study.reference && !summary.stopped {
        let found = sweep.references(open, watch)?;
        outcome.failed += found.failed.len();
        outcome.stopped = found.stopped;
        references = found.made;
    }
    sweep.write_table()?;
    Ok((outcome, references))
}

/// The points of the paper's three cases, as `lampray points` gives them.
fn draw_points(order: Order, device: Option<&mut (dyn Device + 'static)>) -> Result<()> {
    let Some(device) = device else {
        return Ok(());
    };
    for case in CASES {
        let request = Request {
            kind: Kind::Light { distance: 4.0 },
            count: POINTS,
            knobs: vec![Assignment::new(
                "light.sampler",
                case,
                format!("--set light.sampler={case}"),
            )],
        };
        let cloud = points::draw(device, &request)?;
        write(&points_file(order.folder, case), &cloud.to_csv())?;
    }
    Ok(())
}

fn write(path: &Path, text: &str) -> Result<()> {
    Place::prepare(path)?.write(|sink| sink.write_all(text.as_bytes()))
}
