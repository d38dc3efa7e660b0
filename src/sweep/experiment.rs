//! A sweep as it is asked for: runs, regions, and what the runs are held against.

use super::expected::{Expected, Neutral, Of, PlannedReference, ReferenceRule};
use super::grid::Grid;
use super::plan::{Base, Plan, Planned};
use crate::analysis::{Reference, Region};
use crate::device::DeviceInfo;
use crate::error::Result;
use crate::film::read_exr;
use crate::pack::Rect;
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// Everything that is known before the first run. Making one reads every scene and a given reference, so
/// that mistakes are said before anything is rendered.
pub struct Experiment {
    pub base: Base,
    pub grid: Grid,
    pub plan: Plan,
    /// Where the runs are made.
    pub device: DeviceInfo,
    /// Width and height of the pictures that are analysed: those of the first run. Runs of another size
    /// are made and left out of the analysis.
    pub size: [u32; 2],
    /// Of the scene's `[sweep.regions]`, in pictures of that size.
    pub regions: Vec<Region>,
    against: HeldAgainst,
}

enum HeldAgainst {
    Nothing,
    Given(Box<Reference>),
    Own {
        expected: Vec<Expected>,
        neutral: Neutral,
        /// Samples a pixel; none for as many as the runs take.
        samples: Option<u64>,
    },
}

/// A reference of a run, as far as it is there.
#[derive(Clone, Copy)]
pub(super) enum ReferenceOf<'e> {
    Given(&'e Reference),
    /// Its place among the expected pictures.
    Own(usize),
}

impl Experiment {
    /// `shard` is a part and the number of parts, counted from 1.
    ///
    /// # Errors
    /// Those of the grid and of the scenes; [`crate::Error::Usage`] for regions or a given reference that do
    /// not fit, and those of reading it.
    pub fn new(
        base: Base,
        grid: Grid,
        device: &DeviceInfo,
        rule: &ReferenceRule,
        shard: Option<[usize; 2]>,
    ) -> Result<Self> {
        let mut plan = Plan::new(&base, &grid, device)?;
        if let Some([part, parts]) = shard {
            plan = plan.shard(part, parts)?;
        }
        let scene = Scene::parse(&base.name, &base.text, &base.assignments)?;
        let first = plan.runs.iter().min_by_key(|run| run.number);
        let image = &scene.settings.image;
        let size = first.map_or([image.width, image.height], |run| run.size);
        let against = match rule {
            ReferenceRule::None => HeldAgainst::Nothing,
            ReferenceRule::File(path) => HeldAgainst::Given(Box::new(given(path, size)?)),
            ReferenceRule::Auto => HeldAgainst::own(&base, &plan, size, None)?,
            ReferenceRule::Samples(samples) => {
                HeldAgainst::own(&base, &plan, size, Some(*samples))?
            }
        };
        Ok(Self {
            regions: regions(&scene, size)?,
            device: device.clone(),
            base,
            grid,
            plan,
            size,
            against,
        })
    }

    /// The references that the finished ones of the runs need; with all runs finished, those that a whole
    /// sweep has.
    ///
    /// # Errors
    /// Those of a scene.
    pub fn references(&self, finished: &dyn Fn(&Planned) -> bool) -> Result<Vec<PlannedReference>> {
        let each = self.own_references(finished)?;
        Ok(each.into_iter().flatten().collect())
    }

    /// For each expected picture, its reference; none where no run needs it.
    pub(super) fn own_references(
        &self,
        finished: &dyn Fn(&Planned) -> bool,
    ) -> Result<Vec<Option<PlannedReference>>> {
        let HeldAgainst::Own {
            expected,
            neutral,
            samples,
        } = &self.against
        else {
            return Ok(Vec::new());
        };
        let of = Of {
            base: &self.base,
            neutral,
            plan: &self.plan,
            device: &self.device,
        };
        let each = expected.iter();
        each.map(|expected| expected.reference(&of, *samples, finished))
            .collect()
    }

    /// What each of the plan's runs is held against.
    pub(super) fn reference_of_runs(&self) -> Vec<Option<ReferenceOf<'_>>> {
        let mut all = vec![None; self.plan.runs.len()];
        match &self.against {
            HeldAgainst::Nothing => {}
            HeldAgainst::Given(reference) => all.fill(Some(ReferenceOf::Given(reference))),
            HeldAgainst::Own { expected, .. } => {
                for (place, expected) in expected.iter().enumerate() {
                    for run in &expected.runs {
                        all[*run] = Some(ReferenceOf::Own(place));
                    }
                }
            }
        }
        all
    }
}

impl HeldAgainst {
    fn own(base: &Base, plan: &Plan, size: [u32; 2], samples: Option<u64>) -> Result<Self> {
        let neutral = Neutral::new(base)?;
        Ok(Self::Own {
            expected: Expected::all(base, &neutral, plan, size)?,
            neutral,
            samples,
        })
    }
}

/// A reference that is there, found to fit.
fn given(path: &Path, size: [u32; 2]) -> Result<Reference> {
    let reference = Reference::new(&path.to_string_lossy(), read_exr(path)?)?;
    reference.fits(size)?;
    Ok(reference)
}

/// The scene's regions where they are in pictures of a size.
fn regions(scene: &Scene, size: [u32; 2]) -> Result<Vec<Region>> {
    let region = |region: crate::scene::Region| {
        let [x0, y0, x1, y1] = region.rect;
        Region {
            name: region.name,
            rect: Rect { x0, y0, x1, y1 },
        }
    };
    for stated in scene.sweep.regions.iter().cloned().map(region) {
        stated.fits(scene.sweep.size)?;
    }
    let here = scene.sweep.regions_in(size);
    Ok(here.into_iter().map(region).collect())
}

/// Where a folder keeps a reference.
pub(super) fn reference_file(folder: &Path, id: &str, extension: &str) -> PathBuf {
    folder.join("reference").join(format!("{id}.{extension}"))
}
