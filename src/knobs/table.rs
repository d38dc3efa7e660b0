//! The one table of knobs. The scene parser, `--set`, `lampray knobs`, records, sweep columns, the
//! JSON Schema and the README's tables are all made from it; a new knob needs one line here and a
//! field where its value is used.

use super::choice::*;
use super::kind::{Kind, Range, Value};
use std::borrow::Cow;

/// One knob.
#[derive(Debug)]
pub struct Knob {
    /// Its path; `*` stands for the name of a material or the number of a sphere or box.
    pub path: &'static str,
    pub kind: Kind,
    /// Unit of measure; empty where there is none.
    pub unit: &'static str,
    pub given: Given,
    /// One sentence, without a full stop.
    pub meaning: &'static str,
}

/// What a knob is when nobody sets it.
#[derive(Debug)]
pub enum Given {
    /// Nothing: a scene must say it.
    Required,
    Default(Value),
    /// What the preset says, in the order of `Preset::ALL`; the default is the reference's.
    Presets([Value; 4]),
}

impl Knob {
    /// The first part of the path: the table of the scene file.
    pub fn section(&self) -> &'static str {
        self.path
            .split_once('.')
            .map_or(self.path, |(section, _)| section)
    }

    /// The last part of the path: the key in that table.
    pub fn key(&self) -> &'static str {
        self.path.rsplit_once('.').map_or(self.path, |(_, key)| key)
    }

    /// Whether there is one for each material, sphere or box.
    pub fn repeats(&self) -> bool {
        self.path.contains(".*.")
    }

    /// The value under a preset when nothing else sets it; none if a scene must say it.
    pub fn value(&self, preset: Preset) -> Option<&Value> {
        match &self.given {
            Given::Required => None,
            Given::Default(value) => Some(value),
            Given::Presets(values) => Some(&values[preset.index() as usize]),
        }
    }

    /// The value when nothing sets it at all.
    pub fn default(&self) -> Option<&Value> {
        self.value(Preset::Reference)
    }

    /// Whether presets set it.
    pub fn in_presets(&self) -> bool {
        matches!(self.given, Given::Presets(_))
    }
}

const fn knob(
    path: &'static str,
    kind: Kind,
    unit: &'static str,
    given: Given,
    meaning: &'static str,
) -> Knob {
    Knob {
        path,
        kind,
        unit,
        given,
        meaning,
    }
}

const fn whole(value: u64) -> Given {
    Given::Default(Value::Integer(value))
}

const fn real(value: f64) -> Given {
    Given::Default(Value::Number(value))
}

const fn three(x: f64, y: f64, z: f64) -> Given {
    Given::Default(Value::Triple([x, y, z]))
}

const fn text(name: &'static str) -> Value {
    Value::Text(Cow::Borrowed(name))
}

