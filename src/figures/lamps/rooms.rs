//! The room with a small and with a large lamp: bias and noise, region by region.

use super::penumbra::Penumbra;
use super::{CASE_NAMES, RULES};
use crate::analysis::words::{list, number, percent};
use crate::analysis::{Group, Quantity};
use crate::compare::verdict::student;
use crate::error::Result;
use crate::figures::build::{self, map, mean_of, ratio, shown};
use crate::figures::data::{CASES, Data, mean, variance};
use crate::figures::figure::*;
use crate::pack::Rect;
use crate::report::data::Interval;
use std::fmt::Write as _;

const ROOMS: [(&str, &str); 2] = [
    ("fig7-small-lamp", "Small lamp"),
    ("fig7-large-lamp", "Large lamp"),
];
/// Differences up to this share of the light count as none.
const MARGIN: f64 = 0.01;
/// Chance that any of the room's differences is called one by chance.
const LEVEL: f64 = 0.05;

/// What one lamp under one of the rules shows in one region.
struct Cell {
    lamp: usize,
    rules: usize,
    region: String,
    /// Of each case, relative to the reference.
    bias: [Option<Quantity>; 3],
    /// Standard deviation of one sample over the mean.
    noise: [Interval; 3],
    /// Of case 1 and of case 3 against case 2, relative.
    against: [Quantity; 2],
}

/// Name of the first region.
const WHOLE: &str = "whole picture";

fn has_numbers(group: &BarGroup) -> bool {
    group.bars.iter().any(Option::is_some)
}

/// What a difference comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Told {
    Different,
    Same,
    Neither,
}

impl Told {
    fn words(self) -> &'static str {
        match self {
            Told::Different => "different",
            Told::Same => "same within 1 %",
            Told::Neither => "too few samples to tell",
        }
    }
}

pub struct Rooms {
    cells: Vec<Cell>,
}

fn group<'d>(data: &'d Data, room: &str, preset: &str, case: usize) -> Result<&'d Group> {
    let values = [("render.preset", preset), ("light.sampler", CASES[case])];
    data.group(room, &values)
}

/// The pictures: a row for each lamp and rules, a column for each case.
pub fn pictures(data: &Data) -> Result<Pictures> {
    let mut block = build::pictures(
        "rooms",
        "The cases from left to right, and a reference of many samples. Below each picture its bias over the whole of it.",
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
                    format!("{:+.1} ± {:.1} %", 100.0 * bias.value, 196.0 * bias.error)
                });
                cells.push(shown(group, question.size(), 0.0, note));
            }
            let reference = group(data, room, preset, 0)?.reference;
            if let Some(reference) = reference.and_then(|index| question.references().get(index)) {
                let picture = reference.picture();
                let note = format!("{} samples", picture.record.samples);
                cells.push(build::picture(&picture.mean, question.size(), 0.0, note));
            }
            block.rows.push(PictureRow {
                label: format!("{lamp}, {rules}"),
                cells,
            });
        }
    }
    Ok(block)
}

/// a - b relative to b, over the pixels of a region. Runs of equal seeds share their bounces, so the
/// differences of pixels are steadier than the pixels; their spread gives the error.
fn against(a: &Group, b: &Group, width: u32, rect: Rect) -> Quantity {
    let level = |group: &Group, pixel: usize| {
        group.maps.mean[pixel]
            .iter()
            .map(|value| f64::from(*value))
            .sum::<f64>()
            / 3.0
    };
    let rows = rect.y0..rect.y1;
    let pixels: Vec<usize> = rows
        .flat_map(|y| (rect.x0..rect.x1).map(move |x| (y * width + x) as usize))
        .collect();
    let apart: Vec<f64> = pixels
        .iter()
        .map(|pixel| level(a, *pixel) - level(b, *pixel))
        .collect();
    let light: Vec<f64> = pixels.iter().map(|pixel| level(b, *pixel)).collect();
    mean_of(&apart).times(1.0 / mean_of(&light).value)
}

