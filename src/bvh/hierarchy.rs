//! From bodies to a binary tree, from the top down: a node is cut where the surface area heuristic
//! (MacDonald and Booth, "Heuristics for ray tracing using space subdivision", 1990) expects the
//! cheapest rays, tried at the borders of equal bins (Wald, "On fast construction of SAH-based
//! bounding volume hierarchies", 2007) on all three axes. Every leaf holds one body.

use super::bounds::Bounds;
use glam::Vec3;

/// Bins an axis: more of them found no better trees.
const BINS: usize = 16;
/// Nodes with fewer bodies are not worth another thread.
const PARALLEL: usize = 4096;
/// From this depth on nodes are cut in the middle. The heuristic may cut off one body at a time;
/// halving keeps the whole below this and the logarithm of the number of bodies.
const DEEPEST: usize = 64;

/// A body on its way to its leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub bounds: Bounds,
    /// Counted from 1.
    pub body: u32,
}

/// A node of the tree; its first child is the next one, its second stands after the first's own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub bounds: Bounds,
    /// Nodes of the whole subtree, this one included.
    pub size: u32,
    /// The body of a leaf, or 0.
    pub body: u32,
    /// The axis along which the first child comes before the second.
    pub axis: u8,
}

const EMPTY: Node = Node {
    bounds: Bounds::EMPTY,
    size: 0,
    body: 0,
    axis: 0,
};

/// The nodes of a tree over all items, each before its children. They depend on the items and
/// their order alone: each cut is made by one thread, and a subtree's place is known before it is built.
pub(super) fn build(items: &mut [Item]) -> Vec<Node> {
    let mut nodes = vec![EMPTY; (2 * items.len()).saturating_sub(1)];
    if !items.is_empty() {
        fill(items, &mut nodes, 0);
    }
    nodes
}

fn fill(items: &mut [Item], nodes: &mut [Node], depth: usize) {
    let size = nodes.len() as u32;
    if let [item] = items {
        nodes[0] = Node {
            bounds: item.bounds,
            size,
            body: item.body,
            axis: 0,
        };
        return;
    }
    let (bounds, centers) = hulls(items);
    let (axis, middle) = cut(items, &centers, depth);
    nodes[0] = Node {
        bounds,
        size,
        body: 0,
        axis: axis as u8,
    };
    let parallel = items.len() >= PARALLEL;
    let (first, second) = items.split_at_mut(middle);
    let (first_nodes, second_nodes) = nodes[1..].split_at_mut(2 * middle - 1);
    if parallel {
        rayon::join(
            || fill(first, first_nodes, depth + 1),
            || fill(second, second_nodes, depth + 1),
        );
    } else {
        fill(first, first_nodes, depth + 1);
        fill(second, second_nodes, depth + 1);
    }
}

/// What holds the items, and what holds twice their centres.
fn hulls(items: &[Item]) -> (Bounds, Bounds) {
    let empty = (Bounds::EMPTY, Bounds::EMPTY);
    items.iter().fold(empty, |(all, centers), item| {
        let center = item.bounds.twice_center();
        (all.with(&item.bounds), centers.with_point(center))
    })
}

/// Puts the items of the first child before those of the second; the axis, and how many those are.
fn cut(items: &mut [Item], centers: &Bounds, depth: usize) -> (usize, usize) {
    let sides = centers.sides();
    if sides == Vec3::ZERO {
        return (0, items.len() / 2);
    }
    if depth >= DEEPEST {
        return halve(items, sides);
    }
    let bins = Bins::new(centers, items.len());
    let (axis, border) = bins.fill(items).best();
    let mut middle = 0;
    for place in 0..items.len() {
        if bins.place(items[place].bounds.twice_center())[axis] <= border {
            items.swap(middle, place);
            middle += 1;
        }
    }
    (axis, middle)
}

/// The lower half along the longest side.
fn halve(items: &mut [Item], sides: Vec3) -> (usize, usize) {
    let (axis, middle) = (sides.max_position(), items.len() / 2);
    let key = |item: &Item| item.bounds.twice_center()[axis];
    items.select_nth_unstable_by(middle, |a, b| {
        key(a).total_cmp(&key(b)).then(a.body.cmp(&b.body))
    });
    (axis, middle)
}

/// How centres fall into bins.
#[derive(Clone, Copy, Debug)]
struct Bins {
    count: usize,
    lower: Vec3,
    /// Bins a unit; infinite or not a number along a side without length, where all fall into bin 0.
    density: Vec3,
}

impl Bins {
    fn new(centers: &Bounds, items: usize) -> Self {
        let count = items.min(BINS);
        Self {
            count,
            lower: centers.lower,
            density: Vec3::splat(count as f32) / centers.sides(),
        }
    }

    /// The bin on each axis.
    #[inline]
    fn place(&self, center: Vec3) -> [usize; 3] {
        let at = (center - self.lower) * self.density;
        at.to_array().map(|x| (x as usize).min(self.count - 1))
    }

    fn fill(&self, items: &[Item]) -> Filled {
        let mut filled = Filled {
            count: self.count,
            bounds: [[Bounds::EMPTY; BINS]; 3],
            items: [[0; BINS]; 3],
        };
        for item in items {
            let places = self.place(item.bounds.twice_center());
            for (axis, bin) in places.into_iter().enumerate() {
                let bounds = &mut filled.bounds[axis][bin];
                *bounds = bounds.with(&item.bounds);
                filled.items[axis][bin] += 1;
            }
        }
        filled
    }
}

/// What fell into the bins of each axis.
struct Filled {
    count: usize,
    bounds: [[Bounds; BINS]; 3],
    items: [[u32; BINS]; 3],
}

impl Filled {
    /// Axis and last bin of the first child where the cost is least; of equal ones the first. Some
    /// axis has bodies in its first and in its last bin.
    fn best(&self) -> (usize, usize) {
        let (mut best, mut least) = ((0, 0), f32::INFINITY);
        for axis in 0..3 {
            let above = self.costs_above(axis);
            let (mut bounds, mut items) = (Bounds::EMPTY, 0);
            for bin in 0..self.count - 1 {
                bounds = bounds.with(&self.bounds[axis][bin]);
                items += self.items[axis][bin];
                let Some(above) = above[bin].filter(|_| items > 0) else {
                    continue;
                };
                let cost = bounds.half_area() * items as f32 + above;
                if cost < least {
                    (best, least) = ((axis, bin), cost);
                }
            }
        }
        best
    }

    /// Area times number of the items above each bin; none where there are none.
    fn costs_above(&self, axis: usize) -> [Option<f32>; BINS] {
        let mut costs = [None; BINS];
        let (mut bounds, mut items) = (Bounds::EMPTY, 0);
        for bin in (1..self.count).rev() {
            bounds = bounds.with(&self.bounds[axis][bin]);
            items += self.items[axis][bin];
            if items > 0 {
                costs[bin - 1] = Some(bounds.half_area() * items as f32);
            }
        }
        costs
    }
}
