//! The strategies of a render as numbers that a pipeline is specialised with.

use crate::knobs::{choice, *};
use crate::scene::Scene;

/// Samples of a pixel are summed in f32 over runs of this many, and in f64 from there on. Runs end
/// where the sample index is a multiple of it, so that sums never depend on how work was split.
pub const RUN_LENGTH: u32 = 16;

// A randomisation is whole tallies.
const _: () = assert!(randomisation::SHORTEST == RUN_LENGTH as u64);

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
    pub light_test: LightTest,
    pub light_strategy: LightStrategy,
    pub light_choice: LightChoice,
    pub light_direct: LightDirect,
    pub pole_at_receiver: bool,
    /// Whether shadow rays look for boxes that shine, and for the background.
    pub box_lamps: bool,
    pub background_lamp: bool,
    pub scatter_diffuse: ScatterDiffuse,
    pub scatter_bound: ScatterBound,
    pub interruption_rule: InterruptionRule,
    pub interruption_weight: InterruptionWeight,
    pub interruption_order: InterruptionOrder,
    /// What a path may split into; 1 by every rule that splits none.
    pub interruption_split: u32,
    pub last_ray: LastRay,
    pub rough_surfaces: bool,
    pub glass_surfaces: bool,
    pub lens: bool,
    pub sequence: Sequence,
    /// Samples of one randomisation, as a power of two; 4 where samples are independent and have none.
    pub randomisation_bits: u32,
    pub sphere_count: u32,
    pub box_count: u32,
    pub rotated_box_count: u32,
    pub lamp_count: u32,
    /// Iterations of the loops over lamps that one step of a path may take.
    pub light_loops: u32,
    /// Of the bodies, those that stand outside the tree; 0 without one.
    pub outside_sphere_count: u32,
    pub outside_box_count: u32,
    pub outside_rotated_count: u32,
}

impl Strategy {
    /// The scene's strategies; the counts are those of its packed arrays.
    pub fn new(scene: &Scene, spheres: u32, boxes: u32, rotated: u32, lamps: u32) -> Self {
        let settings = &scene.settings;
        let some = |scatter| scene.materials.iter().any(|m| m.scattering() == scatter);
        Self {
            filter: settings.image.filter,
            light_sampler: settings.light.sampler,
            light_weight: settings.light.weight,
            light_test: settings.light.test,
            light_strategy: settings.light.strategy,
            light_choice: settings.light.choice,
            light_direct: settings.light.direct,
            pole_at_receiver: settings.light.pole == Pole::Receiver,
            box_lamps: samples_boxes(scene),
            background_lamp: samples_background(scene),
            scatter_diffuse: settings.scatter.diffuse,
            scatter_bound: settings.scatter.bound,
            interruption_rule: settings.interruption.rule,
            interruption_weight: settings.interruption.weight,
            interruption_order: settings.interruption.order,
            interruption_split: split(&settings.interruption),
            last_ray: last_ray(scene),
            rough_surfaces: some(Scatter::Rough),
            glass_surfaces: some(Scatter::Glass),
            lens: scene.camera.aperture > 0.0,
            sequence: settings.render.sequence,
            randomisation_bits: settings
                .render
                .randomisation()
                .map_or(RUN_LENGTH.ilog2(), u64::ilog2),
            sphere_count: spheres,
            box_count: boxes,
            rotated_box_count: rotated,
            lamp_count: lamps,
            light_loops: lamps,
            outside_sphere_count: 0,
            outside_box_count: 0,
            outside_rotated_count: 0,
        }
    }

    /// Shadow rays that a hit may send.
    pub fn shadow_rays(&self) -> u32 {
        match self.light_choice {
            LightChoice::All => self.lamp_count,
            _ => self.lamp_count.min(1),
        }
    }

    /// Names and values of all override constants of all kernels.
    pub fn overrides(&self) -> Vec<(&'static str, u32)> {
        vec![
            ("FILTER", self.filter.index()),
            ("LIGHT_SAMPLER", self.light_sampler.index()),
            ("LIGHT_WEIGHT", self.light_weight.index()),
            ("LIGHT_TEST", self.light_test.index()),
            ("LIGHT_STRATEGY", self.light_strategy.index()),
            ("LIGHT_CHOICE", self.light_choice.index()),
            ("LIGHT_DIRECT", self.light_direct.index()),
            ("POLE_AT_RECEIVER", u32::from(self.pole_at_receiver)),
            ("BOX_LAMPS", u32::from(self.box_lamps)),
            ("BACKGROUND_LAMP", u32::from(self.background_lamp)),
            ("SCATTER_DIFFUSE", self.scatter_diffuse.index()),
            ("SCATTER_BOUND", self.scatter_bound.index()),
            ("INTERRUPTION_RULE", self.interruption_rule.index()),
            ("INTERRUPTION_WEIGHT", self.interruption_weight.index()),
            ("INTERRUPTION_ORDER", self.interruption_order.index()),
            ("INTERRUPTION_SPLIT", self.interruption_split),
            ("LAST_RAY", self.last_ray.index()),
            ("ROUGH_SURFACES", u32::from(self.rough_surfaces)),
            ("GLASS_SURFACES", u32::from(self.glass_surfaces)),
            ("LENS", u32::from(self.lens)),
            ("SEQUENCE", self.sequence.index()),
            ("RANDOMISATION_BITS", self.randomisation_bits),
            ("SPHERE_COUNT", self.sphere_count),
            ("BOX_COUNT", self.box_count),
            ("ROTATED_BOX_COUNT", self.rotated_box_count),
            ("LAMP_COUNT", self.lamp_count),
            ("LIGHT_LOOPS", self.light_loops),
            ("OUTSIDE_SPHERE_COUNT", self.outside_sphere_count),
            ("OUTSIDE_BOX_COUNT", self.outside_box_count),
            ("OUTSIDE_ROTATED_COUNT", self.outside_rotated_count),
        ]
    }
}

fn box_shines(scene: &Scene) -> bool {
    let mut boxes = scene.boxes.iter();
    boxes.any(|shape| scene.materials[shape.material].emits())
}

/// Whether there are shadow rays to anything but the lamps of the paper.
fn samples(scene: &Scene, source: LightSource) -> bool {
    let light = &scene.settings.light;
    let by_shadow_rays = light.strategy != LightStrategy::Hit;
    source == LightSource::Sample && by_shadow_rays && light.direct == LightDirect::Bsdf
}

/// Whether boxes that shine are lamps.
pub(super) fn samples_boxes(scene: &Scene) -> bool {
    samples(scene, scene.settings.light.boxes) && box_shines(scene)
}

fn samples_background(scene: &Scene) -> bool {
    samples(scene, scene.settings.light.background) && scene.background.max_element() > 0.0
}

fn split(interruption: &Interruption) -> u32 {
    match interruption.rule {
        InterruptionRule::Efficiency => interruption.split,
        _ => 1,
    }
}

fn last_ray(scene: &Scene) -> LastRay {
    let light = &scene.settings.light;
    let background_shines = scene.background.max_element() > 0.0;
    let unsampled = (box_shines(scene) && !samples_boxes(scene))
        || (background_shines && !samples_background(scene));
    if light.direct == LightDirect::Lambert {
        LastRay::Never
    } else if light.strategy == LightStrategy::Sample && !unsampled {
        LastRay::WithoutDensity
    } else {
        LastRay::Always
    }
}
