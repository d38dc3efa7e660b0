//! Twin of `shaders/interruption.wgsl`: the probability that a path goes on after a hit.

use super::maths::{greater, largest, lesser};
use crate::knobs::{InterruptionRule, InterruptionWeight};
use crate::pack::Strategy;
use glam::Vec3;

/// `threshold` is the material's t, or how many rays should leave the hit; `carried` the throughput that the next ray would have.
pub fn survival_probability(
    strategy: &Strategy,
    threshold: f32,
    albedo: Vec3,
    carried: Vec3,
) -> f32 {
    match strategy.interruption_rule {
        InterruptionRule::None => 1.0,
        InterruptionRule::Survival => threshold,
        InterruptionRule::Albedo => largest(albedo),
        InterruptionRule::Throughput => lesser(largest(carried), 0.95),
        InterruptionRule::Efficiency => lesser(threshold, 1.0),
    }
}

/// What the weight of a path that went on is multiplied by.
pub fn survival_weight(strategy: &Strategy, probability: f32) -> f32 {
    match strategy.interruption_weight {
        InterruptionWeight::Compensated => 1.0 / greater(probability, 1e-30),
        InterruptionWeight::Literal => 1.0,
    }
}
