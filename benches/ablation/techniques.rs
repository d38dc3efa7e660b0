//! What makes the baked kernel fast, one technique a row, each with the change that takes it away and
//! what was expected of that before it was measured.

use super::edit::Edit;

/// What taking a technique away does to the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Picture {
    /// Nothing, to the last bit.
    Bits,
    /// Rounding, and no more.
    Mean,
}

#[derive(Clone, Copy, Debug)]
pub struct Technique {
    pub name: &'static str,
    /// What stands in its place.
    pub instead: &'static str,
    /// Processor time of a sample without it, of that with it: Mesa 22.3.6, 25.0.7.
    pub expected: [f64; 2],
    pub edits: &'static [Edit],
    /// Samples of a pixel in a dispatch.
    pub samples: u32,
    pub picture: Picture,
}

/// Samples of a pixel in a dispatch, where nothing else is said.
pub const SAMPLES: u32 = 64;

const PLAIN: Technique = Technique {
    name: "",
    instead: "",
    expected: [1.0, 1.0],
    edits: &[],
    samples: SAMPLES,
    picture: Picture::Bits,
};

pub const TECHNIQUES: &[Technique] = &[
    Technique {
        name: "min and max by selects",
        instead: "the built-in min and max",
        expected: [1.1, 1.1],
        edits: &[
            Edit::Text("return select(b, a, a < b);", "return min(a, b);"),
            Edit::Text("return select(b, a, a > b);", "return max(a, b);"),
        ],
        ..PLAIN
    },
    Technique {
        name: "surface data by selects",
        instead: "arrays in the uniform buffer, with an index that differs from lane to lane",
        expected: [1.3, 1.2],
        edits: &[
            Edit::General("material_at"),
            Edit::General("sphere_at"),
            Edit::General("box_at"),
            Edit::General("lamp_at"),
        ],
        ..PLAIN
    },
    Technique {
        name: "bodies straight down",
        instead: "loops over them, their data by selects",
        expected: [1.8, 1.15],
        edits: &[Edit::General("nearest_hit"), Edit::General("occluded")],
        ..PLAIN
    },
    Technique {
        name: "one polynomial for sine and cosine",
        instead: "the built-in sin and cos",
        expected: [1.1, 1.1],
        edits: &[Edit::Function(
            "sincos_turn",
            "fn sincos_turn(x: f32) -> vec2<f32> {\n    return vec2<f32>(sin(2.0 * PI * x), cos(2.0 * PI * x));\n}\n",
        )],
        picture: Picture::Mean,
        ..PLAIN
    },
    Technique {
        name: "shadow rays look for any body",
        instead: "the nearest body, compared with the lamp's distance",
        expected: [1.06, 1.06],
        edits: &[Edit::Function(
            "occluded",
            "fn occluded(ray: Ray, reach: f32, target_body: u32) -> bool {\n    let hit = nearest_hit(ray);\n    return hit.body != 0u && hit.body != target_body && hit.distance < reach;\n}\n",
        )],
        picture: Picture::Mean,
        ..PLAIN
    },
    Technique {
        name: "a lane goes on with its pixel's next sample",
        instead: "a loop over samples, and in it one over the vertices of a path",
        expected: [1.35, 1.35],
        edits: &[Edit::Text(
            "        if INTERRUPTION_RULE != INTERRUPTION_RULE_EFFICIENCY || path.alive {\n            step_path(&path);\n        }\n",
            "        while path.alive {\n            step_path(&path);\n        }\n",
        )],
        ..PLAIN
    },
    Technique {
        name: "shadow rays try every body",
        instead: "an early return at the first that blocks",
        expected: [1.0, 1.0],
        edits: &[Edit::Every(
            "    blocked |= blocks(",
            "    if blocked {\n        return true;\n    }\n    blocked = blocks(",
        )],
        ..PLAIN
    },
    Technique {
        name: "what was dispatched is read once",
        instead: "the uniform buffer, wherever it is needed",
        expected: [1.1, 1.0],
        edits: &[
            Edit::Text("    job = dispatched;\n", ""),
            Edit::Text("var<private> job: Job;\n", ""),
            Edit::Text("var<uniform> dispatched: Job;", "var<uniform> job: Job;"),
        ],
        ..PLAIN
    },
    Technique {
        name: "meetings as a distance and a truth",
        instead: "-1 for none, and a floor under the distance to each body",
        expected: [1.04, 1.04],
        edits: &[Edit::Function("first_meeting", SENTINEL)],
        ..PLAIN
    },
    Technique {
        name: "scattering's density once a light sample",
        instead: "once for the light reflected and once for its weight",
        expected: [1.02, 1.02],
        edits: &[Edit::Text(
            "evaluate_by_density(material, surface.normal, incoming, light.direction, density);",
            "evaluate_scatter(material, surface.normal, incoming, light.direction);",
        )],
        ..PLAIN
    },
    Technique {
        name: "unit vectors with one division or none",
        instead: "normalize, and a vector divided by its length",
        expected: [1.1, 1.1],
        edits: &[
            Edit::Text("return v * inverseSqrt(dot(v, v));", "return normalize(v);"),
            Edit::Text(
                "return v * (1.5 - 0.5 * dot(v, v));",
                "return normalize(v);",
            ),
            Edit::Text(
                "to_center * inverse,",
                "to_center / greater(distance, 1e-30),",
            ),
            Edit::Text(
                "lamp.radius * inverse;",
                "lamp.radius / greater(distance, 1e-30);",
            ),
        ],
        picture: Picture::Mean,
        ..PLAIN
    },
    Technique {
        name: "branches around what ended paths do not need",
        instead: "one straight line with selects (not kept)",
        expected: [0.9, 0.9],
        edits: &[Edit::Function("step_path", STRAIGHT)],
        ..PLAIN
    },
    Technique {
        name: "a pixel a lane",
        instead: "four pixels a lane, one after the other, in a quarter of the groups (not kept)",
        expected: [0.94, 0.94],
        edits: &[Edit::Function("main", FOUR_PIXELS)],
        ..PLAIN
    },
    Technique {
        name: "products and sums apart",
        instead: "fma in the tests of spheres and boxes and in sine and cosine (not kept)",
        expected: [0.95, 0.95],
        edits: &[
            Edit::Text(
                "let nearest = from_center + b * ray.direction;",
                "let nearest = fma(vec3<f32>(b), ray.direction, from_center);",
            ),
            Edit::Text(
                "let enter = middle - reach;",
                "let enter = fma(-half_size, abs(inverse), middle);",
            ),
            Edit::Text(
                "let leave = middle + reach;",
                "let leave = fma(half_size, abs(inverse), middle);",
            ),
            Edit::Text(
                "let s = x * (3.1415927 + z * (-5.1677103 + z * (2.5500777 + z * (-0.59829217 + z * 0.077659406))));",
                "let s = x * fma(z, fma(z, fma(z, fma(z, 0.077659406, -0.59829217), 2.5500777), -5.1677103), 3.1415927);",
            ),
        ],
        picture: Picture::Mean,
        ..PLAIN
    },
    Technique {
        name: "64 samples of a pixel in a dispatch",
        instead: "16",
        expected: [1.08, 1.08],
        samples: 16,
        ..PLAIN
    },
];

