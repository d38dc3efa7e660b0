// The traversal by a bounding volume hierarchy, which src/bvh lays out: a list of nodes that is read from
// front to back, past whole subtrees whose box the ray misses (Smits 1998). No stack, one load a step.
//
// It finds what the general traversal finds, bit for bit: bodies are met by the same functions, of equal
// hits the first body's counts, and no box hides a body that those functions meet.

// #import maths
// #import ray
// #import sphere
// #import box
// #import scene

// Few bodies that are large beside all others stand outside the tree.
override OUTSIDE_SPHERE_COUNT: u32;
override OUTSIDE_BOX_COUNT: u32;
override OUTSIDE_ROTATED_COUNT: u32;
// Iterations of the loops over lamps that a step may take.
override LIGHT_LOOPS: u32;

// Entries of the list before the first node.
const HEADER: u32 = 3u;
// In an inner node and in the leaf of a box; in the leaf of a box alone.
const NOT_SPHERE: u32 = 0x80000000u;
const BOX: u32 = 0x40000000u;
// The body that a ray starts inside of, as the entry that it tries first.
const OWN: u32 = 0u;
// Boxes grow by this share of the distance to the farthest that the tree holds. Rounding moves rays and
// bodies by less than half of it there: six units in the last place of the distance where
// `intersect_sphere` squares it, and ten where the direction's length is that far from one.
const SLACK: f32 = 4e-6;

// Iterations of this lane's loops so far. Mesa's software drivers leave every loop of an invocation
// after 65,535 of them; the host says how many each lane may take.
var<private> spent: u32;
var<private> allowed: u32;

// A ray among the nodes.
struct Walk {
    // On each axis a grid line's distance is start + number * step; starts are moved outwards by the
    // slack, for the box's near and far side.
    step: vec3<f32>,
    near_start: vec3<f32>,
    far_start: vec3<f32>,
    // Where in a node's words the near side's number is: 0 or 16.
    near_shift: vec3<u32>,
    // The entry in hand, and its words.
    place: u32,
    node: vec4<u32>,
    // The first entry of the order, and that behind its last.
    first: u32,
    end: u32,
}

// Iterations of the loops over what is outside, each with the last look at its condition.
fn outside_loops() -> u32 {
    return OUTSIDE_SPHERE_COUNT + OUTSIDE_BOX_COUNT + OUTSIDE_ROTATED_COUNT + 3u;
}

fn allow(iterations: u32) {
    allowed = iterations;
}

// Whether this lane has taken all the iterations that it may: what it found is not whole.
fn cut_short() -> bool {
    return spent >= allowed;
}

// The leaf of the body that the ray starts on.
fn own_leaf(ray: Ray) -> vec4<u32> {
    if ray.source > SPHERE_COUNT {
        return vec4<u32>(ray.source - SPHERE_COUNT - 1u, 0u, 0u, NOT_SPHERE | BOX);
    }
    let own = sphere_at(ray.source - 1u);
    return vec4<u32>(bitcast<vec3<u32>>(own.center), bitcast<u32>(own.radius));
}

fn start_walk(ray: Ray) -> Walk {
    let order_length = node_at(0u).w;
    let cell = bitcast<vec3<f32>>(node_at(1u).xyz);
    let lower = bitcast<vec3<f32>>(node_at(0u).xyz) - ray.origin;
    let half_diagonal = bitcast<f32>(node_at(2u).x);
    let inverse = safe_inverse(ray.direction);
    let slack = SLACK * (length(lower + 32767.5 * cell) + half_diagonal) * abs(inverse);
    let backwards = inverse < vec3<f32>(0.0);
    let number = select(vec3<u32>(0u), node_at(2u).yzw, backwards);
    let first = HEADER + (number.x + number.y + number.z) * order_length;
    var walk = Walk(
        cell * inverse,
        lower * inverse - slack,
        lower * inverse + slack,
        select(vec3<u32>(0u), vec3<u32>(16u), backwards),
        first,
        node_at(first),
        first,
        first + order_length,
    );
    if ray.inside {
        walk.place = OWN;
        walk.node = own_leaf(ray);
    }
    return walk;
}

fn go_to(walk: ptr<function, Walk>, place: u32) {
    (*walk).place = min(place, (*walk).end);
    (*walk).node = node_at((*walk).place);
}

// Whether a ray enters an inner node's box nearer than `reach`.
fn enters(walk: Walk, reach: f32) -> bool {
    let lines = walk.node.xyz;
    let near_line = (lines >> walk.near_shift) & vec3<u32>(0xffffu);
    let far_line = (lines >> (vec3<u32>(16u) - walk.near_shift)) & vec3<u32>(0xffffu);
    // Signed numbers are the ones that processors convert.
    let enter = vec3<f32>(bitcast<vec3<i32>>(near_line)) * walk.step + walk.near_start;
    let leave = vec3<f32>(bitcast<vec3<i32>>(far_line)) * walk.step + walk.far_start;
    let near = greater(greater(enter.x, enter.y), greater(enter.z, 0.0));
    let far = lesser(lesser(leave.x, leave.y), lesser(leave.z, reach));
    return near <= far;
}

fn at_leaf(walk: Walk) -> bool {
    return (walk.node.w & (NOT_SPHERE | BOX)) != NOT_SPHERE;
}

// Past an inner node, into it or beyond; leaves are left in hand. At the end of the list it stays there:
// what stands behind it is an idle node, or another order's root, which may be looked at twice.
fn descend(walk: ptr<function, Walk>, reach: f32) {
    if !at_leaf(*walk) {
        let skip = (*walk).node.w & ~NOT_SPHERE;
        go_to(walk, (*walk).place + select(skip, 1u, enters(*walk, reach)));
    }
}

