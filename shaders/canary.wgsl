// The canary kernel: short computations whose answers are known, by which a device is judged before it
// is trusted with a picture. What each should answer stands in src/doctor.

// #import maths
// #import random
// #import camera
// #import sphere
// #import box
// #import scatter
// #import light

// Every struct that a scene's arrays hold.
struct CanaryScene {
    material: Material,
    lamp: Lamp,
    sphere: Sphere,
    body: Box,
}

// Every kind of member that a job has.
struct CanaryJob {
    // One of the CANARY_ constants. It and `count` stand first: with the camera there lavapipe 22.3.6 takes
    // three seconds longer to compile.
    canary: u32,
    count: u32,
    corner: vec2<u32>,
    seed: vec2<u32>,
    camera: Camera,
    pole: Basis,
    scene: CanaryScene,
    background: vec3<f32>,
    clamp: f32,
}

@group(1) @binding(0) var<uniform> job: CanaryJob;
@group(1) @binding(1) var<storage, read> scenes: array<CanaryScene>;
@group(1) @binding(2) var<storage, read> inputs: array<vec4<u32>>;
@group(1) @binding(3) var<storage, read_write> outputs: array<vec4<u32>>;

// One step of a linear congruential generator (Numerical Recipes): what many steps give is known
// without taking them.
fn stride(state: u32) -> u32 {
    return state * 1664525u + 1013904223u;
}

// in.x times in.y iterations of two loops in each other, then in.z of one that each lane leaves for
// itself. What came out of both, and how many iterations there were.
fn loops(in: vec4<u32>) -> vec4<u32> {
    var nested = vec2<u32>(in.w, 0u);
    for (var i = 0u; i < in.x; i++) {
        for (var j = 0u; j < in.y; j++) {
            nested = vec2<u32>(stride(nested.x), nested.y + 1u);
        }
    }
    var single = vec2<u32>(in.w, 0u);
    loop {
        if single.y == in.z {
            break;
        }
        single = vec2<u32>(stride(single.x), single.y + 1u);
    }
    return vec4<u32>(nested, single);
}

fn integers(in: vec4<u32>) -> vec4<u32> {
    let a = in.x;
    let b = in.y;
    let shift = b & 31u;
    switch in.z {
        case 0u: {
            return vec4<u32>(a + b, a - b, a * b, a ^ b);
        }
        case 1u: {
            return vec4<u32>(a / b, a % b, a << shift, a >> shift);
        }
        default: {
            let c = bitcast<i32>(a);
            let d = bitcast<i32>(b);
            return bitcast<vec4<u32>>(vec4<i32>(c / d, c % d, c * d, c >> shift));
        }
    }
}

fn random_words(lane: u32) -> vec4<u32> {
    let pixel = vec2<u32>(lane & 127u, lane >> 7u);
    let key = random_key(vec2<u32>(lane, ~lane), pixel, vec2<u32>(lane * 2654435761u, lane));
    return random_bits(key, lane & 7u, lane >> 3u);
}

fn scene_row(scene: CanaryScene, row: u32) -> vec4<u32> {
    let material = scene.material;
    let lamp = scene.lamp;
    let sphere = scene.sphere;
    let body = scene.body;
    switch row {
        case 0u: { return vec4<u32>(bitcast<vec3<u32>>(material.albedo), material.scatter); }
        case 1u: { return bitcast<vec4<u32>>(vec4<f32>(material.emission, material.survival)); }
        case 2u: { return bitcast<vec4<u32>>(vec4<f32>(material.spread, material.lobe_mass, material.lobe_scale, material.shape)); }
        case 3u: { return bitcast<vec4<u32>>(vec4<f32>(lamp.center, lamp.radius)); }
        case 4u: { return vec4<u32>(bitcast<vec3<u32>>(lamp.emission), lamp.body); }
        case 5u: { return vec4<u32>(bitcast<u32>(lamp.weight_radius), 0u, 0u, 0u); }
        case 6u: { return bitcast<vec4<u32>>(vec4<f32>(sphere.center, sphere.radius)); }
        case 7u: { return vec4<u32>(sphere.material, sphere.lamp, sphere.body, 0u); }
        case 8u: { return vec4<u32>(bitcast<vec3<u32>>(body.center), body.material); }
        case 9u: { return vec4<u32>(bitcast<vec3<u32>>(body.half_size), body.id); }
        case 10u: { return vec4<u32>(bitcast<vec3<u32>>(body.axis_x), body.body); }
        case 11u: { return vec4<u32>(bitcast<vec3<u32>>(body.axis_y), 0u); }
        default: { return vec4<u32>(bitcast<vec3<u32>>(body.axis_z), 0u); }
    }
}

