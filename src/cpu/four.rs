//! Rays against bodies, four at a time: the arithmetic of `sphere`, `box` and `ray`, bit for bit, in
//! lanes. Half of the twin's time goes into this; the tests hold it against the functions that it repeats.

use super::r#box::safe_inverse;
use super::ray::Ray;
use crate::pack::{Cuboid, Packed, Sphere};
use glam::{BVec4A, Vec3, Vec4};

/// Three coordinates of four things.
type Three = [Vec4; 3];

/// Stands where no body does: far away, and of a size that nothing meets.
const NOWHERE: f32 = 1e15;

fn three(v: Vec3) -> Three {
    v.to_array().map(Vec4::splat)
}

/// `v(i)` of four things, lane by lane.
fn gather(v: impl Fn(usize) -> [f32; 3]) -> Three {
    let lanes: [[f32; 3]; 4] = std::array::from_fn(v);
    std::array::from_fn(|axis| Vec4::from_array(lanes.map(|lane| lane[axis])))
}

fn dot(a: Three, b: Three) -> Vec4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: Three, b: Three) -> Three {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

/// One ray, as four see it.
#[derive(Clone, Copy, Debug)]
pub struct FourRay {
    origin: Three,
    direction: Three,
    inverse: Three,
    source: Vec4,
    inside: BVec4A,
}

impl FourRay {
    pub fn new(ray: &Ray) -> Self {
        Self {
            origin: three(ray.origin),
            direction: three(ray.direction),
            inverse: three(safe_inverse(ray.direction)),
            source: Vec4::splat(ray.source as f32),
            inside: BVec4A::splat(ray.inside),
        }
    }

    /// `ray::first_distance`.
    fn first_distance(&self, near: Vec4, far: Vec4, met: BVec4A, body: Vec4) -> Vec4 {
        let own = self.source.cmpeq(body);
        let outside = near.cmpgt(Vec4::ZERO) & !own;
        let distance = Vec4::select(outside, near, far);
        let kept = Vec4::select(own, distance.max(Vec4::splat(1e-30)), distance);
        let found = (own & self.inside) | (!own & met);
        Vec4::select(found, kept, Vec4::NEG_ONE)
    }
}

/// Four spheres.
#[derive(Clone, Debug)]
struct Spheres {
    center: Three,
    radius: Vec4,
    body: Vec4,
}

impl Spheres {
    fn new(spheres: &[Sphere], first_body: usize) -> Self {
        let center = |lane: usize| {
            spheres
                .get(lane)
                .map_or([NOWHERE; 3], |sphere| sphere.center)
        };
        let radius = |lane: usize| spheres.get(lane).map_or(0.0, |sphere| sphere.radius);
        Self {
            center: gather(center),
            radius: lanes(radius),
            body: numbers(first_body, spheres.len()),
        }
    }

    /// `sphere::intersect_sphere`, then `ray::first_distance`.
    #[inline(always)]
    fn distances(&self, ray: &FourRay) -> Vec4 {
        let from_center = minus(ray.origin, self.center);
        let b = -dot(from_center, ray.direction);
        let nearest: Three =
            std::array::from_fn(|axis| from_center[axis] + b * ray.direction[axis]);
        let discriminant = self.radius * self.radius - dot(nearest, nearest);
        let met = discriminant.cmpge(Vec4::ZERO);
        if !(met | ray.inside).any() {
            return Vec4::NEG_ONE;
        }
        let c = dot(from_center, from_center) - self.radius * self.radius;
        let half_chord = discriminant.max(Vec4::ZERO).sqrt();
        let ahead = b.cmpge(Vec4::ZERO);
        let q = b + Vec4::select(ahead, half_chord, -half_chord);
        let other = c / Vec4::select(q.cmpeq(Vec4::ZERO), Vec4::splat(1e-30), q);
        let near = Vec4::select(ahead, other, q);
        let far = Vec4::select(ahead, q, other);
        ray.first_distance(near, far, met, self.body)
    }
}

/// Four boxes.
#[derive(Clone, Debug)]
struct Boxes {
    center: Three,
    half_size: Three,
    axes: [Three; 3],
    body: Vec4,
}

impl Boxes {
    fn new(boxes: &[Cuboid], first_body: usize) -> Self {
        let of = |read: fn(&Cuboid) -> [f32; 3], absent: f32| {
            gather(|lane| boxes.get(lane).map_or([absent; 3], read))
        };
        Self {
            center: of(|shape| shape.center, NOWHERE),
            half_size: of(|shape| shape.half_size, -NOWHERE),
            axes: [
                of(|shape| shape.axis_x, 1.0),
                of(|shape| shape.axis_y, 1.0),
                of(|shape| shape.axis_z, 1.0),
            ],
            body: numbers(first_body, boxes.len()),
        }
    }

    #[inline(always)]
    fn distances(&self, ray: &FourRay) -> Vec4 {
        self.slabs(ray, minus(ray.origin, self.center), ray.inverse)
    }

    #[inline(always)]
    fn rotated_distances(&self, ray: &FourRay) -> Vec4 {
        let local = |v: Three| self.axes.map(|axis| dot(axis, v));
        let inverse = local(ray.direction).map(safe_inverse_lanes);
        self.slabs(ray, local(minus(ray.origin, self.center)), inverse)
    }

    /// `box::intersect_box`, then `ray::first_distance`.
    #[inline(always)]
    fn slabs(&self, ray: &FourRay, from_center: Three, inverse: Three) -> Vec4 {
        let middle: Three = std::array::from_fn(|axis| -from_center[axis] * inverse[axis]);
        let reach: Three = std::array::from_fn(|axis| self.half_size[axis] * inverse[axis].abs());
        let enter = minus(middle, reach);
        let leave: Three = std::array::from_fn(|axis| middle[axis] + reach[axis]);
        let near = enter[0].max(enter[1].max(enter[2]));
        let far = leave[0].min(leave[1].min(leave[2])) * 1.000_000_2;
        let met = near.cmple(far) & far.cmpgt(Vec4::ZERO);
        ray.first_distance(near, far, met, self.body)
    }
}

/// `box::safe_inverse`.
fn safe_inverse_lanes(v: Vec4) -> Vec4 {
    let tiny = Vec4::splat(1e-12);
    let signed = Vec4::select(v.cmpge(Vec4::ZERO), tiny, -tiny);
    Vec4::ONE / Vec4::select(v.abs().cmplt(tiny), signed, v)
}

fn lanes(v: impl Fn(usize) -> f32) -> Vec4 {
    Vec4::from_array(std::array::from_fn(v))
}

/// Numbers of up to four bodies; f32 holds them exactly up to 2^24. Where no body stands it is one that no
/// ray starts on: the next number is that of a body among the next four.
fn numbers(first: usize, count: usize) -> Vec4 {
    lanes(|lane| {
        if lane < count {
            (first + lane) as f32
        } else {
            -1.0
        }
    })
}

/// All bodies of a scene in fours.
#[derive(Clone, Debug)]
pub struct Bodies {
    spheres: Vec<Spheres>,
    straight: Vec<Boxes>,
    rotated: Vec<Boxes>,
}

impl Bodies {
    pub fn new(scene: &Packed) -> Self {
        let (straight, rotated) = scene.boxes.split_at(scene.strategy.box_count as usize);
        let sphere_count = scene.spheres.len();
        let fours = |boxes: &[Cuboid], first: usize| {
            let chunks = boxes.chunks(4).enumerate();
            chunks
                .map(|(chunk, four)| Boxes::new(four, first + 4 * chunk))
                .collect()
        };
        let spheres = scene.spheres.chunks(4).enumerate();
        Self {
            spheres: spheres
                .map(|(chunk, four)| Spheres::new(four, 1 + 4 * chunk))
                .collect(),
            straight: fours(straight, 1 + sphere_count),
            rotated: fours(rotated, 1 + sphere_count + straight.len()),
        }
    }

    /// Calls `visit` with the first distances to four bodies at a time, and the bodies, until it
    /// says that it has seen enough.
    #[inline(always)]
    pub fn visit(&self, ray: &FourRay, mut visit: impl FnMut(Vec4, Vec4) -> bool) {
        let _ = self
            .spheres
            .iter()
            .any(|four| visit(four.distances(ray), four.body))
            || self
                .straight
                .iter()
                .any(|four| visit(four.distances(ray), four.body))
            || self
                .rotated
                .iter()
                .any(|four| visit(four.rotated_distances(ray), four.body));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::r#box::{box_local, intersect_box};
    use crate::cpu::random::{random_key, random_unit};
    use crate::cpu::ray::first_distance;
    use crate::cpu::sphere::intersect_sphere;

    fn vector(u: [f32; 4], scale: f32) -> Vec3 {
        (Vec3::new(u[0], u[1], u[2]) - 0.5) * scale
    }

    /// A ray from `origin` with every kind of source: none, the body's own sides, another body, and the
    /// inner side of the one that comes after these.
    fn rays(number: u32) -> [Ray; 5] {
        let key = random_key([7, 0], [1, 2], [number, 0]);
        let origin = vector(random_unit(key, 0, 0), 6.0);
        let direction = vector(random_unit(key, 1, 0), 2.0).normalize_or(Vec3::X);
        [(0, false), (2, false), (2, true), (6, true), (4, true)].map(|(source, inside)| Ray {
            origin,
            direction,
            source,
            inside,
        })
    }

    fn shape(number: u32, turned: bool) -> Cuboid {
        let key = random_key([9, 0], [1, 2], [number, 0]);
        let turn = if turned {
            glam::Quat::from_rotation_y(0.7) * glam::Quat::from_rotation_x(0.3)
        } else {
            glam::Quat::IDENTITY
        };
        Cuboid {
            center: vector(random_unit(key, 0, 0), 4.0).to_array(),
            half_size: (vector(random_unit(key, 1, 0), 2.0).abs() + 0.01).to_array(),
            axis_x: (turn * Vec3::X).to_array(),
            axis_y: (turn * Vec3::Y).to_array(),
            axis_z: (turn * Vec3::Z).to_array(),
            ..Cuboid::default()
        }
    }

    #[test]
    fn four_spheres_are_met_where_each_is() {
        let mut met = 0;
        for number in 0..20_000 {
            let sphere = |lane: u32| {
                let u = random_unit(random_key([5, 0], [3, 4], [number * 4 + lane, 0]), 0, 0);
                Sphere {
                    center: vector(u, 4.0).to_array(),
                    radius: u[3] * 2.0 + 0.01,
                    ..Sphere::default()
                }
            };
            let spheres = [0, 1, 2].map(sphere);
            let four = Spheres::new(&spheres, 1);
            for ray in rays(number) {
                let found = four.distances(&FourRay::new(&ray)).to_array();
                for (lane, sphere) in spheres.iter().enumerate() {
                    let crossing = intersect_sphere(sphere.center.into(), sphere.radius, &ray);
                    let alone = first_distance(crossing, &ray, lane as u32 + 1);
                    assert_eq!(
                        found[lane].to_bits(),
                        alone.to_bits(),
                        "ray {number}, lane {lane}"
                    );
                    met += u32::from(alone > 0.0);
                }
                assert!(found[3] <= 0.0, "nothing stands in the last lane");
            }
        }
        assert!(met > 10_000, "only {met} hits");
    }

    #[test]
    fn four_boxes_are_met_where_each_is() {
        let mut met = 0;
        for number in 0..20_000 {
            for turned in [false, true] {
                let boxes = [0, 1, 2].map(|lane| shape(number * 4 + lane, turned));
                let four = Boxes::new(&boxes, 1);
                for ray in rays(number) {
                    let lanes = FourRay::new(&ray);
                    let found = if turned {
                        four.rotated_distances(&lanes)
                    } else {
                        four.distances(&lanes)
                    };
                    for (lane, shape) in boxes.iter().enumerate() {
                        let from_center = box_local(shape, ray.origin - Vec3::from(shape.center));
                        let inverse = safe_inverse(box_local(shape, ray.direction));
                        let crossing = intersect_box(shape.half_size.into(), from_center, inverse);
                        let alone = first_distance(crossing, &ray, lane as u32 + 1);
                        assert_eq!(
                            found[lane].to_bits(),
                            alone.to_bits(),
                            "ray {number}, lane {lane}"
                        );
                        met += u32::from(alone > 0.0);
                    }
                    assert!(found[3] <= 0.0, "nothing stands in the last lane");
                }
            }
        }
        assert!(met > 10_000, "only {met} hits");
    }
}
