// The scene as every kernel that traces it sees it: nearest hit, any hit, and what was hit.
//
// The one library that reads bindings: group 0 is the scene. The host prints them, as one uniform
// buffer where the scene is small and as storage buffers where it is not, with the functions that
// read them: material_at, sphere_at, box_at and lamp_at. Boxes come with the unrotated ones first.
// A body is a sphere or a box, counted from 1 in that order.

// #import maths
// #import ray
// #import sphere
// #import box
// #import scatter
// #import light

override SPHERE_COUNT: u32;
override BOX_COUNT: u32;
override ROTATED_BOX_COUNT: u32;
override LAMP_COUNT: u32;

struct Hit {
    distance: f32,
    // 0: nothing.
    body: u32,
}

struct Surface {
    point: vec3<f32>,
    // Faces the arriving ray.
    normal: vec3<f32>,
    material: u32,
    // 1 + index among the lamps; 0 for what is no lamp.
    lamp: u32,
    // The body that was hit, and whether from inside it.
    body: u32,
    inside: bool,
    // Place in the scene file: spheres from 1 on, then boxes.
    id: u32,
}

fn rotated_box_crossing(shape: Box, ray: Ray) -> Crossing {
    let from_center = box_local(shape, ray.origin - shape.center);
    return intersect_box(shape.half_size, from_center, safe_inverse(box_local(shape, ray.direction)));
}

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

// Whether anything but the body `target_body` stands nearer than `reach`.
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
        blocked = blocked || (distance > 0.0 && distance < reach);
    }
    for (var i = BOX_COUNT; i < BOX_COUNT + ROTATED_BOX_COUNT; i++) {
        let distance = first_distance(rotated_box_crossing(box_at(i), ray), ray, SPHERE_COUNT + i + 1u);
        blocked = blocked || (distance > 0.0 && distance < reach);
    }
    return blocked;
}

fn sphere_surface(index: u32, hit: Hit, ray: Ray) -> Surface {
    let center = sphere_at(index).center;
    let radius = sphere_at(index).radius;
    let outward = sphere_normal(center, ray.origin + hit.distance * ray.direction);
    let inside = dot(outward, ray.direction) > 0.0;
    // The point is put back on the sphere: errors do not grow with the distance travelled.
    return Surface(
        center + radius * outward,
        select(outward, -outward, inside),
        sphere_at(index).material,
        sphere_at(index).lamp,
        hit.body,
        inside,
        index + 1u,
    );
}

fn box_surface(index: u32, hit: Hit, ray: Ray) -> Surface {
    let shape = box_at(index);
    let rotated = ROTATED_BOX_COUNT > 0u && index >= BOX_COUNT;
    var origin = ray.origin - shape.center;
    var direction = ray.direction;
    if rotated {
        origin = box_local(shape, origin);
        direction = box_local(shape, direction);
    }
    let inside = ray.source == hit.body || all(abs(origin) < shape.half_size);
    let face = box_face(shape.half_size, origin + hit.distance * direction, select(-direction, direction, inside));
    var point = face.point;
    var outward = face.normal;
    if rotated {
        point = box_world(shape, point);
        outward = box_world(shape, outward);
    }
    return Surface(
        shape.center + point,
        select(outward, -outward, inside),
        shape.material,
        0u,
        hit.body,
        inside,
        shape.id,
    );
}

// Only for a hit of something.
fn surface_at(hit: Hit, ray: Ray) -> Surface {
    if hit.body <= SPHERE_COUNT {
        return sphere_surface(hit.body - 1u, hit, ray);
    }
    return box_surface(hit.body - SPHERE_COUNT - 1u, hit, ray);
}
