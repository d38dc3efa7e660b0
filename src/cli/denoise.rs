//! `--denoise`: a second picture beside each output.

use super::progress::bar;
use super::run::{Session, first_failure, remark};
use super::{Output, note};
use crate::denoise;
use crate::device::Device;
use crate::error::{Error, Result};
use crate::film::{Denoising, Format, Picture, Record, Seconds, Stop, Target, name_outputs};
use crate::render::{Rendering, Spares};
use crate::wording::{all_named, signed};
use clap::Args;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// A picture for looking at, beside the one for measuring.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct DenoiseOptions {
    /// Write NAME.denoised.png beside NAME.png, and NAME.denoised.exr beside NAME.exr: the same picture with its noise
    /// filtered out, for looking at. It is biased, and says so in its record; the EXR has no variance
    #[arg(long, help_heading = "Denoising")]
    denoise: bool,
    /// Passes of the filter: the last looks 2^N pixels far
    #[arg(long, value_name = "N", requires = "denoise", value_parser = clap::value_parser!(u32).range(1..=8), default_value_t = Denoising::USUAL.passes, help_heading = "Denoising")]
    denoise_passes: u32,
    /// Differences of light taken for noise, in standard errors: more is smoother, and blurs shadows
    #[arg(long, value_name = "S", requires = "denoise", value_parser = width, default_value_t = Denoising::USUAL.light, allow_negative_numbers = true, help_heading = "Denoising")]
    denoise_light: f64,
    /// Differences of normals that may mix, as the distance between the tips of unit normals
    #[arg(long, value_name = "S", requires = "denoise", value_parser = width, default_value_t = Denoising::USUAL.normal, allow_negative_numbers = true, help_heading = "Denoising")]
    denoise_normal: f64,
    /// Distances between surfaces that may mix, in widths of a pixel
    #[arg(long, value_name = "S", requires = "denoise", value_parser = width, default_value_t = Denoising::USUAL.depth, allow_negative_numbers = true, help_heading = "Denoising")]
    denoise_depth: f64,
}

impl DenoiseOptions {
    /// How to denoise, where that is asked for.
    pub(crate) fn wanted(&self) -> Option<Denoising> {
        self.denoise.then_some(Denoising {
            passes: self.denoise_passes,
            light: self.denoise_light,
            normal: self.denoise_normal,
            depth: self.denoise_depth,
        })
    }
}

fn width(text: &str) -> std::result::Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if Denoising::WIDTHS.contains(&value) => Ok(value),
        _ => Err("give a width from 0.001 to 1000".into()),
    }
}

/// Where the denoised pictures go: beside each output that is a file by its name.
///
/// # Errors
/// [`Error::Usage`] where that is none of them: a pipe has nothing beside it.
pub(crate) fn beside(outputs: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let named: Vec<_> = outputs
        .iter()
        .filter_map(|path| denoised_name(path))
        .collect();
    if named.is_empty() {
        let message = "--denoise writes beside the outputs, and none of them is a file: give -o NAME.png or -o NAME.exr";
        return Err(Error::Usage(message.into()));
    }
    Ok(named)
}

fn denoised_name(path: &Path) -> Option<PathBuf> {
    Format::of(path)?;
    let mut name = path.file_stem()?.to_os_string();
    name.push(".denoised.");
    name.push(path.extension()?);
    Some(path.with_file_name(name))
}

impl Session<'_> {
    /// Writes the pictures without noise, where they are wanted, and names them in the record that is printed; whether
    /// there is nothing left to do. The picture that they are made of has been written: a signal leaves that.
    pub(super) fn denoise(
        &self,
        device: &mut Box<dyn Device>,
        rendering: &Rendering,
        targets: Vec<Target>,
        record: Option<&mut Record>,
    ) -> Result<bool> {
        let (Some(by), Some(record)) = (self.run.denoise, record) else {
            return Ok(true);
        };
        let stopped = rendering.stopped == Some(Stop::Signal);
        let picture = self.picture(rendering).filter(|_| !stopped);
        let smoothed = match &picture {
            Some(picture) => self.smooth(device, picture, by)?,
            None => None,
        };
        let Some(mut smoothed) = smoothed else {
            remark("stopped: no denoised picture is written", self.output);
            return Ok(false);
        };
        name_outputs(&mut smoothed.record, &targets);
        if picture.as_ref().is_some_and(denoise::is_faint) {
            let text = "warning: the light is so faint that 32 bits hold little or nothing of its variance, by which the denoiser goes: noise is left in; give the lamps more emission";
            remark(text, self.output);
        }
        record.outputs.extend(smoothed.record.outputs.clone());
        tell_of_denoising(&smoothed.record, self.output);
        if self.run.no_times {
            smoothed.record.seconds = Seconds::default();
            if let Some(denoised) = &mut smoothed.record.denoised {
                denoised.seconds = 0.0;
            }
        }
        let written = targets.into_iter().map(|target| target.write(&smoothed));
        first_failure(written).map(|()| true)
    }

    /// The picture without noise; none where a signal came first.
    fn smooth(
        &self,
        device: &mut Box<dyn Device>,
        picture: &Picture,
        by: Denoising,
    ) -> Result<Option<Picture>> {
        let bar = bar(self.output, "denoising {wide_bar} {percent}% {elapsed}");
        bar.set_length(1000);
        let mut watch = |share: f64| {
            bar.set_position((share * 1000.0) as u64);
            match self.run.signals.stopped() {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        };
        let spares = Spares {
            anew: &mut || self.run.device.open().map(|chosen| chosen.device),
            any: self.run.device.any(),
            tell: &mut |text| bar.suspend(|| remark(text, self.output)),
        };
        let smoothed = denoise::denoise(device, self.task, picture, by, spares, &mut watch);
        bar.finish_and_clear();
        smoothed
    }
}

/// What to know of the pictures without noise, and one line on them.
fn tell_of_denoising(record: &Record, output: Output) {
    let Some(denoised) = record.denoised.as_ref().filter(|_| !output.quiet) else {
        return;
    };
    for warning in &denoised.warnings {
        remark(&format!("warning: {warning}"), output);
    }
    let (channel, share) = denoised.largest_change();
    note(&format!(
        "{}: denoised in {:.2} s; the mean changed by {} % ({channel})",
        all_named(&record.outputs),
        denoised.seconds,
        signed(100.0 * share, 2)
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn denoised_pictures_stand_beside() {
        let outputs = ["a/room.png", "/dev/stdout", "x.y.EXR"].map(PathBuf::from);
        let beside = beside(&outputs).unwrap();
        assert_eq!(
            beside,
            ["a/room.denoised.png", "x.y.denoised.EXR"].map(PathBuf::from)
        );
        assert!(super::beside(&["/dev/stdout".into()]).is_err());
    }
}