const SENTINEL: &str = "\
fn first_meeting(crossing: Crossing, ray: Ray, body: u32) -> Meeting {
    let own = ray.source == body;
    let outside = crossing.near > 0.0 && !own;
    let distance = select(crossing.far, crossing.near, outside);
    let kept = select(distance, greater(distance, 1e-30), own);
    let found = select(-1.0, kept, select(crossing.met, ray.inside, own));
    return Meeting(found, found > 0.0);
}
";

const STRAIGHT: &str = "\
fn step_path(path: ptr<function, Path>) {
    let hit = nearest_hit((*path).ray);
    let met = hit.body != 0u;
    let surface = surface_at(hit, (*path).ray);
    let background = select(vec3<f32>(0.0), job.background, emission_counts(*path));
    (*path).radiance += (*path).throughput * select(background, emitted(*path, surface, hit.distance), met);
    let goes_on = met && (*path).vertex < job.max_bounces;
    let material = material_at(surface.material);
    let u = random_unit((*path).key, (*path).vertex + 1u, 0u);
    let tested = INTERRUPTION_RULE != INTERRUPTION_RULE_NONE && (*path).vertex >= job.interruption_start;
    let carried = (*path).throughput * material.albedo;
    let probability = select(1.0, survival_probability(material.survival, material.albedo, carried), tested);
    let weight = select(1.0, survival_weight(probability), tested);
    let before = INTERRUPTION_ORDER == INTERRUPTION_ORDER_BEFORE_DIRECT;
    let survives = goes_on && u.z < probability;
    let lit = goes_on && (survives || !before);
    (*path).throughput *= select(1.0, weight, before);
    let origin = offset_origin(surface.point, surface.normal);
    let direct = direct_light(*path, surface, origin);
    (*path).radiance += select(vec3<f32>(0.0), (*path).throughput * direct.radiance, lit);
    (*path).rays += 1u + select(0u, direct.rays, lit);
    (*path).throughput *= select(weight, 1.0, before);
    scatter_path(path, surface, origin, u.xy);
    (*path).alive = (*path).alive && survives;
}
";

const FOUR_PIXELS: &str = "\
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    job = dispatched;
    var lane = group.xy * 8u + local.xy;
    if group.x % 4u != 0u || lane.x >= job.size.x || lane.y >= job.size.y {
        return;
    }
    let end = min(job.size.x, (group.x + 4u) * 8u);
    var slot = lane.y * job.size.x + lane.x;
    var run = empty_run();
    var count = 0u;
    var path = start_path(job.corner + lane, sample_index(0u));
    for (var step = 0u; step < 4u * job.steps; step++) {
        step_path(&path);
        if !path.alive {
            add_sample(&run, path);
            count += 1u;
            let done = count == job.samples;
            if done || sample_index(count).x % RUN_LENGTH == 0u {
                tallies[slot] = tally_of(run);
                slot += job.size.x * job.size.y;
                run = empty_run();
            }
            if done {
                lane.x += 8u;
                slot = lane.y * job.size.x + lane.x;
                count = 0u;
                if lane.x >= end {
                    break;
                }
            }
            path = start_path(job.corner + lane, sample_index(count));
        }
    }
}
";
