// A camera at the origin, a pinhole or a thin lens: the host moves the scene, not the camera, so that
// what is near the eye has small coordinates.

// #import maths

override FILTER: u32;
// 1: the camera has a lens.
override LENS: u32;

struct Camera {
    // Direction through the middle of the image.
    forward: vec3<f32>,
    // Radius of the lens, scene units; 0 for a pinhole.
    aperture: f32,
    // From the middle to the right edge, for a forward of length 1.
    right: vec3<f32>,
    // Distance along `forward` of the plane in focus.
    focus: f32,
    // From the middle to the lower edge.
    down: vec3<f32>,
    // 2 / width and 2 / height.
    pixel: vec2<f32>,
}

// Inverse of the tent's distribution function on [-1, 1]: density 1 - |x|.
fn tent(u: f32) -> f32 {
    let v = 2.0 * u;
    return select(1.0 - root(2.0 - v), root(v) - 1.0, v < 1.0);
}

// Where in the image a path starts, in pixels from the upper left corner. The tent stands on the
// pixel's lower left corner, as in the paper's base code.
fn sample_film(pixel: vec2<u32>, u: vec2<f32>) -> vec2<f32> {
    let corner = vec2<f32>(pixel);
    if FILTER == FILTER_TENT {
        return vec2<f32>(corner.x + tent(u.x), corner.y + 1.0 - tent(u.y));
    }
    return corner + u;
}

// Unit direction from the eye through a place in the image.
fn camera_direction(camera: Camera, film: vec2<f32>) -> vec3<f32> {
    let at = film * camera.pixel - 1.0;
    return normalize(camera.forward + at.x * camera.right + at.y * camera.down);
}

// A point of the lens, even by area: a disc about the eye, across the direction of view.
fn sample_lens(camera: Camera, u: vec2<f32>) -> vec3<f32> {
    let basis = basis_around(camera.forward);
    let at = camera.aperture * root(u.x) * unit_circle(u.y);
    return at.x * basis.x + at.y * basis.y;
}

// Unit direction from a point of the lens to where the ray from its middle through the same place in the
// image meets the plane in focus: a thin lens leaves that ray as it is and gathers all others there.
fn lens_direction(camera: Camera, film: vec2<f32>, lens: vec3<f32>) -> vec3<f32> {
    let at = film * camera.pixel - 1.0;
    let middle = camera.forward + at.x * camera.right + at.y * camera.down;
    return normalize(camera.focus * middle - lens);
}
