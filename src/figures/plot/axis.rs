//! From values to places on the page.

use crate::figures::Scale;

/// Beyond this a difference of two values would not be finite.
const MOST: f64 = 1e300;
/// What a logarithmic axis shows where nothing is to be shown on it.
const NOTHING: (f64, f64) = (0.1, 1.0);

/// An axis whose ends have places.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    pub logarithmic: bool,
    pub low: f64,
    pub high: f64,
    /// Places of the two ends.
    pub from: f64,
    pub to: f64,
}

/// How much room an axis has beyond its values.
#[derive(Clone, Copy)]
pub(super) enum Room {
    /// As little as keeps marks off the ends.
    Tight,
    /// To the next round number, and to zero where it is near.
    Round,
}

impl Axis {
    /// An axis that holds `values`, as far as it can show them, unless the scale says its ends.
    pub fn of(scale: &Scale, values: impl Iterator<Item = f64>, room: Room) -> Self {
        let logarithmic = scale.logarithmic;
        let shown = |value: &f64| is_shown(*value, logarithmic);
        let (least, most) = values
            .filter(shown)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            });
        let (low, high) = match (least <= most, logarithmic) {
            (false, true) => NOTHING,
            (false, false) => (0.0, 1.0),
            (true, true) => beyond_logarithmic(least, most),
            (true, false) => beyond_linear(least, most, room),
        };
        let low = scale.low.filter(shown).unwrap_or(low);
        let high = scale.high.filter(shown).unwrap_or(high);
        let (low, high) = apart(low, high, logarithmic);
        Self {
            logarithmic,
            low,
            high,
            from: 0.0,
            to: 1.0,
        }
    }

    pub fn between(mut self, from: f64, to: f64) -> Self {
        (self.from, self.to) = (from, to);
        self
    }

    /// The place of a value; none for what this axis cannot show.
    pub fn at(&self, value: f64) -> Option<f64> {
        is_shown(value, self.logarithmic).then(|| {
            let share = if self.logarithmic {
                (value.ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
            } else {
                (value - self.low) / (self.high - self.low)
            };
            self.from + share * (self.to - self.from)
        })
    }

    /// The place of a value, or that of the end beyond which it lies.
    pub fn clamped(&self, value: f64) -> Option<f64> {
        if value.is_nan() {
            return None;
        }
        self.at(value.clamp(self.low, self.high))
    }

    pub fn holds(&self, value: f64) -> bool {
        // An end that was rounded on its way still belongs to the axis.
        let slack = 1e-9 * (self.high - self.low).abs();
        is_shown(value, self.logarithmic) && value >= self.low - slack && value <= self.high + slack
    }
}

fn is_shown(value: f64, logarithmic: bool) -> bool {
    value.abs() <= MOST && (!logarithmic || value > 0.0)
}

/// Two ends that differ, in order.
fn apart(low: f64, high: f64, logarithmic: bool) -> (f64, f64) {
    let (low, high) = if high < low { (high, low) } else { (low, high) };
    if high - low > 1e-12 * low.abs().max(high.abs()) {
        return (low, high);
    }
    match (logarithmic, low == 0.0) {
        (true, _) => (low / 2.0, high * 2.0),
        (false, true) => (-1.0, 1.0),
        (false, false) => (low - 0.1 * low.abs(), high + 0.1 * high.abs()),
    }
}

fn beyond_logarithmic(least: f64, most: f64) -> (f64, f64) {
    let margin = (most / least).powf(0.06).max(1.05);
    let low = if least / margin > 0.0 {
        least / margin
    } else {
        least
    };
    (low, (most * margin).min(MOST))
}

fn beyond_linear(least: f64, most: f64, room: Room) -> (f64, f64) {
    let (least, most) = apart(least, most, false);
    let span = most - least;
    match room {
        Room::Tight => (least - 0.03 * span, most + 0.03 * span),
        Room::Round => {
            // A zero that is near says more than an end that is tight.
            let least = if least > 0.0 && least < 0.6 * most {
                0.0
            } else {
                least
            };
            let most = if most < 0.0 && most > 0.6 * least {
                0.0
            } else {
                most
            };
            let step = step_of((most - least) / 12.0);
            let (low, high) = ((least / step).floor() * step, (most / step).ceil() * step);
            (low, high)
        }
    }
}

/// The least of 1, 2, 5 times a power of ten that is no less than `rough`.
pub(super) fn step_of(rough: f64) -> f64 {
    let power = 10f64.powf(rough.log10().floor());
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|factor| factor * power >= rough * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}
