//! A number with its standard error, and the 95 % intervals that follow.

use crate::compare::verdict::student;
use crate::report::data::Interval;

/// Half of what is outside an interval on either side makes 95 %.
pub(super) const UPPER: f64 = 0.975;

/// An estimate whose error is about normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    pub value: f64,
    /// Standard error of `value`.
    pub error: f64,
    /// Degrees of freedom of `error` squared; infinite where it is known.
    pub freedom: f64,
}

/// The same of red, green and blue.
pub type Channels = [Quantity; 3];

impl Quantity {
    /// A number without error.
    pub fn exact(value: f64) -> Self {
        Self {
            value,
            error: 0.0,
            freedom: f64::INFINITY,
        }
    }

    /// Fewer than one degree of freedom is as good as one; rounding may take a variance below 0.
    pub fn new(value: f64, variance: f64, freedom: f64) -> Self {
        Self {
            value,
            error: variance.max(0.0).sqrt(),
            freedom: freedom.max(1.0),
        }
    }

    /// Mean of the channels, which are taken as fully correlated: errors add as they are.
    pub fn over(channels: &Channels) -> Self {
        let mean = |of: fn(&Self) -> f64| channels.iter().map(of).sum::<f64>() / 3.0;
        Self {
            value: mean(|channel| channel.value),
            error: mean(|channel| channel.error),
            freedom: channels
                .iter()
                .map(|channel| channel.freedom)
                .fold(f64::INFINITY, f64::min),
        }
    }

    /// 95 %, two-sided.
    pub fn interval(&self) -> Interval {
        let half = self.half_width();
        Interval {
            value: self.value,
            low: self.value - half,
            high: self.value + half,
        }
    }

    /// Whether the whole interval is above 0.
    pub fn is_above_zero(&self) -> bool {
        self.value > self.half_width()
    }

    pub fn times(&self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            error: self.error * factor.abs(),
            freedom: self.freedom,
        }
    }

    /// Of the logarithm; none where the value is not above 0.
    pub fn logarithm(&self) -> Option<Self> {
        (self.value > 0.0).then(|| Self {
            value: self.value.ln(),
            error: self.error / self.value,
            freedom: self.freedom,
        })
    }

    fn half_width(&self) -> f64 {
        match self.error {
            // Not 0 times an infinite quantile.
            0.0 => 0.0,
            error => error * student(UPPER, self.freedom),
        }
    }
}

/// The interval of a positive number whose logarithm is off by independent `parts`, of which only the
/// errors are read. Degrees of freedom after Welch (1947) and Satterthwaite (1946).
pub(super) fn from_logarithms(value: f64, parts: &[Quantity]) -> Interval {
    let variance: f64 = parts.iter().map(|part| part.error.powi(2)).sum();
    let spread: f64 = parts
        .iter()
        .map(|part| part.error.powi(4) / part.freedom)
        .sum();
    let freedom = if spread > 0.0 {
        variance * variance / spread
    } else {
        f64::INFINITY
    };
    let half = Quantity::new(0.0, variance, freedom).half_width();
    Interval {
        value,
        low: value * (-half).exp(),
        high: value * half.exp(),
    }
}
