//! Arguments that several commands share, and their one conversion each.

use super::Output;
use crate::device::{Device, DeviceKind, DeviceRequest};
use crate::error::{Error, Result};
use crate::pack::Rect;
use crate::place::is_standard_output;
use crate::render::{self, Chosen};
use crate::scene::{Assignment, Scene};
use crate::sweep::Axis;
use crate::wording::named;
use clap::{Args, ValueEnum};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Knobs over what the scene says.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct KnobOptions {
    /// Set a knob over what the scene says; may be given many times, the last one counts
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    #[command(flatten)]
    short: ShortKnobs,
}

/// Knobs with a flag of their own.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct ShortKnobs {
    /// Short for --set image.width=PIXELS
    #[arg(long, value_name = "PIXELS")]
    width: Option<String>,
    /// Short for --set image.height=PIXELS
    #[arg(long, value_name = "PIXELS")]
    height: Option<String>,
    /// Paths a pixel: short for --set render.samples=N
    #[arg(short, long, visible_alias = "spp", value_name = "N")]
    samples: Option<String>,
    /// Short for --set render.seed=N
    #[arg(long, value_name = "N")]
    seed: Option<String>,
    /// Short for --set render.max_bounces=N
    #[arg(long, value_name = "N")]
    max_bounces: Option<String>,
    /// montelight, paper, corrected or reference: short for --set render.preset=NAME
    #[arg(long, value_name = "NAME")]
    preset: Option<String>,
}

impl KnobOptions {
    /// All of them as assignments; the short forms come last, and so count.
    pub(crate) fn assignments(&self) -> Result<Vec<Assignment>> {
        let mut all: Vec<_> = self
            .set
            .iter()
            .map(|text| Assignment::parse(text))
            .collect::<Result<_>>()?;
        all.extend(self.short.assignments());
        Ok(all)
    }

    pub(crate) fn load(&self, path: &Path) -> Result<Scene> {
        Scene::load(path, &self.assignments()?)
    }
}

impl ShortKnobs {
    pub(crate) fn assignments(&self) -> Vec<Assignment> {
        let assignment = |[path, flag, value]: [&str; 3]| {
            Assignment::new(path, value, format!("{flag} {value}"))
        };
        self.given().map(assignment).collect()
    }

    /// Path, flag and value of those that are given.
    fn given(&self) -> impl Iterator<Item = [&str; 3]> {
        let short = [
            ("image.width", "--width", &self.width),
            ("image.height", "--height", &self.height),
            ("render.samples", "--samples", &self.samples),
            ("render.seed", "--seed", &self.seed),
            ("render.max_bounces", "--max-bounces", &self.max_bounces),
            ("render.preset", "--preset", &self.preset),
        ];
        let given = short.into_iter();
        given.filter_map(|(path, flag, value)| Some([path, flag, value.as_deref()?]))
    }

