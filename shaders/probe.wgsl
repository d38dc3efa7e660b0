// The probe kernel: runs one library function over a list of inputs, so that tests can compare
// the GPU with the CPU twin function by function.

// #import maths
// #import random
// #import sequence
// #import camera
// #import ray
// #import sphere
// #import box
// #import scatter
// #import glass
// #import light
// #import light_tree
// #import rectangle
// #import interruption
// #import efficiency

struct ProbeJob {
    // One of the PROBE_ constants.
    function: u32,
    count: u32,
}

struct Input {
    a: vec4<f32>,
    b: vec4<f32>,
    c: vec4<f32>,
    d: vec4<f32>,
}

struct Output {
    a: vec4<f32>,
    b: vec4<f32>,
}

@group(1) @binding(0) var<uniform> job: ProbeJob;
@group(1) @binding(1) var<storage, read> inputs: array<Input>;
@group(1) @binding(2) var<storage, read_write> outputs: array<Output>;

fn crossing_output(crossing: Crossing) -> Output {
    return Output(vec4<f32>(crossing.near, crossing.far, select(0.0, 1.0, crossing.met), 0.0), vec4<f32>(0.0));
}

fn probe_material(in: Input) -> Material {
    let kind = u32(in.d.x);
    return Material(vec3<f32>(0.5, 0.25, 1.0), kind, vec3<f32>(0.0), 1.0, in.d.y, in.d.z, in.d.w, in.a.w);
}

fn probe_lamp(in: Input) -> Lamp {
    return Lamp(in.a.xyz, in.a.w, vec3<f32>(1.0), 1u, in.b.w, 0u, 0u, 0u);
}

// A box around the origin, turned as the probe's pole is.
fn probe_box(in: Input) -> Box {
    let axes = probe_pole();
    return Box(vec3<f32>(0.0), 0u, in.a.xyz, 1u, axes.x, 1u, axes.y, 1u, axes.z, 0u);
}

// Outward normal of one of six faces, in the box's own axes: -x, x, -y, y, -z, z.
fn probe_face(number: u32) -> vec3<f32> {
    let side = select(-1.0, 1.0, number % 2u == 1u);
    return select(vec3<f32>(0.0), vec3<f32>(side), vec3<u32>(0u, 1u, 2u) == vec3<u32>(number / 2u));
}

fn probe_pole() -> Basis {
    return basis_around(normalize(vec3<f32>(0.3, -0.5, 0.8)));
}

// Of the lit surface, by two numbers of the unit square.
fn probe_normal(in: Input) -> vec3<f32> {
    return unit_sphere(in.d.zw);
}

