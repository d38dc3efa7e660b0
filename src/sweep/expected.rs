//! Which expected pictures the runs of a plan have, and the renders that show each: references.
//!
//! Whatever decides the expected picture stays as the run has it: camera, shapes, materials, size, filter,
//! reflections. All that decides how it is sampled is as in the preset `reference`, whatever the file and
//! the command line say; so runs that differ in nothing but that share a reference.

use super::grid::Point;
use super::plan::{Base, Plan, Planned, id};
use crate::analysis::words::plain_text;
use crate::device::DeviceInfo;
use crate::error::{Error, Result};
use crate::knobs::{KNOBS, Knob, Preset};
use crate::scene::{Assignment, Scene};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::PathBuf;
use std::str::FromStr;

/// The most samples a pixel that a render takes, in whole runs of 16.
const MOST_SAMPLES: u64 = 2_147_483_632;

/// Bytes of a name; what would be longer is numbered.
const LONGEST: usize = 80;

/// What runs are held against.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum ReferenceRule {
    /// References of the sweep's own, each with as many samples as the runs that are held against it.
    #[default]
    Auto,
    None,
    /// References of the sweep's own with so many samples a pixel.
    Samples(u64),
    /// A picture that is there.
    File(PathBuf),
}

impl FromStr for ReferenceRule {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let fail = || {
            let remedy = "give auto, none, samples a pixel (2 or more), or FILE.exr";
            Err(Error::Usage(format!("--reference {text}: {remedy}")))
        };
        match text {
            "" => fail(),
            "auto" => Ok(Self::Auto),
            "none" => Ok(Self::None),
            text if text.bytes().all(|byte| byte.is_ascii_digit()) => match text.parse() {
                Ok(samples @ 2..=MOST_SAMPLES) => Ok(Self::Samples(samples)),
                _ => fail(),
            },
            // A word that was mistyped is no file.
            text if !text.contains(['.', '/', '\\']) => fail(),
            text => Ok(Self::File(text.into())),
        }
    }
}

/// An expected picture that some runs share.
#[derive(Clone, Debug)]
pub(super) struct Expected {
    /// What the page calls its reference.
    name: String,
    /// Indices into the plan's runs.
    pub runs: Vec<usize>,
    /// Of one of them: the reference's scene is made from it.
    point: Point,
}

/// A reference that is to be rendered.
#[derive(Clone, Debug)]
pub struct PlannedReference {
    pub name: String,
    /// Hash of everything that decides its pixels: `reference/ID.exr`.
    pub id: String,
    /// Paths a pixel.
    pub samples: u64,
    /// Paths that it takes.
    pub paths: u64,
    pub(super) scene: Scene,
}

/// Where references come from.
pub(super) struct Of<'a> {
    pub base: &'a Base,
    pub neutral: &'a Neutral,
    pub plan: &'a Plan,
    pub device: &'a DeviceInfo,
}

impl PlannedReference {
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
}

impl Expected {
    /// The expected pictures of all runs of a size, in the order of the plan.
    pub fn all(base: &Base, neutral: &Neutral, plan: &Plan, size: [u32; 2]) -> Result<Vec<Self>> {
        let mut places: HashMap<String, usize> = HashMap::new();
        // Repeats of a point have its picture; their scenes need not be read.
        let mut of_point: HashMap<&[(String, String)], usize> = HashMap::new();
        let mut all: Vec<Self> = Vec::new();
        let runs = plan.runs.iter().enumerate();
        for (index, run) in runs.filter(|(_, run)| run.size == size) {
            let place = match of_point.get(run.point.values.as_slice()) {
                Some(place) => *place,
                None => {
                    let scene = neutral.scene(base, &run.point, 2)?;
                    let next = all.len();
                    *places.entry(picture(&scene)).or_insert(next)
                }
            };
            of_point.insert(&run.point.values, place);
            if place == all.len() {
                all.push(Self {
                    name: String::new(),
                    runs: Vec::new(),
                    point: run.point.clone(),
                });
            }
            all[place].runs.push(index);
        }
        name(&mut all, plan);
        Ok(all)
    }

