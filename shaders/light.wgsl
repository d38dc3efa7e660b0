// Points on spherical lamps: sample and density (paper, section 2.2).
//
// Everything is said as the inverse of a density by solid angle, seen from `origin`: it stays
// finite where a density does not, and 0 means "never drawn".

// #import maths

override LIGHT_SAMPLER: u32;
override LIGHT_WEIGHT: u32;
// 1: the pole of the first two samplers points from the lamp to the lit point.
override POLE_AT_RECEIVER: u32;

struct Lamp {
    center: vec3<f32>,
    radius: f32,
    emission: vec3<f32>,
    // 1 + place among the packed bodies.
    body: u32,
    // Radius s of the solid-angle weight.
    weight_radius: f32,
    _pad0: u32,
    _pad1: u32,
    _pad2: u32,
}

struct LightSample {
    direction: vec3<f32>,
    // How far the shadow ray must be free.
    distance: f32,
    // What the lamp's radiance is weighted by, in steradians.
    weight: f32,
    // Inverse density of this direction; 0 where the point cannot be seen.
    inverse_density: f32,
}

// The cone under which a lamp is seen.
struct Cone {
    // Unit vector to the lamp's centre.
    axis: vec3<f32>,
    distance: f32,
    // sin^2 and 1 - cos of the cone's half angle, without cancellation.
    sine_squared: f32,
    height: f32,
    // False on, in or all but on the lamp, where there is no cone.
    open: bool,
}

fn lamp_cone(lamp: Lamp, origin: vec3<f32>) -> Cone {
    let to_center = lamp.center - origin;
    let distance = length(to_center);
    let inverse = 1.0 / greater(distance, 1e-30);
    let ratio = lamp.radius * inverse;
    let sine_squared = lesser(ratio * ratio, 1.0);
    let height = sine_squared / (1.0 + root(1.0 - sine_squared));
    return Cone(
        to_center * inverse,
        distance,
        sine_squared,
        height,
        distance > lamp.radius * 1.0001,
    );
}

// A cone of directions has the solid angle 2 pi (1 - cos).
fn cone_solid_angle(cone: Cone) -> f32 {
    return 2.0 * PI * cone.height;
}

// The base code's weight: 2 pi (1 - sqrt(1 - s^2 / d^2)), with d to the drawn point and the root's
// argument kept at 0 or above.
fn solid_angle_weight(radius: f32, distance: f32) -> f32 {
    let ratio = radius / greater(distance, 1e-30);
    let sine_squared = lesser(ratio * ratio, 1.0);
    return 2.0 * PI * sine_squared / (1.0 + root(1.0 - sine_squared));
}

fn light_pole(pole: Basis, cone: Cone) -> Basis {
    if POLE_AT_RECEIVER == 1u {
        return basis_around(-cone.axis);
    }
    return pole;
}

// Case 1: both angles even. Area density 1 / (2 pi^2 r^2 sin phi).
fn sample_uniform_angles(pole: Basis, u: vec2<f32>) -> vec3<f32> {
    let polar = sincos_turn(0.5 * u.y);
    return from_basis(pole, vec3<f32>(polar.x * unit_circle(u.x), polar.y));
}

// Case 2: phi = acos(1 - 2 u). Area density 1 / (4 pi r^2).
fn sample_inverse_cosine(pole: Basis, u: vec2<f32>) -> vec3<f32> {
    return from_basis(pole, unit_sphere(u.yx));
}

// Case 3: three normal numbers (Box and Muller 1958) made a unit vector. Area density 1 / (4 pi r^2).
fn sample_gaussian(u: vec4<f32>) -> vec3<f32> {
    // A logarithm may be off by a little, and log(1) so be above zero.
    let radius = vec2<f32>(root(-2.0 * log(1.0 - u.x)), root(-2.0 * log(1.0 - u.y)));
    let v = vec3<f32>(radius.x * unit_circle(u.z), radius.y * unit_circle(u.w).x);
    let size = dot(v, v);
    return select(vec3<f32>(0.0, 0.0, 1.0), v * inverseSqrt(greater(size, 1e-30)), size > 1e-30);
}

// Unit vector from the lamp's centre to a point of its surface, by the three samplers that know
// nothing of who looks. The cone sampler draws evenly by area where there is no cone.
fn sample_surface(pole: Basis, u: vec4<f32>) -> vec3<f32> {
    if LIGHT_SAMPLER == LIGHT_SAMPLER_UNIFORM_ANGLES {
        return sample_uniform_angles(pole, u.xy);
    }
    if LIGHT_SAMPLER == LIGHT_SAMPLER_GAUSSIAN {
        return sample_gaussian(u);
    }
    return sample_inverse_cosine(pole, u.xy);
}

