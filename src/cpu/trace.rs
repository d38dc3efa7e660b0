//! Twin of `shaders/trace.wgsl`: the vertices of a pixel's paths, one after the other.

use super::background::{BACKGROUND_SLOT, background_inverse_density};
use super::r#box::box_local;
use super::branch::{Branches, Branching};
use super::camera::{camera_direction, lens_direction, sample_film, sample_lens};
use super::choice::{choice_probability, choose_lamp};
use super::efficiency::{count_continuations, wanted_continuations};
use super::interruption::{survival_probability, survival_weight};
use super::light::*;
use super::maths::{Basis, greater, largest, sample_cosine};
use super::ray::{Ray, offset_origin};
use super::rectangle::{box_inverse_density, sample_box};
use super::scatter::*;
use super::scene::{Surface, Traversal, surface_at};
use super::sequence::{sequence_key, sequence_unit};
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
    /// Of the surface that scattered it there.
    normal: Vec3,
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
        let strategy = &self.scene.strategy;
        let key = sequence_key(strategy, self.job.seed, pixel, sample);
        let u = sequence_unit(strategy, key, 0, 0);
        let film = sample_film(strategy.filter, pixel, Vec2::new(u[0], u[1]));
        let mut ray = Ray {
            origin: Vec3::ZERO,
            direction: camera_direction(&self.job.camera, film),
            source: 0,
            inside: false,
        };
        if strategy.lens {
            let u = sequence_unit(strategy, key, 0, 1);
            ray.origin = sample_lens(&self.job.camera, Vec2::new(u[0], u[1]));
            ray.direction = lens_direction(&self.job.camera, film, ray.origin);
        }
        Path {
            key,
            ray,
            throughput: Vec3::ONE,
            radiance: Vec3::ZERO,
            vertex: 0,
            density: 0.0,
            normal: Vec3::ZERO,
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
        let index = surface.lamp.wrapping_sub(1);
        let lamp = &self.scene.lamps[index as usize];
        let probability = choice_probability(self.scene, index, path.ray.origin, path.normal);
        let outward = if surface.inside {
            -surface.normal
        } else {
            surface.normal
        };
        if lamp.shape != 0 {
            let shape = &self.scene.boxes[(lamp.shape as usize).wrapping_sub(1)];
            let to = distance * path.ray.direction;
            let drawn = box_inverse_density(shape, path.ray.origin, surface.inside, to, outward);
            return power_heuristic(probability / greater(drawn * path.density, 1e-30));
        }
        let hit = LampHit {
            inside: surface.inside,
            direction: path.ray.direction,
            distance,
            outward,
        };
        let inverse_density =
            light_inverse_density(strategy, lamp, self.pole, path.ray.origin, path.normal, hit);
        power_heuristic(probability / greater(inverse_density * path.density, 1e-30))
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

    /// A direction to a box that is a lamp.
    fn sample_box_lamp(&self, number: u32, own: bool, origin: Vec3, u: Vec4) -> LightSample {
        let shape = &self.scene.boxes[(number as usize).wrapping_sub(1)];
        let local = box_local(shape, origin - Vec3::from(shape.center));
        let inside = own || local.abs().cmplt(shape.half_size.into()).all();
        let drawn = sample_box(shape, origin, inside, u);
        LightSample {
            direction: drawn.direction,
            distance: drawn.distance,
            weight: drawn.inverse_density,
            inverse_density: drawn.inverse_density,
        }
    }

    /// What the background sends to a surface and the surface sends on, by one shadow ray; and whether
    /// the ray was traced.
    fn light_from_background(&self, path: &Path, surface: &Surface, origin: Vec3) -> (Vec3, u32) {
        let strategy = &self.scene.strategy;
        let material = &self.scene.materials[surface.material as usize];
        let vertex = path.vertex.wrapping_add(1);
        let u = sequence_unit(strategy, path.key, vertex, BACKGROUND_SLOT);
        let (normal, incoming) = (surface.normal, path.ray.direction);
        let direction = sample_cosine(normal, Vec2::new(u[0], u[1]));
        let inverse_density = background_inverse_density(normal, direction);
        let density = scatter_density(strategy, material, normal, incoming, direction);
        let reflected =
            evaluate_by_density(strategy, material, normal, incoming, direction, density);
        let other = match strategy.light_strategy {
            LightStrategy::Mis => density,
            _ => 0.0,
        };
        let value = reflected
            * inverse_density
            * power_heuristic(inverse_density * other)
            * Vec3::from(self.job.background);
        if largest(value) == 0.0 {
            return (Vec3::ZERO, 0);
        }
        let shadow = Ray {
            origin,
            direction,
            source: surface.body,
            inside: surface.inside,
        };
        let blocked = self.bodies.occluded(&shadow, 3e38, 0);
        (if blocked { Vec3::ZERO } else { value }, 1)
    }

    /// Weight of the background seen by a ray: all of it where shadow rays could not have found it.
    fn background_weight(&self, path: &Path) -> f32 {
        let strategy = &self.scene.strategy;
        if !strategy.background_lamp || path.density == 0.0 {
            return 1.0;
        }
        if strategy.light_strategy == LightStrategy::Sample {
            return 0.0;
        }
        let inverse_density = background_inverse_density(path.normal, path.ray.direction);
        power_heuristic(1.0 / greater(inverse_density * path.density, 1e-30))
    }

    /// What one lamp sends to a surface and the surface sends on, by one shadow ray; and whether
    /// the ray was traced. `slot`: of its random numbers; `inverse_probability`: of the choice of this lamp.
    #[inline(always)]
    fn light_from(
        &self,
        (index, slot): (usize, u32),
        inverse_probability: f32,
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
        // Here and below whole numbers wrap, as WGSL's do: asking whether they would costs 3 % of the time.
        let vertex = path.vertex.wrapping_add(1);
        let u = Vec4::from(sequence_unit(strategy, path.key, vertex, slot));
        let light = match lamp.shape {
            0 => {
                let inside = own || Vec3::from(lamp.center).distance(origin) < lamp.radius;
                sample_light(strategy, lamp, self.pole, origin, surface.normal, inside, u)
            }
            number => self.sample_box_lamp(number, own, origin, u),
        };
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
                let normal = surface.normal;
                evaluate_by_density(
                    strategy,
                    material,
                    normal,
                    incoming,
                    light.direction,
                    density,
                )
            }
        };
        let mut weight = light.weight * inverse_probability;
        if strategy.light_strategy == LightStrategy::Mis {
            weight *= power_heuristic(light.inverse_density * inverse_probability * density);
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

    /// The paper's light of lamps, one shadow ray to each; or one to a lamp that is drawn.
    #[inline(always)]
    fn light_from_lamps(&self, path: &Path, surface: &Surface, origin: Vec3) -> (Vec3, u32) {
        if self.scene.strategy.light_choice != LightChoice::All && !self.scene.lamps.is_empty() {
            let vertex = path.vertex.wrapping_add(1);
            let chosen = choose_lamp(self.scene, path.key, vertex, origin, surface.normal);
            let lamp = (chosen.lamp as usize, 1);
            return self.light_from(lamp, chosen.inverse_probability, path, surface, origin);
        }
        let (mut sum, mut traced) = (Vec3::ZERO, 0u32);
        for index in 0..self.scene.lamps.len() {
            let lamp = (index, (index as u32).wrapping_add(1));
            let (radiance, rays) = self.light_from(lamp, 1.0, path, surface, origin);
            sum += radiance;
            traced = traced.saturating_add(rays);
        }
        (sum, traced)
    }

    /// The light of lamps, and of the background where that is asked for.
    #[inline(always)]
    fn direct_light(&self, path: &mut Path, surface: &Surface, origin: Vec3) {
        if self.scene.strategy.light_strategy == LightStrategy::Hit {
            return;
        }
        let (mut sum, rays) = self.light_from_lamps(path, surface, origin);
        path.rays = path.rays.saturating_add(rays);
        if self.scene.strategy.background_lamp {
            let (radiance, rays) = self.light_from_background(path, surface, origin);
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
            surface.inside,
            u,
        );
        path.throughput *= scattered.weight;
        path.density = scattered.density;
        path.normal = surface.normal;
        path.ray = Ray {
            origin,
            direction: scattered.direction,
            source: surface.body,
            inside: surface.inside,
        };
        // What goes through starts on the other side. Below any other surface the path carries nothing.
        if self.scene.strategy.glass_surfaces && scattered.direction.dot(surface.normal) < 0.0 {
            path.ray.origin = offset_origin(surface.point, -surface.normal);
            path.ray.inside = !surface.inside;
        }
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
        let Some(branching) = branches.take_branch(&self.scene.strategy) else {
            return false;
        };
        path.key = branching.key;
        path.vertex = branching.vertex;
        path.throughput = branching.throughput;
        path.ray.direction = branching.incoming;
        let from = (branching.surface.body, branching.hit);
        branches.leave(from, path.throughput, &mut path.radiance, path.rays);
        let u = sequence_unit(
            &self.scene.strategy,
            branching.key,
            branching.vertex.wrapping_add(1),
            0,
        );
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
        let u = sequence_unit(strategy, path.key, path.vertex.wrapping_add(1), 0);
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
                let background = Vec3::from(self.job.background) * self.background_weight(path);
                path.radiance += path.throughput * background;
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
