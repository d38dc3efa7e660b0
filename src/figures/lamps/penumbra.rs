//! The penumbra of a straight edge, column by column, against the closed forms.

use super::RULES;
use crate::analysis::words::{negated, number, percent};
use crate::analysis::{Group, Quantity};
use crate::error::Result;
use crate::figures::build::{chance, difference, map, mean_of, ratio};
use crate::figures::data::Data;
use crate::figures::figure::*;
use crate::theory::{Drawn, chi_square_above, integrate, share};
use crate::wording::signed;
use std::fmt::Write as _;

const STUDY: &str = "fig7-penumbra";
/// Half of what the picture shows of the floor, and the lamp's radius: they make the edge's place of a column.
const HALF_WIDTH: f64 = 0.05;
const RADIUS: f64 = 0.04;

/// Sampler and pole of what is shown, with its name and its law as published.
const WAYS: [(&str, &str, &str, Drawn); 4] = [
    (
        "uniform-angles",
        "[1,0,0]",
        "case 1, pole across the edge",
        Drawn::Along,
    ),
    (
        "uniform-angles",
        "[0,0,1]",
        "case 1, pole along the edge",
        Drawn::Across,
    ),
    ("inverse-cosine", "[0,0,1]", "case 2", Drawn::Area),
    ("gaussian", "[0,0,1]", "case 3", Drawn::Area),
];

/// One way under one of the rules.
struct Profile {
    rules: usize,
    way: usize,
    columns: Vec<Column>,
}

struct Column {
    /// The edge's place on the lamp's disc, -1 hidden to 1 free.
    h: f64,
    /// Share of the free floor's light.
    measured: Quantity,
    predicted: f64,
    truth: f64,
    /// Variance of one sample.
    variance: f64,
}

pub struct Penumbra {
    profiles: Vec<Profile>,
}

/// The edge's place as seen from a column of so many, and how far a column reaches.
fn place(column: usize, columns: usize) -> (f64, f64) {
    let step = 2.0 * HALF_WIDTH / columns as f64 / RADIUS;
    (HALF_WIDTH / RADIUS - (column as f64 + 0.5) * step, step)
}

/// A law's share, mean over a column.
fn over(drawn: Drawn, (h, step): (f64, f64)) -> f64 {
    integrate(h - 0.5 * step, h + 0.5 * step, 4, |h| share(drawn, h)) / step
}

impl Profile {
    fn new(group: &Group, [width, height]: [u32; 2], rules: usize, way: usize) -> Self {
        let law = if rules == 0 {
            WAYS[way].3
        } else {
            Drawn::Truth
        };
        let column = |x: usize| {
            let pixels = (0..height as usize).map(|y| y * width as usize + x);
            let over_channels =
                |values: [f32; 3]| values.iter().map(|value| f64::from(*value)).sum::<f64>() / 3.0;
            let means: Vec<f64> = pixels
                .clone()
                .map(|pixel| over_channels(group.maps.mean[pixel]))
                .collect();
            let variances: Vec<f64> = pixels
                .map(|pixel| over_channels(group.maps.deviation[pixel]).powi(2))
                .collect();
            let variance = mean_of(&variances).value;
            let taken = means.len() as f64 * group.samples * group.runs as f64;
            let place = place(x, width as usize);
            Column {
                h: place.0,
                measured: Quantity::new(mean_of(&means).value, variance / taken, taken),
                predicted: over(law, place),
                truth: over(Drawn::Truth, place),
                variance,
            }
        };
        Self {
            rules,
            way,
            columns: (0..width as usize).map(column).collect(),
        }
    }

    fn bias(&self, column: &Column) -> Quantity {
        difference(column.measured, Quantity::exact(column.truth))
    }

