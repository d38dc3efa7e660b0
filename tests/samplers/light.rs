//! The light samplers, from their definitions, by area of the unit sphere.

use super::sampling::*;
use crate::support;
use crate::support::form::form_factor;
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

/// Of a lamp of radius 1 around the origin.
#[derive(Clone, Copy, Debug)]
struct Seen {
    sampler: LightSampler,
    test: LightTest,
    to_receiver: DVec3,
    pole: DVec3,
    /// Of the lit surface.
    normal: DVec3,
}

impl Seen {
    fn inside(&self) -> bool {
        self.to_receiver.length() < 1.0
    }

    /// Whether directions are drawn, or points of the half that is seen.
    fn draws_seen(&self) -> bool {
        use LightSampler::*;
        !matches!(self.sampler, UniformAngles | InverseCosine | Gaussian) && !self.inside()
    }

    /// Density by area of the drawn points.
    fn density(&self, outward: DVec3) -> f64 {
        use LightSampler::*;
        let toward = self.to_receiver.normalize();
        let edge = 1.0 / self.to_receiver.length();
        let seen = by_solid_angle(outward, self.to_receiver);
        let facing = if seen.is_some() { 1.0 } else { 0.0 };
        match self.sampler {
            Cone if !self.inside() => cone_density(outward, self.to_receiver),
            FacingCap if !self.inside() => facing / (TAU * (1.0 - edge)),
            FacingAngles if !self.inside() => {
                facing / (TAU * edge.acos() * outward.cross(toward).length().max(1e-12))
            }
            FacingAngles => even_angles(outward, toward),
            ProjectedCap => {
                let up = (outward - self.to_receiver).normalize().dot(self.normal);
                seen.map_or(0.0, |ratio| ratio * up.max(0.0) / self.projected_area())
            }
            UniformAngles => even_angles(outward, self.pole),
            _ => 1.0 / (4.0 * PI),
        }
    }

    fn projected_area(&self) -> f64 {
        if self.inside() {
            return PI;
        }
        let half = (1.0 / self.to_receiver.length()).asin();
        PI * form_factor(half, (-self.to_receiver).angle_between(self.normal))
    }

    /// Density by solid angle that the renderer states for a draw.
    fn stated(&self, outward: DVec3) -> f64 {
        let one = |v: DVec3| {
            let to = self.to_receiver - v;
            self.density(v) * to.length_squared() / v.dot(to.normalize()).abs()
        };
        if self.test == LightTest::Object && !self.draws_seen() && !self.inside() {
            let along = (outward - self.to_receiver).normalize();
            return one(outward) + one(outward - 2.0 * outward.dot(along) * along);
        }
        let counts = by_solid_angle(outward, self.to_receiver).is_some();
        if counts { one(outward) } else { 0.0 }
    }
}

/// Area density of case 1.
fn even_angles(outward: DVec3, pole: DVec3) -> f64 {
    1.0 / (TAU * PI * outward.cross(pole).length().max(1e-12))
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
    tested(sampler, place, pole_at_receiver, LightTest::Point)
}

/// How far off, in radii. Nearer than this a lamp that the horizon cuts is drawn by what is no more but close to its
/// projected solid angle.
fn away(sampler: LightSampler, place: Place) -> f64 {
    match (sampler, place) {
        (LightSampler::ProjectedCap, Place::Near) => 1.5,
        _ => place.away(),
    }
}

/// The lamp's middle, for the projected sampler: above the horizon that cuts it, or below it.
fn receiver_normal(to_receiver: DVec3, low: bool) -> DVec3 {
    let toward = -to_receiver.normalize();
    let height = if low { -0.3 } else { 0.6 } / to_receiver.length().max(1.0);
    let aside = toward.any_orthonormal_vector();
    height * toward + (1.0 - height * height).sqrt() * aside
}

pub fn tested(
    sampler: LightSampler,
    place: Place,
    pole_at_receiver: bool,
    test: LightTest,
) -> Sampling {
    let to_receiver = away(sampler, place) * DVec3::new(0.36, -0.48, 0.8).normalize();
    let center = DVec3::new(0.7, 1.1, -0.4);
    let given = PROBE_POLE.normalize();
    let pole = if pole_at_receiver {
        to_receiver.normalize()
    } else {
        given
    };
    let seen = Seen {
        sampler,
        test,
        to_receiver,
        pole,
        normal: receiver_normal(to_receiver, pole_at_receiver),
    };
    let inside = seen.inside();
    // The other law of area; a receiver that is a tenth of the way further off; one turned by three degrees.
    let mutant = move |outward: DVec3| match sampler {
        LightSampler::UniformAngles => 1.0 / (4.0 * PI),
        LightSampler::Cone if !inside => cone_density(outward, 1.1 * to_receiver),
        LightSampler::FacingCap | LightSampler::FacingAngles if !inside => {
            let to_receiver = 1.1 * to_receiver;
            Seen {
                to_receiver,
                ..seen
            }
            .density(outward)
        }
        LightSampler::ProjectedCap => {
            let normal = (seen.normal + 0.05 * to_receiver.normalize()).normalize();
            Seen { normal, ..seen }.density(outward)
        }
        LightSampler::FacingAngles => 1.0 / (4.0 * PI),
        _ => even_angles(outward, pole),
    };
    let limit = if seen.draws_seen() {
        (1.0 / to_receiver.length()).acos()
    } else {
        PI
    };
    let turns = matches!(sampler, LightSampler::FacingAngles);
    Sampling {
        name: format!("{sampler} {place:?} receiver pole: {pole_at_receiver}, by {test}"),
        strategy: Strategy {
            light_sampler: sampler,
            light_test: test,
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
            normal: narrow(seen.normal),
            ..job()
        },
        axis: if seen.draws_seen() || turns {
            to_receiver.normalize()
        } else {
            pole
        },
        limit,
        midpoints: 12,
        density: Box::new(move |v| seen.density(v)),
        stated: Box::new(move |v| seen.stated(v)),
        ring: 0.0,
        mutant: Box::new(mutant),
    }
}
