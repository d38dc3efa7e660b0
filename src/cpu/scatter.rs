//! Twin of `shaders/scatter.wgsl`: how surfaces send light on.

use super::glass::sample_glass;
use super::maths::*;
use super::rough::{rough_arrival_of, rough_density, rough_share, sample_rough};
use crate::knobs::{Scatter, ScatterBound, ScatterDiffuse};
use crate::pack::{Material, Strategy};
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI, SQRT_2, TAU};

const DIFFUSE: u32 = Scatter::Diffuse as u32;
const DIRECTIONAL: u32 = Scatter::Directional as u32;
const ROUGH: u32 = Scatter::Rough as u32;
const GLASS: u32 = Scatter::Glass as u32;

/// A drawn direction.
#[derive(Clone, Copy, Debug)]
pub struct Scattered {
    pub direction: Vec3,
    /// Of drawing this direction, by solid angle; 0 where it has none.
    pub density: f32,
    /// Scattering function times cosine over density; zero where the light is absorbed.
    pub weight: Vec3,
}

pub fn mirror_direction(normal: Vec3, incoming: Vec3) -> Vec3 {
    unit_vector_again(incoming - 2.0 * normal.dot(incoming) * normal)
}

#[inline(always)]
fn sample_diffuse(strategy: &Strategy, material: &Material, normal: Vec3, u: Vec2) -> Scattered {
    let albedo = Vec3::from(material.albedo);
    let ball = unit_sphere(u);
    if strategy.scatter_diffuse == ScatterDiffuse::Uniform {
        let up = ball.dot(normal);
        let direction = if up >= 0.0 { ball } else { -ball };
        return Scattered {
            direction,
            density: 0.5 / PI,
            weight: albedo * (2.0 * up.abs()),
        };
    }
    let sum = normal + ball;
    let size = sum.dot(sum);
    let direction = if size > 1e-12 {
        sum * (1.0 / size.sqrt())
    } else {
        normal
    };
    let up = direction.dot(normal);
    Scattered {
        direction,
        density: greater(up, 0.0) / PI,
        weight: albedo,
    }
}

fn lobe_density(material: &Material, chord: f32) -> f32 {
    if chord * chord >= 2.0 {
        return 0.0;
    }
    let theta = angle_of_chord(chord);
    let ratio = theta / material.spread;
    let sine = chord * root(1.0 - 0.25 * chord * chord);
    material.lobe_scale * (-0.5 * ratio * ratio).exp() / greater(sine, 1e-6)
}

fn sample_directional(
    strategy: &Strategy,
    material: &Material,
    normal: Vec3,
    incoming: Vec3,
    u: Vec2,
) -> Scattered {
    let drawn = SQRT_2 * material.spread * inverse_erf(u.x * material.lobe_mass);
    let theta = lesser(drawn, FRAC_PI_2);
    let polar = sincos_turn(theta / TAU);
    let basis = basis_around(mirror_direction(normal, incoming));
    let direction = unit_vector_again(from_basis(
        basis,
        (polar.x * unit_circle(u.y)).extend(polar.y),
    ));
    let chord = 2.0 * sincos_turn(theta / (2.0 * TAU)).x;
    let on_ring = strategy.scatter_bound == ScatterBound::Clamp && drawn >= FRAC_PI_2;
    let above = direction.dot(normal) > 0.0;
    Scattered {
        direction,
        density: if on_ring {
            0.0
        } else {
            lobe_density(material, chord)
        },
        weight: if above {
            Vec3::from(material.albedo)
        } else {
            Vec3::ZERO
        },
    }
}

/// `inside`: whether the arriving ray is inside the body.
#[inline(always)]
pub fn sample_scatter(
    strategy: &Strategy,
    material: &Material,
    normal: Vec3,
    incoming: Vec3,
    inside: bool,
    u: Vec2,
) -> Scattered {
    let albedo = Vec3::from(material.albedo);
    match material.scatter {
        DIFFUSE => sample_diffuse(strategy, material, normal, u),
        DIRECTIONAL => sample_directional(strategy, material, normal, incoming, u),
        ROUGH if strategy.rough_surfaces => {
            let rough = sample_rough(material.shape, normal, incoming, u);
            Scattered {
                direction: rough.direction,
                density: rough.density,
                weight: albedo * rough.share,
            }
        }
        GLASS if strategy.glass_surfaces => Scattered {
            direction: sample_glass(material.shape, inside, normal, incoming, u.x),
            density: 0.0,
            weight: albedo,
        },
        _ => Scattered {
            direction: mirror_direction(normal, incoming),
            density: 0.0,
            weight: albedo,
        },
    }
}

/// Density with which [`sample_scatter`] draws `outgoing`.
#[inline(always)]
pub fn scatter_density(
    strategy: &Strategy,
    material: &Material,
    normal: Vec3,
    incoming: Vec3,
    outgoing: Vec3,
) -> f32 {
    let up = normal.dot(outgoing);
    match (material.scatter, strategy.scatter_diffuse) {
        (DIFFUSE, ScatterDiffuse::Uniform) if up >= 0.0 => 0.5 / PI,
        (DIFFUSE, ScatterDiffuse::Cosine) => greater(up, 0.0) / PI,
        (DIRECTIONAL, _) => lobe_density(
            material,
            outgoing.distance(mirror_direction(normal, incoming)),
        ),
        (ROUGH, _) if strategy.rough_surfaces => {
            rough_density(material.shape, normal, incoming, outgoing)
        }
        _ => 0.0,
    }
}

/// Lambert's scattering function times cosine.
pub fn evaluate_lambert(material: &Material, normal: Vec3, outgoing: Vec3) -> Vec3 {
    Vec3::from(material.albedo) * (greater(normal.dot(outgoing), 0.0) / PI)
}

/// [`evaluate_scatter`] where [`scatter_density`] of the two directions is known.
#[inline(always)]
pub fn evaluate_by_density(
    strategy: &Strategy,
    material: &Material,
    normal: Vec3,
    incoming: Vec3,
    outgoing: Vec3,
    density: f32,
) -> Vec3 {
    if material.scatter == DIFFUSE {
        return evaluate_lambert(material, normal, outgoing);
    }
    if normal.dot(outgoing) <= 0.0 {
        return Vec3::ZERO;
    }
    let lobe = Vec3::from(material.albedo) * density;
    if strategy.rough_surfaces && material.scatter == ROUGH {
        let arrival = rough_arrival_of(material.shape, normal, incoming);
        return lobe * rough_share(material.shape, arrival, normal.dot(outgoing));
    }
    lobe
}

/// Scattering function times cosine; the part with a density only.
#[inline(always)]
pub fn evaluate_scatter(
    strategy: &Strategy,
    material: &Material,
    normal: Vec3,
    incoming: Vec3,
    outgoing: Vec3,
) -> Vec3 {
    let density = scatter_density(strategy, material, normal, incoming, outgoing);
    evaluate_by_density(strategy, material, normal, incoming, outgoing, density)
}
