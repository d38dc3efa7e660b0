// A ray, what it crosses, and the rule for the body it starts on.

// #import maths

struct Ray {
    origin: vec3<f32>,
    // Unit length.
    direction: vec3<f32>,
    // 1 + index of the body that the ray starts on; 0 for none.
    source: u32,
    // Whether the ray starts on that body's inner side.
    inside: bool,
}

// Where a ray enters and leaves a convex body.
struct Crossing {
    near: f32,
    far: f32,
    met: bool,
}

// The first distance at which a ray meets a body from the side it is on, or -1.
// A ray that leaves a convex body outwards cannot meet it again, and one that starts on its inner
// side meets the far side and nothing else: so no surface ever shadows itself, and no closed one
// leaks where rounding has put the start of a ray just past an edge, whatever the rounding.
fn first_distance(crossing: Crossing, ray: Ray, body: u32) -> f32 {
    let own = ray.source == body;
    let outside = crossing.near > 0.0 && !own;
    let distance = select(crossing.far, crossing.near, outside);
    let kept = select(distance, greater(distance, 1e-30), own);
    return select(-1.0, kept, select(crossing.met, ray.inside, own));
}

// A point a few units in the last place off the surface, on the side that `normal` points to.
fn offset_origin(point: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let size = largest(abs(point));
    return point + normal * (size * 1e-6);
}
