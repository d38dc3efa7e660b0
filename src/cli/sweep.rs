use super::options::{DeviceOptions, ShortKnobs};
use super::signal::Watch;
use super::{Output, note, print};
use crate::analysis::{Reference, Region};
use crate::device::{Device, DeviceInfo};
use crate::error::{Error, Result};
use crate::film::read_exr;
use crate::pack::Rect;
use crate::place::Place;
use crate::render::{self, Task};
use crate::report::page;
use crate::scene::Scene;
use crate::sweep::{
    About, Axis, Base, Grid, Plan, Planned, Progress, Rules, Summary, Sweep, report_data, table,
};
use clap::Args;
use serde_json::json;
use std::ops::ControlFlow;
use std::path::PathBuf;
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
  lampray sweep scenes/cornell.toml --set light.sampler=cone,gaussian --seeds 100 --shard 1/4 -o part1")]
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
    /// What the runs are held against for bias and error: an EXR of many samples, with another seed
    #[arg(long, value_name = "EXR")]
    reference: Option<PathBuf>,
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
        let grid = self.grid(&base)?;
        grid.count()?;
        let mut device = Some(self.open(output)?);
        let plan = self.plan(&base, &grid, device.as_deref().map(|device| device.info()))?;
        if self.dry_run {
            return self.foretell(&base, &plan, device.as_deref_mut(), output);
        }
        // Read before the runs: a reference that is not there is not to be found out after hours.
        let about = About {
            title: self
                .scene
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            command: command_line(),
            grid: &grid,
            ids: plan.runs.iter().map(|run| run.id.as_str()).collect(),
            regions: regions(&base)?,
            reference: self.reference()?,
        };
        let mut sweep = Sweep::new(&base, &plan, &self.output, self.rules()?)?;
        let mut shown = None;
        let mut watch = |progress: Progress| {
            if shown != Some(progress.run.number) {
                shown = Some(progress.run.number);
                remark(&describe(&progress), output);
            }
            match signals.stopped() {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        };
        let mut open = || {
            device
                .take()
                .map_or_else(|| Ok(self.device.open()?.device), Ok)
        };
        let summary = sweep.go(&mut open, &mut watch)?;
        let entries = sweep.entries()?;
        self.write("table.csv", &table(&entries))?;
        let data = report_data(&self.output, &entries, about)?;
        self.write("report.html", &page(&data)?)?;
        self.conclude(summary, output)
    }

    /// The command line's grid; what it does not say, the scene's `[sweep]` does.
    fn grid(&self, base: &Base) -> Result<Grid> {
        let scene = Scene::parse(&base.name, &base.text, &base.assignments)?;
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

    fn plan(&self, base: &Base, grid: &Grid, device: Option<&DeviceInfo>) -> Result<Plan> {
        let device = device.ok_or_else(|| Error::Internal("no device".into()))?;
        let plan = Plan::new(base, grid, device)?;
        let Some(text) = &self.shard else {
            return Ok(plan);
        };
        let parts = text.split_once('/').and_then(|(part, parts)| {
            Some((part.trim().parse().ok()?, parts.trim().parse().ok()?))
        });
        let (part, parts) = parts
            .ok_or_else(|| Error::Usage(format!("--shard {text}: give I/N, for example 1/4")))?;
        plan.shard(part, parts)
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

    /// `--dry-run`.
    fn foretell(
        &self,
        base: &Base,
        plan: &Plan,
        device: Option<&mut (dyn Device + 'static)>,
        output: Output,
    ) -> Result<()> {
        let device = device.ok_or_else(|| Error::Internal("no device".into()))?;
        let paths: u64 = plan.runs.iter().map(|run| run.paths).sum();
        let seconds = match plan.runs.first() {
            Some(run) => paths as f64 * time_a_path(base, run, device)?,
            None => 0.0,
        };
        if output.json {
            let told = json!({ "runs": plan.runs.len(), "paths": paths, "seconds": seconds });
            return print(&format!("{told}\n"));
        }
        let about = spelled(Duration::from_secs_f64(seconds));
        print(&format!(
            "{} runs, {paths} paths, about {about} on {}\n",
            plan.runs.len(),
            device.info().name
        ))
    }

    fn write(&self, name: &str, text: &str) -> Result<()> {
        let place = Place::prepare(self.output.join(name))?;
        place.write(|sink| sink.write_all(text.as_bytes()))
    }

    fn reference(&self) -> Result<Option<Reference>> {
        let read = |path: &PathBuf| Reference::new(&path.to_string_lossy(), read_exr(path)?);
        self.reference.as_ref().map(read).transpose()
    }

    fn conclude(&self, summary: Summary, output: Output) -> Result<()> {
        let Summary {
            made,
            skipped,
            failed,
            stopped,
        } = summary;
        let folder = self.output.display();
        let state = if stopped { " (stopped early)" } else { "" };
        remark(
            &format!("{folder}: {made} runs made{state}, {skipped} were there, {failed} failed"),
            output,
        );
        if output.json {
            let told = json!({
                "folder": self.output, "made": made, "skipped": skipped, "failed": failed, "stopped": stopped,
            });
            print(&format!("{told}\n"))?;
        }
        match failed {
            0 => Ok(()),
            _ => Err(Error::Runs(failed)),
        }
    }
}

/// Seconds that a path takes, by a small part of a run: the first time it is compiled, too.
fn time_a_path(base: &Base, run: &Planned, device: &mut dyn Device) -> Result<f64> {
    const LONGEST: Duration = Duration::from_secs(2);
    let scene = base.scene(&run.point)?;
    let mut task = Task::new(&scene);
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

/// The scene's `[sweep.regions]`.
fn regions(base: &Base) -> Result<Vec<Region>> {
    let scene = Scene::parse(&base.name, &base.text, &base.assignments)?;
    let region = |region: crate::scene::Region| {
        let [x0, y0, x1, y1] = region.rect;
        Region {
            name: region.name,
            rect: Rect { x0, y0, x1, y1 },
        }
    };
    Ok(scene.sweep.regions.into_iter().map(region).collect())
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

fn describe(progress: &Progress) -> String {
    let values: Vec<String> = progress
        .run
        .point
        .values
        .iter()
        .map(|(path, value)| format!("{path}={value}"))
        .collect();
    let repeat = match progress.run.point.repeat {
        0 => String::new(),
        repeat => format!(" seed +{repeat}"),
    };
    let left = progress.left.map_or(String::new(), |left| {
        format!(", about {} left", spelled(left))
    });
    format!(
        "[{}/{}] {}{repeat}{left}",
        progress.done + 1,
        progress.total,
        values.join(" ")
    )
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
