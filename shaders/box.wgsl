// Rays against boxes, by slabs. A rotated box is met by a ray turned into the box's own axes.

// #import maths
// #import ray

struct Box {
    center: vec3<f32>,
    material: u32,
    half_size: vec3<f32>,
    // Place in the scene file: spheres from 1 on, then boxes.
    id: u32,
    // The box's axes, as rows of the rotation into its own frame.
    axis_x: vec3<f32>,
    // 1 + place among the bodies.
    body: u32,
    axis_y: vec3<f32>,
    // 1 + index among the lamps; 0 for a box that is none.
    lamp: u32,
    axis_z: vec3<f32>,
    _pad1: u32,
}

// Into the box's own axes.
fn box_local(shape: Box, v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(shape.axis_x, v), dot(shape.axis_y, v), dot(shape.axis_z, v));
}

// Back into the scene's axes.
fn box_world(shape: Box, v: vec3<f32>) -> vec3<f32> {
    return v.x * shape.axis_x + v.y * shape.axis_y + v.z * shape.axis_z;
}

// One over each component, with zero read as a tiny number: finite, so that no slab is ever NaN.
fn safe_inverse(v: vec3<f32>) -> vec3<f32> {
    let tiny = vec3<f32>(1e-12);
    return 1.0 / select(v, select(-tiny, tiny, v >= vec3<f32>(0.0)), abs(v) < tiny);
}

// `from_center` and `inverse` (of the direction) are in the box's own axes. The far distance is
// padded by two units in the last place, so that no ray slips between two walls that touch
// (Ize, "Robust BVH Ray Traversal", JCGT 2013).
fn intersect_box(half_size: vec3<f32>, from_center: vec3<f32>, inverse: vec3<f32>) -> Crossing {
    let middle = -from_center * inverse;
    let reach = half_size * abs(inverse);
    let enter = middle - reach;
    let leave = middle + reach;
    let near = greater(enter.x, greater(enter.y, enter.z));
    let far = lesser(leave.x, lesser(leave.y, leave.z)) * 1.0000002;
    return Crossing(near, far, near <= far && far > 0.0);
}

// A point of a box and the outward normal there, in the box's own axes.
struct Face {
    point: vec3<f32>,
    normal: vec3<f32>,
}

// The face nearest to `local`, with the point put on it. `outward` says on which side of each axis
// the face must be, so that thin boxes never show the wrong one.
fn box_face(half_size: vec3<f32>, local: vec3<f32>, outward: vec3<f32>) -> Face {
    let depth = abs(local) - half_size;
    let along_x = depth.x >= depth.y && depth.x >= depth.z;
    let along_y = !along_x && depth.y >= depth.z;
    let axis = vec3<bool>(along_x, along_y, !along_x && !along_y);
    let side = select(vec3<f32>(-1.0), vec3<f32>(1.0), outward >= vec3<f32>(0.0));
    let kept = clamp(local, -half_size, half_size);
    return Face(
        select(kept, side * half_size, axis),
        select(vec3<f32>(0.0), side, axis),
    );
}
