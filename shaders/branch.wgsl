// Paths that split: the branches of a path are traced one after the other. Where a path splits it goes on as
// the first of its branches, and the place waits here for the others.

// #import sequence
// #import scene

// What one path may split into, all of its branches together.
override INTERRUPTION_SPLIT: u32;

// Each split at least halves the branches that a path may still become: so deep are splits within splits.
const DEEPEST_SPLIT: u32 = 4u;

// A hit from which more branches have to leave.
struct Branching {
    key: vec4<u32>,
    vertex: u32,
    throughput: vec3<f32>,
    incoming: vec3<f32>,
    surface: Surface,
    origin: vec3<f32>,
    // Branches that have not left yet, and what each may become.
    left: u32,
    allowed: u32,
}

var<private> branchings: array<Branching, DEEPEST_SPLIT>;
var<private> branchings_open: u32;
// What the branch in hand may become: 1 where it splits no more.
var<private> branches_allowed: u32;

// For each path anew.
fn begin_branches() {
    branchings_open = 0u;
    branches_allowed = INTERRUPTION_SPLIT;
}

// The branch in hand splits into `count`, of which it goes on as one. What it may become is shared out evenly.
fn open_branching(branching: Branching, count: u32) {
    if count < 2u {
        return;
    }
    branches_allowed /= count;
    branchings[branchings_open] = branching;
    branchings[branchings_open].left = count - 1u;
    branchings[branchings_open].allowed = branches_allowed;
    branchings_open += 1u;
}

// The next branch that has not left; only where one is open. Its key is its own.
fn take_branch() -> Branching {
    let last = branchings_open - 1u;
    var branching = branchings[last];
    branchings[last].left -= 1u;
    branchings_open -= select(0u, 1u, branching.left == 1u);
    branches_allowed = branching.allowed;
    branching.key = sequence_branch(branching.key, branching.vertex + 1u, branching.left);
    return branching;
}