fn probe(in: Input) -> Output {
    let zero = vec4<f32>(0.0);
    switch job.function {
        case PROBE_RANDOM_BITS: {
            let key = random_key(bitcast<vec4<u32>>(in.a).xy, bitcast<vec4<u32>>(in.a).zw, bitcast<vec4<u32>>(in.b).xy);
            let bits = random_bits(key, bitcast<vec4<u32>>(in.b).z, bitcast<vec4<u32>>(in.b).w);
            return Output(bitcast<vec4<f32>>(bits), bitcast<vec4<f32>>(key));
        }
        case PROBE_RANDOM_UNIT: {
            let key = random_key(bitcast<vec4<u32>>(in.a).xy, bitcast<vec4<u32>>(in.a).zw, bitcast<vec4<u32>>(in.b).xy);
            return Output(random_unit(key, bitcast<vec4<u32>>(in.b).z, bitcast<vec4<u32>>(in.b).w), zero);
        }
        case PROBE_SEQUENCE: {
            let key = sequence_key(bitcast<vec4<u32>>(in.a).xy, bitcast<vec4<u32>>(in.a).zw, bitcast<vec4<u32>>(in.b).xy);
            return Output(sequence_unit(key, bitcast<vec4<u32>>(in.b).z, bitcast<vec4<u32>>(in.b).w), bitcast<vec4<f32>>(key));
        }
        case PROBE_SINCOS_TURN: {
            return Output(vec4<f32>(sincos_turn(in.a.x), unit_circle(in.a.y)), zero);
        }
        case PROBE_UNIT_SPHERE: {
            return Output(vec4<f32>(unit_sphere(in.a.xy), 0.0), zero);
        }
        case PROBE_ANGLE_OF_CHORD: {
            return Output(vec4<f32>(angle_of_chord(in.a.x), inverse_erf(in.a.y), 0.0, 0.0), zero);
        }
        case PROBE_BASIS_AROUND: {
            let basis = basis_around(in.a.xyz);
            return Output(vec4<f32>(basis.x, 0.0), vec4<f32>(basis.y, 0.0));
        }
        case PROBE_SAMPLE_FILM: {
            return Output(vec4<f32>(sample_film(vec2<u32>(in.a.xy), in.b.xy), 0.0, 0.0), zero);
        }
        case PROBE_INTERSECT_SPHERE: {
            return crossing_output(intersect_sphere(in.a.xyz, in.a.w, Ray(in.b.xyz, in.c.xyz, 0u, false)));
        }
        case PROBE_INTERSECT_BOX: {
            return crossing_output(intersect_box(in.a.xyz, in.b.xyz, safe_inverse(in.c.xyz)));
        }
        case PROBE_BOX_FACE: {
            let face = box_face(in.a.xyz, in.b.xyz, in.c.xyz);
            return Output(vec4<f32>(face.point, 0.0), vec4<f32>(face.normal, 0.0));
        }
        case PROBE_SAMPLE_SCATTER: {
            let scattered = sample_scatter(probe_material(in), in.a.xyz, in.b.xyz, in.b.w == 1.0, in.c.xy);
            return Output(vec4<f32>(scattered.direction, scattered.density), vec4<f32>(scattered.weight, 0.0));
        }
        case PROBE_EVALUATE_SCATTER: {
            let material = probe_material(in);
            let value = evaluate_scatter(material, in.a.xyz, in.b.xyz, in.c.xyz);
            return Output(vec4<f32>(value, scatter_density(material, in.a.xyz, in.b.xyz, in.c.xyz)), zero);
        }
        case PROBE_SAMPLE_LIGHT: {
            let light = sample_light(probe_lamp(in), probe_pole(), in.b.xyz, probe_normal(in), in.d.x == 1.0, in.c);
            return Output(vec4<f32>(light.direction, light.distance), vec4<f32>(light.weight, light.inverse_density, 0.0, 0.0));
        }
        case PROBE_LIGHT_DENSITY: {
            let lamp = probe_lamp(in);
            let to_point = lamp.center + lamp.radius * in.c.xyz - in.b.xyz;
            let reach = length(to_point);
            let density = light_inverse_density(
                lamp, probe_pole(), in.b.xyz, probe_normal(in), in.d.x == 1.0, to_point / reach, reach, in.c.xyz);
            return Output(vec4<f32>(density, power_heuristic(in.d.y), 0.0, 0.0), zero);
        }
        case PROBE_FIRST_SHARE: {
            let pair = LightPair(in.a, in.b, vec2<f32>(in.c.w, in.d.w), vec2<u32>(0u));
            return Output(vec4<f32>(f32(first_share(pair, in.c.xyz, in.d.xyz)), 0.0, 0.0, 0.0), zero);
        }
        case PROBE_SAMPLE_BOX: {
            let light = sample_box(probe_box(in), in.b.xyz, in.d.x == 1.0, in.c);
            return Output(vec4<f32>(light.direction, light.distance), vec4<f32>(light.inverse_density, 0.0, 0.0, 0.0));
        }
        case PROBE_BOX_DENSITY: {
            let shape = probe_box(in);
            let to = box_world(shape, in.c.xyz) - in.b.xyz;
            let outward = box_world(shape, probe_face(u32(in.d.y)));
            return Output(vec4<f32>(box_inverse_density(shape, in.b.xyz, in.d.x == 1.0, to, outward), 0.0, 0.0, 0.0), zero);
        }
        case PROBE_SURVIVAL: {
            let probability = survival_probability(in.a.x, in.b.xyz, in.c.xyz);
            return Output(vec4<f32>(probability, survival_weight(probability), 0.0, 0.0), zero);
        }
        case PROBE_FRESNEL: {
            let parts = fresnel(in.a.x, in.a.y);
            return Output(vec4<f32>(parts.reflectance, parts.cosine, 0.0, 0.0), zero);
        }
        case PROBE_LENS: {
            let camera = Camera(in.a.xyz, in.a.w, in.b.xyz, in.b.w, in.c.xyz, vec2<f32>(0.125));
            let lens = sample_lens(camera, in.d.xy);
            return Output(vec4<f32>(lens, 0.0), vec4<f32>(lens_direction(camera, in.d.zw, lens), 0.0));
        }
        case PROBE_FINITE: {
            return Output(vec4<f32>(select(0.0, 1.0, all_finite(in.a.xyz)), 0.0, 0.0, 0.0), zero);
        }
        case PROBE_CONTINUATIONS: {
            let wanted = wanted_continuations(Worth(in.a.xyz, in.b.xyz), in.c.xyz, in.a.w);
            let count = count_continuations(greater(in.d.x, 1.0), in.d.y);
            return Output(vec4<f32>(wanted, f32(count), 0.0, 0.0), zero);
        }
        case PROBE_BRANCH_KEY: {
            let word = bitcast<vec4<u32>>(in.b);
            let key = random_key(bitcast<vec4<u32>>(in.a).xy, bitcast<vec4<u32>>(in.a).zw, word.xy);
            return Output(bitcast<vec4<f32>>(branch_key(key, word.z, word.w)), zero);
        }
        default: {
            return Output(zero, zero);
        }
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) lane: vec3<u32>) {
    if lane.x < job.count {
        outputs[lane.x] = probe(inputs[lane.x]);
    }
}
