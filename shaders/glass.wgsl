// Smooth clear glass: Fresnel's equations for unpolarised light choose between reflection and refraction.
//
// Every body of glass stands in vacuum by itself: a ray that meets it from outside enters it, one that meets
// it from inside leaves it, whatever else is there. Radiance is carried as radiance over the square of the
// index, which refraction leaves as it is: what begins and ends outside of glass needs no factor.

// #import maths

// 1: some surface is glass.
override GLASS_SURFACES: u32;

struct Fresnel {
    // Share of the light that is reflected.
    reflectance: f32,
    // Cosine of the refracted direction; 0 where all is reflected.
    cosine: f32,
}

// `cosine` is the arriving one, `ratio` the index on this side over the index beyond.
fn fresnel(cosine: f32, ratio: f32) -> Fresnel {
    let sine_squared = ratio * ratio * greater(1.0 - cosine * cosine, 0.0);
    let beyond = root(1.0 - sine_squared);
    let across = (ratio * cosine - beyond) / greater(ratio * cosine + beyond, 1e-30);
    let along = (cosine - ratio * beyond) / greater(cosine + ratio * beyond, 1e-30);
    let reflectance = 0.5 * (across * across + along * along);
    return Fresnel(select(1.0, reflectance, sine_squared < 1.0), beyond);
}

// Where a ray goes on: reflected with the probability of its share, else by Snell's law to the other side.
fn sample_glass(index: f32, inside: bool, normal: vec3<f32>, incoming: vec3<f32>, u: f32) -> vec3<f32> {
    let ratio = select(1.0 / index, index, inside);
    let cosine = greater(-dot(normal, incoming), 0.0);
    let parts = fresnel(cosine, ratio);
    let reflected = incoming + 2.0 * cosine * normal;
    let refracted = ratio * incoming + (ratio * cosine - parts.cosine) * normal;
    return unit_vector_again(select(refracted, reflected, u < parts.reflectance));
}
