//! Unit integrals: the renderer's own densities, summed over every direction they can draw.
//!
//! What is drawn where it has no density is stated beside it: the ring that a clamp piles up, and the
//! lamp's far side, which a sampler of its whole surface draws in vain. The probe kernel answers for the GPU.

use super::cells::axes;
use super::light::{RADIUS, by_solid_angle};
use super::sampling::*;
use super::scatter::{diffuse, directional};
use crate::support;
use crate::support::bench::{Bench, benches};
use glam::{DVec3, Vec3};
use lampray::cpu::light::{LampHit, light_inverse_density};
use lampray::cpu::maths;
use lampray::cpu::scatter::scatter_density;
use lampray::knobs::*;
use lampray::pack::{Draw, ProbeInput};
use lampray::shader::Probe;
use std::f64::consts::TAU;

/// How far an integral may be from its mass.
const NEAR: f64 = 1e-3;
/// Midpoints from the axis to the limit, and around it.
const STEPS: usize = 600;

/// Midpoints over the sphere about a sampler's axis, each with its solid angle.
fn midpoints(of: &Sampling) -> Vec<(DVec3, f64)> {
    let (x, y, z) = axes(of.axis);
    let (high, wide) = (of.limit / STEPS as f64, TAU / STEPS as f64);
    let place = |number: usize| {
        let (i, j) = (number / STEPS, number % STEPS);
        let (sine, cosine) = ((i as f64 + 0.5) * high).sin_cos();
        let (up, along) = ((j as f64 + 0.5) * wide).sin_cos();
        let v = sine * (along * x + up * y) + cosine * z;
        (v, sine * high * wide)
    };
    (0..STEPS * STEPS).map(place).collect()
}

fn four(v: [f32; 3], w: f32) -> [f32; 4] {
    [v[0], v[1], v[2], w]
}

/// What the probe kernel says of some directions, in one lane of its answers.
fn probed(of: &Sampling, probe: Probe, inputs: &[ProbeInput], lane: usize) -> Vec<f64> {
    let mut gpu = support::gpu("densities").expect("only benches that are there");
    let outputs = gpu.probe(&of.strategy, probe, inputs).unwrap();
    outputs.iter().map(|out| f64::from(out.a[lane])).collect()
}

/// Density with which a device says that it scatters into each direction.
fn scattered(of: &Sampling, bench: Bench, directions: &[DVec3]) -> Vec<f64> {
    let (job, material) = (&of.job, &of.job.material);
    let (normal, incoming) = (job.normal, job.incoming);
    if bench == Bench::Twin {
        let stated = |v: &DVec3| {
            let (normal, incoming) = (normal.into(), incoming.into());
            scatter_density(&of.strategy, material, normal, incoming, v.as_vec3()).into()
        };
        return directions.iter().map(stated).collect();
    }
    let [kind, spread, mass, scale] = [
        material.scatter as f32,
        material.spread,
        material.lobe_mass,
        material.lobe_scale,
    ];
    let input = |v: &DVec3| ProbeInput {
        a: four(normal, material.shape),
        b: four(incoming, 0.0),
        c: four(narrow(*v), 0.0),
        d: [kind, spread, mass, scale],
    };
    let inputs: Vec<_> = directions.iter().map(input).collect();
    probed(of, Probe::EvaluateScatter, &inputs, 3)
}

/// The numbers of which `unit_sphere` makes a direction.
fn sphere_place([x, y, z]: [f32; 3]) -> [f32; 2] {
    let turn = f64::from(y).atan2(x.into()) / TAU;
    [0.5 * (1.0 - z), (turn + 0.5) as f32]
}

/// Inverse density by solid angle that a device states for points of the lamp: every direction to
/// it leads to one.
fn inverse_lit(of: &Sampling, bench: Bench, outwards: &[DVec3]) -> Vec<f64> {
    let (lamp, origin) = (&of.job.lamp, Vec3::from(of.job.receiver));
    let [x, y, z] = [of.job.pole.x, of.job.pole.y, of.job.pole.z].map(Into::into);
    if bench == Bench::Twin {
        let stated = |outward: &DVec3| {
            let point = Vec3::from(lamp.center) + lamp.radius * outward.as_vec3();
            let distance = point.distance(origin);
            let hit = LampHit {
                inside: of.job.inside == 1,
                direction: (point - origin) / distance,
                distance,
                outward: outward.as_vec3(),
            };
            let pole = maths::Basis { x, y, z };
            let normal = of.job.normal.into();
            light_inverse_density(&of.strategy, lamp, pole, origin, normal, hit).into()
        };
        return outwards.iter().map(stated).collect();
    }
    let [z, w] = sphere_place(of.job.normal);
    let input = |outward: &DVec3| ProbeInput {
        a: four(lamp.center, lamp.radius),
        b: four(of.job.receiver, lamp.weight_radius),
        c: four(narrow(*outward), 0.0),
        d: [of.job.inside as f32, 1.0, z, w],
    };
    let inputs: Vec<_> = outwards.iter().map(input).collect();
    probed(of, Probe::LightDensity, &inputs, 0)
}

