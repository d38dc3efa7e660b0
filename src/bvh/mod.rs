//! A bounding volume hierarchy in the form that devices walk: a flat list of nodes of 16 bytes, read
//! from front to back without a stack.
//!
//! | entry | words |
//! |---|---|
//! | header 0 | where the grid starts, x, y, z (f32); nodes of one order |
//! | header 1 | the grid's cell, x, y, z (f32); 0 |
//! | header 2 | half of the grid's diagonal (f32); for x, y and z: what it adds to the number of a ray's order that the ray goes backwards along it |
//! | inner node | for x, y and z the grid lines around it, lower in the low half; bit 31 and the nodes of the subtree |
//! | leaf, a sphere | its centre, x, y, z (f32); its radius (f32), whose bit 31 is clear |
//! | leaf, a box | its index; 0; 0; bits 31 and 30 |
//!
//! The orders follow one another, and one idle node stands behind the last. A second list holds each
//! entry's body, counted from 1, or 0; it is read only where a body is met.
//!
//! There are eight orders, one for each octant of directions, while all fit into [`MOST_BYTES`],
//! and four above 2^19 bodies: by the two axes along which the camera looks most. (In a room of 10^6 bodies,
//! seen along z, orders by y and z or x and z cost 1.1 times as much as eight, and orders by x and y 1.8 times.)

mod bounds;
mod grid;
mod hierarchy;
mod outsize;
mod thread;

pub use bounds::Bounds;
pub use grid::Grid;

use glam::Vec3;
use hierarchy::{Item, Node};
use rayon::prelude::*;
use thread::{Slots, thread};

/// The longest list of nodes: what every device can bind.
pub const MOST_BYTES: usize = 128 << 20;
/// Entries before the first node.
pub const HEADER: usize = 3;
/// Set in an inner node and in the leaf of a box.
pub const NOT_SPHERE: u32 = 1 << 31;
/// Set in the leaf of a box alone.
pub const BOX: u32 = 1 << 30;

/// An entry of the list.
pub type Encoded = [u32; 4];

/// A tree, as it goes to a device.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    pub nodes: Vec<Encoded>,
    /// The body of each entry, counted from 1; 0 for what is no leaf.
    pub bodies: Vec<u32>,
    /// The bodies that stand outside the tree, in order.
    pub outside: Vec<u32>,
}

impl Tree {
    /// The tree over bodies with these bounds; `leaf` says what stands for each, by its index. `view` is the
    /// direction of the rays that matter most.
    pub fn new(bounds: &[Bounds], view: Vec3, leaf: impl Fn(usize) -> Encoded + Sync) -> Self {
        let numbered = bounds.par_iter().zip(1..bounds.len() as u32 + 1);
        let mut items: Vec<_> = numbered
            .map(|(&bounds, body)| Item { bounds, body })
            .collect();
        let inside = outsize::set_aside(&mut items);
        let (items, outside) = items.split_at_mut(inside);
        let tree = hierarchy::build(items);
        let hull = tree.first().map_or(Bounds::EMPTY, |root| root.bounds);
        let grid = Grid::over(&hull);
        let weights = weights(tree.len(), view);
        let orders = orders(weights);
        let length = HEADER + orders * tree.len() + 1;
        let mut nodes = header(&grid, tree.len(), weights);
        nodes.resize(length, [0, 0, 0, NOT_SPHERE]);
        let mut bodies = vec![0; length];
        let encoded = encode(&tree, &grid, leaf);
        for order in 0..orders {
            let range = HEADER + order * tree.len()..HEADER + (order + 1) * tree.len();
            let slots = Slots {
                nodes: &mut nodes[range.clone()],
                bodies: &mut bodies[range],
            };
            let backwards = weights.map(|weight| order as u32 & weight != 0);
            thread(&tree, &encoded, backwards, slots);
        }
        let mut outside: Vec<_> = outside.iter().map(|item| item.body).collect();
        outside.sort_unstable();
        Self {
            nodes,
            bodies,
            outside,
        }
    }

    /// The grid of its boxes.
    pub fn grid(&self) -> Grid {
        let vector = |entry: usize| {
            let [x, y, z, _] = self.nodes[entry].map(f32::from_bits);
            Vec3::new(x, y, z)
        };
        Grid {
            lower: vector(0),
            cell: vector(1),
        }
    }

    /// Nodes of one order.
    pub fn order_length(&self) -> usize {
        self.nodes[0][3] as usize
    }

    /// Number of orders.
    pub fn orders(&self) -> usize {
        let [_, x, y, z] = self.nodes[2];
        orders([x, y, z])
    }

    /// Entries of one order.
    pub fn order(&self, number: usize) -> std::ops::Range<usize> {
        let start = HEADER + number * self.order_length();
        start..start + self.order_length()
    }
}

/// What each axis adds to the number of an order: as many axes as there is room for the orders of.
fn weights(nodes: usize, view: Vec3) -> [u32; 3] {
    let entries = HEADER + 8 * nodes + 1;
    if entries * size_of::<Encoded>() <= MOST_BYTES {
        return [1, 2, 4];
    }
    match view.abs().min_position() {
        0 => [0, 1, 2],
        1 => [1, 0, 2],
        _ => [1, 2, 0],
    }
}

/// How many orders there are where each axis adds so much.
fn orders(weights: [u32; 3]) -> usize {
    weights.iter().sum::<u32>() as usize + 1
}

fn header(grid: &Grid, nodes: usize, [x, y, z]: [u32; 3]) -> Vec<Encoded> {
    let words = |v: Vec3, last: u32| {
        let [x, y, z] = v.to_array().map(f32::to_bits);
        [x, y, z, last]
    };
    let half_diagonal = 0.5 * 65536.0 * grid.cell.length();
    vec![
        words(grid.lower, nodes as u32),
        words(grid.cell, 0),
        [half_diagonal.to_bits(), x, y, z],
    ]
}

fn encode(tree: &[Node], grid: &Grid, leaf: impl Fn(usize) -> Encoded + Sync) -> Vec<Encoded> {
    let one = |node: &Node| {
        if node.body > 0 {
            return leaf(node.body as usize - 1);
        }
        let [x, y, z] = grid.enclose(&node.bounds);
        [x, y, z, NOT_SPHERE | node.size]
    };
    tree.par_iter().map(one).collect()
}
