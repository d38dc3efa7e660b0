//! The pilot of the rule `efficiency`: a few paths that tell what the rays that leave each body are worth.
//!
//! EARS (Rath et al. 2022) learns while it renders, in cells of space. Here the cells are the bodies, and all
//! is learnt before the first sample of the picture: so that a sample's value depends on its address alone,
//! whichever device traces it and however the work is split. The pilot's own samples never enter the picture,
//! and their numbers come from a seed of their own: so the picture's mean is not touched.
//!
//! The error that is made small is the mean over the pixels and channels of the variance, as it is: the
//! paper divides it by the squared value of each pixel, for which it needs a picture without noise. Here a
//! pilot's pixels would be too noisy to divide by, and the errors of pictures are compared as they are.

use super::branch::{Branches, Return};
use super::bvh::ByTree;
use super::four;
use super::scene::Traversal;
use super::trace::Tracer;
use crate::pack::{Packed, Rect, Worth};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Rounds of learning: each traces by what the one before it learnt, and the last one is kept.
const ROUNDS: u64 = 3;
/// Pixels that a round looks at, spread over the picture, and samples of each.
const PLACES: u32 = 1024;
const SAMPLES: u64 = 4;
/// Places that are traced before anybody counts the rays.
const WAVE: u32 = 16;
/// A round ends early when it has taken so many rays.
const MOST_RAYS: u64 = 1 << 20;
/// Reflections of a pilot's path: what is left after so many changes no worth by much.
const MOST_BOUNCES: u32 = 64;
/// As many rays as this count for each body beside its own, with the mean of all bodies: few rays tell little
/// of a variance.
const BORROWED: f64 = 16.0;
/// The pilot's seed is the picture's, changed by these bits.
const SEED: u64 = 0x6a09_e667_f3bc_c908;

/// What a pilot found.
#[derive(Clone, Debug, PartialEq)]
pub struct Pilot {
    /// Of each body, in the order of [`Packed`].
    pub worths: Vec<Worth>,
    pub paths: u64,
    /// Rays, shadow rays included.
    pub rays: u64,
}

impl Pilot {
    /// Traces a pilot of a scene that is packed for the rule `efficiency`, over a picture of so many pixels, wide
    /// and high. The same for the same scene, knobs and
    /// seed, whatever the number of threads.
    pub fn new(scene: &Packed, image: [u32; 2]) -> Self {
        let mut scene = Packed {
            seed: scene.seed ^ SEED,
            max_bounces: scene.max_bounces.min(MOST_BOUNCES),
            ..scene.clone()
        };
        let (mut paths, mut rays) = (0, 0);
        for round in 0..ROUNDS {
            let learnt = learn(&scene, image, round);
            paths += learnt.paths;
            rays += learnt.rays;
            scene.worths = learnt.worths(scene.worths.len());
        }
        Self {
            worths: scene.worths,
            paths,
            rays,
        }
    }

    /// What tells the worths of one pilot from those of another.
    pub fn hash(&self) -> String {
        blake3::hash(bytemuck::cast_slice(&self.worths)).to_hex()[..16].into()
    }
}

fn learn(scene: &Packed, image: [u32; 2], round: u64) -> Learnt {
    match &scene.hierarchy {
        Some(hierarchy) => learn_among(scene, &ByTree { scene, hierarchy }, image, round),
        None => learn_among(scene, &four::Bodies::new(scene), image, round),
    }
}

/// One round. Paths of a wave are traced side by side and added in order.
fn learn_among<T: Traversal + Sync>(
    scene: &Packed,
    bodies: &T,
    image: [u32; 2],
    round: u64,
) -> Learnt {
    let nowhere = Rect {
        x0: 0,
        y0: 0,
        x1: 0,
        y1: 0,
    };
    let job = scene.job(nowhere, 0, 1);
    let tracer = Tracer::new(scene, bodies, &job);
    let mut learnt = Learnt::new(scene.worths.len());
    for wave in (0..PLACES).step_by(WAVE as usize) {
        let traced: Vec<_> = (wave..wave + WAVE)
            .into_par_iter()
            .map(|place| {
                let first = (round * u64::from(PLACES) + u64::from(place)) * SAMPLES;
                trace_place(&tracer, pixel_of(image, place), first)
            })
            .collect();
        traced.iter().for_each(|place| learnt.add(place));
        if learnt.rays >= MOST_RAYS {
            break;
        }
    }
    learnt
}

/// What the samples of one pixel gave, and all that came back to bodies on their paths.
struct Place {
    samples: Vec<Vec3>,
    rays: u64,
    returns: Vec<Return>,
}

