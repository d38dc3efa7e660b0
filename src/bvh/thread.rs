//! From a binary tree to lists that need no stack: nodes stand in the order of a depth-first walk,
//! and each says how many to skip where its box is missed (Smits, "Efficiency issues for ray
//! tracing", 1998). The children's order is that of the ray's octant, so that what is near comes first.

use super::Encoded;
use super::hierarchy::Node;

/// Subtrees with fewer nodes are not worth another thread.
const PARALLEL: usize = 1 << 14;

/// A list of nodes with the bodies of its leaves, to be filled.
pub(super) struct Slots<'a> {
    pub nodes: &'a mut [[u32; 4]],
    pub bodies: &'a mut [u32],
}

impl<'a> Slots<'a> {
    fn split_at(self, middle: usize) -> (Self, Self) {
        let (nodes, other_nodes) = self.nodes.split_at_mut(middle);
        let (bodies, other_bodies) = self.bodies.split_at_mut(middle);
        let other = Slots {
            nodes: other_nodes,
            bodies: other_bodies,
        };
        (Slots { nodes, bodies }, other)
    }
}

/// Writes a subtree for rays that go backwards along some of the axes.
pub(super) fn thread(tree: &[Node], encoded: &[Encoded], backwards: [bool; 3], slots: Slots<'_>) {
    let Some((node, children)) = tree.split_first() else {
        return;
    };
    let (own, rest) = slots.split_at(1);
    own.nodes[0] = encoded[0];
    own.bodies[0] = node.body;
    let Some(first) = children.first() else {
        return;
    };
    let middle = first.size as usize;
    let (one, two) = children.split_at(middle);
    let (one_encoded, two_encoded) = encoded[1..].split_at(middle);
    let swapped = backwards[usize::from(node.axis)];
    let (near, far) = rest.split_at(if swapped { two.len() } else { middle });
    let (one_slots, two_slots) = if swapped { (far, near) } else { (near, far) };
    let both = (
        || thread(one, one_encoded, backwards, one_slots),
        || thread(two, two_encoded, backwards, two_slots),
    );
    if tree.len() >= PARALLEL {
        rayon::join(both.0, both.1);
    } else {
        both.0();
        both.1();
    }
}
