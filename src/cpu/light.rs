//! Twin of `shaders/light.wgsl`: points on spherical lamps, sample and density.

use super::cap::{projected_cap, projected_cap_inverse_density, sample_projected_cap};
use super::maths::*;
use crate::knobs::{LightSampler, LightTest, LightWeight};
use crate::pack::{Lamp, Strategy};
use glam::{Vec2, Vec3, Vec4};
use std::f32::consts::PI;

/// Inverse density of directions that are hit and never drawn.
const NEVER_DRAWN: f32 = 1e30;

#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    pub direction: Vec3,
    /// How far the shadow ray must be free.
    pub distance: f32,
    /// What the lamp's radiance is weighted by, in steradians.
    pub weight: f32,
    /// Inverse density of this direction; 0 where the point cannot be seen.
    pub inverse_density: f32,
}

/// The cone under which a lamp is seen.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    pub axis: Vec3,
    pub distance: f32,
    /// sin^2 and 1 - cos of the cone's half angle, without cancellation.
    pub sine_squared: f32,
    pub height: f32,
    /// False on, in or all but on the lamp, where there is no cone.
    pub open: bool,
}

#[inline(always)]
pub fn lamp_cone(lamp: &Lamp, origin: Vec3) -> Cone {
    let to_center = Vec3::from(lamp.center) - origin;
    let distance = to_center.length();
    let inverse = 1.0 / greater(distance, 1e-30);
    let ratio = lamp.radius * inverse;
    let sine_squared = lesser(ratio * ratio, 1.0);
    Cone {
        axis: to_center * inverse,
        distance,
        sine_squared,
        height: sine_squared / (1.0 + root(1.0 - sine_squared)),
        open: distance > lamp.radius * 1.0001,
    }
}

pub fn cone_solid_angle(cone: Cone) -> f32 {
    2.0 * PI * cone.height
}

/// The base code's weight: 2 pi (1 - sqrt(1 - s^2 / d^2)), the root's argument kept at 0 or above.
pub fn solid_angle_weight(radius: f32, distance: f32) -> f32 {
    let ratio = radius / greater(distance, 1e-30);
    let sine_squared = lesser(ratio * ratio, 1.0);
    2.0 * PI * sine_squared / (1.0 + root(1.0 - sine_squared))
}

/// Whether only the half that faces the receiver is drawn from.
fn draws_facing(strategy: &Strategy) -> bool {
    use LightSampler::{FacingAngles, FacingCap};
    matches!(strategy.light_sampler, FacingCap | FacingAngles)
}

/// The cap around the pole that points are drawn from, as its height in lamp radii: 2 is the whole lamp.
pub fn drawn_height(strategy: &Strategy, lamp: &Lamp, cone: Cone, inside: bool) -> f32 {
    if draws_facing(strategy) && cone.open && !inside {
        (cone.distance - lamp.radius) / greater(cone.distance, 1e-30)
    } else {
        2.0
    }
}

/// The polar angle, in turns, of the edge of a cap of that height.
fn cap_angle(height: f32) -> f32 {
    if height > 1.0 {
        0.5
    } else {
        angle_of_chord(root(2.0 * height)) / (2.0 * PI)
    }
}

pub fn light_pole(strategy: &Strategy, pole: Basis, cone: Cone) -> Basis {
    if strategy.pole_at_receiver || draws_facing(strategy) {
        basis_around(-cone.axis)
    } else {
        pole
    }
}

/// Case 1: both angles even.
fn sample_uniform_angles(pole: Basis, u: Vec2) -> Vec3 {
    let polar = sincos_turn(0.5 * u.y);
    from_basis(pole, (polar.x * unit_circle(u.x)).extend(polar.y))
}

/// Case 2: phi = acos(1 - 2 u).
fn sample_inverse_cosine(pole: Basis, u: Vec2) -> Vec3 {
    from_basis(pole, unit_sphere(Vec2::new(u.y, u.x)))
}

/// Case 3: three normal numbers made a unit vector.
fn sample_gaussian(u: Vec4) -> Vec3 {
    let radius = Vec2::new(root(-2.0 * (1.0 - u.x).ln()), root(-2.0 * (1.0 - u.y).ln()));
    let v = (radius.x * unit_circle(u.z)).extend(radius.y * unit_circle(u.w).x);
    let size = v.dot(v);
    if size > 1e-30 {
        v * (1.0 / size.sqrt())
    } else {
        Vec3::Z
    }
}

/// Case 2 on a cap of the given height around the pole.
fn sample_facing_cap(pole: Basis, height: f32, u: Vec2) -> Vec3 {
    let fallen = u.y * height;
    let around = root(fallen * (2.0 - fallen)) * unit_circle(u.x);
    from_basis(pole, around.extend(1.0 - fallen))
}

/// Case 1 on such a cap.
fn sample_facing_angles(pole: Basis, height: f32, u: Vec2) -> Vec3 {
    let polar = sincos_turn(u.y * cap_angle(height));
    from_basis(pole, (polar.x * unit_circle(u.x)).extend(polar.y))
}

