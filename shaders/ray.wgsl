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

// Where a ray first meets a body from the side it is on; the distance may be 0 or below where rounding
// has put the start of a ray past the body that it is inside of.
struct Meeting {
    distance: f32,
    met: bool,
}

// A ray that leaves a convex body outwards cannot meet it again, and one that starts on its inner
// side meets the far side and nothing else: so no surface ever shadows itself, and no closed one
// leaks where rounding has put the start of a ray just past an edge, whatever the rounding.
fn first_meeting(crossing: Crossing, ray: Ray, body: u32) -> Meeting {
    let leaves = body == select(ray.source, 0u, ray.inside);
    let within = body == select(0u, ray.source, ray.inside);
    let outside = (crossing.near > 0.0) & !within;
    let ahead = crossing.met & (crossing.far > 0.0);
    return Meeting(select(crossing.far, crossing.near, outside), (ahead & !leaves) | within);
}

// The same as a distance above zero, or -1.
fn first_distance(crossing: Crossing, ray: Ray, body: u32) -> f32 {
    let meeting = first_meeting(crossing, ray, body);
    return select(-1.0, greater(meeting.distance, 1e-30), meeting.met);
}

// A point a few units in the last place off the surface, on the side that `normal` points to.
fn offset_origin(point: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let size = largest(abs(point));
    return point + normal * (size * 1e-6);
}
