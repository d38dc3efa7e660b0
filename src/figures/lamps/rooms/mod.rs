//! The room with a small and with a large lamp: bias and noise, region by region.

mod shown;
mod told;

use super::RULES;
use super::penumbra::Penumbra;
use crate::analysis::words::{list, number, percent};
use crate::analysis::{Group, Quantity};
use crate::error::Result;
use crate::figures::build::{map, mean_of};
use crate::figures::data::{CASES, Data, mean, variance};
use crate::figures::figure::{Holds, Verdict};
use crate::pack::Rect;
use crate::report::data::Interval;
use told::{Told, told};

pub use shown::pictures;

const ROOMS: [(&str, &str); 2] = [
    ("fig7-small-lamp", "Small lamp"),
    ("fig7-large-lamp", "Large lamp"),
];
/// Name of the first region.
const WHOLE: &str = "whole picture";

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

pub struct Rooms {
    cells: Vec<Cell>,
}

fn group<'d>(data: &'d Data, room: &str, preset: &str, case: usize) -> Result<&'d Group> {
    let values = [("render.preset", preset), ("light.sampler", CASES[case])];
    data.group(room, &values)
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

/// Standard deviation of one sample over the mean.
fn noise(group: &Group, region: usize) -> Interval {
    let level = mean(group, region);
    map(variance(group, region).interval(), |value| {
        value.max(0.0).sqrt() / level.value
    })
}

impl Rooms {
    pub fn new(data: &Data) -> Result<Self> {
        let mut cells = Vec::new();
        for (lamp, (room, _)) in ROOMS.into_iter().enumerate() {
            for (rules, (preset, _)) in RULES.into_iter().enumerate() {
                let [one, two, three] = [0, 1, 2].map(|case| group(data, room, preset, case));
                let groups = [one?, two?, three?];
                let question = &data.analysis(room)?.question;
                let regions = question.regions().iter().enumerate();
                cells.extend(regions.map(|(index, region)| Cell {
                    lamp,
                    rules,
                    region: region.name.clone(),
                    bias: groups.map(|group| group.regions[index].relative_bias),
                    noise: groups.map(|group| noise(group, index)),
                    against: [0, 2].map(|case| {
                        against(groups[case], groups[1], question.size()[0], region.rect)
                    }),
                }));
            }
        }
        Ok(Self { cells })
    }

    /// What a difference comes to in a table of all of them.
    fn told(&self, difference: Quantity) -> Told {
        told(difference, 2 * self.cells.len())
    }

    fn of(&self, lamp: usize, rules: usize) -> impl Iterator<Item = &Cell> {
        self.cells
            .iter()
            .filter(move |cell| cell.lamp == lamp && cell.rules == rules)
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
            "case 1 is {} {way} than case 2 in the region “{}”",
            percent(sized.interval()),
            worst.region
        ))
    }

    pub fn verdict(&self, penumbra: &Penumbra) -> Verdict {
        let told = [0, 1].map(|lamp| self.worst(lamp, 0));
        let holds = match (&told, penumbra.is_split()) {
            ([None, None], false) => Holds::Yes,
            ([Some(_), _], _) => Holds::No,
            _ => Holds::Partly,
        };
        let [small, large] = [0, 1].map(|lamp| self.seen(lamp));
        Verdict {
            holds,
            text: format!(
                "As published, under the small lamp {small}; under the large one {large}. In the penumbra of an edge, {}.",
                penumbra.split()
            ),
        }
    }

    /// What is seen of a lamp as published.
    fn seen(&self, lamp: usize) -> String {
        let same = |cell: &&Cell| self.told(cell.against[0]) == Told::Same;
        let (all, alike) = (
            self.of(lamp, 0).count(),
            self.of(lamp, 0).filter(same).count(),
        );
        match self.worst(lamp, 0) {
            Some(worst) => worst,
            None if alike == all => "cases 1 and 2 agree within 1 % in every region".into(),
            None => format!(
                "cases 1 and 2 agree within 1 % in {alike} of {all} regions, and differ clearly in none"
            ),
        }
    }

    /// Why they look alike all the same.
    fn why(&self) -> String {
        let cells = || {
            (0..ROOMS.len())
                .flat_map(|lamp| self.of(lamp, 1))
                .filter(|cell| cell.region != WHOLE)
        };
        let share = |cell: &Cell| cell.noise[0].value / cell.noise[1].value;
        let least = cells().map(share).fold(f64::INFINITY, f64::min);
        let most = cells().map(share).fold(0.0, f64::max);
        format!(
            "What makes the cases look alike is the weight, which takes no notice of how points are drawn. Divided by their densities they \
             agree on the mean, and case 1 has {} to {} times the noise of case 2, by region: its pole lies sideways to most of these \
             surfaces. With the pole toward what is lit it has less (the plate below).",
            number(least),
            number(most)
        )
    }

    pub fn results(&self) -> Vec<String> {
        let mut sentences = vec![self.why()];
        for (lamp, (_, name)) in ROOMS.into_iter().enumerate() {
            for (rules, (_, label)) in RULES.into_iter().enumerate() {
                sentences.push(self.agreement(lamp, rules, name, label));
            }
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
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(value: f64, error: f64) -> Quantity {
        Quantity::new(value, error * error, f64::INFINITY)
    }

    /// As many cells as a whole table has: two lamps, two rules, six regions.
    fn rooms() -> Rooms {
        let cell = |index: usize| Cell {
            lamp: index / 12,
            rules: index / 6 % 2,
            region: format!("region {}", index % 6),
            bias: [None; 3],
            noise: [Interval::default(); 3],
            against: [of(0.0, 0.001), of(0.0, 0.001)],
        };
        Rooms {
            cells: (0..24).map(cell).collect(),
        }
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
