//! The CPU twin: the same renderer in Rust, one file for each shader library, to be read line by
//! line beside it; `four` alone has no shader, and traces bodies four at a time. It needs no driver and
//! is what the shaders are checked against.

pub mod r#box;
pub mod camera;
pub mod four;
pub mod interruption;
pub mod light;
pub mod maths;
pub mod points;
pub mod random;
pub mod ray;
pub mod scatter;
pub mod scene;
pub mod sphere;
pub mod trace;

use crate::device::{Device, DeviceInfo, DeviceKind, runs};
use crate::error::{Error, Result};
use crate::pack::{Draw, Feature, Packed, PointsJob, Rect, Strategy, Tally};
use four::Bodies;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// The built-in CPU renderer; it uses all cores.
#[derive(Debug)]
pub struct Cpu {
    info: DeviceInfo,
    scene: Option<(Packed, Bodies)>,
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
        }
    }

    fn scene(&self) -> Result<&(Packed, Bodies)> {
        self.scene
            .as_ref()
            .ok_or_else(|| Error::Internal("no scene is loaded".into()))
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
        self.scene = Some((scene.clone(), Bodies::new(scene)));
        Ok(())
    }

    fn trace(&mut self, rect: Rect, first_sample: u64, samples: u32) -> Result<Vec<Tally>> {
        let (scene, bodies) = self.scene()?;
        let job = scene.job(rect, first_sample, samples);
        let tracer = trace::Tracer::new(scene, bodies, &job);
        let by_pixel: Vec<Vec<Tally>> = pixels(rect).map(|pixel| traced(&tracer, pixel)).collect();
        let runs = runs(first_sample, samples) as usize;
        Ok((0..runs)
            .flat_map(|run| by_pixel.iter().map(move |tallies| tallies[run]))
            .collect())
    }

    fn features(&mut self, rect: Rect) -> Result<Vec<Feature>> {
        let (scene, bodies) = self.scene()?;
        Ok(pixels(rect)
            .map(|pixel| feature_at(scene, bodies, pixel))
            .collect())
    }

    fn points(&mut self, strategy: &Strategy, job: &PointsJob) -> Result<Vec<Draw>> {
        let draw = |number| points::draw(strategy, job, number);
        Ok((0..job.count).into_par_iter().map(draw).collect())
    }
}

/// Compiled for newer processors too, and chosen when the program runs.
#[multiversion::multiversion(targets("x86_64+sse4.2+avx+avx2+bmi2"))]
fn traced(tracer: &trace::Tracer, pixel: [u32; 2]) -> Vec<Tally> {
    tracer.pixel(pixel)
}

/// Twin of `shaders/features.wgsl`.
fn feature_at(scene: &Packed, bodies: &Bodies, pixel: [u32; 2]) -> Feature {
    let film = Vec2::new(pixel[0] as f32, pixel[1] as f32) + 0.5;
    let direction = camera::camera_direction(&scene.camera, film);
    let ray = ray::Ray {
        origin: Vec3::ZERO,
        direction,
        source: 0,
        inside: false,
    };
    let hit = scene::nearest_hit(bodies, &ray);
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
