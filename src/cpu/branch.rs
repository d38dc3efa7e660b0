//! Twin of `shaders/branch.wgsl`: paths that split; their branches are traced one after the other. Here whoever
//! wants to know what each branch brought is told.

use super::scene::Surface;
use super::sequence::sequence_branch;
use crate::pack::Strategy;
use glam::Vec3;

/// A hit from which more branches have to leave.
#[derive(Clone, Copy, Debug)]
pub struct Branching {
    pub key: [u32; 4],
    pub vertex: u32,
    pub throughput: Vec3,
    pub incoming: Vec3,
    pub surface: Surface,
    pub origin: Vec3,
    /// Branches that have not left yet, and what each may become.
    pub left: u32,
    pub allowed: u32,
    /// The hit's number among those that somebody watches.
    pub hit: u32,
}

/// What left a hit of a body and came back, for a path that carried one.
#[derive(Clone, Copy, Debug)]
pub struct Return {
    pub body: u32,
    /// The hit that it left, of all hits that somebody watched.
    pub hit: u32,
    pub radiance: Vec3,
    pub rays: u32,
}

/// A branch on its way, and what its path had when it left.
#[derive(Clone, Copy, Debug)]
struct Leaving {
    body: u32,
    hit: u32,
    throughput: Vec3,
    radiance: Vec3,
    rays: u32,
    /// Branchings that were open then.
    open: usize,
}

/// Branches that left and came back.
#[derive(Debug, Default)]
struct Returns {
    hits: u32,
    away: Vec<Leaving>,
    back: Vec<Return>,
}

/// The branches of one path.
#[derive(Debug, Default)]
pub struct Branches {
    open: Vec<Branching>,
    /// What the branch in hand may become: 1 where it splits no more.
    pub allowed: u32,
    /// Where somebody asks what each branch brought.
    returns: Option<Returns>,
    /// Whether paths split in two wherever they may.
    twins: bool,
}

impl Branches {
    /// Of somebody who asks what each branch brings. Where `twins` are wanted paths split in two wherever they may:
    /// two branches of one hit tell how much of what they bring is chance.
    pub fn watched(twins: bool) -> Self {
        Self {
            returns: Some(Returns::default()),
            twins,
            ..Self::default()
        }
    }

    /// How many branches should leave, for a hit that asks for so many.
    pub fn wanted(&self, asked: f32) -> f32 {
        match self.twins && self.allowed > 1 {
            true => 2.0,
            false => asked,
        }
    }

    /// All that came back, in the order in which it did.
    pub fn returned(self) -> Vec<Return> {
        self.returns.map_or_else(Vec::new, |returns| returns.back)
    }

    /// For each path anew.
    pub fn begin(&mut self, split: u32) {
        self.open.clear();
        self.allowed = split;
    }

    /// The branch in hand splits into `count`, of which it goes on as one.
    pub fn open_branching(&mut self, branching: Branching, count: u32) {
        if count < 2 {
            return;
        }
        self.allowed /= count;
        self.open.push(Branching {
            left: count - 1,
            allowed: self.allowed,
            ..branching
        });
    }

    /// The next branch that has not left, if there is one.
    pub fn take_branch(&mut self, strategy: &Strategy) -> Option<Branching> {
        let last = self.open.last_mut()?;
        let branching = *last;
        last.left -= 1;
        if branching.left == 1 {
            self.open.pop();
        }
        self.allowed = branching.allowed;
        let vertex = branching.vertex + 1;
        let key = sequence_branch(strategy, branching.key, vertex, branching.left);
        Some(Branching { key, ..branching })
    }

    /// A number for a hit that somebody watches.
    pub fn number_hit(&mut self) -> u32 {
        self.returns.as_mut().map_or(0, |returns| {
            returns.hits += 1;
            returns.hits
        })
    }

    /// A branch with this throughput leaves a hit of a body. The path's radiance is counted from zero until it is back,
    /// so that what a branch of little weight brings keeps its digits.
    pub fn leave(&mut self, from: (u32, u32), throughput: Vec3, radiance: &mut Vec3, rays: u32) {
        let (body, hit) = from;
        let Some(returns) = &mut self.returns else {
            return;
        };
        returns.away.push(Leaving {
            body,
            hit,
            throughput,
            radiance: std::mem::take(radiance),
            rays,
            open: self.open.len(),
        });
    }

    /// The path has ended: all branches are back that left since the last place from which another has to leave.
    pub fn come_back(&mut self, radiance: &mut Vec3, rays: u32) {
        let Some(returns) = &mut self.returns else {
            return;
        };
        let open = self.open.len();
        while let Some(leaving) = returns.away.pop_if(|leaving| leaving.open >= open) {
            // A channel that carries nothing brings nothing.
            let share = *radiance / leaving.throughput;
            returns.back.push(Return {
                body: leaving.body,
                hit: leaving.hit,
                radiance: Vec3::select(leaving.throughput.cmpgt(Vec3::ZERO), share, Vec3::ZERO),
                rays: rays - leaving.rays,
            });
            *radiance += leaving.radiance;
        }
    }
}
