// The features kernel: what the ray through each pixel's centre meets first.

// #import camera
// #import ray
// #import scene
// #import traversal

struct FeatureJob {
    camera: Camera,
    corner: vec2<u32>,
    size: vec2<u32>,
    // No lane takes more iterations than this where it counts them.
    iterations: u32,
}

// The id where the traversal was left before its end.
const UNFINISHED: u32 = 0xffffffffu;

struct Feature {
    normal: vec3<f32>,
    depth: f32,
    albedo: vec3<f32>,
    id: u32,
}

@group(1) @binding(0) var<uniform> job: FeatureJob;
@group(1) @binding(1) var<storage, read_write> features: array<Feature>;

fn feature_at(film: vec2<f32>) -> Feature {
    let ray = Ray(vec3<f32>(0.0), camera_direction(job.camera, film), 0u, false);
    allow(job.iterations);
    let hit = nearest_hit(ray);
    if cut_short() {
        return Feature(vec3<f32>(0.0), 0.0, vec3<f32>(0.0), UNFINISHED);
    }
    if hit.body == 0u {
        return Feature(vec3<f32>(0.0), 0.0, vec3<f32>(0.0), 0u);
    }
    let surface = surface_at(hit, ray);
    return Feature(surface.normal, hit.distance, material_at(surface.material).albedo, surface.id);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) lane: vec3<u32>) {
    if lane.x < job.size.x && lane.y < job.size.y {
        let film = vec2<f32>(job.corner + lane.xy) + 0.5;
        features[lane.y * job.size.x + lane.x] = feature_at(film);
    }
}
