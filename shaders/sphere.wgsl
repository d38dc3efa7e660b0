// Rays against spheres.

// #import maths
// #import ray

struct Sphere {
    center: vec3<f32>,
    radius: f32,
    material: u32,
    // 1 + index among the lamps; 0 for a sphere that does not shine.
    lamp: u32,
    // 1 + place among the bodies.
    body: u32,
    _pad0: u32,
}

// Distances at which the ray enters and leaves; `met` is false where it passes by.
// The discriminant comes from the vector between centre and ray, and the roots without
// cancellation (Haines, Guenther and Akenine-Moeller, Ray Tracing Gems, 2019, chapter 7).
fn intersect_sphere(center: vec3<f32>, radius: f32, ray: Ray) -> Crossing {
    let from_center = ray.origin - center;
    let b = -dot(from_center, ray.direction);
    let nearest = from_center + b * ray.direction;
    let discriminant = radius * radius - dot(nearest, nearest);
    let c = dot(from_center, from_center) - radius * radius;
    let half_chord = root(discriminant);
    let q = b + select(-half_chord, half_chord, b >= 0.0);
    // q is zero only for a ray that starts on the sphere and grazes it.
    let other = c / select(q, 1e-30, q == 0.0);
    return Crossing(
        select(q, other, b >= 0.0),
        select(other, q, b >= 0.0),
        discriminant >= 0.0,
    );
}

// Outward unit normal at the point of the sphere nearest to `point`.
fn sphere_normal(center: vec3<f32>, point: vec3<f32>) -> vec3<f32> {
    return unit_vector(point - center);
}
