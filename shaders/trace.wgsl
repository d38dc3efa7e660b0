// The tracing kernel: one lane a pixel, one flat loop over the vertices of the pixel's paths. A
// lane whose path ends starts the pixel's next sample, so that lanes stay full.

// #import maths
// #import sequence
// #import camera
// #import ray
// #import scene
// #import traversal
// #import scatter
// #import light
// #import choice
// #import rectangle
// #import background
// #import interruption
// #import efficiency
// #import branch

override LIGHT_STRATEGY: u32;
override LIGHT_DIRECT: u32;
// Whether the ray after the last reflection, which can only find emission, is traced.
override LAST_RAY: u32;

struct Job {
    camera: Camera,
    pole: Basis,
    background: vec3<f32>,
    // Largest radiance of a sample and channel.
    clamp: f32,
    // Upper left pixel and size of the block.
    corner: vec2<u32>,
    size: vec2<u32>,
    // 64 bits each, as (low, high).
    seed: vec2<u32>,
    first_sample: vec2<u32>,
    samples: u32,
    max_bounces: u32,
    interruption_start: u32,
    // No lane takes more steps than this, nor more iterations where it counts them.
    steps: u32,
}

// What a run of samples of one pixel gave. Runs end where the sample index is a multiple of
// RUN_LENGTH: sums in f32 never depend on how the work was split.
struct Tally {
    mean: vec3<f32>,
    rays: u32,
    squares: vec3<f32>,
    non_finite: u32,
}

@group(1) @binding(0) var<uniform> dispatched: Job;
@group(1) @binding(1) var<storage, read_write> tallies: array<Tally>;

// What was dispatched, read once: in Mesa 22 every lane fetches what it reads of a buffer by itself.
var<private> job: Job;

// A path on its way.
struct Path {
    key: vec4<u32>,
    ray: Ray,
    throughput: vec3<f32>,
    radiance: vec3<f32>,
    // Number of the hit that the ray is looking for; the camera's is 0.
    vertex: u32,
    // Of the direction the ray was scattered into; 0 where it has none.
    density: f32,
    // Of the surface that scattered it there.
    normal: vec3<f32>,
    rays: u32,
    alive: bool,
}

fn start_path(pixel: vec2<u32>, sample: vec2<u32>) -> Path {
    begin_branches();
    let key = sequence_key(job.seed, pixel, sample);
    let film = sample_film(pixel, sequence_unit(key, 0u, 0u).xy);
    var ray = Ray(vec3<f32>(0.0), camera_direction(job.camera, film), 0u, false);
    if LENS == 1u {
        ray.origin = sample_lens(job.camera, sequence_unit(key, 0u, 1u).xy);
        ray.direction = lens_direction(job.camera, film, ray.origin);
    }
    return Path(key, ray, vec3<f32>(1.0), vec3<f32>(0.0), 0u, 0.0, vec3<f32>(0.0), 0u, true);
}

// Whether what a ray finds by itself counts. As published only what the camera sees does.
fn emission_counts(path: Path) -> bool {
    return path.vertex == 0u || LIGHT_DIRECT == LIGHT_DIRECT_BSDF;
}

// Weight of a lamp's emission found by a ray. Where shadow rays could not have found it (before
// the first reflection, or after a direction without density), all of it.
fn lamp_hit_weight(path: Path, surface: Surface, distance: f32) -> f32 {
    if path.density == 0.0 || LIGHT_STRATEGY == LIGHT_STRATEGY_HIT {
        return 1.0;
    }
    if LIGHT_STRATEGY == LIGHT_STRATEGY_SAMPLE {
        return 0.0;
    }
    let lamp = lamp_at(surface.lamp - 1u);
    let probability = choice_probability(surface.lamp - 1u, path.ray.origin, path.normal);
    let outward = select(surface.normal, -surface.normal, surface.inside);
    if BOX_LAMPS == 1u && lamp.shape != 0u {
        let to = distance * path.ray.direction;
        let shape = box_at(lamp.shape - 1u);
        let drawn = box_inverse_density(shape, path.ray.origin, surface.inside, to, outward);
        return power_heuristic(probability / greater(drawn * path.density, 1e-30));
    }
    let inverse_density = light_inverse_density(
        lamp, job.pole, path.ray.origin, path.normal, surface.inside, path.ray.direction, distance, outward);
    return power_heuristic(probability / greater(inverse_density * path.density, 1e-30));
}

