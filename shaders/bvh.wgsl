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

// Entries of the list before those of the bodies outside the tree.
const HEADER: u32 = 3u;
// In an inner node and in the leaf of a box; in the leaf of a box alone.
const NOT_SPHERE: u32 = 0x80000000u;
const BOX: u32 = 0x40000000u;
// Boxes grow by this share of the distance to the farthest that the tree holds. Rounding moves rays and
// bodies by less than half of it there: six units in the last place of the distance where
// `intersect_sphere` squares it, and ten where the direction's length is that far from one.
const SLACK: f32 = 4e-6;

// Iterations of this lane's loops so far. Mesa's software drivers leave every loop of an invocation
// after 65,535 of them; the host says how many each lane may take.
var<private> spent: u32;

// A ray among the nodes.
struct Walk {
    // On each axis a grid line's distance is start + number * step; starts are moved outwards by the
    // slack, for the box's near and far side.
    step: vec3<f32>,
    near_start: vec3<f32>,
    far_start: vec3<f32>,
    // Where in a node's words the near side's number is: 0 or 16.
    near_shift: vec3<u32>,
    // The entry in hand, and that behind the last.
    node: u32,
    end: u32,
}

fn cut_short() -> bool {
    return spent >= node_at(2u).y;
}

fn start_walk(ray: Ray) -> Walk {
    let order_length = node_at(0u).w;
    let cell = bitcast<vec3<f32>>(node_at(1u).xyz);
    let lower = bitcast<vec3<f32>>(node_at(0u).xyz) - ray.origin;
    let half_diagonal = bitcast<f32>(node_at(2u).z);
    let inverse = safe_inverse(ray.direction);
    let slack = SLACK * (length(lower + 32767.5 * cell) + half_diagonal) * abs(inverse);
    let backwards = inverse < vec3<f32>(0.0);
    let bits = select(vec3<u32>(0u), vec3<u32>(1u, 2u, 4u), backwards);
    let octant = (bits.x | bits.y | bits.z) & node_at(1u).w;
    let first = HEADER + node_at(2u).x + octant * order_length;
    return Walk(
        cell * inverse,
        lower * inverse - slack,
        lower * inverse + slack,
        select(vec3<u32>(0u), vec3<u32>(16u), backwards),
        first,
        first + order_length,
    );
}

// Whether a ray enters an inner node's box nearer than `reach`.
fn enters(walk: Walk, node: vec4<u32>, reach: f32) -> bool {
    let near_line = (node.xyz >> walk.near_shift) & vec3<u32>(0xffffu);
    let far_line = (node.xyz >> (vec3<u32>(16u) - walk.near_shift)) & vec3<u32>(0xffffu);
    // Signed numbers are the ones that processors convert.
    let enter = vec3<f32>(bitcast<vec3<i32>>(near_line)) * walk.step + walk.near_start;
    let leave = vec3<f32>(bitcast<vec3<i32>>(far_line)) * walk.step + walk.far_start;
    let near = greater(greater(enter.x, enter.y), greater(enter.z, 0.0));
    let far = lesser(lesser(leave.x, leave.y), lesser(leave.z, reach));
    return near <= far;
}

fn box_crossing(index: u32, ray: Ray) -> Crossing {
    let shape = box_at(index);
    if index >= BOX_COUNT {
        return rotated_box_crossing(shape, ray);
    }
    return intersect_box(shape.half_size, ray.origin - shape.center, safe_inverse(ray.direction));
}

// First distance to the body of a leaf, which is entry number `place`; none where it cannot be nearer
// than `reach`, nor as near.
fn leaf_hit(leaf: vec4<u32>, place: u32, ray: Ray, reach: f32) -> Hit {
    var crossing: Crossing;
    if leaf.w >= NOT_SPHERE {
        crossing = box_crossing(leaf.x, ray);
    } else {
        crossing = intersect_sphere(bitcast<vec3<f32>>(leaf.xyz), bitcast<f32>(leaf.w), ray);
    }
    let ahead = select(crossing.far, crossing.near, crossing.near > 0.0);
    if !crossing.met || ahead > reach || ahead <= 0.0 {
        return Hit(-1.0, 0u);
    }
    let body = node_body_at(place);
    return Hit(first_distance(crossing, ray, body), body);
}