    /// Light of the columns that see more than half of the lamp but not all of it, measured and by the law.
    fn lit_half(&self) -> (Quantity, f64) {
        let inside = || {
            self.columns
                .iter()
                .filter(|column| (0.0..1.0).contains(&column.h))
        };
        let light: f64 = inside().map(|column| column.measured.value).sum();
        let variance: f64 = inside().map(|column| column.measured.error.powi(2)).sum();
        let predicted = inside().map(|column| column.predicted).sum();
        (Quantity::new(light, variance, f64::INFINITY), predicted)
    }

    /// The column whose law is furthest from the truth.
    fn worst(&self) -> Option<&Column> {
        let off = |column: &&Column| (column.predicted - column.truth).abs();
        self.columns.iter().max_by(|a, b| off(a).total_cmp(&off(b)))
    }

    /// Pearson's sum over columns in the penumbra, and their number.
    fn square(&self) -> (f64, f64) {
        let inside = self
            .columns
            .iter()
            .filter(|column| column.h.abs() < 0.95 && column.measured.error > 0.0);
        let z =
            inside.map(|column| (column.measured.value - column.predicted) / column.measured.error);
        z.fold((0.0, 0.0), |(sum, count), z| (sum + z * z, count + 1.0))
    }
}

impl Penumbra {
    pub fn new(data: &Data) -> Result<Self> {
        let size = data.analysis(STUDY)?.question.size();
        let mut profiles = Vec::new();
        for (rules, (preset, _)) in RULES.into_iter().enumerate() {
            for (way, (sampler, pole, _, _)) in WAYS.into_iter().enumerate() {
                let values = [
                    ("render.preset", preset),
                    ("light.sampler", sampler),
                    ("light.pole", pole),
                ];
                profiles.push(Profile::new(data.group(STUDY, &values)?, size, rules, way));
            }
        }
        Ok(Self { profiles })
    }

    fn of(&self, rules: usize, way: usize) -> Option<&Profile> {
        self.profiles
            .iter()
            .find(|profile| profile.rules == rules && profile.way == way)
    }

    /// Case 1 with its two poles over case 2, in the lit half of the penumbra, as published: measured, and by
    /// the laws.
    fn splits(&self) -> Vec<(Quantity, f64)> {
        let of = |way| self.of(0, way).map(Profile::lit_half);
        let Some((second, second_law)) = of(2) else {
            return Vec::new();
        };
        let firsts = [of(0), of(1)].into_iter().flatten();
        let split = |(first, law): (Quantity, f64)| {
            let share = ratio(first, second);
            let excess = Quantity {
                value: share.value - 1.0,
                ..share
            };
            (excess, law / second_law - 1.0)
        };
        firsts.map(split).collect()
    }

    /// Whether case 1 clearly differs from case 2 there.
    pub fn is_split(&self) -> bool {
        let clear = |(split, _): &(Quantity, f64)| split.value.abs() > 3.0 * split.error;
        self.splits().iter().any(clear)
    }

    /// The same in words.
    pub fn split(&self) -> String {
        let words = |((split, law), pole): (&(Quantity, f64), &str)| {
            let less = split.value < 0.0;
            let size = if less {
                negated(split.interval())
            } else {
                split.interval()
            };
            let way = if less { "less" } else { "more" };
            format!(
                "{} {way} with its pole {pole} the edge (theory {:.1} %)",
                percent(size),
                100.0 * law.abs()
            )
        };
        let poles = ["across", "along"];
        let splits: Vec<String> = self.splits().iter().zip(poles).map(words).collect();
        format!(
            "from half shadow to full light, case 1 has {} than case 2",
            splits.join(" and ")
        )
    }