fn job_row(row: u32) -> vec4<u32> {
    switch row {
        case 0u: { return bitcast<vec4<u32>>(vec4<f32>(job.camera.forward, job.camera.aperture)); }
        case 1u: { return bitcast<vec4<u32>>(vec4<f32>(job.camera.right, job.camera.focus)); }
        case 2u: { return vec4<u32>(bitcast<vec3<u32>>(job.camera.down), 0u); }
        case 3u: { return vec4<u32>(bitcast<vec2<u32>>(job.camera.pixel), 0u, 0u); }
        case 4u: { return vec4<u32>(bitcast<vec3<u32>>(job.pole.x), 0u); }
        case 5u: { return vec4<u32>(bitcast<vec3<u32>>(job.pole.y), 0u); }
        case 6u: { return vec4<u32>(bitcast<vec3<u32>>(job.pole.z), 0u); }
        case 7u: { return bitcast<vec4<u32>>(vec4<f32>(job.background, job.clamp)); }
        default: { return vec4<u32>(job.corner, job.seed); }
    }
}

// in.x is the place: 0 the uniform buffer's job, 1 its scene, 2 + i scene i of the storage buffer.
fn layout_row(in: vec4<u32>) -> vec4<u32> {
    switch in.x {
        case 0u: { return job_row(in.y); }
        case 1u: { return scene_row(job.scene, in.y); }
        default: { return scene_row(scenes[in.x - 2u], in.y); }
    }
}

// What the bit test says of a number that has gone through arithmetic which leaves its value.
fn finiteness(in: vec4<u32>) -> vec4<u32> {
    let x = bitcast<f32>(in.x) * bitcast<f32>(in.y) + bitcast<f32>(in.z);
    let alone = select(0u, 1u, is_finite(x));
    let second = select(0u, 1u, all_finite(vec3<f32>(1.0, x, 2.0)));
    let last = select(0u, 1u, all_finite(vec3<f32>(1.0, 2.0, x)));
    return vec4<u32>(alone, second, last, 1u);
}

// in.y is 1, in.z is 0: a number copied, multiplied and added to.
fn denormal(in: vec4<u32>) -> vec4<u32> {
    let x = bitcast<f32>(in.x);
    let product = x * bitcast<f32>(in.y);
    let sum = x + bitcast<f32>(in.z);
    return vec4<u32>(bitcast<u32>(x), bitcast<u32>(product), bitcast<u32>(sum), 1u);
}

// Reads and writes past the ends of the buffers, then a value in its place.
fn beyond(lane: u32, in: vec4<u32>) -> vec4<u32> {
    let past_inputs = arrayLength(&inputs) + lane;
    let past_outputs = arrayLength(&outputs) + lane;
    let wild = vec4<u32>(0xdeadbeefu);
    outputs[past_outputs] = wild;
    outputs[past_outputs + 65536u] = wild;
    outputs[0xffffffffu - lane] = wild;
    return vec4<u32>(in.x, inputs[past_inputs].x, inputs[past_inputs * 1024u].x, inputs[0xffffffffu - lane].x);
}

fn floats(in: vec4<u32>) -> vec4<u32> {
    let x = bitcast<f32>(in.x);
    let y = bitcast<f32>(in.y);
    if in.z == 0u {
        return bitcast<vec4<u32>>(vec4<f32>(x / y, sqrt(x), inverseSqrt(x), 1.0));
    }
    return bitcast<vec4<u32>>(vec4<f32>(sincos_turn(x), unit_circle(y)));
}

fn conversion(in: vec4<u32>) -> vec4<u32> {
    let x = bitcast<f32>(in.x);
    let unit = f32(in.y >> 8u) * 5.9604645e-8;
    return vec4<u32>(u32(x), bitcast<u32>(i32(x)), bitcast<u32>(f32(in.y)), bitcast<u32>(unit));
}

fn canary(lane: u32, in: vec4<u32>) -> vec4<u32> {
    switch job.canary {
        case CANARY_LOOPS: { return loops(in); }
        case CANARY_INTEGERS: { return integers(in); }
        case CANARY_RANDOM: { return random_words(in.x); }
        case CANARY_LAYOUT: { return layout_row(in); }
        case CANARY_FINITE: { return finiteness(in); }
        case CANARY_DENORMALS: { return denormal(in); }
        case CANARY_BOUNDS: { return beyond(lane, in); }
        case CANARY_FLOATS: { return floats(in); }
        case CANARY_CONVERSION: { return conversion(in); }
        default: { return vec4<u32>(0u); }
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) lane: vec3<u32>) {
    if lane.x < job.count {
        outputs[lane.x] = canary(lane.x, inputs[lane.x]);
    }
}
