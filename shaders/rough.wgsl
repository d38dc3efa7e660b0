// Rough mirrors: microfacets after Trowbridge and Reitz (GGX), which reflect all light, with height-correlated
// Smith masking (Heitz, "Understanding the Masking-Shadowing Function", JCGT 2014) and one reflection: what a
// facet sends to another facet is lost.
//
// Directions are drawn by the facets that the arriving ray sees, as a cap of a sphere (Dupuy and Benyoub,
// "Sampling Visible GGX Normals with Spherical Caps", CGF 2023), cut where all that is left lies below the
// surface (Eto and Tokuyoshi, "Bounded VNDF Sampling for Smith-GGX Reflections", SIGGRAPH Asia 2023).
//
// `alpha` is at least 1e-3: the host makes mirrors of smoother ones. i is the direction back along the arriving
// ray, o the one that leaves, m the normal of a facet, all of unit length with z along the surface's normal.

// #import maths

// 1: some surface is rough.
override ROUGH_SURFACES: u32;

// What the surface makes of an arriving direction.
struct RoughArrival {
    // i.z
    cosine: f32,
    // Length of i with x and y shortened to alpha of theirs.
    stretched: f32,
    // k: of the shortened and then unit i.z, how far below the plane the cap reaches.
    bound: f32,
    // (1 - k) / alpha^2, which has its digits where k is all but 1.
    rim: f32,
}

struct RoughSample {
    direction: vec3<f32>,
    // By solid angle, below the surface too.
    density: f32,
    // Reflected over drawn; zero below the surface.
    share: f32,
}

fn rough_arrival(alpha: f32, cosine: f32, sine: f32) -> RoughArrival {
    let squared = alpha * alpha;
    let reach = (1.0 + sine) * (1.0 + sine);
    let stretched = sqrt(squared * sine * sine + cosine * cosine);
    let whole = reach + squared * cosine * cosine;
    return RoughArrival(cosine, stretched, (1.0 - squared) * reach / whole, (reach + cosine * cosine) / whole);
}

// Density of the reflection by a facet of which `flatness` is alpha^2 m.z^2 + m.x^2 + m.y^2. With the law of
// normals D(m) = alpha^2 / (pi flatness^2) it is D / (2 (k i.z + stretched)).
fn rough_law(alpha: f32, arrival: RoughArrival, flatness: f32) -> f32 {
    let normals = alpha * alpha / (PI * flatness * flatness);
    return normals / (2.0 * (arrival.bound * arrival.cosine + arrival.stretched));
}

// Scattering function times cosine, D G2 / (4 i.z), over the density: both Smith terms of
// G2 = 2 i.z o.z / (o.z stretched(i) + i.z stretched(o)) and no D. At most 1.
fn rough_share(alpha: f32, arrival: RoughArrival, up: f32) -> f32 {
    let leaving = sqrt(alpha * alpha * greater(1.0 - up * up, 0.0) + up * up);
    let masked = up * arrival.stretched + arrival.cosine * leaving;
    let share = up * (arrival.bound * arrival.cosine + arrival.stretched) / greater(masked, 1e-30);
    return select(0.0, share, up > 0.0);
}

fn rough_arrival_of(alpha: f32, normal: vec3<f32>, incoming: vec3<f32>) -> RoughArrival {
    let cosine = greater(-dot(normal, incoming), 0.0);
    return rough_arrival(alpha, cosine, length(incoming + cosine * normal));
}

// Density with which `sample_rough` draws `outgoing`. The cap's rim is where o, shortened as i was, has
// z = -k i.z: beyond it nothing is drawn.
fn rough_density(alpha: f32, normal: vec3<f32>, incoming: vec3<f32>, outgoing: vec3<f32>) -> f32 {
    let arrival = rough_arrival_of(alpha, normal, incoming);
    let sum = outgoing - incoming;
    let up = dot(normal, sum);
    let across = sum - up * normal;
    let flatness = (alpha * alpha * up * up + dot(across, across)) / greater(dot(sum, sum), 1e-30);
    let drawn = dot(normal, outgoing) > 0.0 || up >= arrival.rim * arrival.cosine * flatness;
    return select(0.0, rough_law(alpha, arrival, greater(flatness, 1e-15)), drawn);
}

fn sample_rough(alpha: f32, normal: vec3<f32>, incoming: vec3<f32>, u: vec2<f32>) -> RoughSample {
    let basis = basis_around(normal);
    let toward = vec3<f32>(-dot(basis.x, incoming), -dot(basis.y, incoming), greater(-dot(normal, incoming), 0.0));
    let arrival = rough_arrival(alpha, toward.z, length(toward.xy));
    let shortened = unit_vector(vec3<f32>(alpha * toward.xy, toward.z));
    // From the cap's top down.
    let fallen = u.x * (1.0 + arrival.bound * shortened.z);
    let cap = vec3<f32>(root(fallen * (2.0 - fallen)) * unit_circle(u.y), 1.0 - fallen);
    let sum = cap + shortened;
    let facet = unit_vector(vec3<f32>(alpha * sum.xy, greater(sum.z, 1e-12)));
    let local = 2.0 * dot(toward, facet) * facet - toward;
    let flatness = alpha * alpha * facet.z * facet.z + dot(facet.xy, facet.xy);
    return RoughSample(
        unit_vector_again(from_basis(basis, local)),
        rough_law(alpha, arrival, flatness),
        rough_share(alpha, arrival, local.z),
    );
}
