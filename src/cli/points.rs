use super::options::{DeviceOptions, KnobOptions, refuse_mixed};
use super::{Output, Result, note, print};
use crate::error::Error;
use crate::points::{self, Kind, Request};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Sampler {
    /// Points on a spherical lamp, by light.sampler
    Light,
    /// Directions that a surface scatters into
    Scatter,
}

/// Draw samples with the renderer's own functions
///
/// Light: points of a lamp of radius 1 around the origin, as a receiver on the z axis draws them.
/// Scatter: unit directions about a surface whose normal is the z axis, lit from the x-z plane.
/// CSV has the columns x, y, z, density (by solid angle; empty where there is none) and counts
/// (0 where the point faces away or the direction goes below the surface).
#[derive(Args)]
#[command(after_help = "Examples:
  lampray points light --set light.sampler=uniform-angles -n 800 -o poles.svg
  lampray points scatter --scatter directional --spread 0.3 --incidence 45 -o lobe.png
  lampray points scatter --scatter rough --roughness 0.4 --incidence 75 -n 100000 > facets.csv
  lampray points light -n 100000 --set light.sampler=gaussian > points.csv")]
pub(crate) struct Command {
    #[arg(value_enum)]
    sampler: Sampler,
    /// How many
    #[arg(short = 'n', long, default_value_t = 800, value_name = "N",
          value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    count: u32,
    /// Where to write: .csv, .png or .svg; CSV on stdout without it
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Light: distance from the lamp's centre to the receiver, in lamp radii
    #[arg(long, default_value_t = 4.0, value_name = "RADII")]
    distance: f64,
    /// Scatter: diffuse, directional, mirror, rough or glass
    #[arg(long, default_value = "directional", value_name = "NAME")]
    scatter: String,
    /// Scatter: sigma of the directional angle, radians
    #[arg(long, default_value_t = 0.3, value_name = "RADIANS")]
    spread: f64,
    /// Scatter: GGX alpha of a rough mirror
    #[arg(long, default_value_t = 0.3, value_name = "ALPHA")]
    roughness: f64,
    /// Scatter: refractive index of glass
    #[arg(long, default_value_t = 1.5, value_name = "INDEX")]
    index: f64,
    /// Scatter: the ray arrives from inside the body; only glass makes a difference
    #[arg(long)]
    inside: bool,
    /// Scatter: angle between the arriving ray and the normal, degrees (45). Light: angle between the receiver's
    /// normal and the line to the lamp's centre, which light.sampler=projected-cap asks for (0)
    #[arg(long, value_name = "DEGREES")]
    incidence: Option<f64>,
    #[command(flatten)]
    knobs: KnobOptions,
    #[command(flatten)]
    device: DeviceOptions,
}

impl Command {
    pub(crate) fn run(self, output: Output) -> Result<()> {
        let kind = match self.sampler {
            Sampler::Light => Kind::Light {
                distance: within("--distance", self.distance, 0.0, 1e6)?,
                incidence: within("--incidence", self.incidence.unwrap_or(0.0), 0.0, 180.0)?,
            },
            Sampler::Scatter => Kind::Scatter {
                scatter: points::scatter(&self.scatter)?,
                spread: within("--spread", self.spread, 1e-12, 1e12)?,
                roughness: within("--roughness", self.roughness, 0.0, 1.0)?,
                index: within("--index", self.index, 1.0, 4.0)?,
                inside: self.inside,
                incidence: within("--incidence", self.incidence.unwrap_or(45.0), 0.0, 89.999)?,
            },
        };
        let request = Request {
            kind,
            count: self.count,
            knobs: self.knobs.assignments()?,
        };
        refuse_mixed(&self.output, output)?;
        let sink = points::Sink::prepare(self.output.as_deref())?;
        let mut chosen = self.device.open()?;
        if let (Some(remark), false) = (&chosen.remark, output.quiet) {
            note(&format!("lampray: {remark}"));
        }
        let cloud = points::draw(chosen.device.as_mut(), &request)?;
        let page = sink.write(&cloud)?;
        if output.json {
            return print(&(cloud.to_json(&self.output) + "\n"));
        }
        if !output.quiet {
            note(&cloud.summary());
        }
        page.map_or(Ok(()), |csv| print(&csv))
    }
}

fn within(flag: &str, value: f64, least: f64, most: f64) -> Result<f64> {
    if value >= least && value <= most {
        return Ok(value);
    }
    Err(Error::Usage(format!(
        "{flag} {value}: must be between {least} and {most}"
    )))
}
