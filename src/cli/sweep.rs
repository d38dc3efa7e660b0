use super::options::{DeviceOptions, ShortKnobs};
use super::progress::Bar;
use super::signal::Watch;
use super::{Output, note, print};
use crate::device::{Device, DeviceInfo};
use crate::error::{Error, Result};
use crate::place::Place;
use crate::render::{self, Task};
use crate::report::page;
use crate::scene::Scene;
use crate::sweep::{
    About, Axis, Base, Experiment, Grid, Progress, ReferenceRule, ReferenceSummary, Rules, Step,
    Summary, Sweep, report_data, table,
};
use clap::Args;
use serde_json::json;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Render a grid of knob values in one process
///
/// Values are lists (a,b,c), whole numbers (1..8, both ends), steps (0..1+0.25) or factors
/// (4..1024*2); several --set make a grid, --zip takes them in step. The folder gets runs.jsonl (one line
/// a run, only ever added to), images/ID.exr and .png, table.csv (one row a run, every knob) and
/// report.html (one file, works offline): bias, noise and cost with intervals, and the pictures. A run
/// that is finished there is not made again; a failed one is. Without --set the scene's own [sweep]
/// table says what to render: set = ["PATH=VALUES", ...], zip, seeds.
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
    /// Try a run that failed so many times more
    #[arg(long, value_name = "N", default_value_t = 0)]
    retry: u32,
    /// Give a run up after so many seconds
    #[arg(long, value_name = "SECONDS")]
    timeout: Option<f64>,
    /// What the runs are held against for bias and error: auto (rendered after them, with as many
    /// samples as they have together), none, samples a pixel, or an EXR of another seed [default: auto]
    #[arg(long, value_name = "auto|none|SAMPLES|FILE.exr")]
    reference: Option<ReferenceRule>,
    /// Make only the I-th of N parts of the grid
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
        let rules = self.rules()?;
        let device = self.open(output)?;
        let experiment = self.experiment(&scene, base, grid, device.info())?;
        if self.dry_run {
            return foretell(&experiment, device, output);
        }
        if let Some(text) = several_sizes(&experiment) {
            remark(&text, output);
        }
        let mut sweep = Sweep::new(&experiment, &self.output, rules)?;
        let bar = Bar::new(output);
        let mut watch = |progress: Progress| {
            bar.show(
                progress.share,
                describe(&progress),
                progress.left.map(spelled),
            );
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
        let early = summary.stopped || (summary.failed > 0 && self.fail_fast);
        let references = match early {
            true => ReferenceSummary {
                stopped: true,
                ..ReferenceSummary::default()
            },
            false => sweep.references(&mut open, &mut watch)?,
        };
        bar.clear();
        self.write("table.csv", &table(&sweep.entries()?))?;
        let about = About {
            title: title(&self.scene),
            command: command_line(),
            findings: not_made(&references),
        };
        let data = report_data(&self.output, &experiment, about)?;
        self.write("report.html", &page(&data)?)?;
        self.conclude(summary, references, output)
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
            axes: set
                .iter()
                .map(|text| Axis::parse(text))
                .collect::<Result<_>>()?,
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
        references: ReferenceSummary,
        output: Output,
    ) -> Result<()> {
        let Summary {
            made,
            skipped,
            failed,
            ..
        } = summary;
        let stopped = summary.stopped || references.stopped;
        let folder = self.output.display();
        let state = if stopped { " (stopped early)" } else { "" };
        let own = match (references.made, references.found) {
            (0, 0) => String::new(),
            (made, found) => format!("; references: {made} made, {found} were there"),
        };
        remark(
            &format!(
                "{folder}: {made} runs made{state}, {skipped} were there, {failed} failed{own}"
            ),
            output,
        );
        for (name, reason) in &references.failed {
            remark(
                &format!("lampray: the {name} was not made: {reason}"),
                output,
            );
        }
        if output.json {
            let own = json!({
                "made": references.made, "found": references.found, "failed": references.failed.len(),
            });
            let told = json!({
                "folder": self.output, "made": made, "skipped": skipped, "failed": failed,
                "stopped": stopped, "references": own,
            });
            print(&format!("{told}\n"))?;
        }
        match (failed, references.failed.len()) {
            (0, 0) => Ok(()),
            (0, references) => Err(Error::References(references)),
            (runs, _) => Err(Error::Runs(runs)),
        }
    }
}