    /// Refuses a knob that is swept, too: one of the two would be passed over.
    ///
    /// # Errors
    /// [`Error::Usage`].
    pub(crate) fn refuse_swept(&self, axes: &[Axis]) -> Result<()> {
        let is_swept = |path: &str| axes.iter().any(|axis| axis.path == path);
        match self.given().find(|[path, ..]| is_swept(path)) {
            None => Ok(()),
            Some([path, flag, _]) => Err(Error::Usage(format!(
                "{path} is swept, and {flag} sets it: one of the two"
            ))),
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Require {
    Hardware,
    Software,
}

/// Which device.
#[derive(Args, Clone, Debug)]
pub(crate) struct DeviceOptions {
    /// auto, cpu, gpu, software, a number or part of a name from `lampray devices`, or pci:ADDRESS
    /// [default: auto]
    #[arg(long, value_name = "WHICH")]
    device: Option<String>,
    /// Fail rather than use another kind of device
    #[arg(long, value_name = "KIND")]
    require: Option<Require>,
}

impl DeviceOptions {
    /// These options, with another device where none is asked for.
    pub(crate) fn or(self, device: &str) -> Self {
        Self {
            device: self.device.or_else(|| Some(device.into())),
            ..self
        }
    }

    /// Whether any device will do.
    pub(crate) fn any(&self) -> bool {
        self.require.is_none() && self.device.as_deref().is_none_or(|device| device == "auto")
    }

    pub(crate) fn open(&self) -> Result<Chosen> {
        let (request, require) = self.wanted()?;
        render::open(&request, require)
    }

    /// [`DeviceOptions::open`] for the doctor.
    pub(crate) fn open_unexamined(&self) -> Result<Chosen> {
        let (request, require) = self.wanted()?;
        render::open_unexamined(&request, require)
    }

    fn wanted(&self) -> Result<(DeviceRequest, Option<DeviceKind>)> {
        let request: DeviceRequest = self.device.as_deref().unwrap_or("auto").parse()?;
        let require = self.require.map(|kind| match kind {
            Require::Hardware => DeviceKind::Hardware,
            Require::Software => DeviceKind::Software,
        });
        Ok((request, require))
    }
}

impl DeviceOptions {
    /// The device that is asked for; without one, each that is here and opens.
    pub(crate) fn open_all(&self) -> Result<Vec<Box<dyn Device>>> {
        if !self.any() {
            return Ok(vec![self.open()?.device]);
        }
        let open =
            |index| render::open(&DeviceRequest::Index(index), None).map(|chosen| chosen.device);
        let opened: Vec<_> = (0..render::devices().len())
            .filter_map(|index| open(index).ok())
            .collect();
        Ok(opened)
    }
}

/// `X0,Y0,X1,Y1` inside an image.
pub(crate) fn crop(text: &str, scene: &Scene) -> Result<Rect> {
    let all = render::whole(scene);
    let numbers: Option<Vec<u32>> = text
        .split(',')
        .map(|part| part.trim().parse().ok())
        .collect();
    match numbers.as_deref() {
        Some(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 && x1 <= all.x1 && y1 <= all.y1 => {
            Ok(Rect { x0, y0, x1, y1 })
        }
        _ => Err(Error::Usage(format!(
            "--crop {text}: give X0,Y0,X1,Y1 in pixels with 0 <= X0 < X1 <= {} and 0 <= Y0 < Y1 <= {}",
            all.x1, all.y1
        ))),
    }
}

/// Refuses a picture where JSON goes: nobody could read either.
///
/// # Errors
/// [`Error::Usage`].
pub(crate) fn refuse_mixed<'p>(
    outputs: impl IntoIterator<Item = &'p PathBuf>,
    output: Output,
) -> Result<()> {
    let mut outputs = outputs.into_iter();
    match outputs.find(|path| output.json && is_standard_output(path)) {
        None => Ok(()),
        Some(path) => Err(Error::Usage(format!(
            "output {} is standard output, where --json prints: leave one of them out, or give -o a file",
            named(path)
        ))),
    }
}

/// A number of seconds above 0, at most a year.
pub(crate) fn seconds(text: &str) -> std::result::Result<Duration, String> {
    const YEAR: f64 = 366.0 * 86400.0;
    match text.trim().parse::<f64>() {
        Ok(value) if value > 0.0 && value <= YEAR => Ok(Duration::from_secs_f64(value)),
        _ => Err("give seconds above 0, at most a year".into()),
    }
}

/// An error relative to the mean: above 0, below 1.
pub(crate) fn relative_error(text: &str) -> std::result::Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value > 0.0 && value < 1.0 => Ok(value),
        _ => Err(
            "give an error relative to the mean, above 0 and below 1 (0.01 is one percent)".into(),
        ),
    }
}

/// `A..B` with A < B, at most 2^63.
pub(crate) fn sample_range(text: &str) -> Result<Range<u64>> {
    let parsed = text.split_once("..").and_then(|(start, end)| {
        Some(start.trim().parse::<u64>().ok()?..end.trim().parse::<u64>().ok()?)
    });
    match parsed {
        Some(range) if range.start < range.end && range.end <= 1 << 63 => Ok(range),
        _ => Err(Error::Usage(format!(
            "--sample-range {text}: give A..B with A < B, whole numbers up to 2^63, B exclusive (for example 0..64)"
        ))),
    }
}
