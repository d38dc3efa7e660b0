use super::keep::KeepOptions;
use super::options::DeviceOptions;
use super::run::{Run, StopRules};
use super::signal::Watch;
use super::{Output, Result, note};
use crate::device::DeviceKind;
use crate::error::Error;
use crate::film::{AdaptiveRecord, Aov, Record, Stop, is_png, read_exr, read_record};
use crate::pack::Rect;
use crate::render::{ADAPTIVE_RULE, scene_hash, whole};
use crate::scene::{Assignment, Scene};
use crate::wording::named;
use clap::Args;
use std::path::{Path, PathBuf};

/// Render again from the record inside a picture
///
/// Takes the scene, every knob, the crop and the samples from the PNG or EXR. On the same device,
/// driver and version the pixels are the same, byte for byte. Of a render that was stopped when some pixels had more
/// samples than others the EXR says how many each gets; a PNG of it is refused. Of a denoised picture both are made
/// again: the picture that it was made of, and NAME.denoised.png or NAME.denoised.exr beside it. The new record says of
/// the samples what the first did: whether they are all that were asked for, why not, and how they were shared out.
#[derive(Args)]
#[command(after_help = "Example:\n  lampray rerun cornell.png -o again.exr")]
pub(crate) struct Command {
    /// A PNG or EXR that lampray wrote
    image: PathBuf,
    /// Where to write; .png or .exr, may be given several times
    #[arg(short, long = "output", required = true, value_name = "FILE")]
    outputs: Vec<PathBuf>,
    #[command(flatten)]
    device: DeviceOptions,
    /// Add layers of first hits to the EXR
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    aov: Vec<Aov>,
}

impl Command {
    pub(crate) fn run(self, output: Output) -> Result<()> {
        let signals = Watch::of_render();
        let (record, text) = read_record(&self.image)?;
        let scene = scene_of(&self.image, &record, text)?;
        if record.shader_hash != crate::shader::library_hash() && !output.quiet {
            note(&format!(
                "warning: {} was made by lampray {} with other shaders: the pixels may differ",
                named(&self.image),
                record.version
            ));
        }
        let region = region_of(&self.image, &record, &scene)?;
        let counts = counts_of(&self.image, &record, region)?;
        let [first, end] = whole_range(&self.image, &record, counts.is_some())?;
        let denoise = record.denoised.as_ref().map(|denoised| denoised.by);
        if denoise.is_some_and(|by| !by.is_sound()) {
            return damaged(
                &self.image,
                "its record says how it was denoised, and that cannot be".into(),
            );
        }
        let (rules, again) = match (&record.adaptive, &counts) {
            (Some(_), None) => (StopRules::adaptive(record.target_error), None),
            _ => (StopRules::default(), Some(&record)),
        };
        let device = device_of(&self.device, &record);
        let (outputs, aovs) = (self.outputs, self.aov);
        Run {
            scene: &scene,
            outputs,
            region,
            samples: first..end,
            counts,
            again,
            aovs,
            denoise,
            device: &device,
            rules,
            keep: KeepOptions::default(),
            no_times: false,
            signals,
        }
        .go(output)
    }
}

/// Says of a picture whose samples are those of a first one how they were shared out there; once it has all of them,
/// also how the first one ended, which had perhaps been asked for more.
pub(super) fn take_over(again: &mut Record, first: &Record, whole: bool) {
    again.target_error = first.target_error;
    again.adaptive = first.adaptive.clone();
    if whole {
        again.complete = first.complete;
        again.stopped = first.stopped;
    }
}

/// The scene with every knob of the record laid over it.
fn scene_of(image: &Path, record: &Record, text: Option<String>) -> Result<Scene> {
    let text = match text {
        Some(text) => text,
        None => Scene::read_text(Path::new(&record.scene))?,
    };
    if scene_hash(&text) != record.scene_hash {
        return damaged(
            image,
            format!("its scene {} has changed since", record.scene),
        );
    }
    let knobs: Vec<_> = record
        .knobs
        .iter()
        .map(|(path, value)| Assignment::from_record(path, value))
        .collect();
    let fault = |error: Error| match error {
        Error::Knob(reason) => Error::Data {
            path: image.into(),
            reason,
        },
        other => other,
    };
    Scene::parse(&record.scene, &text, &knobs).map_err(fault)
}

fn region_of(image: &Path, record: &Record, scene: &Scene) -> Result<Rect> {
    let all = whole(scene);
    match record.crop {
        None => Ok(all),
        Some([x0, y0, x1, y1]) if x0 < x1 && y0 < y1 && x1 <= all.x1 && y1 <= all.y1 => {
            Ok(Rect { x0, y0, x1, y1 })
        }
        Some(_) => damaged(image, "its crop lies outside its image".into()),
    }
}

/// The samples of each pixel, where they follow from nothing that can be done again: the render was stopped when some
/// pixels had more than others, or shared them out by a rule of another version.
fn counts_of(image: &Path, record: &Record, region: Rect) -> Result<Option<Vec<u64>>> {
    let [first, end] = record.sample_range;
    let all_alike = record.samples == end.saturating_sub(first);
    let ended = record.complete || record.stopped == Some(Stop::TargetError);
    let follows = match &record.adaptive {
        Some(adaptive) => ended && adaptive.rule == ADAPTIVE_RULE,
        None => all_alike,
    };
    if follows || record.ranges().len() > 1 {
        return Ok(None);
    }
    if is_png(image)? {
        return damaged(
            image,
            format!(
                "some of its pixels have {} samples and others up to {}, and a PNG does not say which: give the EXR",
                record.samples,
                end.saturating_sub(first)
            ),
        );
    }
    let counts: Vec<_> = read_exr(image)?
        .samples
        .iter()
        .map(|count| *count as u64)
        .collect();
    let sum = counts.iter().copied().fold(0, u64::saturating_add);
    let most = counts.iter().copied().max().unwrap_or(0);
    let sizes = [counts.len(), region.area()];
    if sizes[0] != sizes[1] || sum != record.paths || Some(most) != end.checked_sub(first) {
        return damaged(
            image,
            "its counts of samples are not those of its record".into(),
        );
    }
    Ok(Some(counts))
}

/// The range of samples, where it is one; of an adaptive render whose samples are shared out again the range that its
/// pixels could take from.
fn whole_range(image: &Path, record: &Record, counted: bool) -> Result<[u64; 2]> {
    let ranges = match &record.adaptive {
        Some(adaptive) if !counted => adaptive.allowed.clone(),
        _ => record.ranges(),
    };
    let merged = |adaptive: &AdaptiveRecord| adaptive.allowed.len() > 1;
    let parts = record.adaptive.as_ref().is_some_and(merged);
    match ranges.as_slice() {
        _ if parts => damaged(
            image,
            "it was merged, and the samples of a part went where the error was: render its parts one by one".into(),
        ),
        [[first, end]] if first < end && *end <= 1 << 63 => Ok([*first, *end]),
        [_] => damaged(image, "its range of samples is empty".into()),
        _ => damaged(
            image,
            "it was merged from ranges with gaps: render those one by one".into(),
        ),
    }
}

fn damaged<T>(image: &Path, reason: String) -> Result<T> {
    Err(Error::Data {
        path: image.into(),
        reason,
    })
}

/// The device of the record where none is asked for: the CPU twin stays the CPU twin.
fn device_of(asked: &DeviceOptions, record: &Record) -> DeviceOptions {
    match record.device.kind {
        DeviceKind::Cpu => asked.clone().or("cpu"),
        DeviceKind::Software | DeviceKind::Hardware => asked.clone(),
    }
}
