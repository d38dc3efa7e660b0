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

/// Rounds of learning, each by what was learnt before it, and how many pixels it looks at, spread over the picture.
/// The first knows nothing and is soon forgotten; the last two are kept together.
const ROUNDS: [u32; 6] = [512, 512, 1024, 1024, 2048, 2048];
/// Samples of each pixel, and samples that split in two wherever they may.
const SAMPLES: u64 = 4;
const TWINS: u64 = 2;
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
        let bodies = scene.worths.len();
        let (mut paths, mut rays) = (0, 0);
        let mut learnt = Learnt::new(bodies);
        for (round, places) in (0..).zip(ROUNDS) {
            let new = learn(&scene, image, (round, places));
            paths += new.paths / SAMPLES * (SAMPLES + TWINS);
            rays += new.rays + new.twin_rays;
            if round as usize + 1 < ROUNDS.len() {
                learnt = new;
            } else {
                learnt.join(&new);
            }
            scene.worths = learnt.worths(scene.worths);
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

/// One round: its number, and how many places it looks at.
fn learn(scene: &Packed, image: [u32; 2], round: (u64, u32)) -> Learnt {
    match &scene.hierarchy {
        Some(hierarchy) => learn_among(scene, &ByTree { scene, hierarchy }, image, round),
        None => learn_among(scene, &four::Bodies::new(scene), image, round),
    }
}

/// Paths of a wave are traced side by side and added in order.
fn learn_among<T: Traversal + Sync>(
    scene: &Packed,
    bodies: &T,
    image: [u32; 2],
    (round, places): (u64, u32),
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
    for wave in (0..places).step_by(WAVE as usize) {
        let traced: Vec<_> = (wave..wave + WAVE)
            .into_par_iter()
            .map(|place| {
                let first = ((round << 32) + u64::from(place)) * (SAMPLES + TWINS);
                trace_place(&tracer, pixel_of(image, place), first)
            })
            .collect();
        traced.iter().for_each(|place| learnt.add(place));
        if learnt.rays + learnt.twin_rays >= MOST_RAYS {
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
    /// Of the samples that split in two, whose rays are `twin_rays`.
    twins: Vec<Return>,
    twin_rays: u64,
}

fn trace_place<T: Traversal>(tracer: &Tracer<T>, pixel: [u32; 2], first: u64) -> Place {
    let mut branches = Branches::watched(false);
    let mut traced = Place {
        samples: Vec::new(),
        rays: 0,
        returns: Vec::new(),
        twins: Vec::new(),
        twin_rays: 0,
    };
    for sample in first..first + SAMPLES {
        let (radiance, rays) = tracer.sample_by(pixel, sample, &mut branches);
        traced.samples.push(radiance);
        traced.rays += u64::from(rays);
    }
    traced.returns = branches.returned();
    let mut branches = Branches::watched(true);
    for sample in first + SAMPLES..first + SAMPLES + TWINS {
        let (_, rays) = tracer.sample_by(pixel, sample, &mut branches);
        traced.twin_rays += u64::from(rays);
    }
    traced.twins = branches.returned();
    traced
}

/// The pixel of a place: the places go through the picture's rows by bit reversal, so that whoever ends early
/// has seen all of it.
fn pixel_of(image: [u32; 2], place: u32) -> [u32; 2] {
    let share = u64::from(place.reverse_bits());
    let area = u64::from(image[0]) * u64::from(image[1]);
    let index = (share * area) >> 32;
    let width = u64::from(image[0]);
    [(index % width) as u32, (index / width) as u32]
}

/// Sums over the rays that left a body, each for a path that carried one.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: f64,
    squares: DVec3,
    rays: f64,
    /// Pairs that left the same hit, and the sum of half of the squares of how far apart they were.
    pairs: f64,
    apart: DVec3,
}

impl Sums {
    fn add(&mut self, other: &Self) {
        self.count += other.count;
        self.squares += other.squares;
        self.rays += other.rays;
        self.pairs += other.pairs;
        self.apart += other.apart;
    }

    /// The mean of all as that of few.
    fn borrowed(&self) -> Self {
        let (rays, pairs) = (
            BORROWED / self.count.max(1.0),
            BORROWED / self.pairs.max(1.0),
        );
        Self {
            count: rays * self.count,
            squares: rays * self.squares,
            rays: rays * self.rays,
            pairs: pairs * self.pairs,
            apart: pairs * self.apart,
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
    twin_rays: u64,
}

impl Learnt {
    fn new(bodies: usize) -> Self {
        Self {
            bodies: vec![Sums::default(); bodies],
            variance: 0.0,
            places: 0.0,
            paths: 0,
            rays: 0,
            twin_rays: 0,
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
                squares: radiance * radiance,
                rays: back.rays.into(),
                ..Sums::default()
            });
        }
        for (one, other) in pairs(&place.twins) {
            let apart = (one.radiance - other.radiance).as_dvec3();
            self.bodies[one.body as usize - 1].add(&Sums {
                pairs: 1.0,
                apart: 0.5 * apart * apart,
                ..Sums::default()
            });
        }
        self.paths += place.samples.len() as u64;
        self.rays += place.rays;
        self.twin_rays += place.twin_rays;
        if place.samples.iter().all(|sample| sample.is_finite()) {
            self.variance += variance(&place.samples);
            self.places += 1.0;
        }
    }

    /// What another round found is known too.
    fn join(&mut self, other: &Self) {
        let bodies = self.bodies.iter_mut().zip(&other.bodies);
        bodies.for_each(|(one, other)| one.add(other));
        self.variance += other.variance;
        self.places += other.places;
        self.paths += other.paths;
        self.rays += other.rays;
        self.twin_rays += other.twin_rays;
    }

    /// The worth of each body: its variance and second moment over its cost, by the picture's cost over its
    /// variance. Where the picture has no variance there is nothing to learn: what was known `before` made it so.
    fn worths(&self, before: Vec<Worth>) -> Vec<Worth> {
        let cost = self.rays as f64 / self.paths.max(1) as f64;
        let picture = cost * self.places / self.variance;
        let mut all = Sums::default();
        self.bodies.iter().for_each(|sums| all.add(sums));
        if !picture.is_finite() || all.count == 0.0 {
            return before;
        }
        let borrowed = all.borrowed();
        let worth = |sums: &Sums| {
            let mut with = borrowed;
            with.add(sums);
            worth(&with, picture)
        };
        self.bodies.iter().map(worth).collect()
    }
}

fn worth(sums: &Sums, picture: f64) -> Worth {
    let moment = sums.squares / sums.count;
    // Both are heard of from few rays, of which one may be bright: the variance is the smaller of the two.
    let variance = moment.min(sums.apart / sums.pairs.max(1.0));
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

/// The branches that left the same hit, two by two.
fn pairs(returns: &[Return]) -> impl Iterator<Item = (&Return, &Return)> {
    let finite = returns.iter().filter(|back| back.radiance.is_finite());
    let mut by_hit: Vec<_> = finite.collect();
    by_hit.sort_by_key(|back| back.hit);
    let pairs: Vec<_> = by_hit
        .windows(2)
        .map(|pair| (pair[0], pair[1]))
        .filter(|(one, other)| one.hit == other.hit)
        .collect();
    pairs.into_iter()
}

/// The unbiased variance of a few samples, channels added up.
fn variance(samples: &[Vec3]) -> f64 {
    let count = samples.len() as f64;
    let wide = || samples.iter().map(|sample| sample.as_dvec3());
    let mean = wide().sum::<DVec3>() / count;
    let apart = |sample: DVec3| (sample - mean).length_squared();
    wide().map(apart).sum::<f64>() / (count - 1.0)
}