fn emitted(path: Path, surface: Surface, distance: f32) -> vec3<f32> {
    let emission = material_at(surface.material).emission;
    if !emission_counts(path) || largest(emission) == 0.0 {
        return vec3<f32>(0.0);
    }
    if surface.lamp == 0u {
        return emission;
    }
    return emission * lamp_hit_weight(path, surface, distance);
}

// Direct light at a hit, and the shadow rays that it took.
struct DirectLight {
    radiance: vec3<f32>,
    rays: u32,
}

// What one lamp sends to a surface and the surface sends on along the path, by one shadow ray
// from `origin`, a point just off the surface. `inverse_probability`: of the choice of this lamp.
fn light_from(
    lamp: Lamp,
    inverse_probability: f32,
    path: Path,
    surface: Surface,
    origin: vec3<f32>,
    u: vec4<f32>,
) -> DirectLight {
    let material = material_at(surface.material);
    let incoming = path.ray.direction;
    let own = surface.body == lamp.body;
    let inside = select(distance(lamp.center, origin) < lamp.radius, surface.inside, own);
    var light: LightSample;
    if BOX_LAMPS == 1u && lamp.shape != 0u {
        let shape = box_at(lamp.shape - 1u);
        let from_center = box_local(shape, origin - shape.center);
        let drawn = sample_box(shape, origin, select(all(abs(from_center) < shape.half_size), surface.inside, own), u);
        light = LightSample(drawn.direction, drawn.distance, drawn.inverse_density, drawn.inverse_density);
    } else {
        light = sample_light(lamp, job.pole, origin, surface.normal, inside, u);
    }
    let density = scatter_density(material, surface.normal, incoming, light.direction);
    var reflected = evaluate_lambert(material, surface.normal, light.direction);
    if LIGHT_DIRECT == LIGHT_DIRECT_BSDF {
        reflected = evaluate_by_density(material, surface.normal, incoming, light.direction, density);
    }
    var weight = light.weight * inverse_probability;
    if LIGHT_STRATEGY == LIGHT_STRATEGY_MIS {
        weight *= power_heuristic(light.inverse_density * inverse_probability * density);
    }
    let value = reflected * weight * lamp.emission;
    // A lamp never lights its own outer side.
    if largest(value) == 0.0 || (own && !surface.inside) {
        return DirectLight(vec3<f32>(0.0), 0u);
    }
    let shadow = Ray(origin, light.direction, surface.body, surface.inside);
    let blocked = occluded(shadow, light.distance, lamp.body);
    return DirectLight(select(value, vec3<f32>(0.0), blocked), 1u);
}

// What the background sends to a surface and the surface sends on along the path, by one shadow ray.
fn light_from_background(path: Path, surface: Surface, origin: vec3<f32>, u: vec2<f32>) -> DirectLight {
    let material = material_at(surface.material);
    let direction = sample_cosine(surface.normal, u);
    let inverse_density = background_inverse_density(surface.normal, direction);
    let density = scatter_density(material, surface.normal, path.ray.direction, direction);
    let reflected = evaluate_by_density(material, surface.normal, path.ray.direction, direction, density);
    let other = select(0.0, density, LIGHT_STRATEGY == LIGHT_STRATEGY_MIS);
    let value = reflected * inverse_density * power_heuristic(inverse_density * other) * job.background;
    if largest(value) == 0.0 {
        return DirectLight(vec3<f32>(0.0), 0u);
    }
    let blocked = occluded(Ray(origin, direction, surface.body, surface.inside), 3e38, 0u);
    return DirectLight(select(value, vec3<f32>(0.0), blocked), 1u);
}

// Weight of the background seen by a ray: all of it where shadow rays could not have found it.
fn background_weight(path: Path) -> f32 {
    if BACKGROUND_LAMP == 0u || path.density == 0.0 {
        return 1.0;
    }
    if LIGHT_STRATEGY == LIGHT_STRATEGY_SAMPLE {
        return 0.0;
    }
    let inverse_density = background_inverse_density(path.normal, path.ray.direction);
    return power_heuristic(1.0 / greater(inverse_density * path.density, 1e-30));
}