fn to_receiver(of: &Sampling) -> DVec3 {
    let [receiver, center] = [of.job.receiver, of.job.lamp.center].map(Vec3::from);
    (receiver - center).as_dvec3() / RADIUS
}

/// Integral of a device's density over the directions it draws, without a clamp's ring.
fn mass(of: &Sampling, bench: Bench) -> f64 {
    let (places, areas): (Vec<_>, Vec<_>) = midpoints(of).into_iter().unzip();
    if of.job.scattering == 1 {
        let densities = scattered(of, bench, &places);
        return densities.iter().zip(&areas).map(|(p, area)| p * area).sum();
    }
    let inverse = inverse_lit(of, bench, &places);
    let to = to_receiver(of);
    let lit = |(at, inverse): (usize, f64)| {
        let seen = by_solid_angle(places[at], to).unwrap_or(0.0);
        match inverse > 0.0 {
            true => areas[at] * seen / inverse,
            false => 0.0,
        }
    };
    inverse.into_iter().enumerate().map(lit).sum()
}

/// What the integral must be: 1, less the ring that a clamp piles up; and from outside a lamp, of a
/// sampler of its whole surface, the share that faces the receiver: (1 - 1 / d) / 2 at d radii where
/// points are even by area (Archimedes), else a quadrature of the definition.
fn truth(of: &Sampling) -> f64 {
    let by_point = of.strategy.light_test == LightTest::Point;
    let outside = of.job.scattering == 0 && of.job.inside == 0 && by_point;
    let to = to_receiver(of);
    match of.strategy.light_sampler {
        LightSampler::UniformAngles if outside => {
            let faces = |&(v, _): &(DVec3, f64)| by_solid_angle(v, to).is_some();
            let seen = midpoints(of).into_iter().filter(faces);
            seen.map(|(v, area)| (of.density)(v) * area).sum()
        }
        LightSampler::InverseCosine | LightSampler::Gaussian if outside => {
            0.5 * (1.0 - 1.0 / to.length())
        }
        _ => 1.0 - of.ring,
    }
}

#[test]
fn the_renderers_densities_integrate_to_one() {
    for bench in benches() {
        let mut worst = 0f64;
        for of in samplings() {
            let (found, truth) = (mass(&of, bench), truth(&of));
            let off = (found - truth).abs();
            assert!(off < NEAR, "{bench:?} {}: {found}, not {truth}", of.name);
            worst = worst.max(off);
        }
        println!("{bench:?}: integrals are off by {worst:.1e} at most");
    }
}

/// What is drawn in vain is what the draws say it is: mass with a density plus mass without is 1.
#[test]
fn draws_without_a_density_are_the_rest() {
    const COUNT: usize = 200_000;
    for bench in benches() {
        for of in samplings() {
            let drawn = of.draws(bench, 1, COUNT);
            let vain = |draw: &&Draw| draw.density == 0.0;
            let share = drawn.iter().filter(vain).count() as f64 / COUNT as f64;
            let rest = 1.0 - truth(&of);
            // Four standard errors of a share at most.
            let most = 4.0 * (rest * (1.0 - rest) / COUNT as f64).max(0.0).sqrt() + 1e-4;
            let off = (share - rest).abs();
            assert!(off <= most, "{bench:?} {}: {share}, not {rest}", of.name);
        }
    }
}

#[test]
fn wrong_densities_do_not_integrate_to_one() {
    for bench in benches() {
        let cosine = mass(&diffuse(ScatterDiffuse::Cosine), bench);
        assert!((1.01 * cosine - 1.0).abs() > NEAR);
        // A lobe cut at a right angle whose density was not made up for the cut.
        let mut cut = directional(ScatterBound::Truncate, 1.0);
        cut.job.material.lobe_scale *= cut.job.material.lobe_mass;
        let short = mass(&cut, bench);
        println!("{bench:?}: a lobe that is cut and not made up integrates to {short:.4}");
        assert!((short - 1.0).abs() > NEAR, "{bench:?}: {short}");
    }
}
