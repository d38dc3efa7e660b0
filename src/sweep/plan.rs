//! From a grid to the runs that a device is to make, in the order in which it makes them.

use super::grid::{Grid, Point};
use super::whole::Inputs;
use crate::device::DeviceInfo;
use crate::error::{Error, Result};
use crate::pack::{Packed, Strategy};
use crate::scene::{Assignment, Scene, Unbounded};
use std::collections::{BTreeMap, HashMap};

/// What all runs share.
#[derive(Clone, Debug)]
pub struct Base {
    /// What messages and records call the scene.
    pub name: String,
    pub text: String,
    /// Knobs that are not swept.
    pub assignments: Vec<Assignment>,
}

impl Base {
    /// The scene of one point.
    ///
    /// # Errors
    /// Those of [`Scene::parse`].
    pub fn scene(&self, point: &Point) -> Result<Scene> {
        let own = |assignments: &[Assignment]| {
            let all: Vec<_> = self
                .assignments
                .iter()
                .chain(assignments)
                .cloned()
                .collect();
            Scene::parse(&self.name, &self.text, &all)
        };
        if point.repeat == 0 {
            return own(&point.assignments(0));
        }
        // The repeat's seed counts from the one that the point would have.
        let first = Point {
            repeat: 0,
            ..point.clone()
        };
        let seed = own(&first.assignments(0))?.settings.render.seed;
        own(&point.assignments(seed))
    }
}

/// A run that is to be made.
#[derive(Clone, Debug)]
pub struct Planned {
    /// Place in the grid.
    pub number: usize,
    pub point: Point,
    /// Hash of everything that decides its pixels.
    pub id: String,
    /// Width and height.
    pub size: [u32; 2],
    /// Paths a pixel.
    pub samples: u64,
    /// Paths that it takes.
    pub paths: u64,
    strategy: usize,
}

/// All runs of a sweep.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Those with the same strategies follow each other, and are otherwise in the order of the grid.
    pub runs: Vec<Planned>,
    /// Of each material whose variance has no bound in some runs of the grid, by name: the worst of them, and their
    /// number.
    pub unbounded: BTreeMap<String, (Unbounded, usize)>,
}

impl Plan {
    /// Reads every point's scene, so that mistakes are said before anything is rendered.
    ///
    /// # Errors
    /// Those of the grid, and of the first point whose scene is wrong.
    pub fn new(base: &Base, grid: &Grid, device: &DeviceInfo) -> Result<Self> {
        let mut strategies: HashMap<Strategy, usize> = HashMap::new();
        let mut runs = Vec::new();
        let mut unbounded: BTreeMap<String, (Unbounded, usize)> = BTreeMap::new();
        for (number, point) in grid.points()?.into_iter().enumerate() {
            let scene = base.scene(&point)?;
            for one in scene.unbounded() {
                let name = scene.materials[one.number].name.clone();
                let (worst, count) = unbounded.entry(name).or_insert((one, 0));
                *count += 1;
                if one.growth() > worst.growth() {
                    *worst = one;
                }
            }
            let next = strategies.len();
            let strategy = *strategies
                .entry(Packed::new(&scene).strategy)
                .or_insert(next);
            let image = &scene.settings.image;
            let pixels = u64::from(image.width) * u64::from(image.height);
            runs.push(Planned {
                number,
                id: id(&scene, device),
                size: [image.width, image.height],
                samples: scene.settings.render.samples,
                paths: pixels * scene.settings.render.samples,
                point,
                strategy,
            });
        }
        // A pipeline that is specialised for a strategy is made once and used while it is at hand.
        runs.sort_by_key(|run| run.strategy);
        Ok(Self { runs, unbounded })
    }

    /// Every n-th run of the grid, from the `part`-th on, counted from 1.
    ///
    /// # Errors
    /// [`Error::Usage`] for a part that is not one of `parts`.
    pub fn shard(mut self, part: usize, parts: usize) -> Result<Self> {
        if !(1..=parts).contains(&part) {
            return Err(Error::Usage(format!(
                "--shard {part}/{parts}: the parts are 1/{parts} to {parts}/{parts}"
            )));
        }
        self.runs.retain(|run| run.number % parts == part - 1);
        Ok(self)
    }
}

/// Hash of a run's inputs: scene, every knob, shaders, version and device.
pub(super) fn id(scene: &Scene, device: &DeviceInfo) -> String {
    Inputs::of_scene(scene, device).id()
}