// The paper's light of lamps, one shadow ray to each; or one to a lamp that is drawn.
fn light_from_lamps(path: Path, surface: Surface, origin: vec3<f32>) -> DirectLight {
    if LIGHT_CHOICE != LIGHT_CHOICE_ALL && LAMP_COUNT > 0u {
        let chosen = choose_lamp(path.key, path.vertex + 1u, origin, surface.normal);
        let u = sequence_unit(path.key, path.vertex + 1u, 1u);
        return light_from(lamp_at(chosen.lamp), chosen.inverse_probability, path, surface, origin, u);
    }
    var sum = DirectLight(vec3<f32>(0.0), 0u);
    for (var i = 0u; i < LAMP_COUNT; i++) {
        let u = sequence_unit(path.key, path.vertex + 1u, i + 1u);
        let one = light_from(lamp_at(i), 1.0, path, surface, origin, u);
        sum = DirectLight(sum.radiance + one.radiance, sum.rays + one.rays);
    }
    return sum;
}

// The light of lamps, and of the background where that is asked for.
fn direct_light(path: Path, surface: Surface, origin: vec3<f32>) -> DirectLight {
    if LIGHT_STRATEGY == LIGHT_STRATEGY_HIT {
        return DirectLight(vec3<f32>(0.0), 0u);
    }
    let lamps = light_from_lamps(path, surface, origin);
    if BACKGROUND_LAMP == 0u {
        return lamps;
    }
    let u = sequence_unit(path.key, path.vertex + 1u, BACKGROUND_SLOT);
    let one = light_from_background(path, surface, origin, u.xy);
    return DirectLight(lamps.radiance + one.radiance, lamps.rays + one.rays);
}

// Whether the ray that leaves the hit before the last can still bring something.
fn last_ray_counts(scattered: Scattered) -> bool {
    return LAST_RAY == LAST_RAY_ALWAYS || (LAST_RAY == LAST_RAY_WITHOUT_DENSITY && scattered.density == 0.0);
}

// The ray that scattering at a surface makes of the path; the path ends where it carries nothing.
fn scatter_path(path: ptr<function, Path>, surface: Surface, origin: vec3<f32>, u: vec2<f32>) {
    let material = material_at(surface.material);
    let scattered = sample_scatter(material, surface.normal, (*path).ray.direction, surface.inside, u);
    (*path).throughput *= scattered.weight;
    (*path).density = scattered.density;
    (*path).ray = Ray(origin, scattered.direction, surface.body, surface.inside);
    // What goes through starts on the other side. Below any other surface the path carries nothing.
    if GLASS_SURFACES == 1u && dot(scattered.direction, surface.normal) < 0.0 {
        (*path).ray.origin = offset_origin(surface.point, -surface.normal);
        (*path).ray.inside = !surface.inside;
    }
    (*path).vertex += 1u;
    let useful = (*path).vertex < job.max_bounces || last_ray_counts(scattered);
    (*path).alive = useful && largest((*path).throughput) > 0.0;
    (*path).normal = surface.normal;
}

// How many rays should leave a hit; only the rule `efficiency` asks.
fn continuations(path: Path, surface: Surface) -> f32 {
    return wanted_continuations(worth_at(surface.body - 1u), path.throughput, f32(branches_allowed));
}

// The path goes on as that many, each with its share of the throughput: that of the whole number, so that splitting
// adds no noise of its own.
fn split_path(path: ptr<function, Path>, surface: Surface, origin: vec3<f32>, wanted: f32, u: f32) {
    let count = count_continuations(wanted, u);
    (*path).throughput /= f32(count);
    let branching = Branching(
        (*path).key, (*path).vertex, (*path).throughput, (*path).ray.direction, surface, origin, 0u, 0u);
    open_branching(branching, count);
}

// A path that has ended goes on as its next branch; false where it has no more.
fn next_branch(path: ptr<function, Path>) -> bool {
    if branchings_open == 0u {
        return false;
    }
    let branching = take_branch();
    (*path).key = branching.key;
    (*path).vertex = branching.vertex;
    (*path).throughput = branching.throughput;
    (*path).ray.direction = branching.incoming;
    let u = sequence_unit(branching.key, branching.vertex + 1u, 0u);
    scatter_path(path, branching.surface, branching.origin, u.xy);
    return true;
}

