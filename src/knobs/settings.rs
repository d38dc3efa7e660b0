//! The sampling and picture knobs as one typed value.

use super::choice::*;
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
}

impl Settings {
    /// Whether these knobs make the expected picture differ from the light transport they stand for.
    ///
    /// True for Lambert direct light, the solid-angle weight, literal interruption with any rule,
    /// and either clamp: of radiance, or of the directional angle.
    pub fn biased(&self) -> bool {
        self.light.direct == LightDirect::Lambert
            || self.light.weight == LightWeight::SolidAngle
            || (self.interruption.weight == InterruptionWeight::Literal
                && self.interruption.rule != InterruptionRule::None)
            || self.render.clamp.is_some()
            || self.scatter.bound == ScatterBound::Clamp
    }
}