/// Unit vector from the lamp's centre to a point of its surface.
pub fn sample_surface(strategy: &Strategy, pole: Basis, height: f32, u: Vec4) -> Vec3 {
    match strategy.light_sampler {
        LightSampler::FacingCap => sample_facing_cap(pole, height, Vec2::new(u.x, u.y)),
        LightSampler::FacingAngles => sample_facing_angles(pole, height, Vec2::new(u.x, u.y)),
        LightSampler::UniformAngles => sample_uniform_angles(pole, Vec2::new(u.x, u.y)),
        LightSampler::Gaussian => sample_gaussian(u),
        LightSampler::InverseCosine | LightSampler::Cone | LightSampler::ProjectedCap => {
            sample_inverse_cosine(pole, Vec2::new(u.x, u.y))
        }
    }
}

/// Inverse area density of [`sample_surface`] at a unit vector.
pub fn surface_inverse_density(
    strategy: &Strategy,
    lamp: &Lamp,
    pole: Basis,
    height: f32,
    outward: Vec3,
) -> f32 {
    let area = lamp.radius * lamp.radius * PI;
    match strategy.light_sampler {
        LightSampler::FacingAngles => {
            4.0 * PI * cap_angle(height) * area * outward.cross(pole.z).length()
        }
        LightSampler::FacingCap => 2.0 * area * height,
        LightSampler::UniformAngles => 2.0 * PI * area * outward.cross(pole.z).length(),
        _ => 4.0 * area,
    }
}

/// From area to solid angle: |cos| / distance^2.
fn area_to_solid_angle(outward: Vec3, direction: Vec3, distance: f32, inside: bool) -> f32 {
    let toward = -outward.dot(direction);
    let seen = if inside {
        toward.abs()
    } else {
        greater(toward, 0.0)
    };
    seen / greater(distance * distance, 1e-30)
}

/// Where a direction meets a lamp.
#[derive(Clone, Copy, Debug)]
pub struct LampHit {
    /// Whether the ray comes from inside the lamp.
    pub inside: bool,
    pub direction: Vec3,
    pub distance: f32,
    /// Outward unit normal.
    pub outward: Vec3,
}

/// Inverse density of a direction that counts wherever its line meets the lamp: c / (p d^2 + p' d'^2).
fn chord_inverse_density(
    strategy: &Strategy,
    lamp: &Lamp,
    axes: Basis,
    height: f32,
    hit: LampHit,
) -> f32 {
    let along = hit.outward.dot(hit.direction);
    let other = hit.outward - 2.0 * along * hit.direction;
    let other_distance = hit.distance - 2.0 * lamp.radius * along;
    let unit = Lamp {
        radius: 1.0,
        ..*lamp
    };
    let here = surface_inverse_density(strategy, &unit, axes, height, hit.outward);
    let there = surface_inverse_density(strategy, &unit, axes, height, other);
    let near = hit.distance / lamp.radius;
    let far = other_distance / lamp.radius;
    along.abs() * here * there / greater(near * near * there + far * far * here, 1e-30)
}

/// Inverse density of a direction to a point of the surface.
fn point_inverse_density(
    strategy: &Strategy,
    lamp: &Lamp,
    axes: Basis,
    height: f32,
    hit: LampHit,
) -> f32 {
    // From inside a direction has one point, and of the facing part no two are on one line.
    if strategy.light_test == LightTest::Object && !hit.inside && height > 1.0 {
        return chord_inverse_density(strategy, lamp, axes, height, hit);
    }
    let geometry = area_to_solid_angle(hit.outward, hit.direction, hit.distance, hit.inside);
    surface_inverse_density(strategy, lamp, axes, height, hit.outward) * geometry
}

/// Shirley, Wang and Zimmerman 1996.
#[inline(always)]
fn sample_cone(strategy: &Strategy, lamp: &Lamp, cone: Cone, u: Vec2) -> LightSample {
    let fallen = u.x * cone.height;
    let sine_squared = fallen * (2.0 - fallen);
    let sine = root(sine_squared);
    let cosine = 1.0 - fallen;
    let basis = basis_around(cone.axis);
    let direction = unit_vector_again(from_basis(basis, (sine * unit_circle(u.y)).extend(cosine)));
    let half_chord = root(lamp.radius * lamp.radius - cone.distance * cone.distance * sine_squared);
    let distance = cone.distance * cosine - half_chord;
    let inverse_density = cone_solid_angle(cone);
    let weight = match strategy.light_weight {
        LightWeight::Pdf => inverse_density,
        LightWeight::SolidAngle => solid_angle_weight(lamp.weight_radius, distance),
    };
    LightSample {
        direction,
        distance,
        weight,
        inverse_density,
    }
}

