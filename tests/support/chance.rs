//! Probabilities, for tests of what is random. All in f64.

pub use lampray::theory::{chi_square_above, distance_of_sorted, kolmogorov_above};

/// The level of each of `tests` tests that keeps the chance of any false alarm at `level` (Sidak).
pub fn sidak(level: f64, tests: usize) -> f64 {
    1.0 - (1.0 - level).powf(1.0 / tests as f64)
}

/// What a chi-square test found.
#[derive(Clone, Copy, Debug)]
pub struct Fit {
    pub statistic: f64,
    pub freedom: f64,
    pub p: f64,
}

/// Pearson's test of counts against expectations. Cells that expect too few are pooled, smallest
/// first, until each pool expects at least 5.
pub fn fit(observed: &[f64], expected: &[f64]) -> Fit {
    let mut cells: Vec<_> = expected.iter().copied().zip(observed).collect();
    cells.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut statistic, mut pools) = (0.0, 0);
    let mut pool = (0.0, 0.0);
    let mut rest: f64 = expected.iter().sum();
    for (expects, &counted) in cells {
        pool = (pool.0 + expects, pool.1 + counted);
        rest -= expects;
        if pool.0 >= 5.0 && (rest >= 5.0 || rest < 1e-9 * pool.0) {
            statistic += (pool.1 - pool.0).powi(2) / pool.0;
            pools += 1;
            pool = (0.0, 0.0);
        }
    }
    // What is left over expects next to nothing; if it was counted all the same, that shows.
    statistic += (pool.1 - pool.0).powi(2) / pool.0.max(1e-3);
    let freedom = f64::from(pools) - 1.0;
    assert!(freedom >= 1.0, "too few cells to test");
    Fit {
        statistic,
        freedom,
        p: chi_square_above(statistic, freedom),
    }
}

/// Chance that a binomial count is at least `count`.
pub fn binomial_at_least(count: u64, trials: u64, p: f64) -> f64 {
    let chance = |k: u64| {
        let ways = libm::lgamma(trials as f64 + 1.0)
            - libm::lgamma(k as f64 + 1.0)
            - libm::lgamma((trials - k) as f64 + 1.0);
        (ways + k as f64 * p.ln() + (trials - k) as f64 * (-p).ln_1p()).exp()
    };
    let below: f64 = (0..count).map(chance).sum();
    (1.0 - below).max(0.0)
}
