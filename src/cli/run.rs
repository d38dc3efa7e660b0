//! What `render` and `rerun` share: from a scene to files and a record.

use super::denoise::beside;
use super::keep::{KeepOptions, Keeper};
use super::options::{DeviceOptions, refuse_mixed};
use super::progress::bar;
use super::rerun::take_over;
use super::signal::Watch;
use super::{Output, note, print};
use crate::device::Device;
use crate::error::{Error, Result};
use crate::film::{Aov, Denoising, Film, Picture, Record, Seconds, Stop, Target, name_outputs};
use crate::knobs::shown;
use crate::pack::Rect;
use crate::render::{self, Rendering, Spares, Task};
use crate::scene::Scene;
use crate::wording::{all_named, counted, counted_as, named};
use clap::Args;
use indicatif::ProgressBar;
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A render as a command line asks for it.
pub(crate) struct Run<'a> {
    pub scene: &'a Scene,
    pub outputs: Vec<PathBuf>,
    pub region: Rect,
    pub samples: Range<u64>,
    /// Of each pixel, where that is known: see [`Task::counts`].
    pub counts: Option<Vec<u64>>,
    /// The record of the picture whose samples are taken again, where they are not shared out anew.
    pub again: Option<&'a Record>,
    pub aovs: Vec<Aov>,
    /// How to make the pictures beside the outputs, where they are wanted.
    pub denoise: Option<Denoising>,
    pub device: &'a DeviceOptions,
    pub rules: StopRules,
    pub keep: KeepOptions,
    pub no_times: bool,
    /// Who has watched for signals from the start: one that comes while a scene is read must be heard, and find no
    /// temporary file that nobody would remove.
    pub signals: Watch,
}

/// When to stop before the last sample.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct StopRules {
    /// Stop after so long, all included, with what is done by then; render.samples stays the most
    #[arg(long, value_name = "SECONDS", value_parser = super::options::seconds, allow_negative_numbers = true)]
    time: Option<Duration>,
    /// Stop when the standard error of the mean of the picture, relative to it, is at most E and so are those of
    /// 95 % of the pixels; looked at after 64 samples and then at numbers an eighth apart. More samples go where the
    /// error is, as scouts foresee it: samples that are not in the picture. render.samples stays the most
    #[arg(long, value_name = "E", value_parser = super::options::relative_error, allow_negative_numbers = true)]
    target_error: Option<f64>,
    /// Give every pixel the same number of samples under --target-error
    #[arg(long, requires = "target_error")]
    even: bool,
}

impl StopRules {
    /// Those of a picture whose samples went where the error was.
    pub(crate) fn adaptive(target_error: Option<f64>) -> Self {
        Self {
            target_error,
            ..Self::default()
        }
    }
}

impl Run<'_> {
    /// Renders and writes. Outputs that cannot be written are refused before anything is rendered.
    pub(crate) fn go(self, output: Output) -> Result<()> {
        let started = Instant::now();
        refuse_mixed(&self.outputs, output)?;
        let task = Task {
            region: self.region,
            samples: self.samples.clone(),
            features: !self.aovs.is_empty(),
            denoised: self.denoise.is_some(),
            target_error: self.rules.target_error,
            adaptive: self.rules.target_error.is_some() && !self.rules.even,
            counts: self.counts.clone(),
            ..Task::new(self.scene)
        };
        task.refuse_cut()?;
        task.refuse_adaptive()?;
        render::refuse_too_large(&task)?;
        for line in self.scene.unbounded_lines() {
            remark(&format!("warning: {line}"), output);
        }
        let idle = self.scene.idle_materials().into_iter();
        for line in idle.chain(self.scene.notes()) {
            remark(&format!("note: {line}"), output);
        }
        let (targets, denoised) = self.targets()?;
        let mut device = self.open(output)?;
        let wanted = render::record(&task, device.info(), &Rendering::new(&task));
        let outputs = targets.iter().chain(&denoised);
        let outputs = outputs.map(Target::identity).collect();
        let (mut keeper, mut rendering) = match self.keep.keeper(&task, &wanted, outputs)? {
            Some((keeper, rendering)) => (Some(keeper), rendering),
            None => (None, Rendering::new(&task)),
        };
        let session = Session {
            run: &self,
            task: &task,
            started,
            opening: started.elapsed(),
            output,
        };
        let traced = session.trace(&mut device, &mut rendering, &mut keeper);
        let (mut record, written) = session.write(&rendering, targets);
        let smoothed = match traced.is_ok() && written.is_ok() {
            true => session.denoise(&mut device, &rendering, denoised, record.as_mut()),
            false => Ok(false),
        };
        let enough = matches!(rendering.stopped, None | Some(Stop::TargetError));
        let done = enough && traced.is_ok() && written.is_ok() && matches!(smoothed, Ok(true));
        let kept = session.keep(keeper, &rendering, done);
        if let Some(record) = record.as_ref().filter(|_| !output.quiet && written.is_ok()) {
            warn_non_finite(&rendering);
            note(&summary(record, &rendering));
            session.tell_of_error(&rendering);
        }
        first_failure([traced, written, smoothed.map(drop), kept])?;
        let Some(record) = record else {
            return Ok(());
        };
        if output.json {
            print(&(record.to_json() + "\n"))
        } else {
            Ok(())
        }
    }

    /// The outputs, and the denoised pictures beside them.
    fn targets(&self) -> Result<(Vec<Target>, Vec<Target>)> {
        let mut all = self.outputs.clone();
        if self.denoise.is_some() {
            all.extend(beside(&self.outputs)?);
        }
        let mut targets = Target::prepare_all(&all)?;
        let denoised = targets.split_off(self.outputs.len());
        Ok((targets, denoised))
    }

    fn open(&self, output: Output) -> Result<Box<dyn Device>> {
        let chosen = self.device.open()?;
        if let Some(text) = &chosen.remark {
            remark(text, output);
        }
        Ok(chosen.device)
    }
}

