// The denoise kernel: one pass of an edge-avoiding a-trous wavelet filter (Dammertz, Sewtz, Hanika and Lensch,
// "Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination Filtering", HPG 2010, section 3). Taps
// lie `step` pixels apart, and count for less where the guides or the light differ; how much light may differ
// goes by its variance, which is filtered along (Schied et al., "Spatiotemporal Variance-Guided Filtering",
// HPG 2017, sections 4.2 and 4.3).

// #import maths

struct DenoiseJob {
    // The pixels that are made, within the window.
    corner: vec2<u32>,
    size: vec2<u32>,
    // Width and height of what is bound: those pixels, and the ones around that they look at.
    window: vec2<u32>,
    step: u32,
    // 1: the variance alone is spread, by the guides alone.
    only_variance: u32,
    // What squared differences are multiplied by: of light, in variances; of normals; of the distance from the
    // other's tangent plane, in widths of a pixel there.
    light: f32,
    normal: f32,
    depth: f32,
    _pad0: u32,
}

// What is known of a pixel without noise: means over the pixel.
struct Site {
    normal: vec3<f32>,
    // How wide a pixel is at its distance, scene units; 0 where nothing is met.
    footprint: f32,
    // Relative to the eye.
    position: vec3<f32>,
    // How far the surfaces within the pixel are from their mean: an exponent, as `site_distance` gives it. Below 0
    // where the light is not a number: then it takes part in nothing.
    spread: f32,
    // Mirrors on the way, and the shares of what emits, scatters around the mirror direction and is black.
    kind: vec4<f32>,
}

// Light before the surfaces' albedo, with the mean of its three variances.
struct Estimate {
    light: vec3<f32>,
    variance: f32,
}

@group(1) @binding(0) var<uniform> job: DenoiseJob;
@group(1) @binding(1) var<storage, read> sites: array<Site>;
@group(1) @binding(2) var<storage, read> estimates: array<Estimate>;
@group(1) @binding(3) var<storage, read_write> smoothed: array<Estimate>;

// A difference of one mirror, or of wholly another kind, leaves nothing.
const KIND: f32 = 50.0;
// Beyond this exponent a weight could not be seen in 32 bits.
const FARTHEST: f32 = 40.0;

// Of the cubic B-spline, 1/16 (1, 4, 6, 4, 1), at -2 to 2.
fn spline(offset: i32) -> f32 {
    return select(select(0.0625, 0.25, abs(offset) == 1), 0.375, offset == 0);
}

// How far two pixels' surfaces are apart: the exponent of their weight.
fn site_distance(a: Site, b: Site) -> f32 {
    let turn = a.normal - b.normal;
    let across = b.position - a.position;
    let lift = greater(abs(dot(a.normal, across)), abs(dot(b.normal, across)));
    let width = greater(lesser(a.footprint, b.footprint), 1e-30);
    let steps = lesser(lift / width, 1e6);
    let other = a.kind - b.kind;
    return job.normal * dot(turn, turn) + job.depth * steps * steps + KIND * dot(other, other);
}

// The same of their light. Colours count: neighbours of two walls may be as bright as each other.
fn light_distance(a: Estimate, b: Estimate) -> f32 {
    let apart = a.light - b.light;
    let square = lesser(dot(apart, apart) / 3.0, 1e30);
    return job.light * square / greater(a.variance + b.variance, 1e-30);
}

fn smoothed_at(at: vec2<u32>) -> Estimate {
    let place = at.y * job.window.x + at.x;
    let site = sites[place];
    let own = estimates[place];
    if site.spread < 0.0 {
        return own;
    }
    // Sums of differences: pixels that all agree leave their bits alone.
    var change = vec3<f32>(0.0);
    var variance = 0.0;
    var weights = 0.0;
    for (var y = -2; y <= 2; y++) {
        for (var x = -2; x <= 2; x++) {
            let tap = vec2<i32>(at) + vec2<i32>(x, y) * i32(job.step);
            if any(tap < vec2<i32>(0)) || any(tap >= vec2<i32>(job.window)) {
                continue;
            }
            let index = u32(tap.y) * job.window.x + u32(tap.x);
            let other = estimates[index];
            // A pixel on an edge is like the pixels on both sides of it as much as its own parts are.
            var exponent = site_distance(site, sites[index]) / (1.0 + site.spread);
            if job.only_variance == 0u {
                exponent += light_distance(own, other);
            }
            if sites[index].spread < 0.0 || exponent > FARTHEST {
                continue;
            }
            let weight = spline(x) * spline(y) * exp(-exponent);
            change += weight * (other.light - own.light);
            variance += select(weight * weight, weight, job.only_variance == 1u) * other.variance;
            weights += weight;
        }
    }
    if job.only_variance == 1u {
        return Estimate(own.light, variance / weights);
    }
    return Estimate(own.light + change / weights, variance / (weights * weights));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) lane: vec3<u32>) {
    if lane.x < job.size.x && lane.y < job.size.y {
        smoothed[lane.y * job.size.x + lane.x] = smoothed_at(job.corner + lane.xy);
    }
}
