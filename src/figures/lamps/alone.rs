//! One lamp straight above one plate: the cases' bias as published and their variance with true densities, against
//! quadrature.

use super::RULES;
use crate::analysis::words::{number, ranged};
use crate::analysis::{Group, Quantity};
use crate::error::Result;
use crate::figures::build::{chance, furthest, map, ratio};
use crate::figures::data::{Data, mean, variance};
use crate::figures::figure::*;
use crate::theory::{self, Law, literal_ratio};
use std::fmt::Write as _;

const STUDY: &str = "fig7-one-lamp";
/// The plate's albedo; its radiance is that times q^2.
const ALBEDO: f64 = 0.5;
const RADII: [&str; 4] = ["0.03", "0.17", "0.35", "0.5"];

/// Sampler and pole, name, and law.
const WAYS: [(&str, &str, &str, Law); 4] = [
    (
        "uniform-angles",
        "[0,1,0]",
        "case 1, pole toward the plate",
        Law::PoleToward,
    ),
    (
        "uniform-angles",
        "[0,0,1]",
        "case 1, pole sideways",
        Law::PoleSideways,
    ),
    ("inverse-cosine", "[0,0,1]", "case 2", Law::Area),
    ("gaussian", "[0,0,1]", "case 3", Law::Area),
];

/// One number that theory knows.
struct Known {
    q: f64,
    measured: Quantity,
    predicted: f64,
}

impl Known {
    /// How many standard errors apart.
    fn z(&self) -> f64 {
        (self.measured.value - self.predicted) / self.measured.error.max(f64::MIN_POSITIVE)
    }
}

/// Bias as published and relative variance corrected, way by way and radius by radius.
pub struct Alone {
    bias: [Vec<Known>; 4],
    variance: [Vec<Known>; 4],
}

/// Mean over the truth, less 1.
fn bias(group: &Group, q: f64) -> Quantity {
    let level = mean(group, 0).times(1.0 / (ALBEDO * q * q));
    Quantity {
        value: level.value - 1.0,
        ..level
    }
}

/// Relative variance of a group in a region.
fn relative_variance(group: &Group, region: usize) -> Quantity {
    let level = mean(group, region);
    let square = Quantity::new(
        level.value * level.value,
        (2.0 * level.value * level.error).powi(2),
        level.freedom,
    );
    ratio(variance(group, region), square)
}

impl Alone {
    pub fn new(data: &Data) -> Result<Self> {
        let group = |rules: usize, way: usize, q: &str| {
            let (sampler, pole, _, _) = WAYS[way];
            let values = [
                ("render.preset", RULES[rules].0),
                ("light.sampler", sampler),
                ("light.pole", pole),
                ("spheres.0.radius", q),
            ];
            data.group(STUDY, &values)
        };
        let (mut biases, mut variances) =
            ([(); 4].map(|()| Vec::new()), [(); 4].map(|()| Vec::new()));
        for (way, (_, _, _, law)) in WAYS.into_iter().enumerate() {
            for text in RADII {
                let q: f64 = text.parse().unwrap_or(f64::NAN);
                biases[way].push(Known {
                    q,
                    measured: bias(group(0, way, text)?, q),
                    predicted: literal_ratio(law, q, q) - 1.0,
                });
                variances[way].push(Known {
                    q,
                    measured: relative_variance(group(1, way, text)?, 0),
                    predicted: theory::relative_variance(law, q),
                });
            }
        }
        Ok(Self {
            bias: biases,
            variance: variances,
        })
    }

    pub fn plots(&self) -> Plots {
        let bias = lines(
            "Bias as published",
            ("bias, %", 100.0, false),
            &self.bias,
            |law, q| literal_ratio(law, q, q) - 1.0,
        );
        let variance = lines(
            "Variance with true densities",
            ("variance of one sample over squared mean", 1.0, true),
            &self.variance,
            theory::relative_variance,
        );
        Plots {
            name: "one-lamp".into(),
            caption: "One lamp above a plate: dots are measured, dashed lines integrated. As published the cases differ by bias, \
                      divided by their densities by variance."
                .into(),
            plots: vec![Plot::Lines(bias), Plot::Lines(variance)],
        }
    }

