//! Twin of `shaders/rough.wgsl`: rough mirrors by microfacets.

use super::maths::*;
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// What the surface makes of an arriving direction.
#[derive(Clone, Copy, Debug)]
pub struct RoughArrival {
    /// i.z
    pub cosine: f32,
    /// Length of i with x and y shortened to alpha of theirs.
    pub stretched: f32,
    /// k: of the shortened and then unit i.z, how far below the plane the cap reaches.
    pub bound: f32,
    /// (1 - k) / alpha^2, which has its digits where k is all but 1.
    pub rim: f32,
}

#[derive(Clone, Copy, Debug)]
pub struct RoughSample {
    pub direction: Vec3,
    /// By solid angle, below the surface too.
    pub density: f32,
    /// Reflected over drawn; zero below the surface.
    pub share: f32,
}

pub fn rough_arrival(alpha: f32, cosine: f32, sine: f32) -> RoughArrival {
    let squared = alpha * alpha;
    let reach = (1.0 + sine) * (1.0 + sine);
    let stretched = (squared * sine * sine + cosine * cosine).sqrt();
    let whole = reach + squared * cosine * cosine;
    RoughArrival {
        cosine,
        stretched,
        bound: (1.0 - squared) * reach / whole,
        rim: (reach + cosine * cosine) / whole,
    }
}

/// Density of the reflection by a facet of which `flatness` is alpha^2 m.z^2 + m.x^2 + m.y^2.
pub fn rough_law(alpha: f32, arrival: RoughArrival, flatness: f32) -> f32 {
    let normals = alpha * alpha / (PI * flatness * flatness);
    normals / (2.0 * (arrival.bound * arrival.cosine + arrival.stretched))
}

/// Scattering function times cosine over the density.
pub fn rough_share(alpha: f32, arrival: RoughArrival, up: f32) -> f32 {
    if up <= 0.0 {
        return 0.0;
    }
    let leaving = (alpha * alpha * greater(1.0 - up * up, 0.0) + up * up).sqrt();
    let masked = up * arrival.stretched + arrival.cosine * leaving;
    up * (arrival.bound * arrival.cosine + arrival.stretched) / greater(masked, 1e-30)
}

pub fn rough_arrival_of(alpha: f32, normal: Vec3, incoming: Vec3) -> RoughArrival {
    let cosine = greater(-normal.dot(incoming), 0.0);
    rough_arrival(alpha, cosine, (incoming + cosine * normal).length())
}

/// Density with which [`sample_rough`] draws `outgoing`.
pub fn rough_density(alpha: f32, normal: Vec3, incoming: Vec3, outgoing: Vec3) -> f32 {
    let arrival = rough_arrival_of(alpha, normal, incoming);
    let sum = outgoing - incoming;
    let up = normal.dot(sum);
    let across = sum - up * normal;
    let flatness = (alpha * alpha * up * up + across.dot(across)) / greater(sum.dot(sum), 1e-30);
    let drawn = normal.dot(outgoing) > 0.0 || up >= arrival.rim * arrival.cosine * flatness;
    if !drawn {
        return 0.0;
    }
    rough_law(alpha, arrival, greater(flatness, 1e-15))
}

pub fn sample_rough(alpha: f32, normal: Vec3, incoming: Vec3, u: Vec2) -> RoughSample {
    let basis = basis_around(normal);
    let up = greater(-normal.dot(incoming), 0.0);
    let toward = Vec3::new(-basis.x.dot(incoming), -basis.y.dot(incoming), up);
    let arrival = rough_arrival(alpha, toward.z, toward.truncate().length());
    let shortened = unit_vector((alpha * toward.truncate()).extend(toward.z));
    // From the cap's top down.
    let fallen = u.x * (1.0 + arrival.bound * shortened.z);
    let cap = (root(fallen * (2.0 - fallen)) * unit_circle(u.y)).extend(1.0 - fallen);
    let sum = cap + shortened;
    let facet = unit_vector((alpha * sum.truncate()).extend(greater(sum.z, 1e-12)));
    let local = 2.0 * toward.dot(facet) * facet - toward;
    let across = facet.truncate();
    let flatness = alpha * alpha * facet.z * facet.z + across.dot(across);
    RoughSample {
        direction: unit_vector_again(from_basis(basis, local)),
        density: rough_law(alpha, arrival, flatness),
        share: rough_share(alpha, arrival, local.z),
    }
}
