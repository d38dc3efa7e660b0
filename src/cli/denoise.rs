//! `--denoise`: a second picture beside each output.

use crate::error::{Error, Result};
use crate::film::{Denoising, Format};
use clap::Args;
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
    /// Differences of luminance taken for noise, in standard errors: more is smoother, and blurs shadows
    #[arg(long, value_name = "S", requires = "denoise", value_parser = width, default_value_t = Denoising::USUAL.luminance, allow_negative_numbers = true, help_heading = "Denoising")]
    denoise_luminance: f64,
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
            luminance: self.denoise_luminance,
            normal: self.denoise_normal,
            depth: self.denoise_depth,
        })
    }
}

fn width(text: &str) -> std::result::Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if (1e-3..=1e3).contains(&value) => Ok(value),
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
