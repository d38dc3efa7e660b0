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
    /// For a failed gate: a limit that would have let it pass.
    pub passing: Option<f64>,
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
            // Of similarities the pixels' errors count the other way.
            let curve = if passes || self.metric.rises() {
                None
            } else {
                errors()?
            };
            let passing =
                (!passes && value.is_finite()).then(|| outward(value, self.metric.rises()));
            let curve = curve.as_deref().map(curve_of);
            return Ok(self.judgement(value, None, passes, passing, curve));
        };
        let errors = errors()?.unwrap_or_default();
        let failing = beyond(&errors, self.limit);
        let allowed = allowed.count(errors.len());
        if failing <= allowed {
            return Ok(self.judgement(value, Some([failing, allowed]), true, None, None));
        }
        let passing = beyond_only(&errors, allowed).map(|error| outward(error, false));
        let curve = Some(curve_of(&errors));
        Ok(self.judgement(value, Some([failing, allowed]), false, passing, curve))
    }

    fn judgement(
        &self,
        value: f64,
        pixels: Option<[u64; 2]>,
        passes: bool,
        passing: Option<f64>,
        curve: Option<Vec<Step>>,
    ) -> Judgement {
        Judgement {
            metric: self.metric,
            limit: self.limit,
            value,
            pixels,
            passes,
            passing,
            curve: curve.unwrap_or_default(),
        }
    }
}

/// NaN is beyond every limit.
fn beyond(errors: &[f32], limit: f64) -> u64 {
    let within = |error: &&f32| f64::from(**error) <= limit;
    (errors.len() - errors.iter().filter(within).count()) as u64
}

/// The error that no more than `allowed` pixels are beyond; none where too many are NaN.
fn beyond_only(errors: &[f32], allowed: u64) -> Option<f64> {
    let mut sorted = errors.to_vec();
    // NaN comes last.
    sorted.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let place = sorted.len().checked_sub(1 + allowed as usize)?;
    Some(f64::from(sorted[place])).filter(|error| error.is_finite())
}

/// Three digits, rounded to the side that passes.
fn outward(value: f64, rises: bool) -> f64 {
    if value == 0.0 {
        return 0.0;
    }
    let unit = 10f64.powf(value.abs().log10().floor() - 2.0);
    let digits = if rises {
        (value / unit).floor()
    } else {
        (value / unit).ceil()
    };
    // By its decimal text as well.
    format!("{:.3e}", digits * unit).parse().unwrap_or(value)
}

/// Limits in steps of about a quarter from where half of the pixels fail, at most, to where none does.
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
        for digit in [1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0] {
            // By its decimal text, for three times 0.1 is not 0.3.
            let limit = format!("{digit}e{decade}").parse().unwrap_or(f64::MAX);
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
    fn a_failed_gate_names_a_limit_that_passes() {
        let errors: Vec<f32> = (0..1000).map(|i| i as f32 / 1000.0).collect();
        let failed = |gate: Gate, value| gate.judge(value, || Ok(Some(errors.clone()))).unwrap();
        let next = |gate: Gate, value: f64| {
            let passing = failed(gate, value).passing.expect("a limit");
            let again = Gate {
                limit: passing,
                ..gate
            };
            assert!(failed(again, value).passes, "{passing}");
            passing
        };
        assert_eq!(next(gate(0.01, None), 0.123_456), 0.124);
        assert_eq!(next(gate(0.01, Some(Allowed::Pixels(100))), 0.0), 0.899);
        let least = Gate {
            metric: Metric::Psnr,
            ..gate(30.0, None)
        };
        assert_eq!(next(least, 23.456), 23.4);
        assert_eq!(next(least, -3.21), -3.21);
    }

    #[test]
    fn the_curve_ends_where_nothing_fails() {
        let errors: Vec<f32> = (0..1000).map(|i| i as f32 / 1000.0).collect();
        let judgement = gate(0.1, None).judge(0.5, || Ok(Some(errors))).unwrap();
        let curve = judgement.curve;
        assert_eq!(curve.len(), 4);
        assert_eq!((curve[0].limit, curve[0].failing), (0.5, 499));
        assert_eq!((curve[3].limit, curve[3].failing), (1.0, 0));
    }
}
