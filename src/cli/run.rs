//! What `render` and `rerun` share: from a scene to files and a record.

use super::options::DeviceOptions;
use super::progress::bar;
use super::signal::Watch;
use super::{Output, note, print};
use crate::cpu::Cpu;
use crate::device::Device;
use crate::error::{Error, Result};
use crate::film::{Aov, Film, Record, Target, name_outputs};
use crate::pack::Rect;
use crate::render::{self, Progress, Rendering, Task};
use crate::scene::Scene;
use indicatif::ProgressBar;
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// A render as a command line asks for it.
pub(crate) struct Run<'a> {
    pub scene: &'a Scene,
    pub outputs: Vec<PathBuf>,
    pub region: Rect,
    pub samples: Range<u64>,
    pub aovs: Vec<Aov>,
    pub device: &'a DeviceOptions,
}

impl Run<'_> {
    /// Renders and writes. Outputs that cannot be written are refused before anything is rendered.
    pub(crate) fn go(self, output: Output) -> Result<()> {
        let started = Instant::now();
        // Watched from the start: a signal must find no temporary file that nobody would remove.
        let signals = Watch::new();
        let targets = Target::prepare_all(&self.outputs)?;
        let mut device = self.open(output)?;
        let task = Task {
            region: self.region,
            samples: self.samples.clone(),
            features: !self.aovs.is_empty(),
            ..Task::new(self.scene)
        };
        let opening = started.elapsed();
        let rendering = self.render(device.as_mut(), &task, &signals, output);
        let rendering = match rendering {
            // The device cannot take this scene. Where any will do there is one that can.
            Err(Error::Device(reason)) if self.device.any() => {
                remark(
                    &format!("{reason}; rendering with the built-in CPU renderer"),
                    output,
                );
                device = Box::new(Cpu::new());
                self.render(device.as_mut(), &task, &signals, output)?
            }
            outcome => outcome?,
        };
        if rendering.film.counts.contains(&0) {
            remark(
                "stopped before every pixel had a sample: nothing is written",
                output,
            );
            return Ok(());
        }
        let mut picture = render::picture(&task, device.info(), &rendering, &self.aovs);
        name_outputs(&mut picture.record, &targets);
        picture.record.seconds.setup += opening.as_secs_f64();
        picture.record.seconds.total = started.elapsed().as_secs_f64();
        for target in targets {
            target.write(&picture)?;
        }
        if !output.quiet {
            warn_non_finite(&rendering.film);
            note(&summary(&picture.record));
        }
        if output.json {
            print(&(picture.record.to_json() + "\n"))
        } else {
            Ok(())
        }
    }

    fn open(&self, output: Output) -> Result<Box<dyn Device>> {
        let chosen = self.device.open()?;
        if let Some(text) = &chosen.remark {
            remark(text, output);
        }
        Ok(chosen.device)
    }

    /// Renders under a progress bar, until done or until a signal asks to stop.
    fn render(
        &self,
        device: &mut dyn Device,
        task: &Task,
        signals: &Watch,
        output: Output,
    ) -> Result<Rendering> {
        let bar = progress_bar(output, self.scene);
        let mut watch = |progress: Progress| {
            bar.set_length(progress.total);
            bar.set_position(progress.paths);
            if signals.stopped() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let rendering = render::render(device, task, &mut watch);
        bar.finish_and_clear();
        rendering
    }
}

fn remark(text: &str, output: Output) {
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
    bar.set_prefix(name.to_string_lossy().into_owned());
    bar
}

fn warn_non_finite(film: &Film) {
    if let Some(first) = &film.first_non_finite {
        note(&format!(
            "warning: {} of {} samples were not finite and count as black; the first is sample {} of pixel {},{}",
            film.non_finite, film.paths, first.sample, first.x, first.y
        ));
    }
}

/// One line on what was made: files, size, samples, speed, device.
fn summary(record: &Record) -> String {
    let state = if record.complete {
        ""
    } else {
        " (stopped early)"
    };
    let speed = record.paths as f64 / record.seconds.render.max(1e-9) / 1e6;
    format!(
        "{}: {}x{}, {} samples a pixel{state} in {:.2} s ({speed:.2} Msamples/s) on {}",
        record.outputs.join(", "),
        record.width,
        record.height,
        record.samples,
        record.seconds.render,
        record.device.name
    )
}