// Emission, direct light and the next ray of one hit; the interruption test stands before or
// after direct light.
fn visit(path: ptr<function, Path>, surface: Surface, distance: f32) {
    (*path).radiance += (*path).throughput * emitted(*path, surface, distance);
    if (*path).vertex >= job.max_bounces {
        (*path).alive = false;
        return;
    }
    let material = material_at(surface.material);
    let u = sequence_unit((*path).key, (*path).vertex + 1u, 0u);
    let tested = INTERRUPTION_RULE != INTERRUPTION_RULE_NONE && (*path).vertex >= job.interruption_start;
    let carried = (*path).throughput * material.albedo;
    var threshold = material.survival;
    if INTERRUPTION_RULE == INTERRUPTION_RULE_EFFICIENCY {
        threshold = select(1.0, continuations(*path, surface), tested);
    }
    let probability = select(1.0, survival_probability(threshold, material.albedo, carried), tested);
    let survives = u.z < probability;
    let weight = select(1.0, survival_weight(probability), tested);
    if INTERRUPTION_ORDER == INTERRUPTION_ORDER_BEFORE_DIRECT {
        (*path).throughput *= weight;
        (*path).alive = survives;
        if !survives {
            return;
        }
    }
    let origin = offset_origin(surface.point, surface.normal);
    let direct = direct_light(*path, surface, origin);
    (*path).radiance += (*path).throughput * direct.radiance;
    (*path).rays += direct.rays;
    if INTERRUPTION_ORDER == INTERRUPTION_ORDER_AFTER_DIRECT {
        (*path).throughput *= weight;
        (*path).alive = survives;
        if !survives {
            return;
        }
    }
    if INTERRUPTION_RULE == INTERRUPTION_RULE_EFFICIENCY {
        split_path(path, surface, origin, greater(threshold, 1.0), u.z);
    }
    scatter_path(path, surface, origin, u.xy);
}

fn step_path(path: ptr<function, Path>) {
    let hit = nearest_hit((*path).ray);
    (*path).rays += 1u;
    if hit.body == 0u {
        let counts = emission_counts(*path);
        let background = job.background * background_weight(*path);
        (*path).radiance += (*path).throughput * select(vec3<f32>(0.0), background, counts);
        (*path).alive = false;
        return;
    }
    visit(path, surface_at(hit, (*path).ray), hit.distance);
}

// Sums of one run, as distances from its first sample: they lose no digits where all are alike.
struct Run {
    first: vec3<f32>,
    sum: vec3<f32>,
    squares: vec3<f32>,
    samples: u32,
    rays: u32,
    non_finite: u32,
}

fn empty_run() -> Run {
    return Run(vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0), 0u, 0u, 0u);
}

fn add_sample(run: ptr<function, Run>, path: Path) {
    let finite = all_finite(path.radiance);
    let radiance = select(vec3<f32>(0.0), min(path.radiance, vec3<f32>(job.clamp)), finite);
    let first_fault = select(0u, (*run).samples << 16u, (*run).non_finite == 0u);
    (*run).non_finite += select(first_fault + 1u, 0u, finite);
    (*run).first = select((*run).first, radiance, (*run).samples == 0u);
    let apart = radiance - (*run).first;
    (*run).sum += apart;
    (*run).squares += apart * apart;
    (*run).samples += 1u;
    (*run).rays += path.rays;
}

fn tally_of(run: Run) -> Tally {
    let shift = run.sum / f32(run.samples);
    let squares = max(run.squares - run.sum * shift, vec3<f32>(0.0));
    return Tally(run.first + shift, run.rays, squares, run.non_finite);
}

// Sample number `count` of this block, carried into the high word.
fn sample_index(count: u32) -> vec2<u32> {
    let low = job.first_sample.x + count;
    return vec2<u32>(low, job.first_sample.y + select(0u, 1u, low < job.first_sample.x));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) lane: vec3<u32>) {
    job = dispatched;
    if lane.x >= job.size.x || lane.y >= job.size.y {
        return;
    }
    let pixel = job.corner + lane.xy;
    var slot = lane.y * job.size.x + lane.x;
    var run = empty_run();
    var count = 0u;
    var path = start_path(pixel, sample_index(0u));
    allow(job.steps);
    for (var step = 0u; step < job.steps; step++) {
        // A branch may end where it begins.
        if INTERRUPTION_RULE != INTERRUPTION_RULE_EFFICIENCY || path.alive {
            step_path(&path);
        }
        if cut_short() {
            break;
        }
        if !path.alive && INTERRUPTION_RULE == INTERRUPTION_RULE_EFFICIENCY && next_branch(&path) {
            continue;
        }
        if !path.alive {
            add_sample(&run, path);
            count += 1u;
            let next = sample_index(count);
            let done = count == job.samples;
            if done || next.x % RUN_LENGTH == 0u {
                tallies[slot] = tally_of(run);
                slot += job.size.x * job.size.y;
                run = empty_run();
            }
            if done {
                break;
            }
            path = start_path(pixel, next);
        }
    }
}
