// Small functions that WGSL lacks, or that it leaves too loose to share with the CPU twin.
// All polynomials are least-maximum-error fits made for this project.

const PI: f32 = 3.1415927;

// The smaller and the larger of two numbers that are never NaN. The built-in min and max carry
// fix-ups for NaN that cost a sixth of the whole kernel on lavapipe.
fn lesser(a: f32, b: f32) -> f32 {
    return select(b, a, a < b);
}

fn greater(a: f32, b: f32) -> f32 {
    return select(b, a, a > b);
}

// Largest of three channels.
fn largest(v: vec3<f32>) -> f32 {
    return greater(v.x, greater(v.y, v.z));
}

// A vector made one of unit length, with one root and one division.
fn unit_vector(v: vec3<f32>) -> vec3<f32> {
    return v * inverseSqrt(dot(v, v));
}

// The same for one whose length is off by rounding only: one step of Newton's method, without a root.
fn unit_vector_again(v: vec3<f32>) -> vec3<f32> {
    return v * (1.5 - 0.5 * dot(v, v));
}

// Square root of a number that rounding may have pushed below zero.
fn root(x: f32) -> f32 {
    return sqrt(greater(x, 0.0));
}

// Sine and cosine of x turns, -1/2 <= x <= 1/2, as (sin, cos). Absolute error below 5e-7, and
// relative error below 5e-7 for the sine of a small angle.
// With h half the angle: sin 2h = 2 sin h cos h, cos 2h = (cos h - sin h)(cos h + sin h).
fn sincos_turn(x: f32) -> vec2<f32> {
    let z = x * x;
    let s = x * (3.1415927 + z * (-5.1677103 + z * (2.5500777 + z * (-0.59829217 + z * 0.077659406))));
    let c = 1.0 + z * (-4.934802 + z * (4.0587091 + z * (-1.3352121 + z * (0.23493756 + z * -0.024396716))));
    return vec2<f32>(2.0 * s * c, (c - s) * (c + s));
}

// A point of the unit circle, (cos, sin), evenly distributed for even u in [0, 1).
fn unit_circle(u: f32) -> vec2<f32> {
    return sincos_turn(u - 0.5).yx;
}

// A point of the unit sphere, even by area: z even in (-1, 1] (Archimedes).
fn unit_sphere(u: vec2<f32>) -> vec3<f32> {
    let around = unit_circle(u.y);
    return vec3<f32>(2.0 * root(u.x * (1.0 - u.x)) * around, 1.0 - 2.0 * u.x);
}

// A direction by its cosine to `normal`: to a point of the unit sphere that stands on the surface.
fn sample_cosine(normal: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    let sum = normal + unit_sphere(u);
    let size = dot(sum, sum);
    return select(normal, sum * inverseSqrt(greater(size, 1e-12)), size > 1e-12);
}

// The angle between two unit vectors whose difference has length `chord`, up to a right angle:
// 2 asin(chord / 2). Relative error below 3e-7 for chord <= sqrt(2.02).
fn angle_of_chord(chord: f32) -> f32 {
    let z = chord * chord;
    let tail = z * (5.3821448e-5 + z * (8.2484206e-5 + z * (-2.5252846e-5 + z * 7.1720823e-6)));
    return chord * (1.0 + z * (0.041667689 + z * (0.0046775518 + z * (7.3408539e-4 + tail))));
}

// Inverse error function, 0 <= x < 1. Relative error below 2e-6. The split into a centre in
// w = -ln(1 - x^2) and a tail in sqrt(w) follows Giles, "Approximating the erfinv function" (2010).
fn inverse_erf(x: f32) -> f32 {
    let w = -log((1.0 - x) * (1.0 + x));
    let a = w - 2.5;
    let centre = 1.5014092 + a * (0.24664105 + a * (-0.0041760849 + a * (-0.0012541452
        + a * (2.1726055e-4 + a * (-4.2539345e-6 + a * (-3.1777552e-6 + a * 3.3049287e-7))))));
    let b = sqrt(greater(w, 5.0)) - 3.0;
    let tail = 2.8329773 + b * (1.0016809 + b * (0.0094274422 + b * (-0.007706454
        + b * (0.0058202855 + b * (-0.0034127268 + b * (0.0011295323 + b * -1.3250714e-4))))));
    return x * select(tail, centre, w < 5.0);
}

// Three perpendicular unit vectors; z is the one given.
struct Basis {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>,
}

// Duff et al., "Building an Orthonormal Basis, Revisited" (JCGT 2017).
fn basis_around(z: vec3<f32>) -> Basis {
    let s = select(-1.0, 1.0, z.z >= 0.0);
    let a = -1.0 / (s + z.z);
    let b = z.x * z.y * a;
    return Basis(
        vec3<f32>(1.0 + s * z.x * z.x * a, s * b, -s * z.x),
        vec3<f32>(b, s + z.y * z.y * a, -z.y),
        z,
    );
}

fn from_basis(basis: Basis, v: vec3<f32>) -> vec3<f32> {
    return v.x * basis.x + v.y * basis.y + v.z * basis.z;
}

// Whether a number is NaN or infinite, by its bits: compilers may assume that neither occurs.
fn is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

fn all_finite(v: vec3<f32>) -> bool {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}