// Inverse area density of `sample_surface` at a unit vector.
fn surface_inverse_density(lamp: Lamp, pole: Basis, outward: vec3<f32>) -> f32 {
    let area = lamp.radius * lamp.radius * PI;
    if LIGHT_SAMPLER == LIGHT_SAMPLER_UNIFORM_ANGLES {
        return 2.0 * PI * area * length(cross(outward, pole.z));
    }
    return 4.0 * area;
}

// From area to solid angle: |cos| / distance^2. From outside a lamp only the half that faces
// `origin` is seen; from inside all of it.
fn area_to_solid_angle(outward: vec3<f32>, direction: vec3<f32>, distance: f32, inside: bool) -> f32 {
    let toward = -dot(outward, direction);
    let seen = select(greater(toward, 0.0), abs(toward), inside);
    return seen / greater(distance * distance, 1e-30);
}

// A direction to the lamp by its cone: Shirley, Wang and Zimmerman 1996.
fn sample_cone(lamp: Lamp, cone: Cone, u: vec2<f32>) -> LightSample {
    let fallen = u.x * cone.height;
    let sine_squared = fallen * (2.0 - fallen);
    let sine = root(sine_squared);
    let cosine = 1.0 - fallen;
    let basis = basis_around(cone.axis);
    let direction = unit_vector_again(from_basis(basis, vec3<f32>(sine * unit_circle(u.y), cosine)));
    let half_chord = root(lamp.radius * lamp.radius - cone.distance * cone.distance * sine_squared);
    let distance = cone.distance * cosine - half_chord;
    let inverse_density = cone_solid_angle(cone);
    let literal = solid_angle_weight(lamp.weight_radius, distance);
    let weight = select(inverse_density, literal, LIGHT_WEIGHT == LIGHT_WEIGHT_SOLID_ANGLE);
    return LightSample(direction, distance, weight, inverse_density);
}

// A direction to a point of the lamp's surface.
// With the weight `pdf` the point counts when it is itself seen. With `solid-angle` it counts when
// the lamp is the first body in its direction, as in the base code: points of the far side count
// too, and the shadow ray need only reach the near side, one chord before them.
fn sample_area(lamp: Lamp, axes: Basis, origin: vec3<f32>, inside: bool, u: vec4<f32>) -> LightSample {
    let outward = sample_surface(axes, u);
    let to_point = lamp.center + lamp.radius * outward - origin;
    let distance = length(to_point);
    let direction = to_point / greater(distance, 1e-30);
    let geometry = area_to_solid_angle(outward, direction, distance, inside);
    let inverse_density = surface_inverse_density(lamp, axes, outward) * geometry;
    if LIGHT_WEIGHT == LIGHT_WEIGHT_SOLID_ANGLE {
        let chord = select(0.0, -2.0 * lamp.radius * dot(outward, direction), !inside);
        let near = select(distance, distance + chord, chord < 0.0);
        return LightSample(direction, near, solid_angle_weight(lamp.weight_radius, distance), inverse_density);
    }
    return LightSample(direction, distance, inverse_density, inverse_density);
}

// `inside`: whether `origin` is inside the lamp.
fn sample_light(lamp: Lamp, pole: Basis, origin: vec3<f32>, inside: bool, u: vec4<f32>) -> LightSample {
    let cone = lamp_cone(lamp, origin);
    if LIGHT_SAMPLER == LIGHT_SAMPLER_CONE && cone.open && !inside {
        return sample_cone(lamp, cone, u.xy);
    }
    return sample_area(lamp, light_pole(pole, cone), origin, inside, u);
}

// Inverse density with which `sample_light` draws the unit `direction`, which meets the lamp at
// `origin + distance * direction`, where its outward unit normal is `outward`.
fn light_inverse_density(
    lamp: Lamp,
    pole: Basis,
    origin: vec3<f32>,
    inside: bool,
    direction: vec3<f32>,
    distance: f32,
    outward: vec3<f32>,
) -> f32 {
    let cone = lamp_cone(lamp, origin);
    if LIGHT_SAMPLER == LIGHT_SAMPLER_CONE && cone.open && !inside {
        return cone_solid_angle(cone);
    }
    let geometry = area_to_solid_angle(outward, direction, distance, inside);
    return surface_inverse_density(lamp, light_pole(pole, cone), outward) * geometry;
}

// Power heuristic with exponent 2 (Veach 1997, section 9.2.4): the weight of a strategy, where
// `ratio` is the other strategy's density over its own.
fn power_heuristic(ratio: f32) -> f32 {
    let bounded = lesser(ratio, 1e15);
    return 1.0 / (1.0 + bounded * bounded);
}
