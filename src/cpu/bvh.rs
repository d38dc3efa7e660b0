//! Twin of `shaders/bvh.wgsl`: the traversal by a bounding volume hierarchy. It needs no count of
//! its iterations.

use super::r#box::{intersect_box, safe_inverse};
use super::maths::{greater, lesser};
use super::ray::{Crossing, Ray, first_distance};
use super::scene::{Hit, Traversal, rotated_box_crossing};
use super::sphere::intersect_sphere;
use crate::bvh::{BOX, Encoded, HEADER, NOT_SPHERE, Tree};
use crate::pack::{Cuboid, Hierarchy, Packed, Sphere};
use glam::{UVec3, Vec3};

/// The body that a ray starts inside of, as the entry that it tries first.
const OWN: usize = 0;
/// Share of the distance to the farthest that the tree holds by which boxes grow.
const SLACK: f32 = 4e-6;

/// A scene with its tree.
#[derive(Clone, Copy, Debug)]
pub struct ByTree<'a> {
    pub scene: &'a Packed,
    pub hierarchy: &'a Hierarchy,
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
    /// The entry in hand, and its words.
    place: usize,
    node: Encoded,
    /// The first entry of the order, and that behind its last.
    first: usize,
    end: usize,
}

fn vector(words: Encoded) -> Vec3 {
    let [x, y, z, _] = words.map(f32::from_bits);
    Vec3::new(x, y, z)
}

fn box_leaf(index: u32) -> Encoded {
    [index, 0, 0, NOT_SPHERE | BOX]
}

/// The leaf of the body that the ray starts on.
fn own_leaf(scene: &Packed, ray: &Ray) -> Encoded {
    let own = ray.source as usize - 1;
    match scene.spheres.get(own) {
        Some(sphere) => {
            let [x, y, z] = sphere.center.map(f32::to_bits);
            [x, y, z, sphere.radius.to_bits()]
        }
        None => box_leaf((own - scene.spheres.len()) as u32),
    }
}

fn start_walk(scene: &Packed, tree: &Tree, ray: &Ray) -> Walk {
    let nodes = &tree.nodes;
    let order_length = nodes[0][3] as usize;
    let cell = vector(nodes[1]);
    let lower = vector(nodes[0]) - ray.origin;
    let half_diagonal = f32::from_bits(nodes[2][0]);
    let inverse = safe_inverse(ray.direction);
    let slack = SLACK * ((lower + 32767.5 * cell).length() + half_diagonal) * inverse.abs();
    let backwards = inverse.cmplt(Vec3::ZERO);
    let [_, x, y, z] = nodes[2];
    let order = UVec3::select(backwards, UVec3::new(x, y, z), UVec3::ZERO).element_sum();
    let first = HEADER + order as usize * order_length;
    let (place, node) = match ray.inside {
        true => (OWN, own_leaf(scene, ray)),
        false => (first, nodes[first]),
    };
    Walk {
        step: cell * inverse,
        near_start: lower * inverse - slack,
        far_start: lower * inverse + slack,
        near_shift: <[bool; 3]>::from(backwards).map(|backwards| if backwards { 16 } else { 0 }),
        place,
        node,
        first,
        end: first + order_length,
    }
}

/// Whether a ray enters an inner node's box nearer than `reach`. Shifts and places wrap here, as WGSL's do: asking
/// whether they would costs 3 % of the time.
#[inline(always)]
fn enters(walk: &Walk, reach: f32) -> bool {
    let line =
        |axis: usize, shift: u32| (walk.node[axis].wrapping_shr(shift) & 0xffff) as i32 as f32;
    let near_line = |axis: usize| line(axis, walk.near_shift[axis]);
    let far_line = |axis: usize| line(axis, walk.near_shift[axis] ^ 16);
    let enter = Vec3::new(near_line(0), near_line(1), near_line(2)) * walk.step + walk.near_start;
    let leave = Vec3::new(far_line(0), far_line(1), far_line(2)) * walk.step + walk.far_start;
    let near = greater(greater(enter.x, enter.y), greater(enter.z, 0.0));
    let far = lesser(lesser(leave.x, leave.y), lesser(leave.z, reach));
    near <= far
}

fn at_leaf(walk: &Walk) -> bool {
    walk.node[3] & (NOT_SPHERE | BOX) != NOT_SPHERE
}

fn box_crossing(shape: &Cuboid, rotated: bool, ray: &Ray) -> Crossing {
    if rotated {
        return rotated_box_crossing(shape, ray);
    }
    let from_center = ray.origin - Vec3::from(shape.center);
    intersect_box(
        shape.half_size.into(),
        from_center,
        safe_inverse(ray.direction),
    )
}

