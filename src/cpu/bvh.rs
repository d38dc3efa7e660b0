//! Twin of `shaders/bvh.wgsl`: the traversal by a bounding volume hierarchy. It needs no count of
//! its iterations.

use super::r#box::{intersect_box, safe_inverse};
use super::maths::{greater, lesser};
use super::ray::{Crossing, Ray, first_distance};
use super::scene::{Hit, Traversal, rotated_box_crossing};
use super::sphere::intersect_sphere;
use crate::bvh::{BOX, Encoded, HEADER, NOT_SPHERE, Tree};
use crate::pack::Packed;
use glam::Vec3;

const SLACK: f32 = 4e-6;

/// A scene with its tree.
#[derive(Clone, Copy, Debug)]
pub struct ByTree<'a> {
    pub scene: &'a Packed,
    pub tree: &'a Tree,
}

impl Traversal for ByTree<'_> {
    #[inline(always)]
    fn nearest_hit(&self, ray: &Ray) -> Hit {
        self.nearest_hit(ray)
    }

    #[inline(always)]
    fn occluded(&self, ray: &Ray, reach: f32, target_body: u32) -> bool {
        self.occluded(ray, reach, target_body)
    }
}

/// A ray among the nodes.
#[derive(Clone, Copy, Debug)]
struct Walk {
    /// On each axis a grid line's distance is start + number * step; starts are moved outwards by
    /// the slack, for the box's near and far side.
    step: Vec3,
    near_start: Vec3,
    far_start: Vec3,
    /// Where in a node's words the near side's number is: 0 or 16.
    near_shift: [u32; 3],
    /// The entry in hand, and that behind the last.
    node: usize,
    end: usize,
}

fn vector(words: Encoded) -> Vec3 {
    let [x, y, z, _] = words.map(f32::from_bits);
    Vec3::new(x, y, z)
}

fn start_walk(tree: &Tree, ray: &Ray) -> Walk {
    let nodes = &tree.nodes;
    let order_length = nodes[0][3] as usize;
    let cell = vector(nodes[1]);
    let lower = vector(nodes[0]) - ray.origin;
    let half_diagonal = f32::from_bits(nodes[2][2]);
    let inverse = safe_inverse(ray.direction);
    let slack = SLACK * ((lower + 32767.5 * cell).length() + half_diagonal) * inverse.abs();
    let backwards = inverse.cmplt(Vec3::ZERO);
    let octant = (backwards.bitmask() & nodes[1][3]) as usize;
    let first = HEADER + nodes[2][0] as usize + octant * order_length;
    Walk {
        step: cell * inverse,
        near_start: lower * inverse - slack,
        far_start: lower * inverse + slack,
        near_shift: <[bool; 3]>::from(backwards).map(|backwards| if backwards { 16 } else { 0 }),
        node: first,
        end: first + order_length,
    }
}

/// Whether a ray enters an inner node's box nearer than `reach`.
#[inline(always)]
fn enters(walk: &Walk, node: Encoded, reach: f32) -> bool {
    let line = |axis: usize, shift: u32| ((node[axis] >> shift) & 0xffff) as i32 as f32;
    let near_line = |axis: usize| line(axis, walk.near_shift[axis]);
    let far_line = |axis: usize| line(axis, 16 - walk.near_shift[axis]);
    let enter = Vec3::new(near_line(0), near_line(1), near_line(2)) * walk.step + walk.near_start;
    let leave = Vec3::new(far_line(0), far_line(1), far_line(2)) * walk.step + walk.far_start;
    let near = greater(greater(enter.x, enter.y), greater(enter.z, 0.0));
    let far = lesser(lesser(leave.x, leave.y), lesser(leave.z, reach));
    near <= far
}

/// No hit.
const NONE: Hit = Hit {
    distance: -1.0,
    body: 0,
};

/// The nearer of two hits; of equal ones that of the first body.
#[inline(always)]
fn nearer(best: Hit, other: Hit) -> Hit {
    let first = other.distance == best.distance && other.body < best.body;
    let closer = other.distance > 0.0 && (other.distance < best.distance || first);
    if closer { other } else { best }
}

#[inline(always)]
fn blocks(hit: Hit, reach: f32, target_body: u32) -> bool {
    hit.distance > 0.0 && hit.distance < reach && hit.body != target_body
}

