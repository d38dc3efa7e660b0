//! The four light samplers, from their definitions, by area of the unit sphere.

use super::sampling::*;
use crate::support;
use glam::DVec3;
use lampray::knobs::*;
use lampray::pack::{Lamp, PointsJob, Strategy};
use std::f64::consts::{PI, TAU};

/// Where the lamp is seen from, in radii from its centre.
#[derive(Clone, Copy, Debug)]
pub enum Place {
    Far,
    Near,
    Inside,
}

impl Place {
    pub fn away(self) -> f64 {
        match self {
            Place::Far => 10.0,
            Place::Near => 1.05,
            Place::Inside => 0.4,
        }
    }
}

/// Area density of case 1 (both angles even), and of everything that is even by area.
fn surface_density(sampler: LightSampler, outward: DVec3, pole: DVec3) -> f64 {
    match sampler {
        LightSampler::UniformAngles => 1.0 / (TAU * PI * outward.cross(pole).length().max(1e-12)),
        _ => 1.0 / (4.0 * PI),
    }
}

/// Density of the cone's directions, carried over to the unit sphere around the lamp's centre: the
/// lamp has radius 1 and `to_receiver` leads from its centre.
fn cone_density(outward: DVec3, to_receiver: DVec3) -> f64 {
    let distance = to_receiver.length();
    let solid_angle = TAU * (1.0 - (1.0 - 1.0 / (distance * distance)).sqrt());
    by_solid_angle(outward, to_receiver).map_or(0.0, |ratio| ratio / solid_angle)
}

/// Solid angle over area at a point of the unit sphere; none where it faces away.
pub fn by_solid_angle(outward: DVec3, to_receiver: DVec3) -> Option<f64> {
    let to = to_receiver - outward;
    let cosine = outward.dot(to) / to.length();
    let inside = to_receiver.length() < 1.0;
    let seen = if inside { cosine.abs() } else { cosine };
    (seen > 0.0).then(|| seen / to.length_squared())
}

pub const RADIUS: f64 = 0.35;

/// The probe kernel's pole, so that it can be asked for the same densities.
const PROBE_POLE: DVec3 = DVec3::new(0.3, -0.5, 0.8);

pub fn light(sampler: LightSampler, place: Place, pole_at_receiver: bool) -> Sampling {
    let to_receiver = place.away() * DVec3::new(0.36, -0.48, 0.8).normalize();
    let center = DVec3::new(0.7, 1.1, -0.4);
    let given = PROBE_POLE.normalize();
    let pole = if pole_at_receiver {
        to_receiver.normalize()
    } else {
        given
    };
    let inside = matches!(place, Place::Inside);
    let by_cone = sampler == LightSampler::Cone && !inside;
    let density = move |outward: DVec3| match by_cone {
        true => cone_density(outward, to_receiver),
        false => surface_density(sampler, outward, pole),
    };
    let stated = move |outward: DVec3| {
        by_solid_angle(outward, to_receiver).map_or(0.0, |ratio| density(outward) / ratio)
    };
    // The other law of area; for the cone, a receiver that is a tenth of the way further off.
    let mutant = move |outward: DVec3| match sampler {
        LightSampler::UniformAngles => 1.0 / (4.0 * PI),
        LightSampler::Cone if !inside => cone_density(outward, 1.1 * to_receiver),
        _ => surface_density(LightSampler::UniformAngles, outward, pole),
    };
    let limit = if by_cone {
        (1.0 / to_receiver.length()).acos()
    } else {
        PI
    };
    Sampling {
        name: format!("{sampler} {place:?} receiver pole: {pole_at_receiver}"),
        strategy: Strategy {
            light_sampler: sampler,
            pole_at_receiver,
            ..support::strategy()
        },
        job: PointsJob {
            lamp: Lamp {
                center: narrow(center),
                radius: RADIUS as f32,
                emission: [1.0; 3],
                body: 1,
                weight_radius: RADIUS as f32,
                ..Lamp::default()
            },
            pole: packed_basis(given),
            receiver: narrow(center + RADIUS * to_receiver),
            inside: u32::from(inside),
            ..job()
        },
        axis: if by_cone {
            to_receiver.normalize()
        } else {
            pole
        },
        limit,
        midpoints: 12,
        density: Box::new(density),
        stated: Box::new(stated),
        ring: 0.0,
        mutant: Box::new(mutant),
    }
}
