mod calibrate;
mod gates;
mod parse;
mod report;

use super::options::{DeviceOptions, KnobOptions};
use super::{Output, note, plain, print};
use crate::compare::flip;
use crate::compare::verdict::{self, Outcome, Relation, Terms};
use crate::compare::{
    Comparison, Kinship, MapKind, Pair, Study, Viewing, Wishes, chart, compare, prepare_map, sides,
    write_map,
};
use crate::error::{Error, Result};
use crate::film::{Format, RasterFile};
use crate::place::Place;
use crate::wording::named;
use clap::{Args, ValueEnum};
use gates::Gates;
use report::report;
use serde::Serialize;
use std::borrow::Cow;
use std::fs;
use std::path::{Path, PathBuf};

/// Compare two pictures: metrics, limits, and a verdict that needs no limit
///
/// A is the reference, B the test; PNG or EXR, from lampray or any other program. Where both carry
/// their noise (EXR with variance.R, variance.G, variance.B and samples, as lampray writes it), the
/// verdict says whether their expected images are the same, different, or cannot be told apart yet,
/// with a stated chance of a false alarm. "Same" means that the samples exclude a difference of the
/// picture's mean beyond --margin; of its parts it tells what they exclude. Pictures of one seed are
/// compared as paired. Limits decide where there are any, else the verdict, else equality.
///
/// Exit code: 0 same, 1 different or over a limit, 2 trouble with the pictures, 3 not enough samples
/// to tell.
#[derive(Args)]
#[command(after_help = "Examples:
  lampray diff reference.exr new.exr                                  the verdict, and all metrics
  lampray diff reference.png new.png --metric flip --max 0.05
  lampray diff a.png b.png --metric mae --max 0.02 --allow-pixels 0.1%
  lampray diff a.exr b.exr --map where.png --map-kind z
  lampray diff reference.exr new.exr --bless                          new becomes the reference if it differs
  lampray diff --calibrate scene.toml --metric flip                   which limit, and how often it alarms for nothing")]
pub(crate) struct Command {
    /// The reference
    #[arg(value_name = "A", required_unless_present = "calibrate")]
    reference: Option<PathBuf>,
    /// The test
    #[arg(
        value_name = "B",
        required_unless_present = "calibrate",
        conflicts_with = "calibrate"
    )]
    test: Option<PathBuf>,
    #[command(flatten)]
    gates: Gates,
    /// Chance of calling pictures different that are not
    #[arg(
        long,
        value_name = "P",
        default_value_t = 0.01,
        help_heading = "Verdict"
    )]
    alpha: f64,
    /// "Same" must exclude differences of the mean beyond this, as a share of it
    #[arg(
        long,
        value_name = "SHARE",
        default_value_t = 0.01,
        help_heading = "Verdict"
    )]
    margin: f64,
    /// Relative differences that do not count anywhere
    #[arg(
        long,
        value_name = "SHARE",
        default_value_t = 1e-5,
        help_heading = "Verdict"
    )]
    tolerance: f64,
    /// Let the verdict count beside limits, too
    #[arg(long, help_heading = "Verdict")]
    verdict: bool,
    /// Compare only this part, in pixels
    #[arg(long, value_name = "X0,Y0,X1,Y1")]
    crop: Option<String>,
    /// Stops by which EXR pictures are brightened for ssim, ms-ssim and flip
    #[arg(
        long,
        value_name = "STOPS",
        default_value_t = 0.0,
        allow_negative_numbers = true,
        help_heading = "Viewing"
    )]
    exposure: f64,
    /// Pixels per degree of sight, for flip and hdr-flip
    #[arg(long, value_name = "N", default_value_t = flip::DEFAULT_PPD, help_heading = "Viewing")]
    ppd: f32,
    /// Exposures of hdr-flip, as an earlier comparison printed them; found from the reference without it
    #[arg(
        long,
        value_name = "START,STOP,COUNT",
        allow_hyphen_values = true,
        help_heading = "Viewing"
    )]
    exposures: Option<String>,
    /// Compare pictures with NaN or infinite pixels too; those must then be alike in both
    #[arg(long)]
    allow_non_finite: bool,
    /// Write where they differ: colours with a scale (.png) or numbers (.exr)
    #[arg(long, value_name = "FILE", help_heading = "Map")]
    map: Option<PathBuf>,
    /// What the map shows [default: z with a verdict, signed if paired, else flip]
    #[arg(long, value_name = "KIND", requires = "map", help_heading = "Map")]
    map_kind: Option<MapKind>,
    /// Replace A by B: if B is not the same (or A is not there), or in any case
    #[arg(long, value_name = "WHEN", num_args = 0..=1, default_missing_value = "different", require_equals = true,
        conflicts_with = "crop", help_heading = "References")]
    bless: Option<Bless>,
    /// Render this scene several times and propose a limit for each --metric; with A, against it
    #[arg(long, value_name = "SCENE", conflicts_with_all = ["map", "bless", "crop"], help_heading = "References")]
    calibrate: Option<PathBuf>,
    /// Calibrate: how many seeds on each device
    #[arg(long, value_name = "N", default_value_t = 12, requires = "calibrate", value_parser = clap::value_parser!(u32).range(8..=10_000), help_heading = "References")]
    seeds: u32,
    /// Calibrate: chance that the proposed limit fails a picture that is as it should be, 1e-6 to 0.5
    #[arg(
        long,
        value_name = "P",
        default_value_t = 0.001,
        requires = "calibrate",
        help_heading = "References"
    )]
    false_alarms: f64,
    #[command(flatten)]
    knobs: KnobOptions,
    #[command(flatten)]
    device: DeviceOptions,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Bless {
    /// If B is not the same as A
    Different,
    /// In any case
    All,
}

