//! The sampling and picture knobs as one typed value.

use super::choice::*;
use super::find::find;
use super::kind::Value;
use glam::DVec3;

/// Everything that decides how a scene is sampled, beside the scene itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    pub preset: Preset,
    pub image: Image,
    pub render: Render,
    pub light: Light,
    pub scatter: ScatterSettings,
    pub interruption: Interruption,
}

/// `image.*`: the picture's size and how a PNG is made of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels, 1 to 32768.
    pub width: u32,
    /// Pixels, 1 to 32768.
    pub height: u32,
    pub filter: Filter,
    /// Stops: a PNG shows radiance times 2^exposure.
    pub exposure: f64,
    pub encoding: Encoding,
}

/// `render.*`.
#[derive(Clone, Debug, PartialEq)]
pub struct Render {
    /// Paths a pixel, at least 1.
    pub samples: u64,
    pub seed: u64,
    /// Reflections a path may make.
    pub max_bounces: u32,
    /// Largest radiance a sample may have in a channel.
    pub clamp: Option<f64>,
    pub kernel: RenderKernel,
    pub sequence: Sequence,
    /// The least number of point sets that the samples are cut into where they are not independent.
    pub randomisations: u64,
}

/// `light.*`.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    pub sampler: LightSampler,
    pub weight: LightWeight,
    /// The radius of the solid-angle weight; the lamp's own if absent. Scene units.
    pub weight_radius: Option<f64>,
    pub pole: Pole,
    pub strategy: LightStrategy,
    pub choice: LightChoice,
    pub test: LightTest,
    /// How boxes that shine are found.
    pub boxes: LightSource,
    pub background: LightSource,
    pub direct: LightDirect,
}

/// The z axis of the first two light samplers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pole {
    /// A direction of any length but zero.
    Axis(DVec3),
    /// From the lamp's centre to the lit point.
    Receiver,
}

/// `scatter.*`.
#[derive(Clone, Debug, PartialEq)]
pub struct ScatterSettings {
    pub diffuse: ScatterDiffuse,
    pub bound: ScatterBound,
}

/// `interruption.*`.
#[derive(Clone, Debug, PartialEq)]
pub struct Interruption {
    pub rule: InterruptionRule,
    pub weight: InterruptionWeight,
    /// The first hit at which the test is made; the camera's hit is 0.
    pub start: u32,
    pub order: InterruptionOrder,
    /// Rule `efficiency`: branches that one path may split into, 1 to 16.
    pub split: u32,
}

impl Settings {
    /// The settings of a preset, every other knob at its default.
    pub fn of(preset: Preset) -> Self {
        Self::gather(preset, |path| {
            let knob = find(path).and_then(|target| target.knob.value(preset));
            knob.cloned().unwrap_or(Value::Off)
        })
    }

    /// The settings made of the values that a lookup by path gives.
    pub fn gather(preset: Preset, value: impl Fn(&str) -> Value) -> Self {
        let whole = |path: &str| u32::try_from(value(path).integer()).unwrap_or(u32::MAX);
        Self {
            preset,
            image: Image {
                width: whole("image.width"),
                height: whole("image.height"),
                filter: choice(&value("image.filter")),
                exposure: value("image.exposure").number(),
                encoding: choice(&value("image.encoding")),
            },
            render: Render {
                samples: value("render.samples").integer(),
                seed: value("render.seed").integer(),
                max_bounces: whole("render.max_bounces"),
                clamp: value("render.clamp").optional(),
                kernel: choice(&value("render.kernel")),
                sequence: choice(&value("render.sequence")),
                randomisations: value("render.randomisations").integer(),
            },
            light: Light {
                sampler: choice(&value("light.sampler")),
                weight: choice(&value("light.weight")),
                weight_radius: value("light.weight_radius").optional(),
                pole: pole(&value("light.pole")),
                strategy: choice(&value("light.strategy")),
                choice: choice(&value("light.choice")),
                test: choice(&value("light.test")),
                boxes: choice(&value("light.boxes")),
                background: choice(&value("light.background")),
                direct: choice(&value("light.direct")),
            },
            scatter: ScatterSettings {
                diffuse: choice(&value("scatter.diffuse")),
                bound: choice(&value("scatter.bound")),
            },
            interruption: Interruption {
                rule: choice(&value("interruption.rule")),
                weight: choice(&value("interruption.weight")),
                start: whole("interruption.start"),
                order: choice(&value("interruption.order")),
                split: whole("interruption.split"),
            },
        }
    }

    /// Whether these knobs make the expected picture differ from the light transport they stand for. So may materials:
    /// see [`Scene::biased`](crate::scene::Scene::biased).
    pub fn biased(&self) -> bool {
        !self.biases().is_empty()
    }

    /// The knobs that make it differ, with their values.
    ///
    /// They are Lambert direct light, the solid-angle weight, literal interruption with any rule,
    /// and either clamp: of radiance, or of the directional angle.
    pub fn biases(&self) -> Vec<&'static str> {
        let literal = self.interruption.weight == InterruptionWeight::Literal
            && self.interruption.rule != InterruptionRule::None;
        let causes = [
            (
                self.light.direct == LightDirect::Lambert,
                "light.direct = lambert",
            ),
            (
                self.light.weight == LightWeight::SolidAngle,
                "light.weight = solid-angle",
            ),
            (literal, "interruption.weight = literal"),
            (self.render.clamp.is_some(), "render.clamp"),
            (
                self.scatter.bound == ScatterBound::Clamp,
                "scatter.bound = clamp",
            ),
        ];
        let in_force = causes.into_iter().filter(|(holds, _)| *holds);
        in_force.map(|(_, cause)| cause).collect()
    }
}

/// The choice with the name that a checked value holds.
pub(crate) fn choice<C: Choice>(value: &Value) -> C {
    C::from_name(value.text()).expect("the table of knobs lists the names of this choice")
}

fn pole(value: &Value) -> Pole {
    match value {
        Value::Text(_) => Pole::Receiver,
        axis => Pole::Axis(axis.triple()),
    }
}
