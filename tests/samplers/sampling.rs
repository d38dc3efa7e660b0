//! A sampler, what is asked of it, and what is known of it.

use super::light::{Place, light, tested};
use super::rough::rough;
use super::scatter::{diffuse, directional};
use crate::support::bench::Bench;
use glam::DVec3;
use lampray::knobs::*;
use lampray::pack::{Basis, Draw, PointsJob, Strategy, words};

pub type Density = Box<dyn Fn(DVec3) -> f64 + Sync>;

/// A sampler and what is known of it.
pub struct Sampling {
    pub name: String,
    pub strategy: Strategy,
    pub job: PointsJob,
    /// Axis of the cells, and the polar angle that they reach to.
    pub axis: DVec3,
    pub limit: f64,
    /// Of a side of a cell, by which its share is summed: more where the density ends within cells.
    pub midpoints: usize,
    /// Of the drawn unit vectors, by area of the unit sphere.
    pub density: Density,
    /// From that to the density by solid angle that the renderer states; 0 for what is not seen.
    pub stated: Density,
    /// Share of draws without a density: the ring that a clamp piles up.
    pub ring: f64,
    /// A density that is wrong in the way that this sampler invites.
    pub mutant: Density,
}

impl Sampling {
    /// `count` draws by a device, under a seed of its own for every `family`.
    pub fn draws(&self, bench: Bench, family: u32, count: usize) -> Vec<Draw> {
        let [low, high] = self.job.seed;
        let job = PointsJob {
            count: count as u32,
            seed: [low, high ^ family],
            ..self.job
        };
        let drawn = bench.with(|device| device.points(&self.strategy, &job).unwrap());
        assert_eq!(drawn.len(), count);
        drawn
    }
}

pub fn wide(draw: &Draw) -> DVec3 {
    DVec3::from_array(draw.point.map(f64::from))
}

pub fn job() -> PointsJob {
    let [low, high] = words(0x1f2e_3d4c_5b6a_7988);
    PointsJob {
        seed: [low, high],
        // Draws pass from one high word to the next on their way.
        first: words((1 << 32) - 1000),
        ..PointsJob::default()
    }
}

pub fn narrow(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

pub fn packed_basis(z: DVec3) -> Basis {
    let (x, y) = z.any_orthonormal_pair();
    Basis {
        x: narrow(x),
        y: narrow(y),
        z: narrow(z),
        ..Basis::default()
    }
}

/// All samplers with a density by solid angle, in the places and with the spreads that try them most.
pub fn samplings() -> Vec<Sampling> {
    let mut all = Vec::new();
    for &sampler in LightSampler::ALL {
        for place in [Place::Far, Place::Near, Place::Inside] {
            all.extend([false, true].map(|pole| light(sampler, place, pole)));
        }
    }
    for sampler in [LightSampler::UniformAngles, LightSampler::Gaussian] {
        // With its pole aside the even angles' density by direction has a peak in the midst of the lamp.
        let object = |place| tested(sampler, place, true, LightTest::Object);
        all.extend([Place::Far, Place::Near, Place::Inside].map(object));
    }
    all.extend(ScatterDiffuse::ALL.iter().map(|&law| diffuse(law)));
    for &bound in ScatterBound::ALL {
        all.extend([0.05, 0.3, 1.0].map(|spread| directional(bound, spread)));
    }
    for alpha in [0.1, 0.4, 1.0] {
        all.extend([30.0, 80.0].map(|degrees| rough(alpha, degrees)));
    }
    all
}
