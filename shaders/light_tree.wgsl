// One pair of a light tree: two groups of lamps, of which one is taken by what it may bring (Conty Estevez
// and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018). Lamps are spheres
// and shine in all directions, so that power, distance and the receiver's horizon are all there is to know.

// #import maths

struct LightPair {
    // A sphere around the lamps of each group: centre, radius.
    first: vec4<f32>,
    second: vec4<f32>,
    // What the groups send out; the ratio alone says something.
    power: vec2<f32>,
    // What stands below: another pair, or LEAF with a lamp.
    link: vec2<u32>,
}

const LEAF: u32 = 0x80000000u;
// Shares are whole parts of this many, the numbers that a draw of 24 bits can be.
const WHOLE_SHARE: u32 = 1u << 24u;
// No share is smaller: a group that may shine on a point is taken now and then, whatever the bound says.
const LEAST_SHARE: u32 = 1u << 12u;
// Below the horizon groups count as under this cosine.
const LEAST_COSINE: f32 = 0.015625;

// What a group of unit power may bring to a point of a surface: the cosine at the receiver over the squared
// distance. The angle is the least that the sphere's cone leaves, and the distance at least its radius,
// so that it stays finite inside.
fn nearness(ball: vec4<f32>, point: vec3<f32>, normal: vec3<f32>) -> f32 {
    let to_center = ball.xyz - point;
    let inverse = inverseSqrt(greater(dot(to_center, to_center), ball.w * ball.w));
    let cosine = dot(to_center, normal) * inverse;
    let cone_sine = ball.w * inverse;
    let cone_cosine = root(1.0 - cone_sine * cone_sine);
    let rim = cosine * cone_cosine + root(1.0 - cosine * cosine) * cone_sine;
    let highest = select(rim, 1.0, cosine >= cone_cosine);
    return greater(highest, LEAST_COSINE) * inverse * inverse;
}

// How many parts of WHOLE_SHARE the first group has, seen from a point of a surface with this normal.
fn first_share(pair: LightPair, point: vec3<f32>, normal: vec3<f32>) -> u32 {
    let first = pair.power.x * nearness(pair.first, point, normal);
    let second = pair.power.y * nearness(pair.second, point, normal);
    let share = u32(first / (first + second) * f32(WHOLE_SHARE));
    return clamp(share, LEAST_SHARE, WHOLE_SHARE - LEAST_SHARE);
}
