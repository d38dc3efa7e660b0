//! The strategies of a render as numbers that a pipeline is specialised with.

use crate::knobs::{choice, *};
use crate::scene::Scene;

/// Samples of a pixel are summed in f32 over runs of this many, and in f64 from there on. Runs end
/// where the sample index is a multiple of it, so that sums never depend on how work was split.
pub const RUN_LENGTH: u32 = 16;

choice! {
    /// When the ray after the last reflection, which can only find emission, is traced.
    LastRay, "LAST_RAY" {
        /// Emission counts at the camera's hit only.
        Never = "never",
        /// Only after directions without a density: nothing but lamps shines, and shadow rays find those.
        WithoutDensity = "without-density",
        Always = "always",
    }
}

/// Everything that a kernel's `override` constants say; one pipeline serves all renders with equal ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Strategy {
    pub filter: Filter,
    pub light_sampler: LightSampler,
    pub light_weight: LightWeight,
    pub light_strategy: LightStrategy,
    pub light_direct: LightDirect,
    pub pole_at_receiver: bool,
    pub scatter_diffuse: ScatterDiffuse,
    pub scatter_bound: ScatterBound,
    pub interruption_rule: InterruptionRule,
    pub interruption_weight: InterruptionWeight,
    pub interruption_order: InterruptionOrder,
    /// What a path may split into; 1 by every rule that splits none.
    pub interruption_split: u32,
    pub last_ray: LastRay,
    pub sphere_count: u32,
    pub box_count: u32,
    pub rotated_box_count: u32,
    pub lamp_count: u32,
    /// Of the bodies, those that stand outside the tree; 0 without one.
    pub outside_sphere_count: u32,
    pub outside_box_count: u32,
    pub outside_rotated_count: u32,
}

impl Strategy {
    /// The scene's strategies; the counts are those of its packed arrays.
    pub fn new(scene: &Scene, spheres: u32, boxes: u32, rotated: u32, lamps: u32) -> Self {
        let settings = &scene.settings;
        Self {
            filter: settings.image.filter,
            light_sampler: settings.light.sampler,
            light_weight: settings.light.weight,
            light_strategy: settings.light.strategy,
            light_direct: settings.light.direct,
            pole_at_receiver: settings.light.pole == Pole::Receiver,
            scatter_diffuse: settings.scatter.diffuse,
            scatter_bound: settings.scatter.bound,
            interruption_rule: settings.interruption.rule,
            interruption_weight: settings.interruption.weight,
            interruption_order: settings.interruption.order,
            interruption_split: split(&settings.interruption),
            last_ray: last_ray(scene),
            sphere_count: spheres,
            box_count: boxes,
            rotated_box_count: rotated,
            lamp_count: lamps,
            outside_sphere_count: 0,
            outside_box_count: 0,
            outside_rotated_count: 0,
        }
    }

    /// Names and values of all override constants of all kernels.
    pub fn overrides(&self) -> [(&'static str, u32); 20] {
        [
            ("FILTER", self.filter.index()),
            ("LIGHT_SAMPLER", self.light_sampler.index()),
            ("LIGHT_WEIGHT", self.light_weight.index()),
            ("LIGHT_STRATEGY", self.light_strategy.index()),
            ("LIGHT_DIRECT", self.light_direct.index()),
            ("POLE_AT_RECEIVER", u32::from(self.pole_at_receiver)),
            ("SCATTER_DIFFUSE", self.scatter_diffuse.index()),
            ("SCATTER_BOUND", self.scatter_bound.index()),
            ("INTERRUPTION_RULE", self.interruption_rule.index()),
            ("INTERRUPTION_WEIGHT", self.interruption_weight.index()),
            ("INTERRUPTION_ORDER", self.interruption_order.index()),
            ("INTERRUPTION_SPLIT", self.interruption_split),
            ("LAST_RAY", self.last_ray.index()),
            ("SPHERE_COUNT", self.sphere_count),
            ("BOX_COUNT", self.box_count),
            ("ROTATED_BOX_COUNT", self.rotated_box_count),
            ("LAMP_COUNT", self.lamp_count),
            ("OUTSIDE_SPHERE_COUNT", self.outside_sphere_count),
            ("OUTSIDE_BOX_COUNT", self.outside_box_count),
            ("OUTSIDE_ROTATED_COUNT", self.outside_rotated_count),
        ]
    }
}

fn split(interruption: &Interruption) -> u32 {
    match interruption.rule {
        InterruptionRule::Efficiency => interruption.split,
        _ => 1,
    }
}

fn last_ray(scene: &Scene) -> LastRay {
    let light = &scene.settings.light;
    let box_shines = scene
        .boxes
        .iter()
        .any(|shape| scene.materials[shape.material].emits());
    let unsampled = box_shines || scene.background.max_element() > 0.0;
    if light.direct == LightDirect::Lambert {
        LastRay::Never
    } else if light.strategy == LightStrategy::Sample && !unsampled {
        LastRay::WithoutDensity
    } else {
        LastRay::Always
    }
}
