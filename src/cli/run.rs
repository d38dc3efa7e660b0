//! What `render` and `rerun` share: from a scene to files and a record.

use super::options::DeviceOptions;
use super::signal::Watch;
use super::{Output, note, print};
use crate::error::Result;
use crate::film::{Aov, Features, Film, Picture, Record, Seconds, Target, name_outputs};
use crate::pack::Rect;
use crate::render::{self, Progress, Rendering, Task};
use crate::scene::Scene;
use indicatif::{ProgressBar, ProgressStyle};
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

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
        let targets = Target::prepare_all(&self.outputs)?;
        let mut chosen = self.device.open()?;
        if let (Some(remark), false) = (&chosen.remark, output.quiet) {
            note(&format!("lampray: {remark}"));
        }
        let task = Task {
            scene: self.scene,
            region: self.region,
            samples: self.samples.clone(),
            features: !self.aovs.is_empty(),
        };
        let opening = started.elapsed();
        let bar = progress_bar(output, self.scene);
        let signals = Watch::new();
        let mut watch = |progress: Progress| {
            bar.set_length(progress.total);
            bar.set_position(progress.paths);
            if signals.stopped() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let rendering = render::render(chosen.device.as_mut(), &task, &mut watch)?;
        bar.finish_and_clear();
        let mut record = self.record(chosen.device.info(), &rendering);
        name_outputs(&mut record, &targets);
        record.seconds.setup += opening.as_secs_f64();
        record.seconds.total = started.elapsed().as_secs_f64();
        let picture = self.picture(&rendering, record);
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

    fn record(&self, device: &crate::device::DeviceInfo, rendering: &Rendering) -> Record {
        let settings = &self.scene.settings;
        let whole = render::whole(self.scene);
        let crop = (self.region != whole).then_some(self.region);
        Record {
            version: env!("CARGO_PKG_VERSION").into(),
            scene: self.scene.source.name.clone(),
            scene_hash: scene_hash(&self.scene.source.text),
            shader_hash: crate::shader::library_hash(),
            preset: settings.preset.to_string(),
            knobs: self.scene.knobs.clone(),
            device: device.clone(),
            devices: Vec::new(),
            width: self.region.width(),
            height: self.region.height(),
            crop: crop.map(|rect| [rect.x0, rect.y0, rect.x1, rect.y1]),
            samples: rendering.film.counts.iter().copied().min().unwrap_or(0),
            sample_range: taken(self.samples.start, &rendering.film),
            sample_ranges: Vec::new(),
            seed: settings.render.seed,
            complete: rendering.complete,
            biased: settings.biased(),
            seconds: Seconds {
                setup: rendering.setup.as_secs_f64(),
                render: rendering.tracing.as_secs_f64(),
                total: 0.0,
            },
            paths: 0,
            rays: 0,
            non_finite: 0,
            mean: [0.0; 3],
            standard_error: [0.0; 3],
            outputs: Vec::new(),
        }
    }

    fn picture(&self, rendering: &Rendering, record: Record) -> Picture {
        let features = rendering
            .features
            .as_ref()
            .and_then(|pixels| Features::new(pixels, &self.aovs));
        rendering
            .film
            .picture(record, features, Some(self.scene.source.text.clone()))
    }
}

/// The samples that some pixel has: a render that was stopped may have given some more than others.
fn taken(first: u64, film: &Film) -> [u64; 2] {
    [
        first,
        first + film.counts.iter().copied().max().unwrap_or(0),
    ]
}

/// Identifies a scene's text in records.
pub(crate) fn scene_hash(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_hex()[..16].into()
}

/// A bar on a terminal, nothing elsewhere.
fn progress_bar(output: Output, scene: &Scene) -> ProgressBar {
    if output.quiet {
        return ProgressBar::hidden();
    }
    let name = Path::new(&scene.source.name)
        .file_stem()
        .unwrap_or_default();
    let style = ProgressStyle::with_template("{prefix} {wide_bar} {percent}% {elapsed}/{duration}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::no_length().with_style(style);
    bar.set_prefix(name.to_string_lossy().into_owned());
    bar.enable_steady_tick(Duration::from_millis(200));
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
