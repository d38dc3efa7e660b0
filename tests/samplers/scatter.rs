//! The scatter samplers, from their definitions, by solid angle.

use super::sampling::*;
use crate::support;
use glam::DVec3;
use lampray::knobs::*;
use lampray::pack::{Material, PointsJob, Strategy};
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};

fn scatter_job(
    scatter: Scatter,
    spread: f64,
    mass: f64,
    normal: DVec3,
    incoming: DVec3,
) -> PointsJob {
    let scale = (2.0 / PI).sqrt() / (spread * mass * TAU);
    PointsJob {
        material: Material {
            albedo: [0.8; 3],
            scatter: scatter.index(),
            survival: 1.0,
            spread: spread as f32,
            lobe_mass: mass as f32,
            lobe_scale: scale as f32,
            ..Material::default()
        },
        normal: narrow(normal),
        incoming: narrow(incoming),
        scattering: 1,
        ..job()
    }
}

/// A normal and a direction that arrives.
fn arrival() -> (DVec3, DVec3) {
    (
        DVec3::new(0.1, 0.7, -0.5).normalize(),
        DVec3::new(0.8, -0.5, 0.2).normalize(),
    )
}

/// Density by the cosine to the normal.
type Law = fn(f64) -> f64;

pub fn diffuse(law: ScatterDiffuse) -> Sampling {
    let (normal, incoming) = arrival();
    let even = |out: f64| if out >= 0.0 { 1.0 / TAU } else { 0.0 };
    let cosine = |out: f64| out.max(0.0) / PI;
    let (density, mutant): (Law, Law) = match law {
        ScatterDiffuse::Cosine => (cosine, |out| {
            if out >= 0.0 {
                0.95 * out / PI + 0.05 / TAU
            } else {
                0.0
            }
        }),
        ScatterDiffuse::Uniform => (even, cosine),
    };
    Sampling {
        name: format!("diffuse {law}"),
        strategy: Strategy {
            scatter_diffuse: law,
            ..support::strategy()
        },
        job: scatter_job(Scatter::Diffuse, 1.0, 1.0, normal, incoming),
        axis: normal,
        limit: FRAC_PI_2,
        midpoints: 12,
        density: Box::new(move |v| density(v.dot(normal))),
        stated: Box::new(move |v| density(v.dot(normal))),
        ring: 0.0,
        mutant: Box::new(move |v| mutant(v.dot(normal))),
    }
}

/// The half-normal law of the paper's directional scattering, by solid angle.
fn lobe(theta: f64, spread: f64, mass: f64) -> f64 {
    let law = (2.0 / PI).sqrt() / (spread * mass) * (-0.5 * (theta / spread).powi(2)).exp();
    if theta < FRAC_PI_2 {
        law / (TAU * theta.sin().max(1e-9))
    } else {
        0.0
    }
}

pub fn directional(bound: ScatterBound, spread: f64) -> Sampling {
    let (normal, incoming) = arrival();
    let mirror = incoming - 2.0 * normal.dot(incoming) * normal;
    let below = libm::erf(FRAC_PI_2 / (SQRT_2 * spread));
    let mass = if bound == ScatterBound::Truncate {
        below
    } else {
        1.0
    };
    let density = move |v: DVec3| lobe(v.angle_between(mirror), spread, mass);
    let mutant = move |v: DVec3| lobe(v.angle_between(mirror), 1.02 * spread, mass);
    Sampling {
        name: format!("directional {bound} {spread}"),
        strategy: Strategy {
            scatter_bound: bound,
            ..support::strategy()
        },
        job: scatter_job(Scatter::Directional, spread, mass, normal, incoming),
        axis: mirror,
        limit: FRAC_PI_2.min(5.0 * spread),
        midpoints: 12,
        density: Box::new(density),
        stated: Box::new(density),
        ring: if bound == ScatterBound::Clamp {
            1.0 - below
        } else {
            0.0
        },
        mutant: Box::new(mutant),
    }
}
