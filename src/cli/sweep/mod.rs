mod foretell;
mod told;
pub(super) mod words;

use super::options::{DeviceOptions, ShortKnobs};
use super::progress::Bar;
use super::signal::Watch;
use super::{Output, note, print};
use crate::device::{Device, DeviceInfo};
use crate::error::{Error, Result};
use crate::place::Place;
use crate::report::{ReportData, page};
use crate::scene::Scene;
use crate::sweep::{
    About, Axis, Base, Experiment, Grid, Progress, ReferenceRule, ReferenceSummary, Rules, Summary,
    Sweep, report_data,
};
use clap::Args;
use foretell::foretell;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;
use words::{command_line, describe, ended, not_made, several_sizes, spelled, title};

/// Render a grid of knob values in one process
///
/// Values are lists (a,b,c), whole numbers (1..8, both ends), steps (0..1+0.25) or factors
/// (4..1024*2); several --set make a grid, --zip takes them in step (one value stays). The folder gets runs.jsonl (one line
/// a run, only ever added to), images/ID.exr and .png, table.csv (one row a run, every knob) and
/// report.html (one file, works offline): bias, noise and cost with intervals, and the pictures. A run
/// that is finished there is not made again, unless its EXR is lost or damaged; a failed one is. After
/// the runs the sweep renders what they are held against into reference/: the same scene, sampled as by
/// the preset reference, once for each expected picture. What the pictures say of bias, noise and time
/// goes to stdout, a sentence a line; with --json one object: folder, made, skipped, failed, stopped,
/// references, findings (the sentences) and groups, each with name, values, runs, samples, seconds and
/// the figures of the whole picture (mean, bias, variance, mse, verdict and others), where numbers with
/// a 95 % interval are {value, low, high} and what is not known is null. Without --set the scene's own [sweep] table says what to render:
/// set = ["PATH=VALUES", ...], zip, seeds, reference, regions.
#[derive(Args)]
#[command(after_help = "Examples:
  lampray sweep scenes/cornell.toml --set light.sampler=cone,gaussian --set render.samples=4..64*2 --seeds 8 -o samplers
  lampray sweep scenes/cornell.toml --preset corrected --set materials.white.survival=0.5..1+0.1 -o survival --dry-run
  lampray sweep scenes/cornell.toml --set light.sampler=cone,gaussian --seeds 100 --shard 1/4 -o part1
  lampray sweep scenes/cornell.toml --set render.preset=paper,corrected --set image.filter=box --seeds 8 -o bias")]
pub(crate) struct Command {
    /// Scene file (TOML)
    scene: PathBuf,
    /// A knob and its values; may be given many times
    #[arg(long = "set", value_name = "PATH=VALUES")]
    set: Vec<String>,
    /// Take the values in step instead of in every combination
    #[arg(long)]
    zip: bool,
    /// Repeat each point with so many seeds [default: 1]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    seeds: Option<u64>,
    /// The folder; made where it is not there
    #[arg(short, long = "output", value_name = "DIR")]
    output: PathBuf,
    /// Say how many runs there are and about how long they take, and make none
    #[arg(long)]
    dry_run: bool,
    /// Go on after a run that failed; so it is without this, too
    #[arg(long, conflicts_with = "fail_fast")]
    keep_going: bool,
    /// Stop at the first run that fails
    #[arg(long)]
    fail_fast: bool,
    /// Try a run or a reference that failed so many times more
    #[arg(long, value_name = "N", default_value_t = 0)]
    retry: u32,
    /// Give a run up after so many seconds; references take their time
    #[arg(long, value_name = "SECONDS")]
    timeout: Option<f64>,
    /// What the runs are held against for bias and error: auto (rendered after them, with as many
    /// samples as they have together), none, samples a pixel, or an EXR of another seed [default: auto]
    #[arg(long, value_name = "auto|none|SAMPLES|FILE.exr")]
    reference: Option<ReferenceRule>,
    /// Make only the I-th of N parts of the grid, with references of its runs
    #[arg(long, value_name = "I/N")]
    shard: Option<String>,
    #[command(flatten)]
    knobs: ShortKnobs,
    #[command(flatten)]
    device: DeviceOptions,
}

impl Command {
    pub(crate) fn run(self, output: Output) -> Result<()> {
        let signals = Watch::new();
        let base = Base {
            name: self.scene.to_string_lossy().into_owned(),
            text: Scene::read_text(&self.scene)?,
            assignments: self.knobs.assignments(),
        };
        let scene = Scene::parse(&base.name, &base.text, &base.assignments)?;
        let grid = self.grid(&scene)?;
        grid.count()?;
        self.knobs.refuse_swept(&grid.axes)?;
        let rules = self.rules()?;
        let device = self.open(output)?;
        let experiment = self.experiment(&scene, base, grid, device.info())?;
        for text in words::unbounded(&experiment) {
            remark(&text, output);
        }
        if self.dry_run {
            return foretell(&experiment, device, output);
        }
        if let Some(text) = several_sizes(&experiment) {
            remark(&text, output);
        }
        let mut sweep = Sweep::new(&experiment, &self.output, rules)?;
        for fault in sweep.damaged() {
            remark(&format!("lampray: {fault}; the run is made again"), output);
        }
        let (summary, references) = self.make(&mut sweep, device, &signals, output)?;
        sweep.write_table()?;
        let about = About {
            title: title(&self.scene),
            command: command_line(),
            findings: not_made(&references),
        };
        let data = report_data(&self.output, &experiment, about)?;
        self.write("report.html", &page(&data)?)?;
        self.conclude(summary, &references, &data, output)
    }

