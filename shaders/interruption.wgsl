// Ray interruption (paper, section 2.3): the probability that a path goes on after a hit.

// #import maths

override INTERRUPTION_RULE: u32;
override INTERRUPTION_WEIGHT: u32;
override INTERRUPTION_ORDER: u32;

// `threshold` is the material's t, or how many rays should leave the hit (efficiency); `albedo` the surface's, `carried` the throughput that the next
// ray would have. At most 1, and below 1 for the throughput so that no path is certain to go on.
fn survival_probability(threshold: f32, albedo: vec3<f32>, carried: vec3<f32>) -> f32 {
    if INTERRUPTION_RULE == INTERRUPTION_RULE_SURVIVAL {
        return threshold;
    }
    if INTERRUPTION_RULE == INTERRUPTION_RULE_ALBEDO {
        return largest(albedo);
    }
    if INTERRUPTION_RULE == INTERRUPTION_RULE_THROUGHPUT {
        return lesser(largest(carried), 0.95);
    }
    if INTERRUPTION_RULE == INTERRUPTION_RULE_EFFICIENCY {
        return lesser(threshold, 1.0);
    }
    return 1.0;
}

// What the weight of a path that went on is multiplied by.
fn survival_weight(probability: f32) -> f32 {
    if INTERRUPTION_WEIGHT == INTERRUPTION_WEIGHT_COMPENSATED {
        return 1.0 / greater(probability, 1e-30);
    }
    return 1.0;
}