    /// The values that an axis has among its runs.
    fn values<'p>(&self, plan: &'p Plan, axis: usize) -> BTreeSet<&'p str> {
        let runs = self.runs.iter().map(|run| &plan.runs[*run].point);
        runs.map(|point| point.values[axis].1.as_str()).collect()
    }

    /// The reference that the finished ones of its runs are held against; none where no run is finished.
    pub fn reference(
        &self,
        of: &Of,
        fixed: Option<u64>,
        finished: &dyn Fn(&Planned) -> bool,
    ) -> Result<Option<PlannedReference>> {
        let runs = self.runs.iter().map(|run| &of.plan.runs[*run]);
        let taken: Vec<u64> = runs
            .filter(|run| finished(run))
            .map(|run| run.samples)
            .collect();
        if taken.is_empty() {
            return Ok(None);
        }
        let as_many = taken.iter().fold(0_u64, |sum, n| sum.saturating_add(*n));
        let samples = fixed.unwrap_or(as_many.min(MOST_SAMPLES).next_multiple_of(16));
        let scene = of.neutral.scene(of.base, &self.point, samples)?;
        let image = &scene.settings.image;
        Ok(Some(PlannedReference {
            name: self.name.clone(),
            id: id(&scene, of.device),
            samples,
            paths: u64::from(image.width) * u64::from(image.height) * samples,
            scene,
        }))
    }
}

/// All that a reference's picture depends on; its samples and its seed are the same for all here.
fn picture(scene: &Scene) -> String {
    let knobs = scene.knobs.iter();
    knobs
        .map(|(path, value)| format!("{path}={value}\n"))
        .collect()
}

/// What references have instead of what file, command line and axes say.
#[derive(Clone, Debug)]
pub(super) struct Neutral(Vec<Assignment>);

impl Neutral {
    pub fn new(base: &Base) -> Result<Self> {
        let plain = Scene::parse(&base.name, &base.text, &base.assignments)?;
        let sampling = KNOBS.iter().filter(|knob| samples_only(knob));
        let mut all: Vec<Assignment> = sampling
            .filter_map(|knob| Some(set(knob.path, knob.value(Preset::Reference)?.to_json())))
            .collect();
        for material in &plain.materials {
            let path = format!("materials.{}.survival", material.name);
            all.push(set(&path, 1.0.into()));
        }
        // Far from those of the runs, which count up from the scene's own.
        let seed = plain.settings.render.seed.wrapping_add(1 << 63);
        all.push(set("render.seed", seed.into()));
        Ok(Self(all))
    }

    /// The scene of a point's reference.
    fn scene(&self, base: &Base, point: &Point, samples: u64) -> Result<Scene> {
        let point = Point {
            repeat: 0,
            ..point.clone()
        };
        let mut assignments = base.assignments.clone();
        assignments.extend(point.assignments(0));
        let scene = Scene::parse(&base.name, &base.text, &assignments)?;
        assignments.extend_from_slice(&self.0);
        // What else a preset says, the filter, is not that of the preset that stands here now.
        let kept = KNOBS
            .iter()
            .filter(|knob| knob.in_presets() && !samples_only(knob));
        let kept =
            kept.filter_map(|knob| Some(set(knob.path, scene.knobs.get(knob.path)?.clone())));
        assignments.extend(kept);
        assignments.push(set("render.samples", samples.into()));
        Scene::parse(&base.name, &base.text, &assignments)
    }
}

fn set(path: &str, value: serde_json::Value) -> Assignment {
    let assignment = Assignment::from_record(path, &value);
    let flag = format!("the reference's {path} = {}", assignment.value);
    Assignment { flag, ..assignment }
}

/// Whether a knob decides how a picture is sampled or shown rather than which one is expected. A
/// material's survival is one too: only `interruption.rule = survival` reads it.
fn samples_only(knob: &Knob) -> bool {
    let sections = ["light", "scatter", "interruption"];
    let others = [
        "render.preset",
        "render.clamp",
        "render.sequence",
        "render.randomisations",
        "image.exposure",
        "image.encoding",
    ];
    sections.contains(&knob.section()) || others.contains(&knob.path)
}

/// Names each by the values of the axes that tell it from the others.
fn name(all: &mut [Expected], plan: &Plan) {
    let axes = plan.runs.first().map_or(0, |run| run.point.values.len());
    let values: Vec<Vec<BTreeSet<&str>>> = all
        .iter()
        .map(|expected| (0..axes).map(|axis| expected.values(plan, axis)).collect())
        .collect();
    let telling: Vec<usize> = (0..axes)
        .filter(|axis| values.iter().any(|other| other[*axis] != values[0][*axis]))
        .collect();
    let mut seen = HashSet::new();
    for (number, (expected, values)) in all.iter_mut().zip(&values).enumerate() {
        let parts = telling.iter().map(|axis| {
            let (path, _) = &plan.runs[expected.runs[0]].point.values[*axis];
            let values: Vec<_> = values[*axis].iter().map(|text| plain_text(text)).collect();
            format!("{path} {}", values.join(" or "))
        });
        let name = parts.collect::<Vec<_>>().join(", ");
        expected.name = match name.as_str() {
            "" if number == 0 => "reference".into(),
            name if name.len() > LONGEST || !seen.insert(name.to_string()) => {
                format!("reference {}", number + 1)
            }
            name => format!("reference for {name}"),
        };
    }
}
