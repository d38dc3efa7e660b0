// The guides kernel: what the denoiser knows of a pixel without noise. Rays through a lattice of places in
// each pixel, spread as its samples are, find the first surface that is no mirror: what a mirror shows is
// then told apart as well as what is seen directly.

// #import camera
// #import ray
// #import scene
// #import scatter
// #import traversal

struct GuideJob {
    camera: Camera,
    // The first pixel, and lanes to both sides: `fineness` for each pixel.
    corner: vec2<u32>,
    size: vec2<u32>,
    fineness: u32,
    // Most mirrors that a ray follows.
    mirrors: u32,
    // No lane takes more iterations than this where it counts them.
    iterations: u32,
}

// The id where the traversal was left before it found anything.
const UNFINISHED: u32 = 0xffffffffu;

struct Guide {
    // Faces the arriving ray; zero where nothing is met.
    normal: vec3<f32>,
    // Of the whole way from the eye.
    distance: f32,
    // Relative to the eye.
    position: vec3<f32>,
    // Place in the scene file, 0 for nothing.
    id: u32,
    // The share of its light that the mirrors on the way reflect.
    tint: vec3<f32>,
    mirrors: u32,
}

@group(1) @binding(0) var<uniform> job: GuideJob;
@group(1) @binding(1) var<storage, read_write> guides: array<Guide>;

fn follows(material: Material) -> bool {
    return material.scatter == SURFACE_MIRROR && largest(material.emission) == 0.0;
}

// The end of a ray's way through the mirrors; where its iterations end before, the last mirror.
fn guide_at(film: vec2<f32>) -> Guide {
    let zero = vec3<f32>(0.0);
    var guide = Guide(zero, 0.0, zero, UNFINISHED, vec3<f32>(1.0), 0u);
    var ray = Ray(zero, camera_direction(job.camera, film), 0u, false);
    var tint = vec3<f32>(1.0);
    var way = 0.0;
    allow(job.iterations);
    for (var mirrors = 0u; mirrors <= job.mirrors; mirrors++) {
        let hit = nearest_hit(ray);
        if cut_short() {
            break;
        }
        if hit.body == 0u {
            guide = Guide(zero, 0.0, zero, 0u, tint, mirrors);
            break;
        }
        let surface = surface_at(hit, ray);
        way += hit.distance;
        guide = Guide(surface.normal, way, surface.point, surface.id, tint, mirrors);
        let material = material_at(surface.material);
        if !follows(material) {
            break;
        }
        tint *= material.albedo;
        let outgoing = mirror_direction(surface.normal, ray.direction);
        ray = Ray(offset_origin(surface.point, surface.normal), outgoing, surface.body, surface.inside);
    }
    return guide;
}

// Where in its pixel a ray starts: no two in one column or one row, so that edges along them are known as well
// as others (Kensler, "Correlated Multi-Jittered Sampling", 2013, section 2, without the jitter).
fn place_of(cell: vec2<u32>) -> vec2<f32> {
    let fineness = f32(job.fineness);
    let at = vec2<f32>(cell);
    return (at + (at.yx + 0.5) / fineness) / fineness;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) lane: vec3<u32>) {
    if lane.x < job.size.x && lane.y < job.size.y {
        let pixel = job.corner + lane.xy / job.fineness;
        guides[lane.y * job.size.x + lane.x] = guide_at(sample_film(pixel, place_of(lane.xy % job.fineness)));
    }
}
