use super::denoise::DenoiseOptions;
use super::keep::KeepOptions;
use super::options::{DeviceOptions, KnobOptions, crop, sample_range};
use super::run::{Run, StopRules};
use super::signal::Watch;
use super::{Output, Result};
use crate::error::Error;
use crate::film::Aov;
use crate::render::whole;
use clap::Args;
use std::path::{Path, PathBuf};

/// Render a picture of a scene
///
/// Writes STEM.png and STEM.exr into the current folder unless -o says otherwise. The EXR holds
/// mean radiance, its variance and the sample count; both carry the run record. --denoise writes STEM.denoised.png
/// and STEM.denoised.exr too.
#[derive(Args)]
#[command(after_help = "Examples:
  lampray render scenes/cornell.toml
  lampray render scenes/cornell.toml --preset paper --spp 50 --width 128 --height 128 -o paper.png
  lampray render scenes/cornell.toml --set light.sampler=gaussian --set 'materials.red.albedo=[0.6,0.1,0.1]'
  lampray render scenes/cornell.toml --sample-range 64..128 -o second-half.exr
  lampray render scenes/cornell.toml --denoise -o room.png                  # and room.denoised.png")]
pub(crate) struct Command {
    /// Scene file (TOML)
    scene: PathBuf,
    /// Where to write; .png or .exr, may be given several times
    #[arg(short, long = "output", value_name = "FILE")]
    outputs: Vec<PathBuf>,
    #[command(flatten)]
    knobs: KnobOptions,
    #[command(flatten)]
    device: DeviceOptions,
    /// Render only this part of the image; its pixels are those of the whole image
    #[arg(long, value_name = "X0,Y0,X1,Y1")]
    crop: Option<String>,
    /// Take samples A to B - 1 of each pixel, whatever render.samples says
    #[arg(long, value_name = "A..B")]
    sample_range: Option<String>,
    /// Add layers of first hits to the EXR
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    aov: Vec<Aov>,
    #[command(flatten)]
    denoise: DenoiseOptions,
    #[command(flatten)]
    rules: StopRules,
    #[command(flatten)]
    keep: KeepOptions,
    /// Leave times out of the files: equal renders are then equal files
    #[arg(long)]
    no_times: bool,
}

impl Command {
    pub(crate) fn run(self, output: Output) -> Result<()> {
        let signals = Watch::of_render();
        let scene = self.knobs.load(&self.scene)?;
        let region = match &self.crop {
            Some(text) => crop(text, &scene)?,
            None => whole(&scene),
        };
        let samples = match &self.sample_range {
            Some(text) => sample_range(text)?,
            None => 0..scene.settings.render.samples,
        };
        let outputs = if self.outputs.is_empty() {
            default_outputs(&self.scene)?
        } else {
            self.outputs
        };
        Run {
            scene: &scene,
            outputs,
            region,
            samples,
            counts: None,
            again: None,
            aovs: self.aov,
            denoise: self.denoise.wanted(),
            device: &self.device,
            rules: self.rules,
            keep: self.keep,
            no_times: self.no_times,
            signals,
        }
        .go(output)
    }
}

/// `STEM.png` and `STEM.exr` in the current folder.
fn default_outputs(scene: &Path) -> Result<Vec<PathBuf>> {
    let stem = scene.file_stem().filter(|stem| !stem.is_empty());
    let stem = stem.ok_or_else(|| {
        Error::Usage("the scene has no file name to call the pictures by: give -o".into())
    })?;
    Ok(["png", "exr"]
        .map(|extension| Path::new(stem).with_extension(extension))
        .to_vec())
}
