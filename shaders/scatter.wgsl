// How surfaces send light on: sample, evaluate, density.
//
// `incoming` is the direction of the ray that arrives, `outgoing` that of the ray that leaves,
// `normal` faces the arriving ray; all of unit length. Densities are by solid angle. Directions
// below the surface are absorbed: they are drawn with their density and carry nothing.

// #import maths
// #import rough
// #import glass

override SCATTER_DIFFUSE: u32;
override SCATTER_BOUND: u32;

struct Material {
    albedo: vec3<f32>,
    scatter: u32,
    emission: vec3<f32>,
    // The paper's threshold t (section 2.3).
    survival: f32,
    // Sigma of the half-normal angle, radians.
    spread: f32,
    // The share of the half-normal law below the angle's bound; 1 when the bound is a clamp.
    lobe_mass: f32,
    // sqrt(2 / pi) / (spread * lobe_mass * 2 pi).
    lobe_scale: f32,
    // Rough: alpha. Glass: the index of refraction. Else 0.
    shape: f32,
}

struct Scattered {
    direction: vec3<f32>,
    // Of drawing this direction; 0 where it has none (mirror, glass, the ring that a clamp piles up).
    density: f32,
    // Scattering function times cosine over density; zero where the light is absorbed.
    weight: vec3<f32>,
}

fn mirror_direction(normal: vec3<f32>, incoming: vec3<f32>) -> vec3<f32> {
    return unit_vector_again(incoming - 2.0 * dot(normal, incoming) * normal);
}

// Lambert: by the cosine, as the direction to a point of the unit sphere that stands on the
// surface; or evenly, weighted by twice the cosine. Both have albedo / pi as scattering function.
fn sample_diffuse(material: Material, normal: vec3<f32>, u: vec2<f32>) -> Scattered {
    let ball = unit_sphere(u);
    if SCATTER_DIFFUSE == SCATTER_DIFFUSE_UNIFORM {
        let up = dot(ball, normal);
        let direction = select(-ball, ball, up >= 0.0);
        return Scattered(direction, 0.5 / PI, material.albedo * (2.0 * abs(up)));
    }
    let sum = normal + ball;
    let size = dot(sum, sum);
    let direction = select(normal, sum * inverseSqrt(greater(size, 1e-12)), size > 1e-12);
    let up = dot(direction, normal);
    return Scattered(direction, greater(up, 0.0) / PI, material.albedo);
}

// Density of the half-normal lobe at `chord`, the distance between the tips of the mirror
// direction and the one asked for: f(theta) / (2 pi sin theta), with
// f(theta) = sqrt(2 / pi) / (sigma Z) exp(-theta^2 / (2 sigma^2)) up to a right angle, Z = lobe_mass.
fn lobe_density(material: Material, chord: f32) -> f32 {
    let theta = angle_of_chord(chord);
    let ratio = theta / material.spread;
    let sine = chord * root(1.0 - 0.25 * chord * chord);
    let density = material.lobe_scale * exp(-0.5 * ratio * ratio) / greater(sine, 1e-6);
    return select(0.0, density, chord * chord < 2.0);
}

// The paper's directional scattering (section 2.1): an azimuth even in [0, 2 pi] and a polar angle
// |N(0, sigma)| around the mirror direction, kept to a right angle by the truncated law or by a clamp.
fn sample_directional(material: Material, normal: vec3<f32>, incoming: vec3<f32>, u: vec2<f32>) -> Scattered {
    let drawn = 1.4142135 * material.spread * inverse_erf(u.x * material.lobe_mass);
    let theta = lesser(drawn, 0.5 * PI);
    let polar = sincos_turn(theta / (2.0 * PI));
    let basis = basis_around(mirror_direction(normal, incoming));
    let direction = unit_vector_again(from_basis(basis, vec3<f32>(polar.x * unit_circle(u.y), polar.y)));
    let chord = 2.0 * sincos_turn(theta / (4.0 * PI)).x;
    let on_ring = SCATTER_BOUND == SCATTER_BOUND_CLAMP && drawn >= 0.5 * PI;
    return Scattered(
        direction,
        select(lobe_density(material, chord), 0.0, on_ring),
        select(vec3<f32>(0.0), material.albedo, dot(direction, normal) > 0.0),
    );
}

// `inside`: whether the arriving ray is inside the body.
fn sample_scatter(material: Material, normal: vec3<f32>, incoming: vec3<f32>, inside: bool, u: vec2<f32>) -> Scattered {
    if material.scatter == SURFACE_DIFFUSE {
        return sample_diffuse(material, normal, u);
    }
    if material.scatter == SURFACE_DIRECTIONAL {
        return sample_directional(material, normal, incoming, u);
    }
    if ROUGH_SURFACES == 1u && material.scatter == SURFACE_ROUGH {
        let rough = sample_rough(material.shape, normal, incoming, u);
        return Scattered(rough.direction, rough.density, material.albedo * rough.share);
    }
    if GLASS_SURFACES == 1u && material.scatter == SURFACE_GLASS {
        return Scattered(sample_glass(material.shape, inside, normal, incoming, u.x), 0.0, material.albedo);
    }
    return Scattered(mirror_direction(normal, incoming), 0.0, material.albedo);
}

// Density with which `sample_scatter` draws `outgoing`.
fn scatter_density(material: Material, normal: vec3<f32>, incoming: vec3<f32>, outgoing: vec3<f32>) -> f32 {
    let up = dot(normal, outgoing);
    if material.scatter == SURFACE_DIFFUSE {
        let even = select(0.0, 0.5 / PI, up >= 0.0);
        return select(greater(up, 0.0) / PI, even, SCATTER_DIFFUSE == SCATTER_DIFFUSE_UNIFORM);
    }
    if material.scatter == SURFACE_DIRECTIONAL {
        return lobe_density(material, distance(outgoing, mirror_direction(normal, incoming)));
    }
    if ROUGH_SURFACES == 1u && material.scatter == SURFACE_ROUGH {
        return rough_density(material.shape, normal, incoming, outgoing);
    }
    return 0.0;
}

// Lambert's scattering function times cosine.
fn evaluate_lambert(material: Material, normal: vec3<f32>, outgoing: vec3<f32>) -> vec3<f32> {
    return material.albedo * (greater(dot(normal, outgoing), 0.0) / PI);
}

// `evaluate_scatter` where `scatter_density` of the two directions is known.
fn evaluate_by_density(
    material: Material,
    normal: vec3<f32>,
    incoming: vec3<f32>,
    outgoing: vec3<f32>,
    density: f32,
) -> vec3<f32> {
    var lobe = material.albedo * select(0.0, density, dot(normal, outgoing) > 0.0);
    if ROUGH_SURFACES == 1u && material.scatter == SURFACE_ROUGH {
        let arrival = rough_arrival_of(material.shape, normal, incoming);
        lobe *= rough_share(material.shape, arrival, dot(normal, outgoing));
    }
    return select(lobe, evaluate_lambert(material, normal, outgoing), material.scatter == SURFACE_DIFFUSE);
}

// Scattering function times cosine; the part with a density only. The directional lobe's is albedo times its
// density; the rough one's has a share of that.
fn evaluate_scatter(material: Material, normal: vec3<f32>, incoming: vec3<f32>, outgoing: vec3<f32>) -> vec3<f32> {
    let density = scatter_density(material, normal, incoming, outgoing);
    return evaluate_by_density(material, normal, incoming, outgoing, density);
}