impl Rooms {
    pub fn new(data: &Data) -> Result<Self> {
        let mut cells = Vec::new();
        for (lamp, (room, _)) in ROOMS.into_iter().enumerate() {
            let question = &data.analysis(room)?.question;
            let width = question.size()[0];
            for (rules, (preset, _)) in RULES.into_iter().enumerate() {
                let [one, two, three] = [0, 1, 2].map(|case| group(data, room, preset, case));
                let groups = [one?, two?, three?];
                for (index, region) in question.regions().iter().enumerate() {
                    let noise = |group: &Group| {
                        let level = mean(group, index);
                        map(variance(group, index).interval(), |value| {
                            value.max(0.0).sqrt() / level.value
                        })
                    };
                    cells.push(Cell {
                        lamp,
                        rules,
                        region: region.name.clone(),
                        bias: groups.map(|group| group.regions[index].relative_bias),
                        noise: groups.map(noise),
                        against: [0, 2]
                            .map(|case| against(groups[case], groups[1], width, region.rect)),
                    });
                }
            }
        }
        Ok(Self { cells })
    }

    fn of(&self, lamp: usize, rules: usize) -> impl Iterator<Item = &Cell> {
        self.cells
            .iter()
            .filter(move |cell| cell.lamp == lamp && cell.rules == rules)
    }