/// What is said where not all runs can be analysed together.
fn several_sizes(experiment: &Experiment) -> Option<String> {
    let [width, height] = experiment.size;
    let mut runs = experiment.plan.runs.iter();
    runs.any(|run| run.size != experiment.size).then(|| {
        format!(
            "lampray: the runs have several sizes; the report analyses those of {width} x {height}"
        )
    })
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

fn title(scene: &Path) -> String {
    let stem = scene.file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}

/// Why references are missing.
fn not_made(references: &ReferenceSummary) -> Vec<String> {
    let failed = references.failed.iter();
    let mut sentences: Vec<String> = failed
        .map(|(name, reason)| format!("The {name} was not made: {reason}."))
        .collect();
    if references.stopped {
        sentences.push("The sweep was stopped early; the same command goes on with it.".into());
    }
    sentences
}

/// `--dry-run`.
fn foretell(experiment: &Experiment, mut device: Box<dyn Device>, output: Output) -> Result<()> {
    let runs = &experiment.plan.runs;
    let references = experiment.references(&|_| true)?;
    let paths: u64 = runs.iter().map(|run| run.paths).sum();
    let more: u64 = references.iter().map(|reference| reference.paths).sum();
    let mut seconds = 0.0;
    if let Some(run) = runs.first() {
        let scene = experiment.base.scene(&run.point)?;
        seconds += paths as f64 * time_a_path(&scene, device.as_mut())?;
    }
    if let Some(reference) = references.first() {
        seconds += more as f64 * time_a_path(reference.scene(), device.as_mut())?;
    }
    if output.json {
        let told = json!({
            "runs": runs.len(), "paths": paths, "references": references.len(),
            "reference_paths": more, "seconds": seconds,
        });
        return print(&format!("{told}\n"));
    }
    let about = spelled(Duration::from_secs_f64(seconds));
    let own = match references.len() {
        0 => String::new(),
        1 => format!(", 1 reference of {more} paths"),
        many => format!(", {many} references of {more} paths"),
    };
    print(&format!(
        "{} runs, {paths} paths{own}, about {about} on {}\n",
        runs.len(),
        device.info().name
    ))
}

/// Seconds that a path takes, by a small part of a render: the first time it is compiled, too.
fn time_a_path(scene: &Scene, device: &mut dyn Device) -> Result<f64> {
    const LONGEST: Duration = Duration::from_secs(2);
    let mut task = Task::new(scene);
    task.samples.end = task.samples.end.min(4);
    let mut pilot = || {
        let started = Instant::now();
        let rendering =
            render::render(device, &task, &mut |_| match started.elapsed() > LONGEST {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            })?;
        let paths: u64 = rendering.film.counts.iter().sum();
        Ok(rendering.tracing.as_secs_f64() / paths.max(1) as f64)
    };
    pilot()?;
    pilot()
}

/// As it was typed, for a shell.
fn command_line() -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+".contains(c);
    let quoted = |word: String| match word.chars().all(plain) && !word.is_empty() {
        true => word,
        false => format!("'{}'", word.replace('\'', "'\\''")),
    };
    let words = std::env::args().skip(1).map(quoted);
    std::iter::once("lampray".to_string())
        .chain(words)
        .collect::<Vec<_>>()
        .join(" ")
}

/// Which run of how many it is, and what it is of.
fn describe(progress: &Progress) -> String {
    let place = format!("{}/{}", progress.done + 1, progress.total);
    match progress.step {
        Step::Reference(reference) => {
            format!("[reference {place}] {} samples a pixel", reference.samples)
        }
        Step::Run(run) => {
            let values = run.point.values.iter();
            let values: Vec<String> = values
                .map(|(path, value)| format!("{path}={value}"))
                .collect();
            let repeat = match run.point.repeat {
                0 => String::new(),
                repeat => format!(" seed +{repeat}"),
            };
            format!("[{place}] {}{repeat}", values.join(" "))
        }
    }
}

/// Seconds, minutes or hours.
fn spelled(duration: Duration) -> String {
    let seconds = duration.as_secs_f64();
    match seconds {
        ..90.0 => format!("{seconds:.0} s"),
        ..5400.0 => format!("{:.0} min", seconds / 60.0),
        _ => format!("{:.1} h", seconds / 3600.0),
    }
}

fn remark(text: &str, output: Output) {
    if !output.quiet {
        note(text);
    }
}