fn outside_sphere_hit(shape: &Sphere, ray: &Ray) -> Hit {
    let crossing = intersect_sphere(shape.center.into(), shape.radius, ray);
    Hit {
        distance: first_distance(crossing, ray, shape.body),
        body: shape.body,
    }
}

fn outside_box_hit(shape: &Cuboid, rotated: bool, ray: &Ray) -> Hit {
    Hit {
        distance: first_distance(box_crossing(shape, rotated, ray), ray, shape.body),
        body: shape.body,
    }
}

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
    #[inline(always)]
    fn go_to(&self, walk: &mut Walk, place: usize) {
        walk.place = place.min(walk.end);
        walk.node = self.hierarchy.tree.nodes[walk.place];
    }

    /// Past an inner node, into it or beyond; leaves are left in hand.
    #[inline(always)]
    fn descend(&self, walk: &mut Walk, reach: f32) {
        if !at_leaf(walk) {
            let skip = (walk.node[3] & !NOT_SPHERE) as usize;
            let skip = if enters(walk, reach) { 1 } else { skip };
            self.go_to(walk, walk.place.wrapping_add(skip));
        }
    }

    #[inline(always)]
    fn after_leaf(&self, walk: &mut Walk) {
        let next = match walk.place {
            OWN => walk.first,
            place => place.wrapping_add(1),
        };
        self.go_to(walk, next);
    }

    /// First distance to the body of the leaf in hand; none where it cannot be nearer than `reach`,
    /// nor as near. The body that the ray starts inside of is met whatever the rounding.
    #[inline(always)]
    fn leaf_hit(&self, walk: &Walk, ray: &Ray, reach: f32) -> Hit {
        let leaf = walk.node;
        let crossing = if leaf[3] >= NOT_SPHERE {
            let rotated = leaf[0] >= self.scene.strategy.box_count;
            box_crossing(&self.scene.boxes[leaf[0] as usize], rotated, ray)
        } else {
            intersect_sphere(vector(leaf), f32::from_bits(leaf[3]), ray)
        };
        let ahead = if crossing.near > 0.0 {
            crossing.near
        } else {
            crossing.far
        };
        let own = walk.place == OWN;
        if !own && (!crossing.met || ahead > reach || ahead <= 0.0) {
            return Hit {
                distance: -1.0,
                body: 0,
            };
        }
        let body = match own {
            true => ray.source,
            false => self.hierarchy.tree.bodies[walk.place],
        };
        Hit {
            distance: first_distance(crossing, ray, body),
            body,
        }
    }

    /// First distances to the bodies outside the tree.
    #[inline(always)]
    fn outside(&self, ray: &Ray) -> impl Iterator<Item = Hit> {
        let straight = self.scene.strategy.outside_box_count as usize;
        let spheres = self.hierarchy.spheres.iter();
        let boxes = self.hierarchy.boxes.iter().enumerate();
        spheres
            .map(|shape| outside_sphere_hit(shape, ray))
            .chain(boxes.map(move |(index, shape)| outside_box_hit(shape, index >= straight, ray)))
    }

    #[inline(always)]
    pub fn nearest_hit(&self, ray: &Ray) -> Hit {
        let none = Hit {
            distance: 3e38,
            body: 0,
        };
        let mut best = self.outside(ray).fold(none, nearer);
        let mut walk = start_walk(self.scene, &self.hierarchy.tree, ray);
        while walk.place < walk.end {
            self.descend(&mut walk, best.distance);
            if at_leaf(&walk) {
                best = nearer(best, self.leaf_hit(&walk, ray, best.distance));
                self.after_leaf(&mut walk);
            }
        }
        best
    }

    /// Whether anything but the body `target_body` stands nearer than `reach`.
    #[inline(always)]
    pub fn occluded(&self, ray: &Ray, reach: f32, target_body: u32) -> bool {
        let mut blocked = self.outside(ray).any(|hit| blocks(hit, reach, target_body));
        if blocked {
            return true;
        }
        let mut walk = start_walk(self.scene, &self.hierarchy.tree, ray);
        while walk.place < walk.end && !blocked {
            self.descend(&mut walk, reach);
            if at_leaf(&walk) {
                blocked = blocks(self.leaf_hit(&walk, ray, reach), reach, target_body);
                self.after_leaf(&mut walk);
            }
        }
        blocked
    }
}