/// A render under way.
pub(super) struct Session<'a> {
    pub(super) run: &'a Run<'a>,
    pub(super) task: &'a Task<'a>,
    started: Instant,
    /// Until the device was open.
    opening: Duration,
    pub(super) output: Output,
}

impl Session<'_> {
    /// Renders under a progress bar, until done or until somebody says stop.
    fn trace(
        &self,
        device: &mut Box<dyn Device>,
        rendering: &mut Rendering,
        keeper: &mut Option<Keeper>,
    ) -> Result<()> {
        let signals = &self.run.signals;
        let bar = progress_bar(self.output, self.run.scene);
        let mut watch = |rendering: &Rendering| {
            bar.set_length(rendering.length());
            bar.set_position(rendering.traced());
            if signals.hung_up() {
                bar.suspend(|| self.write_meanwhile(rendering));
            }
            if let Some(keeper) = keeper {
                keeper.save_if_due(self.task, rendering);
            }
            let late = self
                .run
                .rules
                .time
                .is_some_and(|time| self.started.elapsed() >= time);
            match (signals.stopped(), late) {
                (true, _) => ControlFlow::Break(Stop::Signal),
                (_, true) => ControlFlow::Break(Stop::Time),
                _ => ControlFlow::Continue(()),
            }
        };
        let spares = Spares {
            anew: &mut || self.run.device.open().map(|chosen| chosen.device),
            any: self.run.device.any(),
            tell: &mut |text| bar.suspend(|| remark(text, self.output)),
        };
        let traced = render::endure(device, self.task, rendering, spares, &mut watch);
        bar.finish_and_clear();
        traced
    }

    /// Says where a render that had all its samples has a larger error than was asked for.
    fn tell_of_error(&self, rendering: &Rendering) {
        let Some(target) = self.run.rules.target_error.filter(|_| rendering.complete()) else {
            return;
        };
        let found = rendering.film.relative_error();
        if found.reaches(target) {
            return;
        }
        let text = format!(
            "--target-error {} is not reached: the error is {:.2e} for the picture's mean and {:.2e} for 95 % of the pixels; give it more samples",
            shown(target),
            found.picture,
            found.pixels
        );
        remark(&text, self.output);
    }

    /// The picture as it stands; none while there are pixels without a sample.
    pub(super) fn picture(&self, rendering: &Rendering) -> Option<Picture> {
        let device = rendering.devices.first()?;
        if rendering.film.counts.contains(&0) {
            return None;
        }
        let mut picture = render::picture(self.task, device, rendering, &self.run.aovs);
        let seconds = &mut picture.record.seconds;
        seconds.setup += self.opening.as_secs_f64();
        seconds.total = self.started.elapsed().as_secs_f64();
        if let Some(first) = self.run.again {
            take_over(&mut picture.record, first, rendering.complete());
        }
        Some(picture)
    }

    /// Saves what is done, or removes the checkpoints of what is all done.
    fn keep(&self, keeper: Option<Keeper>, rendering: &Rendering, done: bool) -> Result<()> {
        let Some(mut keeper) = keeper else {
            return Ok(());
        };
        if done {
            keeper.remove();
            return Ok(());
        }
        keeper.save(self.task, rendering)?;
        if let Some(path) = keeper.kept() {
            let path = named(path);
            remark(&format!("--resume goes on from {path}"), self.output);
        }
        Ok(())
    }

    /// Writes the picture, to every output that takes it; its record, if there is one.
    fn write(&self, rendering: &Rendering, targets: Vec<Target>) -> (Option<Record>, Result<()>) {
        let Some(mut picture) = self.picture(rendering) else {
            let what = match rendering.traced() {
                0 => "nothing is traced yet: no picture is written, and there are no sums to keep",
                _ => "not every pixel has a sample yet: no picture is written",
            };
            if rendering.stopped == Some(Stop::Time) {
                return (
                    None,
                    Err(Error::Unfinished(format!("time is up, and {what}"))),
                );
            }
            // A render that failed before its first block says what failed, which is enough.
            if rendering.film.paths > 0 || rendering.stopped.is_some() {
                remark(what, self.output);
            }
            return (None, Ok(()));
        };
        name_outputs(&mut picture.record, &targets);
        let record = picture.record.clone();
        if self.run.no_times {
            picture.record.seconds = Seconds::default();
        }
        let written = targets.into_iter().map(|target| target.write(&picture));
        (Some(record), first_failure(written))
    }

    /// Writes the picture so far, and lets the render go on.
    fn write_meanwhile(&self, rendering: &Rendering) {
        let written = Target::prepare_all(&self.run.outputs).and_then(|mut targets| {
            // A reader of a pipe gets one picture: the last.
            targets.retain(|target| !target.is_stream());
            let (record, written) = self.write(rendering, targets);
            written.map(|()| record)
        });
        match written {
            Ok(Some(record)) => remark(
                &format!("{}; going on", summary(&record, rendering)),
                self.output,
            ),
            Ok(None) => {}
            Err(error) => note(&format!("lampray: warning: {error}; the render goes on")),
        }
    }
}