/// A direction to a point of the lamp's surface. With `solid-angle` or the test `object` points of the far side
/// count too, and the shadow ray need only reach the near side, one chord before them.
#[inline(always)]
fn sample_area(
    strategy: &Strategy,
    lamp: &Lamp,
    axes: Basis,
    origin: Vec3,
    inside: bool,
    u: Vec4,
) -> LightSample {
    let height = drawn_height(strategy, lamp, lamp_cone(lamp, origin), inside);
    let outward = sample_surface(strategy, axes, height, u);
    let to_point = Vec3::from(lamp.center) + lamp.radius * outward - origin;
    let distance = to_point.length();
    let direction = to_point / greater(distance, 1e-30);
    let hit = LampHit {
        inside,
        direction,
        distance,
        outward,
    };
    let inverse_density = point_inverse_density(strategy, lamp, axes, height, hit);
    let literal = strategy.light_weight == LightWeight::SolidAngle;
    if literal || strategy.light_test == LightTest::Object {
        let chord = if inside {
            0.0
        } else {
            -2.0 * lamp.radius * outward.dot(direction)
        };
        let near = if chord < 0.0 {
            distance + chord
        } else {
            distance
        };
        let weight = if literal {
            solid_angle_weight(lamp.weight_radius, distance)
        } else {
            inverse_density
        };
        return LightSample {
            direction,
            distance: near,
            weight,
            inverse_density,
        };
    }
    LightSample {
        direction,
        distance,
        weight: inverse_density,
        inverse_density,
    }
}

/// Where a direction from `origin` meets the lamp: from inside its far side, from outside its near one.
fn lamp_distance(lamp: &Lamp, origin: Vec3, direction: Vec3, inside: bool) -> f32 {
    let to_center = Vec3::from(lamp.center) - origin;
    let middle = to_center.dot(direction);
    let off = to_center - middle * direction;
    let half_chord = root(lamp.radius * lamp.radius - off.dot(off));
    if inside {
        middle + half_chord
    } else {
        middle - half_chord
    }
}

/// Inverse density of a direction by its cosine; 0 below the surface.
fn cosine_inverse_density(normal: Vec3, direction: Vec3) -> f32 {
    let up = normal.dot(direction);
    if up > 0.0 {
        PI / greater(up, 1e-30)
    } else {
        0.0
    }
}

fn sample_projected(
    strategy: &Strategy,
    lamp: &Lamp,
    origin: Vec3,
    normal: Vec3,
    inside: bool,
    u: Vec4,
) -> LightSample {
    let cone = lamp_cone(lamp, origin);
    let (direction, inverse_density) = if inside {
        let direction = sample_cosine(normal, Vec2::new(u.x, u.y));
        (direction, cosine_inverse_density(normal, direction))
    } else {
        let cap = projected_cap(cone.axis, cone.sine_squared, normal);
        let direction = sample_projected_cap(&cap, u.truncate());
        (direction, projected_cap_inverse_density(&cap, direction))
    };
    let distance = lamp_distance(lamp, origin, direction, inside);
    let weight = match strategy.light_weight {
        LightWeight::Pdf => inverse_density,
        LightWeight::SolidAngle => solid_angle_weight(lamp.weight_radius, distance),
    };
    LightSample {
        direction,
        distance,
        weight,
        inverse_density,
    }
}

/// `inside`: whether `origin` is inside the lamp. `normal`: the lit surface's, towards the side that light
/// comes from; the projected sampler alone asks for it.
#[inline(always)]
pub fn sample_light(
    strategy: &Strategy,
    lamp: &Lamp,
    pole: Basis,
    origin: Vec3,
    normal: Vec3,
    inside: bool,
    u: Vec4,
) -> LightSample {
    if strategy.light_sampler == LightSampler::ProjectedCap {
        return sample_projected(strategy, lamp, origin, normal, inside, u);
    }
    let cone = lamp_cone(lamp, origin);
    if strategy.light_sampler == LightSampler::Cone && cone.open && !inside {
        return sample_cone(strategy, lamp, cone, Vec2::new(u.x, u.y));
    }
    let axes = light_pole(strategy, pole, cone);
    sample_area(strategy, lamp, axes, origin, inside, u)
}

/// Inverse density with which [`sample_light`] draws the direction that meets the lamp at `hit`.
pub fn light_inverse_density(
    strategy: &Strategy,
    lamp: &Lamp,
    pole: Basis,
    origin: Vec3,
    normal: Vec3,
    hit: LampHit,
) -> f32 {
    let cone = lamp_cone(lamp, origin);
    if strategy.light_sampler == LightSampler::ProjectedCap {
        let drawn = if hit.inside {
            cosine_inverse_density(normal, hit.direction)
        } else {
            let cap = projected_cap(cone.axis, cone.sine_squared, normal);
            projected_cap_inverse_density(&cap, hit.direction)
        };
        return if drawn > 0.0 { drawn } else { NEVER_DRAWN };
    }
    if strategy.light_sampler == LightSampler::Cone && cone.open && !hit.inside {
        return cone_solid_angle(cone);
    }
    let (axes, height) = (
        light_pole(strategy, pole, cone),
        drawn_height(strategy, lamp, cone, hit.inside),
    );
    point_inverse_density(strategy, lamp, axes, height, hit)
}

/// Power heuristic with exponent 2 (Veach 1997): `ratio` is the other strategy's density over its own.
pub fn power_heuristic(ratio: f32) -> f32 {
    let bounded = lesser(ratio, 1e15);
    1.0 / (1.0 + bounded * bounded)
}