    pub fn results(&self) -> Vec<String> {
        let all = || self.bias.iter().chain(&self.variance).flatten();
        let (worst, p) = furthest(all().map(Known::z));
        vec![
            format!(
                "One lamp: {} measured biases and variances against theory: the furthest is {} standard errors off (p = {} for so many).",
                all().count(),
                number(worst),
                chance(p)
            ),
            self.order(),
        ]
    }

    /// The variances of a lamp at q = 0.17, least first.
    fn order(&self) -> String {
        let of = |way: usize| self.variance[way].iter().find(|known| known.q == 0.17);
        let mut found: Vec<(usize, &Known)> =
            (0..4).filter_map(|way| Some((way, of(way)?))).collect();
        found.sort_by(|a, b| a.1.measured.value.total_cmp(&b.1.measured.value));
        let words: Vec<String> = found
            .iter()
            .map(|(way, known)| {
                let value = ranged(known.measured.interval());
                format!(
                    "{} {value}, theory {}",
                    WAYS[*way].2,
                    number(known.predicted)
                )
            })
            .collect();
        format!(
            "Relative variance of one sample at q = 0.17, corrected: {}.",
            words.join("; ")
        )
    }

    pub fn csv(&self) -> DataFile {
        let mut csv = String::from("quantity,sampler,pole,q,measured,low,high,predicted\n");
        for (name, ways) in [
            ("published bias", &self.bias),
            ("corrected relative variance", &self.variance),
        ] {
            for (way, known) in ways
                .iter()
                .enumerate()
                .flat_map(|(way, all)| all.iter().map(move |known| (way, known)))
            {
                let interval = known.measured.interval();
                let (sampler, pole, _, _) = WAYS[way];
                // Writing into a string cannot fail.
                let _ = writeln!(
                    csv,
                    "{name},{sampler},\"{pole}\",{},{},{},{},{}",
                    known.q, interval.value, interval.low, interval.high, known.predicted
                );
            }
        }
        DataFile {
            name: "fig7-one-lamp.csv".into(),
            csv,
        }
    }
}

/// Dots and the lines of theory; `factor` and logarithm belong to the label.
fn lines(
    title: &str,
    (label, factor, logarithmic): (&str, f64, bool),
    ways: &[Vec<Known>; 4],
    predict: impl Fn(Law, f64) -> f64,
) -> Lines {
    let mut series = Vec::new();
    for (way, known) in ways.iter().enumerate() {
        let (_, _, name, law) = WAYS[way];
        // Case 3 lies on case 2: a little aside both are seen.
        let aside = if way == 3 { 0.008 } else { 0.0 };
        let point = |known: &Known| {
            Point::within(
                known.q + aside,
                map(known.measured.interval(), |value| factor * value),
            )
        };
        series.push(Series {
            name: name.into(),
            look: Look::Dots,
            colour: way,
            points: known.iter().map(point).collect(),
        });
        // Case 3 has the law of case 2.
        if way < 3 {
            let at = |step: i32| {
                let q = 0.02 + 0.48 * f64::from(step) / 48.0;
                Point::exact(q, factor * predict(law, q))
            };
            series.push(Series {
                name: if way == 0 { "theory" } else { "" }.into(),
                look: Look::Predicted,
                colour: way,
                points: (0..=48).map(at).collect(),
            });
        }
    }
    Lines {
        title: title.into(),
        x: Scale {
            label: "q, radius over distance".into(),
            low: Some(0.0),
            ..Scale::default()
        },
        y: Scale {
            label: label.into(),
            logarithmic,
            ..Scale::default()
        },
        series,
        marks: Vec::new(),
    }
}
