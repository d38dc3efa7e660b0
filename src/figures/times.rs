//! Figure 8: run time against the limit on reflections.

use super::build::{Line, difference, median_of, ratio};
use super::data::Data;
use super::figure::*;
use super::study::THRESHOLD;
use crate::analysis::Quantity;
use crate::analysis::words::{number, ranged};
use crate::error::Result;
use crate::theory::hits;
use std::fmt::Write as _;

/// A study, what it is called, and the share of paths that go on from a hit.
const STUDIES: [(&str, &str, f64); 2] = [
    ("fig8-limit", "limit alone", 1.0),
    ("fig8-threshold", "limit and threshold 0.75", THRESHOLD),
];
const RULES: [(&str, &str); 2] = [("paper", "as published"), ("corrected", "corrected")];
const LIMITS: u32 = 10;
/// A curve whose later half rises less than this share of its earlier half is no line.
const NEARLY: f64 = 0.8;

/// Run time of one kind of paths at every limit.
struct Curve {
    study: usize,
    rules: usize,
    steps: Vec<Step>,
    /// Time through the limit, through the mean number of hits, and through the rays.
    by_limit: Line,
    by_hits: Line,
    by_rays: Line,
}

struct Step {
    limit: u32,
    /// Tracing time of a run, median of the repeats.
    seconds: Quantity,
    rays: f64,
    hits: f64,
}

impl Curve {
    fn new(data: &Data, study: usize, rules: usize) -> Result<Self> {
        let (name, _, survival) = STUDIES[study];
        let step = |limit: u32| {
            let text = limit.to_string();
            let values = [
                ("render.preset", RULES[rules].0),
                ("render.max_bounces", text.as_str()),
            ];
            Ok(Step {
                limit,
                seconds: median_of(&data.times(name, &values)?),
                rays: data.sum(name, &values, "rays")? / data.sum(name, &values, "paths")?.max(1.0),
                hits: hits(survival, limit),
            })
        };
        let steps: Vec<Step> = (1..=LIMITS).map(step).collect::<Result<_>>()?;
        let line = |x: fn(&Step) -> f64| {
            let points: Vec<_> = steps
                .iter()
                .map(|step| [x(step), step.seconds.value])
                .collect();
            Line::through(&points)
        };
        Ok(Self {
            by_limit: line(|step| f64::from(step.limit)),
            by_hits: line(|step| step.hits),
            by_rays: line(|step| step.rays),
            study,
            rules,
            steps,
        })
    }

    fn name(&self) -> String {
        format!("{}, {}", STUDIES[self.study].1, RULES[self.rules].1)
    }

    /// Time at the last limit over that at the first.
    fn growth(&self) -> Quantity {
        ratio(
            self.steps[self.steps.len() - 1].seconds,
            self.steps[0].seconds,
        )
    }

    /// What the last four limits add over what the first four add: 1 for a line.
    fn straightness(&self) -> Quantity {
        let at = |limit: usize| self.steps[limit - 1].seconds;
        ratio(difference(at(10), at(6)), difference(at(5), at(1)))
    }

    /// The same of the rays, which are counted, not timed.
    fn straightness_of_rays(&self) -> f64 {
        let at = |limit: usize| self.steps[limit - 1].rays;
        (at(10) - at(6)) / (at(5) - at(1))
    }

    /// The same of the mean number of hits.
    fn expected_straightness(&self) -> f64 {
        let at = |limit: usize| self.steps[limit - 1].hits;
        (at(10) - at(6)) / (at(5) - at(1))
    }

    fn points(&self, y: impl Fn(&Step) -> Point) -> Vec<Point> {
        self.steps.iter().map(y).collect()
    }
}

/// # Errors
/// [`crate::Error::Usage`] where runs are missing.
pub fn figure(data: &Data) -> Result<Figure> {
    let mut curves = Vec::new();
    for study in 0..STUDIES.len() {
        for rules in 0..RULES.len() {
            curves.push(Curve::new(data, study, rules)?);
        }
    }
    Ok(Figure {
        number: 8,
        title: "Run time against the limit on reflections".into(),
        claim: "Run time grows almost in proportion to the interruption limit.".into(),
        reading: format!(
            "A closed room, so that no path is lost; the limit is the number of surfaces that a path may meet. The paper sets a \
             threshold t for each object besides; both are measured, without a threshold and with t = {THRESHOLD} everywhere. If each hit is \
             followed by another with probability q, here t, a path makes (1 - q^N) / (1 - q) hits on average. Times are of tracing alone, on {}.",
            data.device(8)
        ),
        verdict: verdict(&curves),
        results: results(&curves),
        blocks: vec![Block::Plots(plots(&curves)), Block::Table(table(&curves))],
        commands: data.commands(8),
        sweeps: data.pages(8),
        data: vec![csv(&curves)],
    })
}