/// Exit codes that are not errors.
const SAME: u8 = 0;
const DIFFERENT: u8 = 1;
const TROUBLE: u8 = 2;
const NOT_ENOUGH: u8 = 3;

impl Command {
    /// Returns the exit code.
    pub(crate) fn run(self, output: Output) -> Result<u8> {
        let wishes = self.wishes()?;
        if let Some(scene) = &self.calibrate {
            return self.calibrate(scene, &wishes, output);
        }
        // Both are there, or there would be a message of usage.
        let (Some(reference), Some(test)) = (&self.reference, &self.test) else {
            return Err(Error::Usage("diff needs two pictures".into()));
        };
        self.check_calibration_only()?;
        if self.bless.is_some() && !reference.exists() {
            self.check_outputs(reference, test)?;
            // A reference that cannot be read would fail everybody from now on.
            RasterFile::open(test)?.read()?;
            bless(reference, test, output)?;
            if output.json {
                print_json(&serde_json::json!({ "a": reference, "b": test, "blessed": true }))?;
            }
            return Ok(SAME);
        }
        self.compare(reference, test, &wishes, output)
    }

    fn compare(
        &self,
        reference: &Path,
        test: &Path,
        wishes: &Wishes,
        output: Output,
    ) -> Result<u8> {
        self.check_outputs(reference, test)?;
        // Outputs that cannot be written are refused before the work. Nothing is held in their places
        // meanwhile, so that a signal leaves nothing behind.
        self.map.as_deref().map(prepare_map).transpose()?;
        self.bless.map(|_| Place::prepare(reference)).transpose()?;
        let crop = self.crop.as_deref().map(parse::crop).transpose()?;
        let pair = Pair::read(reference, test, crop)?;
        let study = Study::new(&pair, wishes.viewing);
        let comparison = compare(&study, wishes)?;
        let code = code(comparison.conclusion);
        if let Some(path) = &self.map {
            self.write_map(path, &study, wishes)?;
        }
        if output.json {
            let files = Files {
                a: reference.to_string_lossy(),
                b: test.to_string_lossy(),
                comparison: &comparison,
            };
            print_json(&files)?;
        } else {
            print(&plain(&report(&comparison, reference, test)))?;
        }
        match self.bless {
            Some(when) if when == Bless::All || code == DIFFERENT => {
                bless(reference, test, output)?;
                Ok(SAME)
            }
            _ => Ok(code),
        }
    }

    /// Options of rendering say nothing to pictures that are there.
    fn check_calibration_only(&self) -> Result<()> {
        if self.knobs.assignments()?.is_empty() && self.device.any() {
            return Ok(());
        }
        Err(Error::Usage(
            "knobs and devices are for --calibrate, which renders".into(),
        ))
    }

    /// Refuses outputs that would destroy an input, or make it something else than its name says.
    fn check_outputs(&self, reference: &Path, test: &Path) -> Result<()> {
        let same = |a: &Path, b: &Path| {
            fs::canonicalize(a).is_ok_and(|a| fs::canonicalize(b).is_ok_and(|b| a == b))
        };
        if let Some(map) = self
            .map
            .as_deref()
            .filter(|map| same(map, reference) || same(map, test))
        {
            return Err(Error::Usage(format!(
                "--map {}: that is one of the pictures",
                named(map)
            )));
        }
        if self.bless.is_some() && Format::of(reference) != Format::of(test) {
            return Err(Error::Usage(format!(
                "--bless would make {} a copy of {}, which is of another format",
                named(reference),
                named(test)
            )));
        }
        Ok(())
    }

