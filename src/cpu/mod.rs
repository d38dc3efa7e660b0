//! The CPU twin: the same renderer in Rust, one file for each shader library, to be read line by
//! line beside it; `four` alone has no shader, and traces bodies four at a time. It needs no driver and
//! is what the shaders are checked against.

pub mod background;
pub mod r#box;
pub mod branch;
pub mod bvh;
pub mod camera;
pub mod canary;
pub mod cap;
pub mod choice;
pub mod denoise;
pub mod efficiency;
pub mod four;
pub mod glass;
pub mod guides;
pub mod interruption;
pub mod light;
pub mod light_tree;
pub mod loops;
pub mod maths;
pub mod pilot;
pub mod points;
pub mod random;
pub mod ray;
pub mod rectangle;
pub mod rough;
pub mod scatter;
pub mod scene;
pub mod sequence;
pub mod sphere;
pub mod trace;

use crate::device::{Block, Device, DeviceInfo, DeviceKind, Limits, Traced, runs};
use crate::error::{Error, Result};
use crate::pack::{
    CanaryJob, CanaryScene, DenoiseJob, Draw, Estimate, Feature, Guide, GuideJob, Hierarchy,
    Packed, PointsJob, Rect, Site, Strategy, Tally,
};
use bvh::ByTree;
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use scene::Traversal;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

/// What a scene's rays are traced among.
#[derive(Debug)]
enum Bodies {
    Four(four::Bodies),
    Tree(Arc<Hierarchy>),
}

/// The built-in CPU renderer; it uses all cores.
#[derive(Debug)]
pub struct Cpu {
    info: DeviceInfo,
    scene: Option<(Packed, Bodies)>,
    /// Blocks that were started: each is traced when it is asked for, by all cores.
    started: VecDeque<Block>,
}

impl Default for Cpu {
    fn default() -> Self {
        Self::new()
    }
}

impl Cpu {
    pub fn new() -> Self {
        Self {
            info: info(),
            scene: None,
            started: VecDeque::new(),
        }
    }

    fn scene(&self) -> Result<&(Packed, Bodies)> {
        self.scene
            .as_ref()
            .ok_or_else(|| Error::Internal("no scene is loaded".into()))
    }

    /// The tallies of a block, in the order of [`Traced`].
    fn tallies(&self, block: Block) -> Result<Vec<Tally>> {
        let (scene, bodies) = self.scene()?;
        let job = scene.job(block.rect, block.first_sample, block.samples);
        let by_pixel: Vec<Vec<Tally>> = match bodies {
            Bodies::Four(four) => {
                let tracer = trace::Tracer::new(scene, four, &job);
                pixels(block.rect)
                    .map(|pixel| traced_by_loops(&tracer, pixel))
                    .collect()
            }
            Bodies::Tree(hierarchy) => {
                let tree = ByTree { scene, hierarchy };
                let tracer = trace::Tracer::new(scene, &tree, &job);
                pixels(block.rect)
                    .map(|pixel| traced_by_tree(&tracer, pixel))
                    .collect()
            }
        };
        let runs = runs(block.first_sample, block.samples) as usize;
        Ok((0..runs)
            .flat_map(|run| by_pixel.iter().map(move |tallies| tallies[run]))
            .collect())
    }
}

/// How records name the CPU twin.
pub fn info() -> DeviceInfo {
    DeviceInfo {
        kind: DeviceKind::Cpu,
        name: format!(
            "built-in CPU renderer, {} threads",
            rayon::current_num_threads()
        ),
        driver: format!("lampray {}", env!("CARGO_PKG_VERSION")),
        backend: "none".into(),
        pci: String::new(),
    }
}

/// The pixels of a rectangle, row by row.
fn pixels(rect: Rect) -> impl IndexedParallelIterator<Item = [u32; 2]> {
    let width = rect.width() as usize;
    (0..rect.area()).into_par_iter().map(move |index| {
        [
            rect.x0 + (index % width) as u32,
            rect.y0 + (index / width) as u32,
        ]
    })
}

impl Device for Cpu {
    fn info(&self) -> &DeviceInfo {
        &self.info
    }

