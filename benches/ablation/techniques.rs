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
            "    for (var step = 0u; step < job.steps; step++) {\n        step_path(&path);\n",
            "    for (var step = 0u; step < job.steps; step++) {\n        while path.alive {\n            step_path(&path);\n        }\n",
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
        name: "64 samples of a pixel in a dispatch",
        instead: "16",
        expected: [1.08, 1.08],
        samples: 16,
        ..PLAIN
    },
];