    fn wishes(&self) -> Result<Wishes> {
        let share = |flag: &str, value: f64, least: f64, most: f64| {
            if (least..=most).contains(&value) {
                Ok(value)
            } else {
                Err(Error::Usage(format!(
                    "{flag} {value:e}: must be from {least:e} to {most}"
                )))
            }
        };
        if !(self.tolerance >= 0.0 && self.tolerance <= 1e6) {
            return Err(Error::Usage(format!(
                "--tolerance {}: must be from 0 to a million",
                self.tolerance
            )));
        }
        if !flip::PPD.contains(&self.ppd) {
            let (least, most) = (flip::PPD.start(), flip::PPD.end());
            return Err(Error::Usage(format!(
                "--ppd {}: must be from {least} to {most}",
                self.ppd
            )));
        }
        if !(-100.0..=100.0).contains(&self.exposure) {
            return Err(Error::Usage(format!(
                "--exposure {}: must be from -100 to 100",
                self.exposure
            )));
        }
        let (metrics, gates) = self.gates.read()?;
        Ok(Wishes {
            metrics,
            gates,
            viewing: Viewing {
                ppd: self.ppd,
                exposure: self.exposure,
                exposures: self
                    .exposures
                    .as_deref()
                    .map(parse::exposures)
                    .transpose()?,
            },
            terms: Terms {
                alpha: share("--alpha", self.alpha, 1e-9, 0.5)?,
                margin: share("--margin", self.margin, 1e-9, 1000.0)?,
                tolerance: self.tolerance,
            },
            verdict_counts: self.verdict,
            allow_non_finite: self.allow_non_finite,
        })
    }

    fn write_map(&self, path: &Path, study: &Study, wishes: &Wishes) -> Result<()> {
        let pair = study.pair;
        let related = pair.kinship();
        let paired = related.as_ref().is_some_and(|kinship| kinship.paired);
        let relation = related
            .as_ref()
            .map_or_else(Relation::default, Kinship::relation);
        let sides = sides(pair, relation).ok().filter(|_| !paired);
        let usual = match (&sides, paired) {
            (Some(_), _) => MapKind::Z,
            (None, true) => MapKind::Signed,
            (None, false) => MapKind::Flip,
        };
        let kind = self.map_kind.unwrap_or(usual);
        if kind == MapKind::Z && paired {
            return Err(Error::Usage("--map-kind z: both pictures were made of the same random numbers, which says nothing of the noise of a pixel; take signed".into()));
        }
        let z = sides.map(|sides| verdict::z_map(&sides, wishes.terms));
        write_map(prepare_map(path)?, &chart(study, kind, z)?)
    }
}

/// A comparison with the names of its files.
#[derive(Serialize)]
struct Files<'a> {
    a: Cow<'a, str>,
    b: Cow<'a, str>,
    #[serde(flatten)]
    comparison: &'a Comparison,
}

fn print_json(value: &impl Serialize) -> Result<()> {
    let json = serde_json::to_string(value).map_err(|error| Error::Internal(error.to_string()))?;
    print(&(json + "\n"))
}

/// What a failure of `diff` itself exits with: pictures that cannot be read are its trouble, like
/// those of any `diff`.
pub(crate) fn trouble(error: &Error) -> Option<u8> {
    matches!(error, Error::Data { .. } | Error::Input { .. }).then_some(TROUBLE)
}

fn code(conclusion: Outcome) -> u8 {
    match conclusion {
        Outcome::Same => SAME,
        Outcome::Different => DIFFERENT,
        Outcome::NotEnoughSamples => NOT_ENOUGH,
    }
}

fn remark(text: &str, output: Output) {
    if !output.quiet {
        note(text);
    }
}

/// Copies the test over the reference, as whole as any output.
fn bless(reference: &Path, test: &Path, output: Output) -> Result<()> {
    let bytes = fs::read(test).map_err(|source| Error::Input {
        path: test.into(),
        source,
    })?;
    Place::prepare(reference)?.write(|sink| sink.write_all(&bytes))?;
    let (reference, test) = (named(reference), named(test));
    remark(&format!("{reference} is now a copy of {test}"), output);
    Ok(())
}
