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

fn to_sphere(center: vec3<f32>, radius: f32, ray: Ray, body: u32) -> f32 {
    return first_distance(intersect_sphere(center, radius, ray), ray, body);
}

// `inverse` is that of the ray's direction.
fn to_box(center: vec3<f32>, half_size: vec3<f32>, inverse: vec3<f32>, ray: Ray, body: u32) -> f32 {
    return first_distance(intersect_box(half_size, ray.origin - center, inverse), ray, body);
}

fn to_rotated_box(shape: Box, ray: Ray) -> f32 {
    return first_distance(rotated_box_crossing(shape, ray), ray, shape.body);
}

fn nearer(best: Hit, distance: f32, body: u32) -> Hit {
    let closer = distance > 0.0 && distance < best.distance;
    return Hit(select(best.distance, distance, closer), select(best.body, body, closer));
}

fn blocks(distance: f32, reach: f32) -> bool {
    return (distance > 0.0) & (distance < reach);
}

// How many iterations this lane may take: there is nothing to count.
fn allow(iterations: u32) {}

// Whether a traversal was left before its end: these never are.
fn cut_short() -> bool {
    return false;
}