fn plots(curves: &[Curve]) -> Plots {
    let limit = || Scale {
        label: "limit".into(),
        ..Scale::default()
    };
    let times = |rules: usize| {
        let mine = || curves.iter().filter(move |curve| curve.rules == rules);
        let x = |step: &Step| f64::from(step.limit);
        let measured = mine().map(|curve| Series {
            name: STUDIES[curve.study].1.into(),
            look: Look::Dots,
            colour: curve.study,
            points: curve.points(|step| Point::within(x(step), step.seconds.interval())),
        });
        let predicted = mine().map(|curve| Series {
            name: String::new(),
            look: Look::Predicted,
            colour: curve.study,
            points: curve.points(|step| Point::exact(x(step), curve.by_hits.at(step.hits))),
        });
        Plot::Lines(Lines {
            title: format!("Run time, {}", RULES[rules].1),
            x: limit(),
            y: Scale {
                label: "seconds".into(),
                low: Some(0.0),
                ..Scale::default()
            },
            series: measured.chain(predicted).collect(),
            marks: Vec::new(),
        })
    };
    let rays = Lines {
        title: "Rays a path".into(),
        x: limit(),
        y: Scale {
            label: "rays a path".into(),
            low: Some(0.0),
            ..Scale::default()
        },
        series: curves
            .iter()
            .enumerate()
            .map(|(colour, curve)| Series {
                name: curve.name(),
                look: Look::Measured,
                colour,
                points: curve.points(|step| Point::exact(f64::from(step.limit), step.rays)),
            })
            .collect(),
        marks: Vec::new(),
    };
    Plots {
        name: "time".into(),
        caption: "Median tracing time of a run over interleaved repeats; its 95 % interval is made of their median distance from it. Dashed, a fit in proportion to \
                  (1 - q^N) / (1 - q) plus a constant."
            .into(),
        plots: vec![times(0), times(1), Plot::Lines(rays)],
    }
}

fn table(curves: &[Curve]) -> Table {
    let row = |curve: &Curve| {
        let share = |line: Line| format!("{:.1} %", 100.0 * line.explained);
        vec![
            curve.name(),
            format!("{:.1}", 1e3 * curve.steps[0].seconds.value),
            steadily_many(curve.growth()),
            number(curve.steps[curve.steps.len() - 1].hits),
            share(curve.by_limit),
            share(curve.by_hits),
            share(curve.by_rays),
        ]
    };
    let head = [
        "paths",
        "ms at limit 1",
        "time at limit 10 over limit 1",
        "hits at limit 10 over limit 1",
        "explained by the limit",
        "by (1 - q^N) / (1 - q)",
        "by rays",
    ];
    Table {
        caption: "Share of the variance of the ten times that a straight line explains.".into(),
        head: head.map(String::from).to_vec(),
        rows: curves.iter().map(row).collect(),
    }
}

fn find(curves: &[Curve], study: usize, rules: usize) -> &Curve {
    &curves[study * RULES.len() + rules]
}

/// Rays say it the same way on every machine; times say how far rays are what costs.
fn verdict(curves: &[Curve]) -> Verdict {
    let (alone, with) = (find(curves, 0, 0), find(curves, 1, 0));
    let straight = |curve: &Curve| curve.straightness_of_rays() > NEARLY;
    let holds = match (straight(alone), straight(with)) {
        (true, true) => Holds::Yes,
        (true, false) => Holds::Partly,
        (false, _) => Holds::No,
    };
    let words = |curve: &Curve| {
        let seen = match straight(curve) {
            true => "the cost is nearly a line",
            false => "it levels off",
        };
        format!(
            "{seen}: counted in rays, limits 7 to 10 add {} times what limits 2 to 5 add (hits: {}), in time {}",
            number(curve.straightness_of_rays()),
            number(curve.expected_straightness()),
            steadily(curve.straightness())
        )
    };
    Verdict {
        holds,
        text: format!(
            "As published, with the limit alone {}. With thresholds, as the paper has them (t = {THRESHOLD}), {}.",
            words(alone),
            words(with)
        ),
    }
}

/// A number of times that may be too unsteady to be worth a number.
fn steadily(value: Quantity) -> String {
    let interval = value.interval();
    match interval.high - interval.low < 1.0 {
        true => ranged(interval),
        false => "too unsteady on this machine to tell".into(),
    }
}

fn results(curves: &[Curve]) -> Vec<String> {
    let sentence = |curve: &Curve| {
        let explained = [curve.by_hits, curve.by_rays, curve.by_limit];
        let [hits, rays, limit] = explained.map(|line| format!("{:.0} %", 100.0 * line.explained));
        format!(
            "{}: a straight line through rays explains {rays} of the differences in run time, through hits {hits}, through the limit {limit}; \
             limit 10 takes {} times as long as limit 1.",
            capital(&curve.name()),
            steadily_many(curve.growth())
        )
    };
    curves.iter().map(sentence).collect()
}

/// The same where numbers are well above 1.
fn steadily_many(value: Quantity) -> String {
    let interval = value.interval();
    match interval.high - interval.low < 0.5 * interval.value {
        true => ranged(interval),
        false => format!("about {:.0}", interval.value),
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

fn csv(curves: &[Curve]) -> DataFile {
    let mut csv = String::from("paths,limit,seconds,low,high,rays_a_path,expected_hits\n");
    for curve in curves {
        for step in &curve.steps {
            let interval = step.seconds.interval();
            // Writing into a string cannot fail.
            let _ = writeln!(
                csv,
                "\"{}\",{},{},{},{},{},{}",
                curve.name(),
                step.limit,
                interval.value,
                interval.low,
                interval.high,
                step.rays,
                step.hits
            );
        }
    }
    DataFile {
        name: "fig8-time.csv".into(),
        csv,
    }
}
