//! The rooms as pictures, bars, a table and a file.

use super::{Cell, ROOMS, Rooms, WHOLE, group};
use crate::error::Result;
use crate::figures::build::{self, map, shown};
use crate::figures::data::{CASES, Data};
use crate::figures::figure::*;
use crate::figures::lamps::{CASE_NAMES, RULES};
use crate::report::data::Interval;
use crate::wording::{counted, signed};
use std::fmt::Write as _;

fn has_numbers(group: &BarGroup) -> bool {
    group.bars.iter().any(Option::is_some)
}

/// The pictures: a row for each lamp and rules, a column for each case.
pub fn pictures(data: &Data) -> Result<Pictures> {
    let mut block = build::pictures(
        "rooms",
        "The cases from left to right, and a reference of many samples, with the regions outlined: ceiling, back wall, ball top, lit floor and \
         penumbra, from top to bottom. Below each picture its bias over the whole of it.",
        &["case 1", "case 2", "case 3", "reference"],
    );
    for (room, lamp) in ROOMS {
        let question = &data.analysis(room)?.question;
        for (preset, rules) in RULES {
            let mut cells = Vec::new();
            for case in 0..3 {
                let group = group(data, room, preset, case)?;
                let bias = group.regions[0].relative_bias;
                let note = bias.map_or(String::new(), |bias| {
                    let value = signed(100.0 * bias.value, 2);
                    format!("{value} ± {:.2} %", 196.0 * bias.error)
                });
                cells.push(shown(group, question.size(), 0.0, note));
            }
            let reference = group(data, room, preset, 0)?.reference;
            if let Some(reference) = reference.and_then(|index| question.references().get(index)) {
                let picture = reference.picture();
                let note = counted(picture.record.samples, "sample");
                let mut shown = build::picture(&picture.mean, question.size(), 0.0, note);
                if preset == RULES[0].0 {
                    let regions = question.regions().iter().skip(1);
                    regions.for_each(|region| build::outline(&mut shown, region.rect));
                }
                cells.push(shown);
            }
            block.rows.push(PictureRow {
                label: format!("{lamp}, {rules}"),
                cells,
            });
        }
    }
    Ok(block)
}

impl Rooms {
    pub fn blocks(&self) -> Vec<Block> {
        let bias = |cell: &Cell| {
            cell.bias
                .map(|bias| bias.map(|bias| map(bias.interval(), |value| 100.0 * value)))
        };
        let noise = |cell: &Cell| {
            // The lamp itself would make most of the noise of the whole picture.
            let shown = cell.region != WHOLE;
            cell.noise
                .map(|noise| shown.then(|| map(noise, |value| 100.0 * value)))
        };
        vec![
            Block::Plots(self.bars(
                "bias",
                "Bias of each case by region against the reference, whose own error the three have in common; whiskers are 95 % intervals.",
                ("bias, %", 0.0),
                &bias,
            )),
            Block::Plots(self.bars(
                "noise",
                "Noise of each case by region: standard deviation of one sample over the mean. (Of the whole picture it would be that of the lamp’s edge.)",
                ("noise, %", 0.0),
                &noise,
            )),
            Block::Table(self.table()),
        ]
    }

    fn bars(
        &self,
        name: &str,
        caption: &str,
        (label, base): (&str, f64),
        of: &dyn Fn(&Cell) -> [Option<Interval>; 3],
    ) -> Plots {
        let plot = |lamp: usize, rules: usize| {
            let group = |cell: &Cell| BarGroup {
                name: cell.region.clone(),
                bars: of(cell).to_vec(),
                predicted: vec![None; 3],
            };
            Plot::Bars(Bars {
                title: format!("{}, {}", ROOMS[lamp].1, RULES[rules].1),
                y: Scale {
                    label: label.into(),
                    ..Scale::default()
                },
                base,
                names: CASE_NAMES.map(String::from).to_vec(),
                colours: vec![0, 1, 2],
                groups: self
                    .of(lamp, rules)
                    .map(group)
                    .filter(has_numbers)
                    .collect(),
                marks: Vec::new(),
            })
        };
        let each = [(0, 0), (0, 1), (1, 0), (1, 1)];
        Plots {
            name: name.into(),
            caption: caption.into(),
            plots: each.map(|(lamp, rules)| plot(lamp, rules)).to_vec(),
        }
    }

    fn table(&self) -> Table {
        let row = |cell: &Cell| {
            let percents = cell.against.map(|difference| {
                let interval = difference.interval();
                let [value, low, high] = [difference.value, interval.low, interval.high]
                    .map(|part| signed(100.0 * part, 2));
                format!("{value} % ({low} to {high})")
            });
            let [first, third] = percents;
            vec![
                ROOMS[cell.lamp].1.into(),
                RULES[cell.rules].1.into(),
                cell.region.clone(),
                first,
                self.told(cell.against[0]).words().into(),
                third,
                self.told(cell.against[1]).words().into(),
            ]
        };
        let head = [
            "lamp",
            "rules",
            "region",
            "case 1 against case 2",
            "",
            "case 3 against case 2",
            "",
        ];
        Table {
            caption: "Difference of the means. Brackets are 95 % intervals of each difference by itself; the verdicts allow a chance of 5 % for any \
                      mistake in the whole table. Same within 1 % is said where the whole interval for that is inside 1 %, even where the \
                      difference is clearly not 0. Cases 2 and 3 are one distribution: the last columns are the control."
                .into(),
            head: head.map(String::from).to_vec(),
            rows: self.cells.iter().map(row).collect(),
        }
    }

    pub fn csv(&self) -> DataFile {
        let mut csv = String::from(
            "lamp,rules,region,case,bias,bias_low,bias_high,noise,noise_low,noise_high,against_case_2,against_low,against_high\n",
        );
        for cell in &self.cells {
            for case in 0..3 {
                let ends = |interval: Option<Interval>| {
                    interval.map_or(",,".to_string(), |of| {
                        format!("{},{},{}", of.value, of.low, of.high)
                    })
                };
                let against = [Some(cell.against[0]), None, Some(cell.against[1])][case];
                // Writing into a string cannot fail.
                let _ = writeln!(
                    csv,
                    "{},{},{},{},{},{},{}",
                    ROOMS[cell.lamp].1,
                    RULES[cell.rules].1,
                    cell.region,
                    CASES[case],
                    ends(cell.bias[case].map(|bias| bias.interval())),
                    ends(Some(cell.noise[case])),
                    ends(against.map(|against| against.interval()))
                );
            }
        }
        DataFile {
            name: "fig7-rooms.csv".into(),
            csv,
        }
    }
}