/// The first failure, which says how the program ends; those after it are told.
pub(super) fn first_failure(outcomes: impl IntoIterator<Item = Result<()>>) -> Result<()> {
    // Collected, so that each of them is tried.
    let failures: Vec<_> = outcomes.into_iter().filter_map(Result::err).collect();
    let mut failures = failures.into_iter();
    let Some(first) = failures.next() else {
        return Ok(());
    };
    for error in failures {
        note(&format!("lampray: {error}"));
    }
    Err(first)
}

pub(super) fn remark(text: &str, output: Output) {
    if !output.quiet {
        note(&format!("lampray: {text}"));
    }
}

/// A bar on a terminal, nothing elsewhere.
fn progress_bar(output: Output, scene: &Scene) -> ProgressBar {
    let name = Path::new(&scene.source.name)
        .file_stem()
        .unwrap_or_default();
    let bar = bar(
        output,
        "{prefix} {wide_bar} {percent}% {elapsed}/{duration}",
    );
    bar.set_prefix(named(name));
    bar
}

fn warn_non_finite(rendering: &Rendering) {
    let scouts = rendering.scouts.as_ref().map(|scouts| &scouts.film);
    for film in [Some(&rendering.film), scouts].into_iter().flatten() {
        warn_non_finite_of(film);
    }
}

fn warn_non_finite_of(film: &Film) {
    if let Some(first) = &film.first_non_finite {
        note(&format!(
            "warning: {} of {} not finite, counted as black; the first is sample {} of pixel {},{}",
            film.non_finite,
            counted(film.paths, "sample"),
            first.sample,
            first.x,
            first.y
        ));
    }
}

/// One line on what was made: files, size, samples, speed, device. How it ended and how fast it was are this render's:
/// of a picture that is made again the record says how the first one ended, and has its scouts.
fn summary(record: &Record, rendering: &Rendering) -> String {
    let state = match rendering.stopped {
        None if rendering.complete() => "",
        None => " so far",
        Some(Stop::TargetError) => " (error as asked for)",
        Some(Stop::Time) => " (time is up)",
        Some(Stop::Signal) => " (stopped)",
    };
    let devices: Vec<_> = record
        .all_devices()
        .into_iter()
        .map(|device| device.name)
        .collect();
    let speed = rendering.traced() as f64 / record.seconds.render.max(1e-9) / 1e6;
    format!(
        "{}: {}x{}, {}{state} in {:.2} s ({speed:.2} Msamples/s) on {}",
        all_named(&record.outputs),
        record.width,
        record.height,
        samples(record),
        record.seconds.render,
        devices.join(" and ")
    )
}

/// Samples a pixel, and of how many where they differ by design.
fn samples(record: &Record) -> String {
    let [first, end] = record.sample_range;
    if record.adaptive.is_none() || record.samples == end - first {
        return counted_as(record.samples, "sample a pixel", "samples a pixel");
    }
    let pixels = f64::from(record.width) * f64::from(record.height);
    let mean = record.paths as f64 / pixels;
    format!(
        "{} to {} (mean {mean:.1}) samples a pixel",
        record.samples,
        end - first
    )
}
