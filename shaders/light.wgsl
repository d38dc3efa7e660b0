// Points on spherical lamps: sample and density (paper, section 2.2).
//
// Everything is said as the inverse of a density by solid angle, seen from `origin`: it stays
// finite where a density does not, and 0 means "never drawn".

// #import maths
// #import cap

override LIGHT_SAMPLER: u32;
override LIGHT_WEIGHT: u32;
override LIGHT_TEST: u32;
// 1: the pole of the first two samplers points from the lamp to the lit point.
override POLE_AT_RECEIVER: u32;

// Inverse density of directions that are hit and never drawn.
const NEVER_DRAWN: f32 = 1e30;

struct Lamp {
    center: vec3<f32>,
    radius: f32,
    emission: vec3<f32>,
    // 1 + place among the packed bodies.
    body: u32,
    // Radius s of the solid-angle weight.
    weight_radius: f32,
    // 0 for a sphere; 1 + index of a box, whose middle and half diagonal are above.
    shape: u32,
    _pad0: u32,
    _pad1: u32,
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

// Whether only the half that faces the receiver is drawn from.
fn draws_facing() -> bool {
    return LIGHT_SAMPLER == LIGHT_SAMPLER_FACING_CAP || LIGHT_SAMPLER == LIGHT_SAMPLER_FACING_ANGLES;
}

// The cap around the pole that points are drawn from, as its height in lamp radii: 2 is the whole lamp.
fn drawn_height(lamp: Lamp, cone: Cone, inside: bool) -> f32 {
    let facing = (cone.distance - lamp.radius) / greater(cone.distance, 1e-30);
    return select(2.0, facing, draws_facing() && cone.open && !inside);
}

// The polar angle, in turns, of the edge of a cap of that height.
fn cap_angle(height: f32) -> f32 {
    return select(angle_of_chord(root(2.0 * height)) / (2.0 * PI), 0.5, height > 1.0);
}

fn light_pole(pole: Basis, cone: Cone) -> Basis {
    if POLE_AT_RECEIVER == 1u || draws_facing() {
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

// Case 2 and case 1 on a cap of the given height around the pole.
fn sample_facing(pole: Basis, height: f32, u: vec2<f32>) -> vec3<f32> {
    if LIGHT_SAMPLER == LIGHT_SAMPLER_FACING_ANGLES {
        let polar = sincos_turn(u.y * cap_angle(height));
        return from_basis(pole, vec3<f32>(polar.x * unit_circle(u.x), polar.y));
    }
    let fallen = u.y * height;
    return from_basis(pole, vec3<f32>(root(fallen * (2.0 - fallen)) * unit_circle(u.x), 1.0 - fallen));
}

// Unit vector from the lamp's centre to a point of its surface, by the samplers of points. Those of
// directions draw evenly by area where there is no cone.
fn sample_surface(pole: Basis, height: f32, u: vec4<f32>) -> vec3<f32> {
    if draws_facing() {
        return sample_facing(pole, height, u.xy);
    }
    if LIGHT_SAMPLER == LIGHT_SAMPLER_UNIFORM_ANGLES {
        return sample_uniform_angles(pole, u.xy);
    }
    if LIGHT_SAMPLER == LIGHT_SAMPLER_GAUSSIAN {
        return sample_gaussian(u);
    }
    return sample_inverse_cosine(pole, u.xy);
}

// Inverse area density of `sample_surface` at a unit vector that it can draw.
fn surface_inverse_density(lamp: Lamp, pole: Basis, height: f32, outward: vec3<f32>) -> f32 {
    let area = lamp.radius * lamp.radius * PI;
    if LIGHT_SAMPLER == LIGHT_SAMPLER_FACING_ANGLES {
        return 4.0 * PI * cap_angle(height) * area * length(cross(outward, pole.z));
    }
    if LIGHT_SAMPLER == LIGHT_SAMPLER_FACING_CAP {
        return 2.0 * area * height;
    }
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

// Inverse density of a direction that counts wherever its line meets the lamp, where it meets it at `distance` with
// the outward normal `outward`: both ends of the chord may have been drawn. With d their distances, p their
// densities by area and c the cosine there, it is c / (p d^2 + p' d'^2).
fn chord_inverse_density(
    lamp: Lamp,
    axes: Basis,
    height: f32,
    outward: vec3<f32>,
    direction: vec3<f32>,
    distance: f32,
) -> f32 {
    let along = dot(outward, direction);
    let other = outward - 2.0 * along * direction;
    let other_distance = distance - 2.0 * lamp.radius * along;
    let unit = Lamp(lamp.center, 1.0, lamp.emission, lamp.body, 1.0, 0u, 0u, 0u);
    let here = surface_inverse_density(unit, axes, height, outward);
    let there = surface_inverse_density(unit, axes, height, other);
    let near = distance / lamp.radius;
    let far = other_distance / lamp.radius;
    return abs(along) * here * there / greater(near * near * there + far * far * here, 1e-30);
}

// Inverse density of a direction to a point of the surface, and what the point counts by.
fn point_inverse_density(
    lamp: Lamp,
    axes: Basis,
    height: f32,
    inside: bool,
    outward: vec3<f32>,
    direction: vec3<f32>,
    distance: f32,
) -> f32 {
    // From inside a direction has one point, and of the facing part no two are on one line.
    if LIGHT_TEST == LIGHT_TEST_OBJECT && !inside && height > 1.0 {
        return chord_inverse_density(lamp, axes, height, outward, direction, distance);
    }
    let geometry = area_to_solid_angle(outward, direction, distance, inside);
    return surface_inverse_density(lamp, axes, height, outward) * geometry;
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
// With the weight `pdf` and the test `point` the point counts when it is itself seen. With the test `object`, and always
// with the weight `solid-angle`, it counts when the lamp is the first body in its direction, as in the base code:
// points of the far side count too, and the shadow ray need only reach the near side, one chord before them.
fn sample_area(lamp: Lamp, axes: Basis, height: f32, origin: vec3<f32>, inside: bool, u: vec4<f32>) -> LightSample {
    let outward = sample_surface(axes, height, u);
    let to_point = lamp.center + lamp.radius * outward - origin;
    let distance = length(to_point);
    let direction = to_point / greater(distance, 1e-30);
    let inverse_density = point_inverse_density(lamp, axes, height, inside, outward, direction, distance);
    if LIGHT_WEIGHT == LIGHT_WEIGHT_SOLID_ANGLE || LIGHT_TEST == LIGHT_TEST_OBJECT {
        let chord = select(0.0, -2.0 * lamp.radius * dot(outward, direction), !inside);
        let near = select(distance, distance + chord, chord < 0.0);
        let literal = solid_angle_weight(lamp.weight_radius, distance);
        let weight = select(inverse_density, literal, LIGHT_WEIGHT == LIGHT_WEIGHT_SOLID_ANGLE);
        return LightSample(direction, near, weight, inverse_density);
    }
    return LightSample(direction, distance, inverse_density, inverse_density);
}

// Where a direction from `origin` meets the lamp: from inside its far side, from outside its near one.
fn lamp_distance(lamp: Lamp, origin: vec3<f32>, direction: vec3<f32>, inside: bool) -> f32 {
    let to_center = lamp.center - origin;
    let middle = dot(to_center, direction);
    let off = to_center - middle * direction;
    let half_chord = root(lamp.radius * lamp.radius - dot(off, off));
    return select(middle - half_chord, middle + half_chord, inside);
}

// Inverse density of a direction by projected solid angle: from inside every direction leads to the lamp, and all
// of them above the surface are drawn by their cosine.
fn projected_inverse_density(cone: Cone, normal: vec3<f32>, inside: bool, direction: vec3<f32>) -> f32 {
    if inside {
        let up = dot(normal, direction);
        return select(0.0, PI / greater(up, 1e-30), up > 0.0);
    }
    return projected_cap_inverse_density(projected_cap(cone.axis, cone.sine_squared, normal), direction);
}

fn sample_projected(
    lamp: Lamp,
    cone: Cone,
    origin: vec3<f32>,
    normal: vec3<f32>,
    inside: bool,
    u: vec4<f32>,
) -> LightSample {
    var direction = sample_cosine(normal, u.xy);
    if !inside {
        direction = sample_projected_cap(projected_cap(cone.axis, cone.sine_squared, normal), u.xyz);
    }
    let distance = lamp_distance(lamp, origin, direction, inside);
    let inverse_density = projected_inverse_density(cone, normal, inside, direction);
    let literal = solid_angle_weight(lamp.weight_radius, distance);
    let weight = select(inverse_density, literal, LIGHT_WEIGHT == LIGHT_WEIGHT_SOLID_ANGLE);
    return LightSample(direction, distance, weight, inverse_density);
}

// `inside`: whether `origin` is inside the lamp. `normal`: the lit surface's, towards the side that light
// comes from; the projected sampler alone asks for it.
fn sample_light(
    lamp: Lamp,
    pole: Basis,
    origin: vec3<f32>,
    normal: vec3<f32>,
    inside: bool,
    u: vec4<f32>,
) -> LightSample {
    let cone = lamp_cone(lamp, origin);
    if LIGHT_SAMPLER == LIGHT_SAMPLER_PROJECTED_CAP {
        return sample_projected(lamp, cone, origin, normal, inside, u);
    }
    if LIGHT_SAMPLER == LIGHT_SAMPLER_CONE && cone.open && !inside {
        return sample_cone(lamp, cone, u.xy);
    }
    return sample_area(lamp, light_pole(pole, cone), drawn_height(lamp, cone, inside), origin, inside, u);
}

// Inverse density with which `sample_light` draws the unit `direction`, which meets the lamp at
// `origin + distance * direction`, where its outward unit normal is `outward`. Below the horizon of a surface
// whose sampler draws none it is as large as if there were no lamp to draw.
fn light_inverse_density(
    lamp: Lamp,
    pole: Basis,
    origin: vec3<f32>,
    normal: vec3<f32>,
    inside: bool,
    direction: vec3<f32>,
    distance: f32,
    outward: vec3<f32>,
) -> f32 {
    let cone = lamp_cone(lamp, origin);
    if LIGHT_SAMPLER == LIGHT_SAMPLER_PROJECTED_CAP {
        let drawn = projected_inverse_density(cone, normal, inside, direction);
        return select(NEVER_DRAWN, drawn, drawn > 0.0);
    }
    if LIGHT_SAMPLER == LIGHT_SAMPLER_CONE && cone.open && !inside {
        return cone_solid_angle(cone);
    }
    let height = drawn_height(lamp, cone, inside);
    return point_inverse_density(lamp, light_pole(pole, cone), height, inside, outward, direction, distance);
}

// Power heuristic with exponent 2 (Veach 1997, section 9.2.4): the weight of a strategy, where
// `ratio` is the other strategy's density over its own.
fn power_heuristic(ratio: f32) -> f32 {
    let bounded = lesser(ratio, 1e15);
    return 1.0 / (1.0 + bounded * bounded);
}
