//! Paths that are interrupted: how many hits they make, and how much light a limit keeps.

/// Mean number of hits of a path that makes at most `limit` and goes on from each with probability
/// `survival`: (1 - q^N) / (1 - q).
pub fn hits(survival: f64, limit: u32) -> f64 {
    if (1.0 - survival).abs() < 1e-12 {
        return f64::from(limit);
    }
    (1.0 - survival.powi(limit as i32)) / (1.0 - survival)
}

/// Share of the reflected light that is there after `limit` reflections, where each keeps the share
/// `kept` of the one before: 1 - kept^N. Literal interruption keeps albedo times threshold, compensated
/// interruption the albedo.
pub fn energy_share(kept: f64, limit: u32) -> f64 {
    1.0 - kept.powi(limit as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hits_of_a_threshold_of_three_quarters() {
        let found = [1, 2, 3, 4].map(|limit| hits(0.75, limit));
        assert_eq!(found, [1.0, 1.75, 2.3125, 2.734375]);
        assert_eq!(hits(1.0, 7), 7.0);
        assert_eq!(energy_share(0.5, 3), 0.875);
    }
}
