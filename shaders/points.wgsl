// The points kernel: draws by the renderer's own light and scatter samplers, to look at and to test.

// #import maths
// #import sequence
// #import scatter
// #import light

struct PointsJob {
    lamp: Lamp,
    material: Material,
    pole: Basis,
    // Where the lamp is seen from.
    receiver: vec3<f32>,
    // 1 where the receiver is inside the lamp, or the arriving ray inside the body.
    inside: u32,
    // Surface normal and arriving direction for scattering, unit length.
    normal: vec3<f32>,
    count: u32,
    incoming: vec3<f32>,
    // 0: points on the lamp. 1: scattered directions.
    scattering: u32,
    seed: vec2<u32>,
    // Number of the first draw, as (low, high).
    first: vec2<u32>,
}

struct Draw {
    // A point of the lamp as a unit vector from its centre, or a scattered direction.
    point: vec3<f32>,
    // By solid angle as seen from the receiver or the surface; 0 where there is none.
    density: f32,
    // 1 where it counts: the lamp's point faces the receiver, the direction leaves the surface.
    useful: u32,
    _pad0: u32,
    _pad1: u32,
    _pad2: u32,
}

@group(1) @binding(0) var<uniform> job: PointsJob;
@group(1) @binding(1) var<storage, read_write> draws: array<Draw>;

fn draw_light(u: vec4<f32>) -> Draw {
    let light = sample_light(job.lamp, job.pole, job.receiver, job.normal, job.inside == 1u, u);
    let cone = lamp_cone(job.lamp, job.receiver);
    var outward = normalize(job.receiver + light.distance * light.direction - job.lamp.center);
    let by_cone = LIGHT_SAMPLER == LIGHT_SAMPLER_CONE && cone.open && job.inside == 0u;
    if !by_cone && LIGHT_SAMPLER != LIGHT_SAMPLER_PROJECTED_CAP {
        outward = sample_surface(light_pole(job.pole, cone), drawn_height(job.lamp, cone, job.inside == 1u), u);
    }
    let seen = light.inverse_density > 0.0;
    let density = select(0.0, 1.0 / greater(light.inverse_density, 1e-30), seen);
    return Draw(outward, density, select(0u, 1u, seen), 0u, 0u, 0u);
}

fn draw_scatter(u: vec4<f32>) -> Draw {
    let scattered = sample_scatter(job.material, job.normal, job.incoming, job.inside == 1u, u.xy);
    let useful = select(0u, 1u, dot(scattered.direction, job.normal) > 0.0);
    return Draw(scattered.direction, scattered.density, useful, 0u, 0u, 0u);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) lane: vec3<u32>) {
    if lane.x >= job.count {
        return;
    }
    let low = job.first.x + lane.x;
    let number = vec2<u32>(low, job.first.y + select(0u, 1u, low < job.first.x));
    let u = sequence_unit(sequence_key(job.seed, vec2<u32>(0u), number), 1u, 1u);
    if job.scattering == 1u {
        draws[lane.x] = draw_scatter(u);
    } else {
        draws[lane.x] = draw_light(u);
    }
}
