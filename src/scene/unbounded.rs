//! Materials whose threshold makes compensated paths too bright and too few: where the variance has no bound.
//!
//! A path that goes on from a hit with probability t weighs rho / t times as much, so that the hit multiplies the
//! second moment of its weight by t (rho / t)^2 = rho^2 / t. At 1 or above, what a path that stays among such
//! surfaces brings has a variance that grows with every hit, in proportion to their number at 1 and as a power of
//! it above; in a closed room of one such material nothing but the limit on reflections bounds it. Where paths
//! leave, or meet surfaces between with a factor below 1, the product over the hits of a path decides.

use super::Scene;
use crate::knobs::{InterruptionRule, InterruptionWeight, Scatter, short};
use crate::wording::counted;

/// Materials of one scene that are told of.
const MOST: usize = 10;

/// A material that shapes have, with a threshold at or below the square of its albedo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unbounded {
    /// Its place among the scene's materials.
    pub number: usize,
    /// The paper's t.
    pub survival: f64,
    /// The largest channel.
    pub albedo: f64,
    /// Hits of a path at which it is tested: `max_bounces` less `interruption.start`.
    pub tests: u32,
}

impl Unbounded {
    /// What a hit multiplies the second moment of a path's weight by, at least 1; infinite for a threshold of 0.
    pub fn growth(self) -> f64 {
        self.albedo * self.albedo / self.survival
    }

    /// What hits make of the second moment of a path's weight: each, and so many together.
    pub fn effect(self, tests: Option<u32>) -> String {
        let growth = self.growth();
        let each = format!("{growth:.4}");
        if each == "1.0000" {
            return "no hit makes the second moment of a path's weight smaller".into();
        }
        let all = tests.map(|tests| {
            let all = growth.powf(tests.into());
            format!(", {} by up to {all:.3e}", counted(tests, "hit"))
        });
        format!(
            "every hit multiplies the second moment of a path's weight by {each}{}",
            all.unwrap_or_default()
        )
    }

    /// What is wrong, with the numbers, and the remedy.
    pub fn words(self, name: &str, scene: &Scene) -> (String, String) {
        let Self {
            survival,
            albedo,
            tests,
            ..
        } = self;
        let square = albedo * albedo;
        if survival == 0.0 {
            return (
                format!("`{name}` has survival 0: every path ends there"),
                "no weight can make up for paths that never go on: the picture lacks their light; set `survival` above 0".into(),
            );
        }
        let message = format!(
            "`{name}` has survival {survival}, not above the square of its albedo, {square:.4}: {}",
            self.effect(Some(tests))
        );
        let bound = match scene.seems_closed() {
            true => {
                "the scene seems closed: among such surfaces nothing but `render.max_bounces` bounds the variance"
            }
            false => {
                "only paths that leave the scene, or other surfaces, and `render.max_bounces` bound the variance"
            }
        };
        let note = format!(
            "{bound}; set `survival` above {square:.4} (at {albedo} weights never grow), or `interruption.rule` to `albedo`"
        );
        (message, note)
    }
}

impl Scene {
    /// Whether the expected picture differs from the light transport that the scene stands for.
    pub fn biased(&self) -> bool {
        !self.biases().is_empty()
    }

    /// What makes it differ: [`Settings::biases`](crate::knobs::Settings::biases), and materials at which every path
    /// ends, which no weight makes up for.
    pub fn biases(&self) -> Vec<String> {
        let mut settings = self.settings.biases();
        // A bound of directions that no surface draws.
        let bounds = self.scatters(Scatter::Directional);
        settings.retain(|cause| bounds || !cause.starts_with("scatter.bound"));
        let settings = settings.into_iter().map(String::from);
        let ends = self.unbounded().into_iter();
        let ends = ends.filter(|one| one.survival == 0.0);
        let name = |one: Unbounded| short(&self.materials[one.number].name);
        settings
            .chain(ends.map(|one| format!("materials.{}.survival = 0", name(one))))
            .collect()
    }

    /// The materials whose thresholds leave the variance without a bound, or lose light; none by another rule than
    /// compensated survival, nor where no hit is tested.
    pub fn unbounded(&self) -> Vec<Unbounded> {
        let interruption = &self.settings.interruption;
        let tests = self
            .settings
            .render
            .max_bounces
            .saturating_sub(interruption.start);
        if interruption.rule != InterruptionRule::Survival
            || interruption.weight != InterruptionWeight::Compensated
            || tests == 0
        {
            return Vec::new();
        }
        let used = self.used_materials();
        let materials = self.materials.iter().enumerate();
        let all = materials.filter(|(number, _)| used[*number]);
        let all = all.map(|(number, material)| Unbounded {
            number,
            survival: material.survival,
            albedo: material.albedo.max_element(),
            tests,
        });
        let low = |one: &Unbounded| {
            one.survival < 1.0 && one.albedo > 0.0 && one.survival <= one.albedo * one.albedo
        };
        let mut low: Vec<_> = all.filter(low).collect();
        // Lost light before noise: the list is cut.
        low.sort_by_key(|one| one.survival > 0.0);
        low.truncate(MOST);
        low
    }

    /// Which materials a shape has.
    pub(super) fn used_materials(&self) -> Vec<bool> {
        let mut used = vec![false; self.materials.len()];
        let spheres = self.spheres.iter().map(|sphere| sphere.material);
        let boxes = self.boxes.iter().map(|shape| shape.material);
        spheres
            .chain(boxes)
            .for_each(|material| used[material] = true);
        used
    }
}
