//! The loop that feeds a device with blocks and adds up what comes back.

mod choose;
mod picture;
mod plan;

pub use choose::{Chosen, VULKAN_HINT, devices, open, word};
pub use picture::{picture, scene_hash};
pub use plan::{Block, Plan};

use crate::device::{Device, run_ranges};
use crate::error::Result;
use crate::film::Film;
use crate::pack::{Feature, Packed, Rect, Traversal};
use crate::scene::Scene;
use std::ops::{ControlFlow, Range};
use std::time::{Duration, Instant};

/// What is to be rendered of a scene.
#[derive(Clone, Debug)]
pub struct Task<'a> {
    pub scene: &'a Scene,
    /// The part of the image, in its own pixels.
    pub region: Rect,
    /// Which samples of each pixel.
    pub samples: Range<u64>,
    /// Whether first-hit features are wanted too.
    pub features: bool,
    /// How rays find bodies.
    pub traversal: Traversal,
}

impl<'a> Task<'a> {
    /// The whole image with all of its samples.
    pub fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            region: whole(scene),
            samples: 0..scene.settings.render.samples,
            features: false,
            traversal: Traversal::of(scene),
        }
    }

    /// [`Task::new`] for one of many scenes whose values differ: nothing is compiled for this one alone
    /// unless its knobs ask for it.
    pub fn one_of_many(scene: &'a Scene) -> Self {
        Self {
            traversal: Traversal::of_one_of_many(scene),
            ..Self::new(scene)
        }
    }
}

/// All pixels of a scene's image.
pub fn whole(scene: &Scene) -> Rect {
    let image = &scene.settings.image;
    Rect {
        x0: 0,
        y0: 0,
        x1: image.width,
        y1: image.height,
    }
}

/// How far a render is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Paths done and to do.
    pub paths: u64,
    pub total: u64,
}

/// What a render gave.
#[derive(Debug)]
pub struct Rendering {
    pub film: Film,
    pub features: Option<Vec<Feature>>,
    /// False where it was stopped before its last block.
    pub complete: bool,
    /// Getting the scene onto the device and compiling.
    pub setup: Duration,
    /// Tracing alone.
    pub tracing: Duration,
}

/// Renders a task; `watch` is called between blocks and may stop it.
///
/// # Errors
/// Those of the device's calls; nothing is returned of a block that failed.
pub fn render(
    device: &mut dyn Device,
    task: &Task,
    watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Rendering> {
    let plan = Plan::new(task.region, task.samples.clone());
    render_plan(device, task, plan, watch)
}

/// [`render`] by a plan of one's own.
///
/// # Errors
/// As [`render`].
pub fn render_plan(
    device: &mut dyn Device,
    task: &Task,
    mut plan: Plan,
    watch: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Rendering> {
    let started = Instant::now();
    device.load(&Packed::by(task.scene, task.traversal))?;
    let features = task
        .features
        .then(|| device.features(task.region))
        .transpose()?;
    let setup = started.elapsed();
    let mut film = Film::new(task.region);
    let mut tracing = Duration::ZERO;
    // All samples there can be of two pixels are more than u64 counts.
    let total = (task.region.area() as u64).saturating_mul(task.samples.end - task.samples.start);
    let mut paths = 0;
    let mut complete = true;
    while let Some(block) = plan.next_block() {
        let began = Instant::now();
        let tallies = device.trace(block.rect, block.first_sample, block.samples)?;
        let took = began.elapsed();
        tracing += took;
        plan.learn(&block, took);
        add_block(&mut film, &block, &tallies);
        paths += block.paths();
        if watch(Progress { paths, total }).is_break() {
            complete = paths == total;
            break;
        }
    }
    Ok(Rendering {
        film,
        features,
        complete,
        setup,
        tracing,
    })
}

/// Adds a block's tallies to the film, run by run.
fn add_block(film: &mut Film, block: &Block, tallies: &[crate::pack::Tally]) {
    let (rect, region) = (block.rect, film.region);
    let mut tallies = tallies.iter();
    for (first, samples) in run_ranges(block.first_sample, block.samples) {
        for y in rect.y0..rect.y1 {
            let row = (y - region.y0) as usize * region.width() as usize;
            for x in rect.x0..rect.x1 {
                if let Some(tally) = tallies.next() {
                    film.add(row + (x - region.x0) as usize, first, samples, tally);
                }
            }
        }
    }
}
