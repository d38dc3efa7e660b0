//! Twin of `shaders/trace.wgsl`: the vertices of a pixel's paths, one after the other.

use super::branch::{Branches, Branching};
use super::camera::{camera_direction, sample_film};
use super::efficiency::{count_continuations, wanted_continuations};
use super::interruption::{survival_probability, survival_weight};
use super::light::*;
use super::maths::{Basis, greater, largest};
use super::random::{random_key, random_unit};
use super::ray::{Ray, offset_origin};
use super::scatter::*;
use super::scene::{Surface, Traversal, surface_at};
use crate::knobs::*;
use crate::pack::{Job, LastRay, Packed, RUN_LENGTH, Tally};
use glam::{Vec2, Vec3, Vec4};

/// A path on its way.
#[derive(Clone, Copy, Debug)]
struct Path {
    key: [u32; 4],
    ray: Ray,
    throughput: Vec3,
    radiance: Vec3,
    /// Number of the hit that the ray is looking for; the camera's is 0.
    vertex: u32,
    /// Of the direction the ray was scattered into; 0 where it has none.
    density: f32,
    rays: u32,
    alive: bool,
}

/// A scene and a dispatch: what the kernel has in its bindings.
#[derive(Clone, Copy, Debug)]
pub struct Tracer<'a, T> {
    scene: &'a Packed,
    bodies: &'a T,
    job: &'a Job,
    pole: Basis,
}

impl<'a, T: Traversal> Tracer<'a, T> {
    pub fn new(scene: &'a Packed, bodies: &'a T, job: &'a Job) -> Self {
        let pole = Basis {
            x: job.pole.x.into(),
            y: job.pole.y.into(),
            z: job.pole.z.into(),
        };
        Self {
            scene,
            bodies,
            job,
            pole,
        }
    }

    #[inline(always)]
    fn start_path(&self, pixel: [u32; 2], sample: [u32; 2]) -> Path {
        let key = random_key(self.job.seed, pixel, sample);
        let u = random_unit(key, 0, 0);
        let film = sample_film(self.scene.strategy.filter, pixel, Vec2::new(u[0], u[1]));
        let direction = camera_direction(&self.job.camera, film);
        Path {
            key,
            ray: Ray {
                origin: Vec3::ZERO,
                direction,
                source: 0,
                inside: false,
            },
            throughput: Vec3::ONE,
            radiance: Vec3::ZERO,
            vertex: 0,
            density: 0.0,
            rays: 0,
            alive: true,
        }
    }

    #[inline(always)]
    fn emission_counts(&self, path: &Path) -> bool {
        path.vertex == 0 || self.scene.strategy.light_direct == LightDirect::Bsdf
    }

    #[inline(always)]
    fn lamp_hit_weight(&self, path: &Path, surface: &Surface, distance: f32) -> f32 {
        let strategy = &self.scene.strategy;
        if path.density == 0.0 || strategy.light_strategy == LightStrategy::Hit {
            return 1.0;
        }
        if strategy.light_strategy == LightStrategy::Sample {
            return 0.0;
        }
        let lamp = &self.scene.lamps[(surface.lamp as usize).wrapping_sub(1)];
        let outward = if surface.inside {
            -surface.normal
        } else {
            surface.normal
        };
        let hit = LampHit {
            inside: surface.inside,
            direction: path.ray.direction,
            distance,
            outward,
        };
        let inverse_density =
            light_inverse_density(strategy, lamp, self.pole, path.ray.origin, hit);
        power_heuristic(1.0 / greater(inverse_density * path.density, 1e-30))
    }

    #[inline(always)]
    fn emitted(&self, path: &Path, surface: &Surface, distance: f32) -> Vec3 {
        let emission = Vec3::from(self.scene.materials[surface.material as usize].emission);
        if !self.emission_counts(path) || largest(emission) == 0.0 {
            return Vec3::ZERO;
        }
        if surface.lamp == 0 {
            return emission;
        }
        emission * self.lamp_hit_weight(path, surface, distance)
    }

