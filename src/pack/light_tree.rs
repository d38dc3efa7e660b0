//! A binary tree over lamps, from the top down: groups are cut where the surface area orientation heuristic
//! (Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018), here
//! of lamps that shine in all directions, finds power and extent best kept together. It is tried at
//! the borders of equal bins on all three axes. Every leaf holds one lamp.

use super::choice::ChoiceEntry;
use glam::DVec3;

/// A link to a lamp rather than to a pair: `LEAF` of `shaders/light_tree.wgsl`.
const LEAF: u32 = 1 << 31;
/// Bins an axis.
const BINS: usize = 16;
/// Groups of fewer lamps are not worth another thread.
const PARALLEL: usize = 4096;
/// Pairs on the way to any lamp: a path is a bit for each, and a word holds no more. 2^20 lamps need 20.
const DEEPEST: u32 = 32;

/// A sphere around lamps, and what they send out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Group {
    pub center: DVec3,
    pub radius: f64,
    pub power: f64,
}

/// A lamp on its way to its leaf.
#[derive(Clone, Copy, Debug)]
struct Item {
    group: Group,
    lamp: u32,
}

/// Two groups, and what stands below them.
#[derive(Clone, Copy, Debug)]
struct Pair {
    groups: [Group; 2],
    links: [u32; 2],
}

const NOTHING: Group = Group {
    center: DVec3::ZERO,
    radius: 0.0,
    power: 0.0,
};

/// The tree's entries: three for each pair, parents first; then the paths of the lamps, four an entry. And
/// how many pairs are at most on the way to a lamp.
///
/// There is one lamp at least.
pub(super) fn build(lamps: &[Group]) -> (Vec<ChoiceEntry>, u32) {
    let items = lamps.iter().zip(0..);
    let mut items: Vec<_> = items.map(|(&group, lamp)| Item { group, lamp }).collect();
    let nothing = Pair {
        groups: [NOTHING; 2],
        links: [0; 2],
    };
    let mut pairs = vec![nothing; lamps.len() - 1];
    if !pairs.is_empty() {
        fill(&mut items, &mut pairs, 0, 0);
    }
    let (paths, depth) = paths(&pairs, lamps.len());
    let mut entries: Vec<_> = pairs.iter().flat_map(encoded).collect();
    entries.extend(paths.chunks(4).map(four));
    (entries, depth)
}

/// Makes the pair over the items, and those below it, in `pairs`, of which the first has the number `place`.
fn fill(items: &mut [Item], pairs: &mut [Pair], place: u32, depth: u32) {
    let middle = cut(items, depth);
    let parallel = items.len() >= PARALLEL;
    let (first, second) = items.split_at_mut(middle);
    let (own, below) = pairs.split_at_mut(1);
    let (first_pairs, second_pairs) = below.split_at_mut(middle - 1);
    let places = [place + 1, place + middle as u32];
    own[0] = Pair {
        groups: [group_of(first), group_of(second)],
        links: [link(first, places[0]), link(second, places[1])],
    };
    let mut one = || descend(first, first_pairs, places[0], depth + 1);
    let mut other = || descend(second, second_pairs, places[1], depth + 1);
    if parallel {
        rayon::join(one, other);
    } else {
        one();
        other();
    }
}

fn descend(items: &mut [Item], pairs: &mut [Pair], place: u32, depth: u32) {
    if items.len() > 1 {
        fill(items, pairs, place, depth);
    }
}

fn link(items: &[Item], place: u32) -> u32 {
    match items {
        [item] => item.lamp | LEAF,
        _ => place,
    }
}

/// The sphere around the middle of the items' bounds that holds them all.
fn group_of(items: &[Item]) -> Group {
    if let [item] = items {
        return item.group;
    }
    let center = hull(items).center();
    let reach = |item: &Item| item.group.center.distance(center) + item.group.radius;
    Group {
        center,
        radius: items.iter().map(reach).fold(0.0, f64::max),
        power: items.iter().map(|item| item.group.power).sum(),
    }
}

/// A box along the axes.
#[derive(Clone, Copy, Debug)]
struct Hull {
    lower: DVec3,
    upper: DVec3,
}

impl Hull {
    const EMPTY: Self = Self {
        lower: DVec3::INFINITY,
        upper: DVec3::NEG_INFINITY,
    };

    fn with(self, lower: DVec3, upper: DVec3) -> Self {
        Self {
            lower: self.lower.min(lower),
            upper: self.upper.max(upper),
        }
    }

    fn with_group(self, group: &Group) -> Self {
        self.with(group.center - group.radius, group.center + group.radius)
    }

    fn center(&self) -> DVec3 {
        0.5 * (self.lower + self.upper)
    }

    fn sides(&self) -> DVec3 {
        self.upper - self.lower
    }

    /// Half of the surface.
    fn half_area(&self) -> f64 {
        let DVec3 { x, y, z } = self.sides();
        x * y + y * z + z * x
    }
}

fn hull(items: &[Item]) -> Hull {
    let with = |hull: Hull, item: &Item| hull.with_group(&item.group);
    items.iter().fold(Hull::EMPTY, with)
}