    /// With a level that holds for all of the table's differences together (Bonferroni).
    fn told(&self, difference: Quantity) -> Told {
        let each = LEVEL / (2 * self.cells.len()) as f64;
        let reach = |p: f64| student(p, difference.freedom) * difference.error;
        let size = difference.value.abs();
        if size + reach(1.0 - each) < MARGIN {
            Told::Same
        } else if size > reach(1.0 - 0.5 * each) {
            Told::Different
        } else {
            Told::Neither
        }
    }

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
                "Bias of each case by region against the reference; whiskers are 95 % intervals.",
                ("bias, %", 0.0),
                &bias,
            )),
            Block::Plots(self.bars(
                "noise",
                "Noise of each case by region: standard deviation of one sample over the mean.",
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
                let [low, high] = [interval.low, interval.high].map(|end| 100.0 * end);
                format!(
                    "{:+.2} % ({low:+.2} to {high:+.2})",
                    100.0 * difference.value
                )
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
            caption: "Difference of the means, 95 % intervals; verdicts at 5 % over the whole table. Cases 2 and 3 are one \
                      distribution: the last column is the control."
                .into(),
            head: head.map(String::from).to_vec(),
            rows: self.cells.iter().map(row).collect(),
        }
    }

    /// Regions in which case 1 is told from case 2.
    fn differing(&self, lamp: usize, rules: usize) -> Vec<&Cell> {
        let clear = |cell: &&Cell| self.told(cell.against[0]) == Told::Different;
        self.of(lamp, rules).filter(clear).collect()
    }

    /// The largest of them, in words.
    fn worst(&self, lamp: usize, rules: usize) -> Option<String> {
        let size = |cell: &&&Cell| cell.against[0].value.abs();
        let cells = self.differing(lamp, rules);
        let worst = cells.iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
        let first = worst.against[0];
        let way = if first.value < 0.0 {
            "darker"
        } else {
            "brighter"
        };
        let sized = Quantity {
            value: first.value.abs(),
            ..first
        };
        Some(format!(
            "case 1 is {} {way} than case 2 in the region {}",
            percent(sized.interval()),
            worst.region
        ))
    }

    pub fn verdict(&self, penumbra: &Penumbra) -> Verdict {
        let published = [0, 1].map(|lamp| self.worst(lamp, 0));
        let holds = match (&published, penumbra.is_split()) {
            ([None, None], false) => Holds::Yes,
            ([Some(_), _], _) => Holds::No,
            _ => Holds::Partly,
        };
        let [small, large] =
            published.map(|worst| worst.unwrap_or("no region tells them apart".into()));
        Verdict {
            holds,
            text: format!(
                "As published, with the small lamp {small}; with the large one {large}; and in the penumbra of an edge {}.",
                penumbra.split()
            ),
        }
    }

    /// Why they look alike all the same.
    fn why(&self) -> String {
        format!(
            "What makes the cases look alike is the weight, which takes no notice of how points are drawn. Divided by their densities they \
             agree on the mean and differ in noise: {}.",
            self.noisiest()
        )
    }

    /// Where the true densities tell the cases apart most.
    fn noisiest(&self) -> String {
        let cells = (0..ROOMS.len()).flat_map(|lamp| self.of(lamp, 1));
        let share = |cell: &Cell| cell.noise[0].value / cell.noise[1].value;
        let most = cells.max_by(|a, b| share(a).total_cmp(&share(b)));
        most.map_or(String::new(), |cell| {
            format!(
                "case 1 has up to {} times the noise of case 2 ({}, {})",
                number(share(cell)),
                ROOMS[cell.lamp].1.to_lowercase(),
                cell.region
            )
        })
    }

    pub fn results(&self) -> Vec<String> {
        let mut sentences = vec![self.why()];
        for (lamp, (_, name)) in ROOMS.into_iter().enumerate() {
            for (rules, (_, label)) in RULES.into_iter().enumerate() {
                sentences.push(self.agreement(lamp, rules, name, label));
            }
            sentences.extend(self.noises(lamp, name));
        }
        sentences
    }

    fn agreement(&self, lamp: usize, rules: usize, name: &str, label: &str) -> String {
        let cells: Vec<_> = self.of(lamp, rules).collect();
        let named = |told: Told, which: usize| -> Vec<&str> {
            let fits = cells
                .iter()
                .filter(|cell| self.told(cell.against[which]) == told);
            fits.map(|cell| cell.region.as_str()).collect()
        };
        let part = |told: Told, words: &str| {
            let names = named(told, 0);
            (!names.is_empty()).then(|| format!("{words} in {}", list(&names)))
        };
        let parts: Vec<String> = [
            part(Told::Different, "differ"),
            part(Told::Same, "are the same within 1 %"),
            part(Told::Neither, "cannot be told apart with these samples"),
        ]
        .into_iter()
        .flatten()
        .collect();
        let control = match named(Told::Different, 1).as_slice() {
            [] => "case 3, the control, differs from case 2 nowhere".to_string(),
            names => format!(
                "case 3, the control, differs from case 2 in {}",
                list(names)
            ),
        };
        format!(
            "{name}, {label}: cases 1 and 2 {}; {control}.",
            parts.join(", ")
        )
    }

    /// How much more a case's samples scatter than another's where the lamp lights a floor.
    fn noises(&self, lamp: usize, name: &str) -> Option<String> {
        let cell = |rules: usize| self.of(lamp, rules).find(|cell| cell.region == "lit floor");
        let of = |cell: &Cell| number(cell.noise[0].value / cell.noise[1].value);
        Some(format!(
            "{name}, lit floor: case 1 has {} times the noise of case 2 as published, and {} times when each is divided by its density.",
            of(cell(0)?),
            of(cell(1)?)
        ))
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

/// Relative variance of a group in a region.
pub fn relative_variance(group: &Group, region: usize) -> Quantity {
    let level = mean(group, region);
    let square = Quantity::new(
        level.value * level.value,
        (2.0 * level.value * level.error).powi(2),
        level.freedom,
    );
    ratio(variance(group, region), square)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(value: f64, error: f64) -> Quantity {
        Quantity::new(value, error * error, f64::INFINITY)
    }

    /// As many cells as a whole table has: two lamps, two rules, six regions.
    fn rooms() -> Rooms {
        let nothing = Interval::default();
        let cell = |index: usize| Cell {
            lamp: index / 12,
            rules: index / 6 % 2,
            region: format!("region {}", index % 6),
            bias: [None; 3],
            noise: [nothing; 3],
            against: [of(0.0, 0.001), of(0.0, 0.001)],
        };
        Rooms {
            cells: (0..24).map(cell).collect(),
        }
    }

    #[test]
    fn a_difference_is_told_at_the_level_of_the_whole_table() {
        let rooms = rooms();
        // 5 % over 48 differences: 3.28 standard errors on two sides, 3.08 on one.
        assert_eq!(rooms.told(of(0.033, 0.01)), Told::Different);
        assert_eq!(rooms.told(of(-0.033, 0.01)), Told::Different);
        assert_eq!(rooms.told(of(0.032, 0.01)), Told::Neither);
        assert_eq!(rooms.told(of(0.0, 0.0032)), Told::Same);
        assert_eq!(rooms.told(of(0.0, 0.0034)), Told::Neither);
        // Clearly there, and clearly below the margin: that is the same.
        assert_eq!(rooms.told(of(0.004, 0.001)), Told::Same);
    }

    #[test]
    fn the_largest_difference_that_is_told_is_named() {
        let mut rooms = rooms();
        assert_eq!(rooms.worst(1, 0), None);
        rooms.cells[12].against[0] = of(-0.05, 0.001);
        rooms.cells[13].against[0] = of(0.04, 0.001);
        rooms.cells[14].against[0] = of(0.9, 0.5);
        let worst = rooms.worst(1, 0).unwrap();
        assert!(
            worst.contains("darker") && worst.contains("region 0"),
            "{worst}"
        );
        assert_eq!(rooms.worst(0, 0), None);
        assert_eq!(rooms.worst(1, 1), None);
    }
}