    /// Makes the runs and then, unless they ended early, the references.
    fn make(
        &self,
        sweep: &mut Sweep,
        device: Box<dyn Device>,
        signals: &Watch,
        output: Output,
    ) -> Result<(Summary, ReferenceSummary)> {
        let bar = Bar::new(output);
        let mut watch = |progress: Progress| {
            let left = progress.left.map(spelled);
            bar.show(progress.share, describe(&progress), left);
            match signals.stopped() {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        };
        let mut device = Some(device);
        let mut open = || {
            device
                .take()
                .map_or_else(|| Ok(self.device.open()?.device), Ok)
        };
        let summary = sweep.go(&mut open, &mut watch)?;
        let references = match summary.stopped || (summary.failed > 0 && self.fail_fast) {
            true => ReferenceSummary {
                stopped: true,
                ..ReferenceSummary::default()
            },
            false => sweep.references(&mut open, &mut watch)?,
        };
        bar.clear();
        Ok((summary, references))
    }

    /// The command line's grid; what it does not say, the scene's `[sweep]` does.
    fn grid(&self, scene: &Scene) -> Result<Grid> {
        let wanted = &scene.sweep;
        let set = if self.set.is_empty() {
            &wanted.set
        } else {
            &self.set
        };
        Ok(Grid {
            axes: Axis::parse_all(set)?,
            zip: self.zip || (self.set.is_empty() && wanted.zip),
            seeds: self.seeds.unwrap_or(wanted.seeds).max(1),
        })
    }

    fn open(&self, output: Output) -> Result<Box<dyn Device>> {
        let chosen = self.device.open()?;
        if let Some(text) = &chosen.remark {
            remark(&format!("lampray: {text}"), output);
        }
        Ok(chosen.device)
    }

    fn experiment(
        &self,
        scene: &Scene,
        base: Base,
        grid: Grid,
        device: &DeviceInfo,
    ) -> Result<Experiment> {
        let shard = self.shard.as_deref().map(shard).transpose()?;
        let rule = match (&self.reference, &scene.sweep.reference) {
            (Some(rule), _) => rule.clone(),
            (None, Some(text)) => beside(text.parse()?, &self.scene),
            (None, None) => ReferenceRule::default(),
        };
        Experiment::new(base, grid, device, &rule, shard)
    }

    fn rules(&self) -> Result<Rules> {
        let timeout = self.timeout.map(|seconds| {
            let duration = Duration::try_from_secs_f64(seconds).ok();
            duration
                .filter(|duration| !duration.is_zero())
                .ok_or_else(|| Error::Usage(format!("--timeout {seconds}: give seconds above 0")))
        });
        Ok(Rules {
            fail_fast: self.fail_fast,
            retries: self.retry,
            timeout: timeout.transpose()?,
        })
    }

    fn write(&self, name: &str, text: &str) -> Result<()> {
        let place = Place::prepare(self.output.join(name))?;
        place.write(|sink| sink.write_all(text.as_bytes()))
    }

    fn conclude(
        &self,
        summary: Summary,
        references: &ReferenceSummary,
        data: &ReportData,
        output: Output,
    ) -> Result<()> {
        remark(&ended(&self.output, summary, references), output);
        for (name, reason) in &references.failed {
            remark(
                &format!("lampray: the {name} was not made: {reason}"),
                output,
            );
        }
        print(&match output.json {
            true => format!("{}\n", told::json(&self.output, summary, references, data)),
            false => data.findings.iter().map(|one| format!("{one}\n")).collect(),
        })?;
        match (summary.failed, references.failed.len()) {
            (0, 0) => Ok(()),
            (0, references) => Err(Error::References(references)),
            (runs, _) => Err(Error::Runs(runs)),
        }
    }
}

/// A file that a scene names is beside it.
fn beside(rule: ReferenceRule, scene: &Path) -> ReferenceRule {
    match (rule, scene.parent()) {
        (ReferenceRule::File(file), Some(folder)) => ReferenceRule::File(folder.join(file)),
        (rule, _) => rule,
    }
}

/// `I/N`.
fn shard(text: &str) -> Result<[usize; 2]> {
    let parts = text
        .split_once('/')
        .and_then(|(part, parts)| Some([part.trim().parse().ok()?, parts.trim().parse().ok()?]));
    parts.ok_or_else(|| Error::Usage(format!("--shard {text}: give I/N, for example 1/4")))
}

pub(super) fn remark(text: &str, output: Output) {
    if !output.quiet {
        note(text);
    }
}