/// Puts the items of the first group before those of the second; how many those are.
fn cut(items: &mut [Item], depth: u32) -> usize {
    let with = |hull: Hull, item: &Item| hull.with(item.group.center, item.group.center);
    let centers = items.iter().fold(Hull::EMPTY, with);
    let sides = centers.sides();
    if sides.max_element() <= 0.0 {
        return items.len() / 2;
    }
    // As many levels as halving takes are kept free for it.
    let halvings = usize::BITS - (items.len() - 1).leading_zeros();
    if depth + halvings >= DEEPEST {
        return halve(items, sides.max_position());
    }
    let (axis, border) = cheapest(items, &centers);
    let mut middle = 0;
    for place in 0..items.len() {
        if bin(items[place].group.center, &centers, axis) <= border {
            items.swap(middle, place);
            middle += 1;
        }
    }
    match middle == 0 || middle == items.len() {
        true => halve(items, axis),
        false => middle,
    }
}

/// The lower half along an axis.
fn halve(items: &mut [Item], axis: usize) -> usize {
    let middle = items.len() / 2;
    let key = |item: &Item| item.group.center[axis];
    items.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
    middle
}

/// The bin of a centre along an axis.
fn bin(center: DVec3, centers: &Hull, axis: usize) -> usize {
    let side = centers.sides()[axis];
    let along = (center[axis] - centers.lower[axis]) / side;
    // Rust's conversion saturates, and makes 0 of what an axis without extent gives.
    ((along * BINS as f64) as usize).min(BINS - 1)
}

/// The axis and the last bin of the first group: least power times surface over both groups, times how much
/// shorter the axis is than the longest, which keeps groups from growing thin.
fn cheapest(items: &[Item], centers: &Hull) -> (usize, usize) {
    let sides = centers.sides();
    let mut best = (f64::INFINITY, sides.max_position(), BINS / 2);
    for axis in (0..3).filter(|axis| sides[*axis] > 0.0) {
        let mut bins = [(Hull::EMPTY, 0.0); BINS];
        for Item { group, .. } in items {
            let bin = &mut bins[bin(group.center, centers, axis)];
            *bin = (bin.0.with_group(group), bin.1 + group.power);
        }
        let costs = costs(&bins);
        let slim = sides.max_element() / sides[axis];
        for (border, cost) in costs.into_iter().enumerate() {
            if slim * cost < best.0 {
                best = (slim * cost, axis, border);
            }
        }
    }
    (best.1, best.2)
}

/// The cost of a cut behind each bin but the last.
fn costs(bins: &[(Hull, f64); BINS]) -> [f64; BINS - 1] {
    let join = |(hull, power): (Hull, f64), bin: &(Hull, f64)| {
        (hull.with(bin.0.lower, bin.0.upper), power + bin.1)
    };
    let cost = |(hull, power): (Hull, f64)| match hull.lower.x <= hull.upper.x {
        true => hull.half_area() * power,
        false => 0.0,
    };
    let mut costs = [0.0; BINS - 1];
    let mut below = (Hull::EMPTY, 0.0);
    let mut above = (Hull::EMPTY, 0.0);
    for border in 0..BINS - 1 {
        below = join(below, &bins[border]);
        costs[border] += cost(below);
        above = join(above, &bins[BINS - 1 - border]);
        costs[BINS - 2 - border] += cost(above);
    }
    costs
}

/// The way to each lamp, a bit a pair from the lowest on, and the longest way. Parents come first, so that a
/// pair's own way is known when it is reached.
fn paths(pairs: &[Pair], lamps: usize) -> (Vec<u32>, u32) {
    let mut to_pair = vec![(0_u32, 0_u32); pairs.len()];
    let mut to_lamp = vec![0; lamps];
    let mut depth = 0;
    for (place, pair) in pairs.iter().enumerate() {
        let (path, level) = to_pair[place];
        depth = depth.max(level + 1);
        for (side, link) in pair.links.into_iter().enumerate() {
            let path = path | (side as u32) << level;
            match link & LEAF {
                0 => to_pair[link as usize] = (path, level + 1),
                _ => to_lamp[(link & !LEAF) as usize] = path,
            }
        }
    }
    (to_lamp, depth)
}

fn encoded(pair: &Pair) -> [ChoiceEntry; 3] {
    let strongest = pair.groups[0].power.max(pair.groups[1].power);
    // Powers as shares of the larger: their own range may be beyond f32's.
    let power = |group: &Group| match strongest > 0.0 {
        true => (group.power / strongest) as f32,
        false => 1.0,
    };
    let [first, second] = pair.groups;
    let last = [power(&first).to_bits(), power(&second).to_bits()];
    [
        ball(&first),
        ball(&second),
        [last[0], last[1], pair.links[0], pair.links[1]],
    ]
}

fn ball(group: &Group) -> ChoiceEntry {
    let [x, y, z] = group.center.as_vec3().to_array().map(f32::to_bits);
    [x, y, z, (group.radius as f32).to_bits()]
}

fn four(paths: &[u32]) -> ChoiceEntry {
    std::array::from_fn(|lane| paths.get(lane).copied().unwrap_or(0))
}
