//! Limits on metrics, and what a failed one says so that the next limit need not be guessed.

use super::Metric;
use crate::error::Result;
use serde::Serialize;

/// How many pixels may be beyond the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Allowed {
    Pixels(u64),
    /// Of all pixels, 0..1.
    Share(f64),
}

impl Allowed {
    fn count(self, pixels: usize) -> u64 {
        match self {
            Allowed::Pixels(count) => count,
            Allowed::Share(share) => (share * pixels as f64).floor() as u64,
        }
    }
}

/// A metric with its limit: the largest value that passes, or the smallest where larger is better.
/// With `allowed`, the limit holds for each pixel, and so many may break it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    pub metric: Metric,
    pub limit: f64,
    pub allowed: Option<Allowed>,
}

/// How a gate was met.
#[derive(Clone, Debug, Serialize)]
pub struct Judgement {
    pub metric: Metric,
    pub limit: f64,
    /// The metric's value over the picture.
    pub value: f64,
    /// Pixels beyond the limit, and how many may be; present where pixels were counted.
    pub pixels: Option<[u64; 2]>,
    pub passes: bool,
    /// For a failed gate whose metric has a value for each pixel: limits, and the pixels beyond each.
    pub curve: Vec<Step>,
}

/// A limit, and what it would have let pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Step {
    pub limit: f64,
    /// Pixels beyond it.
    pub failing: u64,
    /// Of all pixels, 0..1.
    pub share: f64,
}

impl Gate {
    /// Whether a picture passes; `errors` is asked for the error of each pixel only where it matters.
    ///
    /// # Errors
    /// That of `errors`.
    pub fn judge(
        &self,
        value: f64,
        errors: impl FnOnce() -> Result<Option<Vec<f32>>>,
    ) -> Result<Judgement> {
        let Some(allowed) = self.allowed else {
            // Written so that NaN fails.
            let passes = if self.metric.rises() {
                value >= self.limit
            } else {
                value <= self.limit
            };
            let curve = if passes { None } else { errors()? };
            return Ok(self.judgement(value, None, passes, curve.as_deref().map(curve_of)));
        };
        let errors = errors()?.unwrap_or_default();
        let failing = beyond(&errors, self.limit);
        let allowed = allowed.count(errors.len());
        let passes = failing <= allowed;
        let curve = (!passes).then(|| curve_of(&errors));
        Ok(self.judgement(value, Some([failing, allowed]), passes, curve))
    }

    fn judgement(
        &self,
        value: f64,
        pixels: Option<[u64; 2]>,
        passes: bool,
        curve: Option<Vec<Step>>,
    ) -> Judgement {
        Judgement {
            metric: self.metric,
            limit: self.limit,
            value,
            pixels,
            passes,
            curve: curve.unwrap_or_default(),
        }
    }
}

/// NaN is beyond every limit.
fn beyond(errors: &[f32], limit: f64) -> u64 {
    let within = |error: &&f32| f64::from(**error) <= limit;
    (errors.len() - errors.iter().filter(within).count()) as u64
}

/// Limits 1, 2, 5, 10, ... from where half of the pixels fail, at most, to where none does.
fn curve_of(errors: &[f32]) -> Vec<Step> {
    let mut sorted: Vec<f64> = errors.iter().map(|error| f64::from(*error)).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(&largest) = sorted
        .last()
        .filter(|largest| **largest > 0.0 && largest.is_finite())
    else {
        return Vec::new();
    };
    let smallest = sorted[sorted.len() / 2].max(1e-6 * largest);
    let step = |limit: f64| {
        let failing = (sorted.len() - sorted.partition_point(|error| *error <= limit)) as u64;
        Step {
            limit,
            failing,
            share: failing as f64 / sorted.len() as f64,
        }
    };
    let mut steps = Vec::new();
    let mut decade = smallest.log10().floor() as i32;
    'decades: loop {
        for digit in [1.0, 2.0, 5.0] {
            let limit = digit * 10f64.powi(decade);
            if limit < smallest {
                continue;
            }
            steps.push(step(limit));
            if limit >= largest {
                break 'decades;
            }
        }
        decade += 1;
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gate(limit: f64, allowed: Option<Allowed>) -> Gate {
        Gate {
            metric: Metric::Mae,
            limit,
            allowed,
        }
    }

    #[test]
    fn a_limit_is_met_or_broken() {
        assert!(gate(0.5, None).judge(0.5, || Ok(None)).unwrap().passes);
        assert!(
            !gate(0.5, None)
                .judge(0.500_001, || Ok(None))
                .unwrap()
                .passes
        );
        assert!(!gate(0.5, None).judge(f64::NAN, || Ok(None)).unwrap().passes);
        let least = Gate {
            metric: Metric::Psnr,
            ..gate(30.0, None)
        };
        assert!(least.judge(f64::INFINITY, || Ok(None)).unwrap().passes);
        assert!(!least.judge(29.9, || Ok(None)).unwrap().passes);
    }

    #[test]
    fn so_many_pixels_may_break_it() {
        let errors = vec![0.0, 0.1, 0.2, 0.3, f32::NAN];
        for (allowed, passes) in [
            (Allowed::Pixels(2), false),
            (Allowed::Pixels(3), true),
            (Allowed::Share(0.4), false),
            (Allowed::Share(0.6), true),
        ] {
            let judgement = gate(0.15, Some(allowed))
                .judge(0.0, || Ok(Some(errors.clone())))
                .unwrap();
            assert_eq!(judgement.passes, passes, "{allowed:?}");
            assert_eq!(judgement.pixels.map(|[failing, _]| failing), Some(3));
        }
    }

    #[test]
    fn the_curve_ends_where_nothing_fails() {
        let errors: Vec<f32> = (0..1000).map(|i| i as f32 / 1000.0).collect();
        let judgement = gate(0.1, None).judge(0.5, || Ok(Some(errors))).unwrap();
        let curve = judgement.curve;
        assert_eq!(curve.len(), 2);
        assert_eq!((curve[0].limit, curve[0].failing), (0.5, 499));
        assert_eq!((curve[1].limit, curve[1].failing), (1.0, 0));
    }
}