fn trace_place<T: Traversal>(tracer: &Tracer<T>, pixel: [u32; 2], first: u64) -> Place {
    let mut branches = Branches::watched();
    let mut traced = Place {
        samples: Vec::new(),
        rays: 0,
        returns: Vec::new(),
    };
    for sample in first..first + SAMPLES {
        let (radiance, rays) = tracer.sample_by(pixel, sample, &mut branches);
        traced.samples.push(radiance);
        traced.rays += u64::from(rays);
    }
    traced.returns = branches.returned();
    traced
}

/// The pixel of a place: the places go through the picture's rows by bit reversal, so that whoever ends early
/// has seen all of it.
fn pixel_of(image: [u32; 2], place: u32) -> [u32; 2] {
    let share = u64::from(place.reverse_bits());
    let area = u64::from(image[0]) * u64::from(image[1]);
    let index = share * area >> 32;
    let width = u64::from(image[0]);
    [(index % width) as u32, (index / width) as u32]
}

/// Sums over the rays that left a body, each for a path that carried one.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: f64,
    radiance: DVec3,
    squares: DVec3,
    rays: f64,
}

impl Sums {
    fn add(&mut self, other: &Self) {
        self.count += other.count;
        self.radiance += other.radiance;
        self.squares += other.squares;
        self.rays += other.rays;
    }

    fn times(&self, factor: f64) -> Self {
        Self {
            count: factor * self.count,
            radiance: factor * self.radiance,
            squares: factor * self.squares,
            rays: factor * self.rays,
        }
    }
}

/// What a round found.
struct Learnt {
    bodies: Vec<Sums>,
    /// Sum over the places of the variance of a path, channels added up.
    variance: f64,
    places: f64,
    paths: u64,
    rays: u64,
}

impl Learnt {
    fn new(bodies: usize) -> Self {
        Self {
            bodies: vec![Sums::default(); bodies],
            variance: 0.0,
            places: 0.0,
            paths: 0,
            rays: 0,
        }
    }

    fn add(&mut self, place: &Place) {
        for back in place
            .returns
            .iter()
            .filter(|back| back.radiance.is_finite())
        {
            let radiance = back.radiance.as_dvec3();
            self.bodies[back.body as usize - 1].add(&Sums {
                count: 1.0,
                radiance,
                squares: radiance * radiance,
                rays: back.rays.into(),
            });
        }
        self.paths += place.samples.len() as u64;
        self.rays += place.rays;
        if place.samples.iter().all(|sample| sample.is_finite()) {
            self.variance += variance(&place.samples);
            self.places += 1.0;
        }
    }

    /// The worth of each body: its variance and second moment over its cost, by the picture's cost over its
    /// variance. Where the picture has no variance nothing is known.
    fn worths(&self, bodies: usize) -> Vec<Worth> {
        let cost = self.rays as f64 / self.paths.max(1) as f64;
        let picture = cost * self.places / self.variance;
        let mut all = Sums::default();
        self.bodies.iter().for_each(|sums| all.add(sums));
        if !picture.is_finite() || all.count == 0.0 {
            return vec![Worth::UNKNOWN; bodies];
        }
        let borrowed = all.times(BORROWED / all.count);
        let worth = |sums: &Sums| {
            let mut with = borrowed;
            with.add(sums);
            worth(&with, picture)
        };
        self.bodies.iter().map(worth).collect()
    }
}

fn worth(sums: &Sums, picture: f64) -> Worth {
    let mean = sums.radiance / sums.count;
    let moment = sums.squares / sums.count;
    let variance = (moment - mean * mean).max(DVec3::ZERO);
    // Every ray that leaves is one.
    let cost = (sums.rays / sums.count).max(1.0);
    let single = |value: DVec3| {
        let scaled = value * (picture / cost);
        scaled.min(DVec3::splat(MOST_WORTH)).as_vec3().to_array()
    };
    Worth {
        split: single(variance),
        keep: single(moment),
        ..Worth::default()
    }
}

/// So that squares and sums of it stay finite.
const MOST_WORTH: f64 = 1e12;

/// The unbiased variance of a few samples, channels added up.
fn variance(samples: &[Vec3]) -> f64 {
    let count = samples.len() as f64;
    let wide = || samples.iter().map(|sample| sample.as_dvec3());
    let mean = wide().sum::<DVec3>() / count;
    let apart = |sample: DVec3| (sample - mean).length_squared();
    wide().map(apart).sum::<f64>() / (count - 1.0)
}
