//! Bodies that are large beside all others, such as the walls of a room, stand outside the tree and
//! are tried one by one. Nearly every ray meets their boxes anyway, and left in they would make the grid
//! coarse for all that is small: a wall that is a sphere of radius 1e5 leaves a room of size 100 some
//! thirty of its 65,535 lines.

use super::bounds::Bounds;
use super::hierarchy::Item;

/// The most bodies outside the tree.
const MOST: usize = 16;
/// A body is outsize whose longest side is more than this share of that of all that are smaller.
const SHARE: f32 = 0.25;

fn longest(bounds: &Bounds) -> f32 {
    bounds.sides().max_element()
}

/// Moves the outsize bodies behind the others; the number of those that stay. Largest go first, and of
/// equal ones the first.
pub(super) fn set_aside(items: &mut [Item]) -> usize {
    let larger = |a: &Item, b: &Item| {
        let by_size = longest(&a.bounds).total_cmp(&longest(&b.bounds));
        by_size.then(b.body.cmp(&a.body))
    };
    let most = MOST.min(items.len());
    let rest = items.len() - most;
    if most > 0 && rest > 0 {
        items.select_nth_unstable_by(rest, larger);
    }
    items[rest..].sort_unstable_by(larger);
    // What each candidate is measured by: the bounds of all that are smaller.
    let empty = Bounds::EMPTY;
    let mut hull = items[..rest]
        .iter()
        .fold(empty, |hull, item| hull.with(&item.bounds));
    let mut outsize = Vec::with_capacity(most);
    for item in &items[rest..] {
        outsize.push(longest(&item.bounds) > SHARE * longest(&hull).max(0.0));
        hull = hull.with(&item.bounds);
    }
    let stay = outsize.iter().rposition(|outsize| !outsize);
    rest + stay.map_or(0, |last| last + 1)
}
