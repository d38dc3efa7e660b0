// The baked traversal: what the general one does, straight down. This is the part that is the same for
// every scene; the host prints the rest (src/shader/bake): `nearest_hit` and `occluded` with one line
// a body, each line one call of a function below, and the functions that read the scene.
//
// Bodies come in the general traversal's order and are met by the same functions of the same numbers:
// it finds the same, bit for bit.

// #import maths
// #import ray
// #import sphere
// #import box
// #import scene

fn to_sphere(center: vec3<f32>, radius: f32, ray: Ray, body: u32) -> Meeting {
    return first_meeting(intersect_sphere(center, radius, ray), ray, body);
}

// `inverse` is that of the ray's direction.
fn to_box(center: vec3<f32>, half_size: vec3<f32>, inverse: vec3<f32>, ray: Ray, body: u32) -> Meeting {
    return first_meeting(intersect_box(half_size, ray.origin - center, inverse), ray, body);
}

fn to_rotated_box(shape: Box, ray: Ray) -> Meeting {
    return first_meeting(rotated_box_crossing(shape, ray), ray, shape.body);
}

fn nearer(best: Hit, meeting: Meeting, body: u32) -> Hit {
    let closer = meeting.met & (meeting.distance < best.distance);
    return Hit(select(best.distance, meeting.distance, closer), select(best.body, body, closer));
}

// What `first_distance` makes of the nearest meeting.
fn found(best: Hit) -> Hit {
    return Hit(greater(best.distance, 1e-30), best.body);
}

fn blocks(meeting: Meeting, reach: f32) -> bool {
    return meeting.met & (meeting.distance < reach);
}

// How many iterations this lane may take: there is nothing to count.
fn allow(iterations: u32) {}

// Whether a traversal was left before its end: these never are.
fn cut_short() -> bool {
    return false;
}
