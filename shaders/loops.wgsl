// The general traversal: every body is tried, one after the other.

// #import maths
// #import ray
// #import sphere
// #import box
// #import scene

fn nearest_hit(ray: Ray) -> Hit {
    var best = Hit(3e38, 0u);
    for (var i = 0u; i < SPHERE_COUNT; i++) {
        let distance = first_distance(intersect_sphere(sphere_at(i).center, sphere_at(i).radius, ray), ray, i + 1u);
        let closer = distance > 0.0 && distance < best.distance;
        best = Hit(select(best.distance, distance, closer), select(best.body, i + 1u, closer));
    }
    let inverse = safe_inverse(ray.direction);
    for (var i = 0u; i < BOX_COUNT; i++) {
        let body = SPHERE_COUNT + i + 1u;
        let crossing = intersect_box(box_at(i).half_size, ray.origin - box_at(i).center, inverse);
        let distance = first_distance(crossing, ray, body);
        let closer = distance > 0.0 && distance < best.distance;
        best = Hit(select(best.distance, distance, closer), select(best.body, body, closer));
    }
    for (var i = BOX_COUNT; i < BOX_COUNT + ROTATED_BOX_COUNT; i++) {
        let body = SPHERE_COUNT + i + 1u;
        let distance = first_distance(rotated_box_crossing(box_at(i), ray), ray, body);
        let closer = distance > 0.0 && distance < best.distance;
        best = Hit(select(best.distance, distance, closer), select(best.body, body, closer));
    }
    return best;
}

// Whether anything but the body `target_body` stands nearer than `reach`; that is a sphere unless boxes are lamps.
fn occluded(ray: Ray, reach: f32, target_body: u32) -> bool {
    var blocked = false;
    for (var i = 0u; i < SPHERE_COUNT; i++) {
        let distance = first_distance(intersect_sphere(sphere_at(i).center, sphere_at(i).radius, ray), ray, i + 1u);
        blocked = blocked || (distance > 0.0 && distance < reach && i + 1u != target_body);
    }
    let inverse = safe_inverse(ray.direction);
    for (var i = 0u; i < BOX_COUNT; i++) {
        let crossing = intersect_box(box_at(i).half_size, ray.origin - box_at(i).center, inverse);
        let distance = first_distance(crossing, ray, SPHERE_COUNT + i + 1u);
        let other = BOX_LAMPS == 0u || SPHERE_COUNT + i + 1u != target_body;
        blocked = blocked || (distance > 0.0 && distance < reach && other);
    }
    for (var i = BOX_COUNT; i < BOX_COUNT + ROTATED_BOX_COUNT; i++) {
        let distance = first_distance(rotated_box_crossing(box_at(i), ray), ray, SPHERE_COUNT + i + 1u);
        let other = BOX_LAMPS == 0u || SPHERE_COUNT + i + 1u != target_body;
        blocked = blocked || (distance > 0.0 && distance < reach && other);
    }
    return blocked;
}

// How many iterations this lane may take: the host sees to it that these loops need no more.
fn allow(iterations: u32) {}

// Whether a traversal was left before its end: these never are.
fn cut_short() -> bool {
    return false;
}
