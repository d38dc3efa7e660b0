//! Spheres and boxes as solids: where a point is, and whether a ray meets one. For the checks alone;
//! pictures are traced elsewhere.

use super::{Cuboid, Sphere};
use glam::{DMat3, DVec3, EulerRot};

/// A shape.
#[derive(Clone, Copy)]
pub(crate) enum Solid<'a> {
    Sphere(&'a Sphere),
    Box(&'a Cuboid),
}

impl Solid<'_> {
    pub(crate) fn material(&self) -> usize {
        match self {
            Self::Sphere(sphere) => sphere.material,
            Self::Box(cuboid) => cuboid.material,
        }
    }

    /// Distance from a point to the surface, negative inside.
    pub(crate) fn distance(&self, point: DVec3) -> f64 {
        match self {
            Self::Sphere(sphere) => point.distance(sphere.center) - sphere.radius,
            Self::Box(cuboid) => {
                let half = (cuboid.max - cuboid.min) / 2.0;
                let beyond = turn_back(cuboid, point - center(cuboid)).abs() - half;
                beyond.max(DVec3::ZERO).length() + beyond.max_element().min(0.0)
            }
        }
    }

    /// Whether a ray that starts anywhere meets the surface.
    pub(crate) fn meets(&self, from: DVec3, direction: DVec3) -> bool {
        match self {
            Self::Sphere(sphere) => {
                let to = sphere.center - from;
                let along = to.dot(direction);
                let across = (to - along * direction).length();
                across < sphere.radius && (along > 0.0 || to.length() < sphere.radius)
            }
            Self::Box(cuboid) => {
                let half = (cuboid.max - cuboid.min) / 2.0;
                let from = turn_back(cuboid, from - center(cuboid));
                let rate = turn_back(cuboid, direction).recip();
                let (one, two) = ((-half - from) * rate, (half - from) * rate);
                let (near, far) = (one.min(two).max_element(), one.max(two).min_element());
                near <= far && far > 0.0
            }
        }
    }
}

fn center(cuboid: &Cuboid) -> DVec3 {
    (cuboid.min + cuboid.max) / 2.0
}

/// From the scene's axes to the box's own.
fn turn_back(cuboid: &Cuboid, vector: DVec3) -> DVec3 {
    if cuboid.rotation == DVec3::ZERO {
        return vector;
    }
    let [x, y, z] = cuboid.rotation.to_array().map(f64::to_radians);
    // About x first, so that x stands next to the vector: Z Y X v.
    DMat3::from_euler(EulerRot::ZYX, z, y, x).transpose() * vector
}