/// Montelight, paper, corrected, reference.
const fn presets(names: [&'static str; 4]) -> Given {
    let [montelight, paper, corrected, reference] = names;
    Given::Presets([
        text(montelight),
        text(paper),
        text(corrected),
        text(reference),
    ])
}

const fn integer(least: u64, most: u64) -> Kind {
    Kind::Integer { least, most }
}

use Given::{Default, Presets, Required};
use Kind::{Choice as Name, Material, Number, OptionalNumber, Pole, Triple};

/// Every knob, in the order in which tables show them.
#[rustfmt::skip]
pub static KNOBS: &[Knob] = &[
    knob("camera.position", Triple(Range::ANY), "scene units", Required, "where the pinhole or the middle of the lens is"),
    knob("camera.look_at", Triple(Range::ANY), "scene units", Required, "the point in the middle of the picture"),
    knob("camera.up", Triple(Range::ANY), "", three(0.0, 1.0, 0.0), "the direction that is up in the picture"),
    knob("camera.fov", Number(Range::open(0.0, 180.0)), "degrees", real(45.0), "vertical field of view"),
    knob("camera.aperture", Number(Range::NOT_NEGATIVE), "scene units", real(0.0), "radius of a thin lens; 0 is a pinhole, in focus everywhere"),
    knob("camera.focus", OptionalNumber(Range::POSITIVE), "scene units", Default(Value::Off), "with an aperture: distance along the view to the plane in focus; off is that of look_at"),

    knob("image.width", integer(1, 32768), "pixels", whole(256), "width of the picture"),
    knob("image.height", integer(1, 32768), "pixels", whole(256), "height of the picture"),
    knob("image.filter", Name(Filter::NAMES), "", presets(["tent", "tent", "box", "box"]), "pixel filter: a box of 1 pixel, or a tent 2 pixels wide"),
    knob("image.exposure", Number(Range::closed(-100.0, 100.0)), "stops", real(0.0), "a PNG shows radiance times 2^exposure; EXR is left alone"),
    knob("image.encoding", Name(Encoding::NAMES), "", presets(["gamma22", "gamma22", "srgb", "srgb"]), "the curve from light to PNG values"),

    knob("render.samples", integer(1, 2_147_483_647), "paths", whole(64), "paths a pixel"),
    knob("render.seed", integer(0, u64::MAX), "", whole(0), "seed of the random numbers, 64 bits"),
    knob("render.max_bounces", integer(0, 1_000_000), "reflections", whole(8), "reflections a path may make: 0 is emission alone, 1 adds direct light"),
    knob("render.clamp", OptionalNumber(Range::POSITIVE), "radiance",
        Presets([Value::Number(1.0), Value::Off, Value::Off, Value::Off]), "the largest radiance that a sample may have in a channel"),
    knob("render.sequence", Name(Sequence::NAMES), "", Default(text("independent")), "how the numbers of a pixel's samples fill their space: each by itself, one in each cell of a grid, as Sobol's sequence scrambled, or as that with errors that cancel among neighbouring pixels"),
    knob("render.randomisations", integer(2, 65536), "", whole(8), "but for independent samples: the point sets, each made random anew, that the samples of a pixel are cut into, at least; their length is a power of two, 16 or more, and their spread tells the standard error"),
    knob("render.kernel", Name(RenderKernel::NAMES), "", Default(text("auto")), "how rays find bodies, which changes no picture: one after the other (general), the same in code compiled for the scene (baked), by a tree (bvh), or as number and work say"),
    knob("render.preset", Name(Preset::NAMES), "", Default(text("reference")), "the set of sampling knobs to start from"),

    knob("background.emission", Triple(Range::NOT_NEGATIVE), "radiance", three(0.0, 0.0, 0.0), "what rays that leave the scene see, R, G, B"),

    knob("materials.*.scatter", Name(Scatter::NAMES), "", Default(text("diffuse")), "how the surface sends light on"),
    knob("materials.*.albedo", Triple(Range::UNIT), "", three(0.75, 0.75, 0.75), "reflectance, R, G, B"),
    knob("materials.*.spread", Number(Range::POSITIVE), "radians", real(0.3), "directional only: sigma of the half-normal angle around the mirror direction"),
    knob("materials.*.roughness", Number(Range::UNIT), "", real(0.3), "rough only: GGX alpha, 0 a mirror (as is all below 0.001), 1 very rough"),
    knob("materials.*.index", Number(Range::closed(1.0, 4.0)), "", real(1.5), "glass only: refractive index; 1 is as good as air"),
    knob("materials.*.survival", Number(Range::UNIT), "", real(1.0), "the paper's threshold t: the probability that a path goes on"),
    knob("materials.*.emission", Triple(Range::NOT_NEGATIVE), "radiance", three(0.0, 0.0, 0.0), "light that the surface sends out, R, G, B"),

    knob("spheres.*.center", Triple(Range::ANY), "scene units", Required, "the centre"),
    knob("spheres.*.radius", Number(Range::POSITIVE), "scene units", Required, "the radius"),
    knob("spheres.*.material", Material, "", Required, "the name of its material; a sphere that emits is a light and is sampled"),

    knob("boxes.*.min", Triple(Range::ANY), "scene units", Required, "the corner with the smallest coordinates"),
    knob("boxes.*.max", Triple(Range::ANY), "scene units", Required, "the corner with the largest coordinates"),
    knob("boxes.*.rotation", Triple(Range::ANY), "degrees", three(0.0, 0.0, 0.0), "turns about the box's centre: about x, then y, then z"),
    knob("boxes.*.material", Material, "", Required, "the name of its material; a box that emits is a light, which light.boxes may sample"),

    knob("light.sampler", Name(LightSampler::NAMES), "", presets(["uniform-angles", "uniform-angles", "inverse-cosine", "cone"]),
        "how a point on a lamp is drawn: the paper's cases 1, 2, 3; the cone of directions; the half that faces the receiver, by area or by case 1's angles; or by projected solid angle"),
    knob("light.weight", Name(LightWeight::NAMES), "", presets(["solid-angle", "solid-angle", "pdf", "pdf"]),
        "what a drawn point is weighted by: the sampler's true density, or the base code's cone"),
    knob("light.weight_radius", OptionalNumber(Range::POSITIVE), "scene units",
        Presets([Value::Number(1.5), Value::Off, Value::Off, Value::Off]), "the radius in the solid-angle weight; off is the lamp's own"),
    knob("light.test", Name(LightTest::NAMES), "", Default(text("point")),
        "when a drawn point counts: when it is seen itself, or when the lamp is the first body in its direction, with the density of both ends of the chord; the solid-angle weight always asks for the body"),
    knob("light.pole", Pole, "", three(0.0, 0.0, 1.0), "z axis of the first two samplers: a direction, or towards the receiver"),
    knob("light.strategy", Name(LightStrategy::NAMES), "", presets(["sample", "sample", "mis", "mis"]),
        "which rays find the lamps: shadow rays, hits of scattered rays, or both by the power heuristic"),
    knob("light.choice", Name(LightChoice::NAMES), "", presets(["all", "all", "all", "all"]),
        "which lamps a hit sends shadow rays to: every one, or one that is drawn: evenly, by power, or by a tree that knows power, distance and horizon"),
    knob("light.boxes", Name(LightSource::NAMES), "", Default(text("hit")),
        "whether shadow rays look for boxes that shine, at a place of their faces even by solid angle whatever the sampler; Lambert direct light leaves them to what the camera sees"),
    knob("light.background", Name(LightSource::NAMES), "", Default(text("hit")),
        "whether a shadow ray looks for the background, in a direction by the cosine to the lit surface's normal; Lambert direct light leaves it to what the camera sees"),
    knob("light.direct", Name(LightDirect::NAMES), "", presets(["lambert", "lambert", "bsdf", "bsdf"]),
        "what direct light does: what the surface's scattering says, or Lambert everywhere, as in the paper"),

    knob("scatter.diffuse", Name(ScatterDiffuse::NAMES), "", presets(["cosine", "cosine", "cosine", "cosine"]), "how directions are drawn on diffuse surfaces"),
    knob("scatter.bound", Name(ScatterBound::NAMES), "", presets(["clamp", "clamp", "truncate", "truncate"]),
        "what keeps the directional angle under a right angle: the truncated law, or the minimum"),

    knob("interruption.rule", Name(InterruptionRule::NAMES), "", presets(["albedo", "survival", "survival", "throughput"]),
        "the probability of going on: 1, the material's t, the largest albedo, the largest throughput up to 0.95, or what pays best by a pilot (efficiency), which also splits paths"),
    knob("interruption.weight", Name(InterruptionWeight::NAMES), "", presets(["literal", "literal", "compensated", "compensated"]),
        "whether paths that go on are divided by that probability"),
    knob("interruption.start", integer(0, 4_294_967_295), "hits",
        Presets([Value::Integer(5), Value::Integer(0), Value::Integer(0), Value::Integer(4)]), "the first hit at which the test is made; the camera's hit is 0"),
    knob("interruption.order", Name(InterruptionOrder::NAMES), "", presets(["before-direct", "after-direct", "after-direct", "after-direct"]),
        "whether a hit's direct light is added before or after the test"),
    knob("interruption.split", integer(1, 16), "branches", whole(8), "rule `efficiency` only: what one path may split into, all its branches together; 1 thins paths out and splits none"),
];
