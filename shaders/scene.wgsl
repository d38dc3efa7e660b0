// The scene as every kernel that traces it sees it, and what was hit of it. What is hit comes from a
// traversal: `loops`, `bvh` or `baked`, files with the same functions of which a kernel gets one; the
// host prints half of the last.
//
// This library, `choice` and the traversals alone read bindings: group 0 is the scene. The host prints them,
// as one uniform buffer where the scene is small and as storage buffers where it is not, with the functions that
// read them: material_at, sphere_at, box_at, lamp_at, choice_at and worth_at. Boxes come with the unrotated ones first.
// A body is a sphere or a box, counted from 1 in that order.

// #import maths
// #import ray
// #import sphere
// #import box
// #import scatter
// #import light
// #import efficiency

override SPHERE_COUNT: u32;
override BOX_COUNT: u32;
override ROTATED_BOX_COUNT: u32;
override LAMP_COUNT: u32;
// 1: boxes that shine are lamps.
override BOX_LAMPS: u32;

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
        select(0u, shape.lamp, BOX_LAMPS == 1u),
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
