//! What the published weight buys and costs: less noise, for a bias that more samples do not take away.

use super::RULES;
use crate::analysis::Quantity;
use crate::analysis::words::{list, number};
use crate::error::Result;
use crate::figures::build::ratio;
use crate::figures::data::{Data, mean, variance};
use crate::figures::figure::*;
use crate::report::data::Interval;
use crate::wording::signed;

const ROOMS: [(&str, &str); 2] = [
    ("fig7-small-lamp", "small lamp"),
    ("fig7-large-lamp", "large lamp"),
];
/// Case 2 stands for all three.
const CASE: &str = "inverse-cosine";

/// One region under one lamp, published against corrected.
struct Row {
    lamp: &'static str,
    region: String,
    bias: Option<Interval>,
    /// Standard deviation of one sample over the mean.
    noise: [f64; 2],
    /// Samples a pixel at which the published bias equals the noise; none where no bias is told.
    crossing: Option<Interval>,
    /// Mean squared error of a run as published over corrected.
    error: Option<Quantity>,
}

pub struct Worth {
    rows: Vec<Row>,
    samples: f64,
}

impl Worth {
    pub fn new(data: &Data) -> Result<Self> {
        let (mut rows, mut samples) = (Vec::new(), 0.0);
        for (room, lamp) in ROOMS {
            let values =
                RULES.map(|(preset, _)| [("render.preset", preset), ("light.sampler", CASE)]);
            let groups = [data.group(room, &values[0])?, data.group(room, &values[1])?];
            let against = data.against(room, &values[0])?;
            samples = groups[0].samples;
            for (index, region) in data.analysis(room)?.question.regions().iter().enumerate() {
                let deviation = |rules: usize| {
                    variance(groups[rules], index).value.max(0.0).sqrt()
                        / mean(groups[rules], index).value
                };
                let [published, corrected] = groups.map(|group| group.regions[index].energy.mse());
                let told = published.value > 0.0 && corrected.is_above_zero();
                rows.push(Row {
                    lamp,
                    region: region.name.clone(),
                    bias: groups[0].regions[index]
                        .relative_bias
                        .map(|bias| bias.interval()),
                    noise: [0, 1].map(deviation),
                    crossing: against[index].crossing,
                    error: told.then(|| ratio(published, corrected)),
                });
            }
        }
        Ok(Self { rows, samples })
    }

    pub fn table(&self) -> Table {
        let row = |row: &Row| {
            let percent = |of: Interval| {
                let [value, low, high] =
                    [of.value, of.low, of.high].map(|part| signed(100.0 * part, 1));
                format!("{value} % ({low} to {high})")
            };
            let plain = |of: Interval| {
                format!(
                    "{} ({} to {})",
                    number(of.value),
                    number(of.low),
                    number(of.high)
                )
            };
            vec![
                row.lamp.into(),
                row.region.clone(),
                row.bias.map_or(String::new(), percent),
                format!("{:.0} %", 100.0 * row.noise[0]),
                format!("{:.0} %", 100.0 * row.noise[1]),
                row.crossing.map_or("no bias is told".into(), plain),
                row.error
                    .map_or(String::new(), |error| plain(error.interval())),
            ]
        };
        let head = [
            "lamp",
            "region",
            "bias",
            "noise",
            "noise, corrected",
            "samples to the bias",
            "error ratio",
        ];
        Table {
            caption: format!(
                "What the published weight costs and buys, case 2: its bias; its noise and that of the corrected weight (standard deviation of one \
                 sample over the mean); the number of samples a pixel whose noise is as large as the bias; and the mean squared error of a pixel at \
                 the paper's {} samples over that of the corrected weight, below 1 where the published one is nearer to the truth.",
                self.samples
            ),
            head: head.map(String::from).to_vec(),
            rows: self.rows.iter().map(row).collect(),
        }
    }

    pub fn results(&self) -> Vec<String> {
        let named = |fits: &dyn Fn(&Quantity) -> bool| -> Vec<String> {
            let rows = self
                .rows
                .iter()
                .filter(|row| row.error.as_ref().is_some_and(fits));
            rows.map(|row| format!("{} ({})", row.region, row.lamp))
                .collect()
        };
        let better = named(&|error| error.interval().high < 1.0);
        let worse = named(&|error| error.interval().low > 1.0);
        let part = |names: &[String], words: &str| {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            (!names.is_empty()).then(|| format!("{words} in {}", list(&names)))
        };
        let parts = [
            part(&better, "it is nearer to the truth than the corrected one"),
            part(&worse, "further from it"),
        ];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        if parts.is_empty() {
            return Vec::new();
        }
        vec![format!(
            "The published weight is biased but quiet: at {} samples a pixel {}. Its bias stays however many samples are taken.",
            self.samples,
            parts.join(", ")
        )]
    }
}