    pub fn plots(&self) -> Plots {
        let plot = |rules: usize| {
            let profiles = self
                .profiles
                .iter()
                .filter(|profile| profile.rules == rules);
            let measured = profiles.clone().map(|profile| Series {
                name: WAYS[profile.way].2.into(),
                look: Look::Band,
                colour: profile.way,
                points: profile
                    .columns
                    .iter()
                    .map(|column| Point::within(column.h, column.measured.interval()))
                    .collect(),
            });
            // Case 3 has the law of case 2.
            let laws = profiles
                .filter(|profile| rules == 0 && profile.way < 3)
                .map(|profile| law("", profile.way, profile, |column| column.predicted));
            let truth = self
                .of(rules, 0)
                .map(|profile| law("truth", WAYS.len(), profile, |column| column.truth));
            Plot::Lines(Lines {
                title: format!("Across the penumbra, {}", RULES[rules].1),
                x: Scale {
                    label: "place of the edge on the lamp's disc".into(),
                    low: Some(-1.25),
                    high: Some(1.25),
                    ..Scale::default()
                },
                y: Scale {
                    label: "share of the light".into(),
                    low: Some(0.0),
                    high: Some(1.1),
                    ..Scale::default()
                },
                series: measured.chain(laws).chain(truth).collect(),
                marks: Vec::new(),
            })
        };
        Plots {
            name: "penumbra".into(),
            caption: "Light on a floor behind a straight edge under a far lamp, from shadow to light; bands are measured, dashed lines \
                      are closed forms."
                .into(),
            plots: vec![plot(0), plot(1)],
        }
    }

    pub fn results(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        for (rules, (_, label)) in RULES.into_iter().enumerate() {
            let profiles = || {
                self.profiles
                    .iter()
                    .filter(move |profile| profile.rules == rules)
            };
            let p = |profile: &Profile| {
                let (square, count) = profile.square();
                chi_square_above(square, count)
            };
            let least = profiles().map(p).fold(1.0, f64::min);
            let count = profiles().count();
            sentences.push(format!(
                "Penumbra, {label}: {count} profiles of {} columns against their closed forms, chi-square of each: the least p is {} (for so \
                 many, {}).",
                self.profiles[0].square().1,
                chance(least),
                chance((count as f64 * least).min(1.0))
            ));
        }
        for way in 0..3 {
            sentences.extend(self.of(0, way).and_then(crossing));
        }
        sentences
    }

    pub fn csv(&self) -> DataFile {
        let mut csv = String::from("rules,sampler,pole,h,share,low,high,predicted,truth\n");
        for profile in &self.profiles {
            for column in &profile.columns {
                let interval = column.measured.interval();
                let (sampler, pole, _, _) = WAYS[profile.way];
                // Writing into a string cannot fail.
                let _ = writeln!(
                    csv,
                    "{},{sampler},\"{pole}\",{},{},{},{},{},{}",
                    RULES[profile.rules].1,
                    column.h,
                    interval.value,
                    interval.low,
                    interval.high,
                    column.predicted,
                    column.truth
                );
            }
        }
        DataFile {
            name: "fig7-penumbra.csv".into(),
            csv,
        }
    }
}

fn law(name: &str, colour: usize, profile: &Profile, of: fn(&Column) -> f64) -> Series {
    Series {
        name: name.into(),
        look: Look::Predicted,
        colour,
        points: profile
            .columns
            .iter()
            .map(|column| Point::exact(column.h, of(column)))
            .collect(),
    }
}

/// Where the published weight is furthest off: how far, and after how many samples a pixel shows it.
fn crossing(profile: &Profile) -> Option<String> {
    let worst = profile.worst()?;
    let bias = profile.bias(worst);
    let size = map(bias.interval(), |value| {
        value * worst.measured.value.signum()
    });
    let samples = worst.variance / (bias.value * bias.value);
    let predicted =
        worst.predicted * (1.0 - worst.predicted) / (worst.predicted - worst.truth).powi(2);
    Some(format!(
        "Penumbra, as published, {}: furthest off at {:.2} of the disc, by {} of the free light (theory {} %); one pixel needs \
         {} samples (theory {}) for that to equal its noise.",
        WAYS[profile.way].2,
        worst.h,
        percent(size),
        signed(100.0 * (worst.predicted - worst.truth), 1),
        number(samples),
        number(predicted)
    ))
}