// The far side of the body that the ray starts inside of. It is found whatever the rounding, and so
// not left to boxes.
fn own_hit(ray: Ray) -> Hit {
    if !ray.inside {
        return Hit(-1.0, 0u);
    }
    if ray.source > SPHERE_COUNT {
        return Hit(first_distance(box_crossing(ray.source - SPHERE_COUNT - 1u, ray), ray, ray.source), ray.source);
    }
    let own = sphere_at(ray.source - 1u);
    return Hit(first_distance(intersect_sphere(own.center, own.radius, ray), ray, ray.source), ray.source);
}

// The nearer of two hits; of equal ones that of the first body.
fn nearer(best: Hit, other: Hit) -> Hit {
    let first = other.distance == best.distance && other.body < best.body;
    let closer = other.distance > 0.0 && (other.distance < best.distance || first);
    return Hit(select(best.distance, other.distance, closer), select(best.body, other.body, closer));
}

fn blocks(hit: Hit, reach: f32, target_body: u32) -> bool {
    return hit.distance > 0.0 && hit.distance < reach && hit.body != target_body;
}

// One entry of the list. At the end it stays there.
fn visit_nearest(walk: ptr<function, Walk>, best: ptr<function, Hit>, ray: Ray) {
    let place = (*walk).node;
    let node = node_at(place);
    var next = place + 1u;
    if (node.w & (NOT_SPHERE | BOX)) == NOT_SPHERE {
        if !enters(*walk, node, (*best).distance) {
            next = place + (node.w & ~NOT_SPHERE);
        }
    } else {
        *best = nearer(*best, leaf_hit(node, place, ray, (*best).distance));
    }
    (*walk).node = min(next, (*walk).end);
}

fn nearest_hit(ray: Ray) -> Hit {
    let outside = node_at(2u).x;
    spent += LAMP_COUNT + outside + 3u;
    var best = nearer(Hit(3e38, 0u), own_hit(ray));
    for (var place = HEADER; place < HEADER + outside; place++) {
        best = nearer(best, leaf_hit(node_at(place), place, ray, best.distance));
    }
    var walk = start_walk(ray);
    while walk.node < walk.end && !cut_short() {
        spent += 1u;
        visit_nearest(&walk, &best, ray);
        visit_nearest(&walk, &best, ray);
        visit_nearest(&walk, &best, ray);
        visit_nearest(&walk, &best, ray);
    }
    return best;
}

// One entry of the list; whether its body stands in the way.
fn visit_any(walk: ptr<function, Walk>, ray: Ray, reach: f32, target_body: u32) -> bool {
    let place = (*walk).node;
    let node = node_at(place);
    var next = place + 1u;
    var blocked = false;
    if (node.w & (NOT_SPHERE | BOX)) == NOT_SPHERE {
        if !enters(*walk, node, reach) {
            next = place + (node.w & ~NOT_SPHERE);
        }
    } else {
        blocked = blocks(leaf_hit(node, place, ray, reach), reach, target_body);
    }
    (*walk).node = select(min(next, (*walk).end), (*walk).end, blocked);
    return blocked;
}

// Whether anything but the body `target_body` stands nearer than `reach`.
fn occluded(ray: Ray, reach: f32, target_body: u32) -> bool {
    if cut_short() {
        return true;
    }
    let outside = node_at(2u).x;
    spent += outside + 2u;
    var blocked = blocks(own_hit(ray), reach, target_body);
    for (var place = HEADER; place < HEADER + outside; place++) {
        let blocks_too = blocks(leaf_hit(node_at(place), place, ray, reach), reach, target_body);
        blocked = blocked || blocks_too;
    }
    var walk = start_walk(ray);
    walk.node = select(walk.node, walk.end, blocked);
    while walk.node < walk.end && !cut_short() {
        spent += 1u;
        let first = visit_any(&walk, ray, reach, target_body);
        let second = visit_any(&walk, ray, reach, target_body);
        let third = visit_any(&walk, ray, reach, target_body);
        let fourth = visit_any(&walk, ray, reach, target_body);
        blocked = blocked || first || second || third || fourth;
    }
    return blocked;
}