impl ByTree<'_> {
    fn box_crossing(&self, index: usize, ray: &Ray) -> Crossing {
        let shape = &self.scene.boxes[index];
        if index >= self.scene.strategy.box_count as usize {
            return rotated_box_crossing(shape, ray);
        }
        let from_center = ray.origin - Vec3::from(shape.center);
        intersect_box(shape.half_size.into(), from_center, safe_inverse(ray.direction))
    }

    /// First distance to the body of a leaf; none where it cannot be nearer than `reach`, nor as near.
    #[inline(always)]
    fn leaf_hit(&self, leaf: Encoded, place: usize, ray: &Ray, reach: f32) -> Hit {
        let crossing = if leaf[3] >= NOT_SPHERE {
            self.box_crossing(leaf[0] as usize, ray)
        } else {
            intersect_sphere(vector(leaf), f32::from_bits(leaf[3]), ray)
        };
        let ahead = if crossing.near > 0.0 { crossing.near } else { crossing.far };
        if !crossing.met || ahead > reach || ahead <= 0.0 {
            return NONE;
        }
        let body = self.tree.bodies[place];
        Hit {
            distance: first_distance(crossing, ray, body),
            body,
        }
    }

    /// The far side of the body that the ray starts inside of: found whatever the rounding.
    #[inline(always)]
    fn own_hit(&self, ray: &Ray) -> Hit {
        if !ray.inside {
            return NONE;
        }
        let own = ray.source as usize - 1;
        let crossing = match self.scene.spheres.get(own) {
            Some(sphere) => intersect_sphere(sphere.center.into(), sphere.radius, ray),
            None => self.box_crossing(own - self.scene.spheres.len(), ray),
        };
        Hit {
            distance: first_distance(crossing, ray, ray.source),
            body: ray.source,
        }
    }

    /// One entry of the list.
    #[inline(always)]
    fn visit_nearest(&self, walk: &mut Walk, best: &mut Hit, ray: &Ray) {
        let place = walk.node;
        let node = self.tree.nodes[place];
        walk.node += 1;
        if node[3] & (NOT_SPHERE | BOX) == NOT_SPHERE {
            if !enters(walk, node, best.distance) {
                walk.node = place + (node[3] & !NOT_SPHERE) as usize;
            }
        } else {
            *best = nearer(*best, self.leaf_hit(node, place, ray, best.distance));
        }
    }

    #[inline(always)]
    pub fn nearest_hit(&self, ray: &Ray) -> Hit {
        let outside = self.tree.outside();
        let none = Hit {
            distance: 3e38,
            body: 0,
        };
        let mut best = nearer(none, self.own_hit(ray));
        for place in HEADER..HEADER + outside {
            best = nearer(best, self.leaf_hit(self.tree.nodes[place], place, ray, best.distance));
        }
        let mut walk = start_walk(self.tree, ray);
        while walk.node < walk.end {
            self.visit_nearest(&mut walk, &mut best, ray);
        }
        best
    }

    /// One entry of the list; whether its body stands in the way.
    #[inline(always)]
    fn visit_any(&self, walk: &mut Walk, ray: &Ray, reach: f32, target_body: u32) -> bool {
        let place = walk.node;
        let node = self.tree.nodes[place];
        walk.node += 1;
        if node[3] & (NOT_SPHERE | BOX) == NOT_SPHERE {
            if !enters(walk, node, reach) {
                walk.node = place + (node[3] & !NOT_SPHERE) as usize;
            }
            return false;
        }
        blocks(self.leaf_hit(node, place, ray, reach), reach, target_body)
    }

    /// Whether anything but the body `target_body` stands nearer than `reach`.
    #[inline(always)]
    pub fn occluded(&self, ray: &Ray, reach: f32, target_body: u32) -> bool {
        let outside = self.tree.outside();
        let mut blocked = blocks(self.own_hit(ray), reach, target_body);
        for place in HEADER..HEADER + outside {
            let hit = self.leaf_hit(self.tree.nodes[place], place, ray, reach);
            blocked = blocked || blocks(hit, reach, target_body);
        }
        let mut walk = start_walk(self.tree, ray);
        while walk.node < walk.end && !blocked {
            blocked = self.visit_any(&mut walk, ray, reach, target_body);
        }
        blocked
    }
}