    fn load(&mut self, scene: &Packed) -> Result<()> {
        let bodies = match &scene.hierarchy {
            Some(hierarchy) => Bodies::Tree(hierarchy.clone()),
            None => Bodies::Four(four::Bodies::new(scene)),
        };
        self.scene = Some((scene.clone(), bodies));
        self.started.clear();
        Ok(())
    }

    fn start(&mut self, block: Block) -> Result<()> {
        self.started.push_back(block);
        Ok(())
    }

    fn finish(&mut self) -> Result<Traced> {
        let none = || Error::Internal("no block was started".into());
        let block = self.started.pop_front().ok_or_else(none)?;
        let began = Instant::now();
        let tallies = self.tallies(block)?;
        Ok(Traced {
            tallies,
            took: began.elapsed(),
        })
    }

    fn features(&mut self, rect: Rect) -> Result<Vec<Feature>> {
        let (scene, bodies) = self.scene()?;
        let feature = |pixel| match bodies {
            Bodies::Four(four) => feature_at(scene, four, pixel),
            Bodies::Tree(hierarchy) => feature_at(scene, &ByTree { scene, hierarchy }, pixel),
        };
        Ok(pixels(rect).map(feature).collect())
    }

    fn guides(&mut self, rect: Rect, fineness: u32) -> Result<Vec<Guide>> {
        let (scene, bodies) = self.scene()?;
        let job = GuideJob::new(scene, rect, fineness);
        let guide = |lane| match bodies {
            Bodies::Four(four) => guides::guide(scene, four, &job, lane),
            Bodies::Tree(hierarchy) => {
                guides::guide(scene, &ByTree { scene, hierarchy }, &job, lane)
            }
        };
        Ok(pixels(job.lanes()).map(guide).collect())
    }

    fn denoise(
        &mut self,
        job: &DenoiseJob,
        sites: &[Site],
        estimates: &[Estimate],
    ) -> Result<Vec<Estimate>> {
        Ok(denoise::pass(job, sites, estimates))
    }

    fn points(&mut self, strategy: &Strategy, job: &PointsJob) -> Result<Vec<Draw>> {
        let draw = |number| points::draw(strategy, job, number);
        Ok((0..job.count).into_par_iter().map(draw).collect())
    }

    fn limits(&self) -> Result<Option<Limits>> {
        Ok(None)
    }

    fn canary(
        &mut self,
        _strategy: &Strategy,
        job: &CanaryJob,
        _scenes: &[CanaryScene],
        inputs: &[[u32; 4]],
    ) -> Result<Option<Vec<[u32; 4]>>> {
        Ok(canary::canary(job, inputs))
    }
}

/// Compiled for newer processors too, and chosen when the program runs.
#[multiversion::multiversion(targets("x86_64+sse4.2+avx+avx2+bmi2"))]
fn traced_by_loops(tracer: &trace::Tracer<four::Bodies>, pixel: [u32; 2]) -> Vec<Tally> {
    tracer.pixel(pixel)
}

/// As [`traced_by_loops`].
#[multiversion::multiversion(targets("x86_64+sse4.2+avx+avx2+bmi2"))]
fn traced_by_tree(tracer: &trace::Tracer<ByTree<'_>>, pixel: [u32; 2]) -> Vec<Tally> {
    tracer.pixel(pixel)
}

/// Twin of `shaders/features.wgsl`.
fn feature_at(scene: &Packed, bodies: &impl Traversal, pixel: [u32; 2]) -> Feature {
    let film = Vec2::new(pixel[0] as f32, pixel[1] as f32) + 0.5;
    let direction = camera::camera_direction(&scene.camera, film);
    let ray = ray::Ray {
        origin: Vec3::ZERO,
        direction,
        source: 0,
        inside: false,
    };
    let hit = bodies.nearest_hit(&ray);
    if hit.body == 0 {
        return Feature::default();
    }
    let surface = scene::surface_at(scene, hit, &ray);
    Feature {
        normal: surface.normal.to_array(),
        depth: hit.distance,
        albedo: scene.materials[surface.material as usize].albedo,
        id: surface.id,
    }
}
