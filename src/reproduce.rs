//! Renders what the paper's figures are made of: the sweeps of [`crate::figures::studies`] and the points of
//! figure 6, into a folder from which the figures are drawn.

use crate::device::{Device, DeviceInfo};
use crate::error::{Error, Result};
use crate::figures::{
    CASES, Effort, Made, MadeFigure, POINTS, Study, points_file, studies, study_folder,
};
use crate::place::Place;
use crate::points::{self, Kind, Request};
use crate::report::page;
use crate::scene::Assignment;
use crate::sweep::{About, Experiment, Open, Progress, Rules, Sweep, Watch, report_data};
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

/// What is wanted, and where.
#[derive(Clone, Copy, Debug)]
pub struct Order<'a> {
    pub folder: &'a Path,
    pub effort: Effort,
    /// The figures: 5 to 9.
    pub figures: &'a [u32],
}

/// How it ended.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// What was found damaged and made again, a line each.
    pub damaged: Vec<String>,
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
    let mut first = open()?;
    let info = first.info().clone();
    let data = order.folder.join("data");
    fs::create_dir_all(&data).map_err(|source| Error::Create { path: data, source })?;
    if order.figures.contains(&6) {
        draw_points(order.folder, first.as_mut())?;
    }
    let wanted = |study: &Study| order.figures.contains(&study.figure);
    let plan = |study: Study| Ok((study.experiment(&info)?, study));
    let mine = studies(order.effort).into_iter().filter(wanted).map(plan);
    let mine: Vec<(Experiment, Study)> = mine.collect::<Result<_>>()?;
    let folder = |study: &Study| study_folder(order.folder, study);
    let sweep = |(experiment, study)| Sweep::new(experiment, &folder(study), Rules::default());
    let sweeps = mine
        .iter()
        .map(|(experiment, study)| sweep((experiment, study)));
    let sweeps: Vec<Sweep> = sweeps.collect::<Result<_>>()?;
    let mut pace = Pace::new(&sweeps);
    let mut device = Some(first);
    let mut outcome = Outcome::default();
    for ((experiment, study), mut sweep) in mine.iter().zip(sweeps) {
        let paths = sweep.paths();
        outcome.damaged.extend_from_slice(sweep.damaged());
        let mut watch = |progress: Progress| hear(study, pace.over_all(progress, paths));
        let mut again = || device.take().map_or_else(&mut *open, Ok);
        let (one, references) = run(study, &mut sweep, &mut again, &mut watch)?;
        device = sweep.into_device().or(device.take());
        pace.done += paths;
        outcome.made += one.made;
        outcome.found += one.found;
        outcome.failed += one.failed;
        outcome.stopped = one.stopped;
        report(&folder(study), experiment, study, one.made + references > 0)?;
        if outcome.stopped {
            break;
        }
    }
    if !outcome.stopped && outcome.failed == 0 {
        note(order, &info)?;
    }
    Ok(outcome)
}

/// Writes down what is there now, beside the figures of earlier calls.
fn note(order: Order, device: &DeviceInfo) -> Result<()> {
    let mut made = Made::read(order.folder)?;
    for number in order.figures {
        made.0
            .insert(*number, MadeFigure::new(order.effort, device.clone()));
    }
    made.write(order.folder)
}

/// Paths and time of all studies together.
struct Pace {
    started: Instant,
    done: u64,
    all: u64,
}

impl Pace {
    fn new(sweeps: &[Sweep]) -> Self {
        Self {
            started: Instant::now(),
            done: 0,
            all: sweeps.iter().map(Sweep::paths).fold(0, u64::saturating_add),
        }
    }

    /// A sweep's progress with the share and the time left of all of them.
    fn over_all<'a>(&self, progress: Progress<'a>, paths: u64) -> Progress<'a> {
        let share = (self.done as f64 + progress.share * paths as f64) / self.all.max(1) as f64;
        let left = self.started.elapsed().as_secs_f64() * (1.0 / share - 1.0);
        Progress {
            share,
            left: Duration::try_from_secs_f64(left).ok(),
            ..progress
        }
    }
}

/// The study's own page. Where nothing is new, that of the call before is good.
fn report(folder: &Path, experiment: &Experiment, study: &Study, new: bool) -> Result<()> {
    let path = folder.join("report.html");
    if !new && path.exists() {
        return Ok(());
    }
    let about = About {
        title: study.name.into(),
        command: study.command(),
        ..About::default()
    };
    write(&path, &page(&report_data(folder, experiment, about)?)?)
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
        ..Outcome::default()
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
fn draw_points(folder: &Path, device: &mut dyn Device) -> Result<()> {
    for case in CASES {
        let request = Request {
            kind: Kind::Light {
                distance: 4.0,
                incidence: 0.0,
            },
            count: POINTS,
            knobs: vec![Assignment::new(
                "light.sampler",
                case,
                format!("--set light.sampler={case}"),
            )],
        };
        let cloud = points::draw(device, &request)?;
        write(&points_file(folder, case), &cloud.to_csv())?;
    }
    Ok(())
}

fn write(path: &Path, text: &str) -> Result<()> {
    Place::prepare(path)?.write(|sink| sink.write_all(text.as_bytes()))
}
