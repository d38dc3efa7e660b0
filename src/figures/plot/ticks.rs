//! Where an axis is marked, and what stands there.

use super::axis::{Axis, step_of};
use super::canvas::TEXT;
use super::measure::text_width;

/// A place on an axis; without a label where it is a lesser one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub value: f64,
    pub label: Option<Label>,
}

/// A number as it is written: `words`, and a raised power of ten behind it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Label {
    pub words: String,
    pub power: Option<i32>,
}

impl Label {
    pub fn width(&self) -> f64 {
        let power = self
            .power
            .map_or_else(String::new, |power| format!("−{}", power.abs()));
        text_width(&self.words, TEXT, false) + text_width(&power, 0.75 * TEXT, false)
    }
}

/// The ticks of an axis, `most` labelled ones or about so many.
pub(super) fn ticks(axis: &Axis, most: usize) -> Vec<Tick> {
    let ticks = if axis.logarithmic {
        logarithmic(axis, most)
    } else {
        linear(axis, most)
    };
    ticks
        .into_iter()
        .filter(|tick| axis.holds(tick.value))
        .collect()
}

/// As many ticks as leave room between labels that stand beside one another.
pub(super) fn ticks_abreast(axis: &Axis) -> Vec<Tick> {
    for most in (2..=10).rev() {
        let ticks = ticks(axis, most);
        if has_room(axis, &ticks) {
            return ticks;
        }
    }
    let mut ticks = ticks(axis, 2);
    for tick in ticks.iter_mut().skip(1) {
        tick.label = None;
    }
    ticks
}

fn has_room(axis: &Axis, ticks: &[Tick]) -> bool {
    const GAP: f64 = 10.0;
    let mut end = f64::NEG_INFINITY;
    ticks.iter().all(|tick| {
        let (Some(at), Some(label)) = (axis.at(tick.value), &tick.label) else {
            return true;
        };
        let free = at - label.width() / 2.0 >= end;
        end = at + label.width() / 2.0 + GAP;
        free
    })
}

fn linear(axis: &Axis, most: usize) -> Vec<Tick> {
    let step = step_of((axis.high - axis.low) / most.max(1) as f64);
    let values: Vec<f64> = multiples(axis.low, axis.high, step);
    let greatest = values
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    let scientific = !(1e-3..1e5).contains(&greatest);
    values
        .into_iter()
        .map(|value| Tick {
            value,
            label: Some(if scientific {
                powered(value, step)
            } else {
                plain(value, step)
            }),
        })
        .collect()
}

fn multiples(low: f64, high: f64, step: f64) -> Vec<f64> {
    const MOST: usize = 40;
    let first = (low / step - 1e-9).ceil();
    (0..MOST)
        .map(|index| (first + index as f64) * step)
        .take_while(|value| *value <= high + 1e-9 * step)
        .collect()
}

/// Decades, or parts of them where there are few; the rest of 2 to 9 without a label.
fn logarithmic(axis: &Axis, most: usize) -> Vec<Tick> {
    let (first, last) = (
        axis.low.log10().floor() as i32,
        axis.high.log10().ceil() as i32,
    );
    let inside = |value: f64| axis.holds(value);
    let decades = (first..=last).filter(|&power| inside(ten(power))).count();
    let fine = |factors: &[i32]| {
        let value = |power| move |&factor: &i32| f64::from(factor) * ten(power);
        (first..=last)
            .flat_map(|power| factors.iter().map(value(power)))
            .filter(|&value| inside(value))
            .count()
    };
    if decades >= 3 || (decades >= 2 && fine(&[1, 2, 5]) > most) {
        let inside = (first..=last).filter(|&power| inside(ten(power)));
        return by_decades(first, last, &inside.collect::<Vec<_>>(), most);
    }
    let all = [[1, 2, 5].as_slice(), &[1, 3], &[1, 2, 3, 4, 5, 6, 7, 8, 9]];
    match all
        .into_iter()
        .find(|factors| (2..=most).contains(&fine(factors)))
    {
        Some(factors) => by_factors(first, last, factors),
        None => linear(axis, most),
    }
}

fn by_decades(first: i32, last: i32, decades: &[i32], most: usize) -> Vec<Tick> {
    let every = decades.len().div_ceil(most.max(1)).max(1) as i32;
    let minor = if every == 1 { 1..=9 } else { 1..=1 };
    let plain = decades.iter().all(|power| (-3..=4).contains(power));
    (first..=last)
        .flat_map(|power| minor.clone().map(move |factor| (power, factor)))
        .map(|(power, factor)| Tick {
            value: f64::from(factor) * ten(power),
            label: (factor == 1 && power.rem_euclid(every) == 0)
                .then(|| of_factor(1, power, plain)),
        })
        .collect()
}

fn by_factors(first: i32, last: i32, labelled: &[i32]) -> Vec<Tick> {
    let plain = first >= -3 && last <= 5;
    (first..=last)
        .flat_map(|power| (1..=9).map(move |factor| (power, factor)))
        .map(|(power, factor)| Tick {
            value: f64::from(factor) * ten(power),
            label: labelled
                .contains(&factor)
                .then(|| of_factor(factor, power, plain)),
        })
        .collect()
}

fn of_factor(factor: i32, power: i32, in_full: bool) -> Label {
    if in_full {
        return plain(f64::from(factor) * ten(power), ten(power));
    }
    Label {
        words: if factor == 1 {
            "10".into()
        } else {
            format!("{factor}×10")
        },
        power: Some(power),
    }
}

fn plain(value: f64, step: f64) -> Label {
    let digits = (-(step.log10() + 1e-9).floor()).clamp(0.0, 12.0) as usize;
    let words = format!("{:.digits$}", value.abs());
    let sign = if value < 0.0 && words.bytes().any(|digit| (b'1'..=b'9').contains(&digit)) {
        "−"
    } else {
        ""
    };
    Label {
        words: format!("{sign}{}", grouped(&words)),
        power: None,
    }
}

/// Thousands apart, from five digits on.
fn grouped(words: &str) -> String {
    let (whole, rest) = words.split_at(words.find('.').unwrap_or(words.len()));
    if whole.len() < 5 {
        return words.into();
    }
    let (head, tail) = whole.split_at(whole.len() - 3);
    format!("{head}\u{202f}{tail}{rest}")
}

/// A mantissa and a power of ten; nought is nought.
fn powered(value: f64, step: f64) -> Label {
    if value.abs() < 0.5 * step {
        return plain(0.0, 1.0);
    }
    let power = value.abs().log10().floor() as i32;
    let mantissa = plain(value / ten(power), (step / ten(power)).min(1.0)).words;
    Label {
        words: format!("{mantissa}×10"),
        power: Some(power),
    }
}

fn ten(power: i32) -> f64 {
    10f64.powi(power)
}