    /// What one lamp sends to a surface and the surface sends on, by one shadow ray; and whether
    /// the ray was traced.
    #[inline(always)]
    fn light_from(
        &self,
        index: usize,
        path: &Path,
        surface: &Surface,
        origin: Vec3,
    ) -> (Vec3, u32) {
        let strategy = &self.scene.strategy;
        let lamp = &self.scene.lamps[index];
        let material = &self.scene.materials[surface.material as usize];
        let incoming = path.ray.direction;
        let own = surface.body == lamp.body;
        // A lamp never lights its own outer side.
        if own && !surface.inside {
            return (Vec3::ZERO, 0);
        }
        let inside = own || Vec3::from(lamp.center).distance(origin) < lamp.radius;
        // Here and below whole numbers wrap, as WGSL's do: asking whether they would costs 3 % of the time.
        let slot = (index as u32).wrapping_add(1);
        let u = Vec4::from(random_unit(path.key, path.vertex.wrapping_add(1), slot));
        let light = sample_light(strategy, lamp, self.pole, origin, inside, u);
        let density = scatter_density(
            strategy,
            material,
            surface.normal,
            incoming,
            light.direction,
        );
        let reflected = match strategy.light_direct {
            LightDirect::Lambert => evaluate_lambert(material, surface.normal, light.direction),
            LightDirect::Bsdf => {
                evaluate_by_density(material, surface.normal, light.direction, density)
            }
        };
        let mut weight = light.weight;
        if strategy.light_strategy == LightStrategy::Mis {
            weight *= power_heuristic(light.inverse_density * density);
        }
        let value = reflected * weight * Vec3::from(lamp.emission);
        if largest(value) == 0.0 {
            return (Vec3::ZERO, 0);
        }
        let shadow = Ray {
            origin,
            direction: light.direction,
            source: surface.body,
            inside: surface.inside,
        };
        let blocked = self.bodies.occluded(&shadow, light.distance, lamp.body);
        (if blocked { Vec3::ZERO } else { value }, 1)
    }

    /// The paper's direct light: one shadow ray to each lamp.
    #[inline(always)]
    fn direct_light(&self, path: &mut Path, surface: &Surface, origin: Vec3) {
        if self.scene.strategy.light_strategy == LightStrategy::Hit {
            return;
        }
        let mut sum = Vec3::ZERO;
        for index in 0..self.scene.lamps.len() {
            let (radiance, rays) = self.light_from(index, path, surface, origin);
            sum += radiance;
            path.rays = path.rays.saturating_add(rays);
        }
        path.radiance += path.throughput * sum;
    }

    #[inline(always)]
    fn last_ray_counts(&self, scattered: &Scattered) -> bool {
        match self.scene.strategy.last_ray {
            LastRay::Always => true,
            LastRay::WithoutDensity => scattered.density == 0.0,
            LastRay::Never => false,
        }
    }

    #[inline(always)]
    fn scatter_path(&self, path: &mut Path, surface: &Surface, origin: Vec3, u: Vec2) {
        let material = &self.scene.materials[surface.material as usize];
        let scattered = sample_scatter(
            &self.scene.strategy,
            material,
            surface.normal,
            path.ray.direction,
            u,
        );
        path.throughput *= scattered.weight;
        path.density = scattered.density;
        path.ray = Ray {
            origin,
            direction: scattered.direction,
            source: surface.body,
            inside: surface.inside,
        };
        path.vertex = path.vertex.wrapping_add(1);
        let useful = path.vertex < self.job.max_bounces || self.last_ray_counts(&scattered);
        path.alive = useful && largest(path.throughput) > 0.0;
    }

    /// How many rays should leave a hit; only the rule `efficiency` asks.
    fn continuations(&self, path: &Path, surface: &Surface, branches: &Branches) -> f32 {
        let worth = &self.scene.worths[(surface.body as usize).wrapping_sub(1)];
        wanted_continuations(worth, path.throughput, branches.allowed as f32)
    }

    /// The path goes on as that many, each with its share of the throughput: that of the whole number, so that
    /// splitting adds no noise of its own.
    fn split_path(
        &self,
        path: &mut Path,
        surface: &Surface,
        origin: Vec3,
        (wanted, u): (f32, f32),
        branches: &mut Branches,
    ) {
        let count = count_continuations(branches.wanted(wanted), u);
        path.throughput /= count as f32;
        let hit = branches.number_hit();
        let branching = Branching {
            key: path.key,
            vertex: path.vertex,
            throughput: path.throughput,
            incoming: path.ray.direction,
            surface: *surface,
            origin,
            left: 0,
            allowed: 0,
            hit,
        };
        branches.open_branching(branching, count);
        let from = (surface.body, hit);
        branches.leave(from, path.throughput, &mut path.radiance, path.rays);
    }

    /// A path that has ended goes on as its next branch; false where it has no more.
    fn next_branch(&self, path: &mut Path, branches: &mut Branches) -> bool {
        branches.come_back(&mut path.radiance, path.rays);
        let Some(branching) = branches.take_branch() else {
            return false;
        };
        path.key = branching.key;
        path.vertex = branching.vertex;
        path.throughput = branching.throughput;
        path.ray.direction = branching.incoming;
        let from = (branching.surface.body, branching.hit);
        branches.leave(from, path.throughput, &mut path.radiance, path.rays);
        let u = random_unit(branching.key, branching.vertex.wrapping_add(1), 0);
        self.scatter_path(
            path,
            &branching.surface,
            branching.origin,
            Vec2::new(u[0], u[1]),
        );
        true
    }