fn box_crossing(shape: Box, rotated: bool, ray: Ray) -> Crossing {
    if rotated {
        return rotated_box_crossing(shape, ray);
    }
    return intersect_box(shape.half_size, ray.origin - shape.center, safe_inverse(ray.direction));
}

// First distance to the body of the leaf in hand; none where it cannot be nearer than `reach`, nor as
// near. The body that the ray starts inside of is met whatever the rounding.
fn leaf_hit(walk: Walk, ray: Ray, reach: f32) -> Hit {
    let leaf = walk.node;
    var crossing: Crossing;
    if leaf.w >= NOT_SPHERE {
        crossing = box_crossing(box_at(leaf.x), leaf.x >= BOX_COUNT, ray);
    } else {
        crossing = intersect_sphere(bitcast<vec3<f32>>(leaf.xyz), bitcast<f32>(leaf.w), ray);
    }
    let ahead = select(crossing.far, crossing.near, crossing.near > 0.0);
    let own = walk.place == OWN;
    if !own && (!crossing.met || ahead > reach || ahead <= 0.0) {
        return Hit(-1.0, 0u);
    }
    let body = select(node_body_at(walk.place), ray.source, own);
    return Hit(first_distance(crossing, ray, body), body);
}

fn after_leaf(walk: Walk) -> u32 {
    return select(walk.place + 1u, walk.first, walk.place == OWN);
}

fn outside_sphere_hit(index: u32, ray: Ray) -> Hit {
    let shape = outside_sphere_at(index);
    return Hit(first_distance(intersect_sphere(shape.center, shape.radius, ray), ray, shape.body), shape.body);
}

fn outside_box_hit(index: u32, inverse: vec3<f32>, ray: Ray) -> Hit {
    let shape = outside_box_at(index);
    let crossing = intersect_box(shape.half_size, ray.origin - shape.center, inverse);
    return Hit(first_distance(crossing, ray, shape.body), shape.body);
}

fn outside_rotated_hit(index: u32, ray: Ray) -> Hit {
    let shape = outside_box_at(index);
    return Hit(first_distance(rotated_box_crossing(shape, ray), ray, shape.body), shape.body);
}

// The nearer of two hits; of equal ones that of the first body.
fn nearer(best: Hit, other: Hit) -> Hit {
    let first = other.distance == best.distance && other.body < best.body;
    let closer = other.distance > 0.0 && (other.distance < best.distance || first);
    return Hit(select(best.distance, other.distance, closer), select(best.body, other.body, closer));
}

fn nearest_outside(ray: Ray) -> Hit {
    var best = Hit(3e38, 0u);
    for (var i = 0u; i < OUTSIDE_SPHERE_COUNT; i++) {
        best = nearer(best, outside_sphere_hit(i, ray));
    }
    let inverse = safe_inverse(ray.direction);
    for (var i = 0u; i < OUTSIDE_BOX_COUNT; i++) {
        best = nearer(best, outside_box_hit(i, inverse, ray));
    }
    for (var i = OUTSIDE_BOX_COUNT; i < OUTSIDE_BOX_COUNT + OUTSIDE_ROTATED_COUNT; i++) {
        best = nearer(best, outside_rotated_hit(i, ray));
    }
    return best;
}

fn nearest_hit(ray: Ray) -> Hit {
    spent += LIGHT_LOOPS + outside_loops() + 3u;
    var best = nearest_outside(ray);
    var walk = start_walk(ray);
    while walk.place < walk.end && !cut_short() {
        spent += 1u;
        descend(&walk, best.distance);
        descend(&walk, best.distance);
        descend(&walk, best.distance);
        if at_leaf(walk) {
            best = nearer(best, leaf_hit(walk, ray, best.distance));
            go_to(&walk, after_leaf(walk));
        }
    }
    return best;
}

fn blocks(hit: Hit, reach: f32, target_body: u32) -> bool {
    return hit.distance > 0.0 && hit.distance < reach && hit.body != target_body;
}

fn blocked_outside(ray: Ray, reach: f32, target_body: u32) -> bool {
    var blocked = false;
    for (var i = 0u; i < OUTSIDE_SPHERE_COUNT; i++) {
        let met = blocks(outside_sphere_hit(i, ray), reach, target_body);
        blocked = blocked || met;
    }
    let inverse = safe_inverse(ray.direction);
    for (var i = 0u; i < OUTSIDE_BOX_COUNT; i++) {
        let met = blocks(outside_box_hit(i, inverse, ray), reach, target_body);
        blocked = blocked || met;
    }
    for (var i = OUTSIDE_BOX_COUNT; i < OUTSIDE_BOX_COUNT + OUTSIDE_ROTATED_COUNT; i++) {
        let met = blocks(outside_rotated_hit(i, ray), reach, target_body);
        blocked = blocked || met;
    }
    return blocked;
}

// Whether anything but the body `target_body` stands nearer than `reach`.
fn occluded(ray: Ray, reach: f32, target_body: u32) -> bool {
    spent += outside_loops() + 1u;
    var blocked = cut_short() || blocked_outside(ray, reach, target_body);
    if blocked {
        return true;
    }
    var walk = start_walk(ray);
    while walk.place < walk.end && !cut_short() {
        spent += 1u;
        descend(&walk, reach);
        descend(&walk, reach);
        descend(&walk, reach);
        if at_leaf(walk) {
            blocked = blocks(leaf_hit(walk, ray, reach), reach, target_body);
            go_to(&walk, select(after_leaf(walk), walk.end, blocked));
        }
    }
    return blocked;
}