    /// Emission, direct light and the next ray of one hit.
    #[inline(always)]
    fn visit(&self, path: &mut Path, surface: &Surface, distance: f32, branches: &mut Branches) {
        let strategy = &self.scene.strategy;
        path.radiance += path.throughput * self.emitted(path, surface, distance);
        if path.vertex >= self.job.max_bounces {
            path.alive = false;
            return;
        }
        let material = &self.scene.materials[surface.material as usize];
        let albedo = Vec3::from(material.albedo);
        let u = random_unit(path.key, path.vertex.wrapping_add(1), 0);
        let tested = strategy.interruption_rule != InterruptionRule::None
            && path.vertex >= self.job.interruption_start;
        let splits = strategy.interruption_rule == InterruptionRule::Efficiency;
        let threshold = match splits {
            true if tested => self.continuations(path, surface, branches),
            true => 1.0,
            false => material.survival,
        };
        let (mut survives, mut weight) = (true, 1.0);
        if tested {
            let carried = path.throughput * albedo;
            let probability = survival_probability(strategy, threshold, albedo, carried);
            survives = u[2] < probability;
            weight = survival_weight(strategy, probability);
        }
        if strategy.interruption_order == InterruptionOrder::BeforeDirect {
            path.throughput *= weight;
            path.alive = survives;
            if !survives {
                return;
            }
        }
        let origin = offset_origin(surface.point, surface.normal);
        self.direct_light(path, surface, origin);
        if strategy.interruption_order == InterruptionOrder::AfterDirect {
            path.throughput *= weight;
            path.alive = survives;
            if !survives {
                return;
            }
        }
        if splits {
            let wanted = (greater(threshold, 1.0), u[2]);
            self.split_path(path, surface, origin, wanted, branches);
        }
        self.scatter_path(path, surface, origin, Vec2::new(u[0], u[1]));
    }

    #[inline(always)]
    fn step_path(&self, path: &mut Path, branches: &mut Branches) {
        let hit = self.bodies.nearest_hit(&path.ray);
        path.rays = path.rays.saturating_add(1);
        if hit.body == 0 {
            if self.emission_counts(path) {
                path.radiance += path.throughput * Vec3::from(self.job.background);
            }
            path.alive = false;
            return;
        }
        let surface = surface_at(self.scene, hit, &path.ray);
        self.visit(path, &surface, hit.distance, branches);
    }

    /// Radiance of one sample of a pixel, unclamped, and the rays it took.
    #[inline(always)]
    pub fn sample(&self, pixel: [u32; 2], sample: u64) -> (Vec3, u32) {
        self.sample_by(pixel, sample, &mut Branches::default())
    }

    /// The same with the branches that the path splits into.
    #[inline(always)]
    pub fn sample_by(&self, pixel: [u32; 2], sample: u64, branches: &mut Branches) -> (Vec3, u32) {
        let strategy = &self.scene.strategy;
        branches.begin(strategy.interruption_split);
        let mut path = self.start_path(pixel, crate::pack::words(sample));
        loop {
            while path.alive {
                self.step_path(&mut path, branches);
            }
            let splits = strategy.interruption_rule == InterruptionRule::Efficiency;
            if !(splits && self.next_branch(&mut path, branches)) {
                return (path.radiance, path.rays);
            }
        }
    }

    /// One tally for each run of the job's samples of a pixel.
    #[inline(always)]
    pub fn pixel(&self, pixel: [u32; 2]) -> Vec<Tally> {
        let first = u64::from(self.job.first_sample[0]) | u64::from(self.job.first_sample[1]) << 32;
        let end = first + u64::from(self.job.samples);
        let mut run = Run::default();
        let mut tallies = Vec::new();
        for sample in first..end {
            let (radiance, rays) = self.sample(pixel, sample);
            run.add(radiance, rays, self.job.clamp);
            if sample + 1 == end || (sample + 1).is_multiple_of(u64::from(RUN_LENGTH)) {
                tallies.push(run.tally());
                run = Run::default();
            }
        }
        tallies
    }
}

/// Sums of one run, as distances from its first sample.
#[derive(Clone, Copy, Debug, Default)]
struct Run {
    first: Vec3,
    sum: Vec3,
    squares: Vec3,
    samples: u32,
    rays: u32,
    non_finite: u32,
}

impl Run {
    fn add(&mut self, radiance: Vec3, rays: u32, clamp: f32) {
        let finite = radiance.is_finite();
        if !finite {
            self.non_finite += if self.non_finite == 0 {
                1 + (self.samples << 16)
            } else {
                1
            };
        }
        let radiance = if finite {
            radiance.min(Vec3::splat(clamp))
        } else {
            Vec3::ZERO
        };
        if self.samples == 0 {
            self.first = radiance;
        }
        let apart = radiance - self.first;
        self.sum += apart;
        self.squares += apart * apart;
        self.samples += 1;
        self.rays = self.rays.saturating_add(rays);
    }

    fn tally(&self) -> Tally {
        let shift = self.sum / self.samples as f32;
        let squares = (self.squares - self.sum * shift).max(Vec3::ZERO);
        Tally {
            mean: (self.first + shift).to_array(),
            rays: self.rays,
            squares: squares.to_array(),
            non_finite: self.non_finite,
        }
    }
}
