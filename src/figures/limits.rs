//! Figure 9: pictures with limits on reflections, and the light that each adds.

use super::build::{chance, pictures, ratio, shown};
use super::data::{Data, mean};
use super::figure::*;
use super::study::{THRESHOLD, UNLIMITED};
use crate::analysis::words::{number, percent, ranged};
use crate::analysis::{Group, Quantity};
use crate::error::Result;
use crate::report::data::Interval;
use crate::theory::{chi_square_above, energy_share};
use std::fmt::Write as _;

const ROOM: &str = "fig9-room";
const SPHERE: &str = "fig9-sphere";
const RULES: [(&str, &str); 2] = [("paper", "as published"), ("corrected", "corrected")];
const LIMITS: [u32; 6] = [1, 2, 3, 4, 8, UNLIMITED];
/// Of the sphere: albedo of its wall, and the share of the wall's light that its lamp takes away.
const ALBEDO: f64 = 0.8;
const TAKEN: f64 = 0.0625;

/// Share of all light that a limit leaves.
struct Level {
    limit: u32,
    share: Quantity,
    predicted: Option<f64>,
}

fn group<'d>(data: &'d Data, study: &str, preset: &str, limit: u32) -> Result<&'d Group> {
    let text = limit.to_string();
    data.group(
        study,
        &[("render.preset", preset), ("render.max_bounces", &text)],
    )
}

/// What a hit of the sphere's wall passes on to the next.
fn kept(rules: usize) -> f64 {
    let threshold = if rules == 0 { THRESHOLD } else { 1.0 };
    ALBEDO * (1.0 - TAKEN) * threshold
}

fn levels(data: &Data, study: &str, rules: usize, region: usize) -> Result<Vec<Level>> {
    let preset = RULES[rules].0;
    let all = mean(group(data, study, preset, UNLIMITED)?, region);
    let level = |limit: u32| {
        Ok(Level {
            limit,
            share: ratio(mean(group(data, study, preset, limit)?, region), all),
            predicted: (study == SPHERE).then(|| energy_share(kept(rules), limit)),
        })
    };
    LIMITS
        .into_iter()
        .filter(|limit| *limit != UNLIMITED)
        .map(level)
        .collect()
}

/// # Errors
/// [`crate::Error::Usage`] where runs are missing.
pub fn figure(data: &Data) -> Result<Figure> {
    let spheres = [levels(data, SPHERE, 0, 0)?, levels(data, SPHERE, 1, 0)?];
    Ok(Figure {
        number: 9,
        title: "Pictures with limits on reflections".into(),
        claim: "With limit 1 places hidden from the lamp have no light; with limit 2 they have light reflected once; mirror and \
                directional balls show what they reflect only from there on."
            .into(),
        reading: format!(
            "The limit is the number of surfaces that a path may meet, each with its direct light: limit 1 is direct light alone. Beside \
             the room, a hollow ball whose light can be summed by hand: of what its wall reflects, a share of rho (1 - q^2) is reflected \
             again, times the threshold t = {THRESHOLD} where survivors are not divided by it, as published."
        ),
        verdict: verdict(data)?,
        results: results(data, &spheres)?,
        blocks: vec![
            Block::Pictures(rooms(data)?),
            Block::Plots(plots(data, &spheres)?),
            Block::Table(table(&spheres)),
        ],
        commands: data.commands(9),
        data: vec![csv(data, &spheres)?],
    })
}

fn rooms(data: &Data) -> Result<Pictures> {
    let size = data.analysis(ROOM)?.question.size();
    let columns = LIMITS.map(|limit| match limit {
        UNLIMITED => "no limit".to_string(),
        limit => format!("limit {limit}"),
    });
    let mut block = pictures(
        "rooms",
        "As published the mirror ball is lit like chalk from limit 1 on, and the lamp's reflection stays black; corrected, with limit 1 \
         a mirror shows the lamp and nothing else.",
        &columns.each_ref().map(String::as_str),
    );
    for (preset, label) in RULES {
        let cell = |limit: u32| {
            Ok(shown(
                group(data, ROOM, preset, limit)?,
                size,
                0.0,
                String::new(),
            ))
        };
        block.rows.push(PictureRow {
            label: label.into(),
            cells: LIMITS.into_iter().map(cell).collect::<Result<_>>()?,
        });
    }
    Ok(block)
}

fn plots(data: &Data, spheres: &[Vec<Level>; 2]) -> Result<Plots> {
    let measured = |levels: &[Level], name: &str, colour: usize| Series {
        name: name.into(),
        look: Look::Measured,
        colour,
        points: levels
            .iter()
            .map(|level| Point::within(f64::from(level.limit), level.share.interval()))
            .collect(),
    };
    let lines = |title: &str, series: Vec<Series>| {
        Plot::Lines(Lines {
            title: title.into(),
            x: Scale {
                label: "limit".into(),
                ..Scale::default()
            },
            y: Scale {
                label: "share of all light".into(),
                low: Some(0.0),
                high: Some(1.0),
                ..Scale::default()
            },
            series,
            marks: Vec::new(),
        })
    };
    let mut sphere = Vec::new();
    for (rules, levels) in spheres.iter().enumerate() {
        sphere.push(Series {
            look: Look::Dots,
            ..measured(levels, RULES[rules].1, rules)
        });
        sphere.push(Series {
            name: String::new(),
            look: Look::Predicted,
            colour: rules,
            points: (1..=8)
                .map(|limit| Point::exact(f64::from(limit), energy_share(kept(rules), limit)))
                .collect(),
        });
    }
    let mut room = Vec::new();
    for (colour, region) in data.analysis(ROOM)?.question.regions().iter().enumerate() {
        room.push(measured(
            &levels(data, ROOM, 1, colour)?,
            &region.name,
            colour,
        ));
    }
    Ok(Plots {
        name: "energy".into(),
        caption: "Share of the light that is there with each limit: in the hollow ball, dashed its closed form, and in the room by region."
            .into(),
        plots: vec![lines("Hollow ball", sphere), lines("Room, corrected", room)],
    })
}

fn table(spheres: &[Vec<Level>; 2]) -> Table {
    let row = |(published, corrected): (&Level, &Level)| {
        let cells = [published, corrected].map(|level| {
            let predicted = level.predicted.unwrap_or(f64::NAN);
            [
                percent(level.share.interval()),
                format!("{:.2} %", 100.0 * predicted),
            ]
        });
        let [[a, b], [c, d]] = cells;
        vec![published.limit.to_string(), a, b, c, d]
    };
    let head = ["limit", "as published", "theory", "corrected", "theory"];
    Table {
        caption: "Hollow ball: share of the reflected light that each limit leaves.".into(),
        head: head.map(String::from).to_vec(),
        rows: spheres[0].iter().zip(&spheres[1]).map(row).collect(),
    }
}

fn in_room(data: &Data, preset: &str, limit: u32, region: &str) -> Result<Quantity> {
    Ok(mean(
        group(data, ROOM, preset, limit)?,
        data.region(ROOM, region)?,
    ))
}

fn verdict(data: &Data) -> Result<Verdict> {
    let shadow = in_room(data, "paper", 1, "shadow")?;
    let second = in_room(data, "paper", 2, "shadow")?;
    let all = in_room(data, "paper", UNLIMITED, "shadow")?;
    let wall = in_room(data, "paper", 1, "back wall")?;
    let dark = shadow.interval().high < 0.01 * wall.value;
    let lit = second.is_above_zero();
    let mirror = ratio(
        in_room(data, "paper", 1, "mirror ball")?,
        in_room(data, "corrected", UNLIMITED, "mirror ball")?,
    );
    Ok(Verdict {
        holds: match (dark, lit) {
            (true, true) => Holds::Yes,
            (true, false) | (false, true) => Holds::Partly,
            (false, false) => Holds::No,
        },
        text: format!(
            "With limit 1 the shadow has {} of the lit wall's light, with limit 2 {} of what it has in the end. What the mirror ball shows \
             with limit 1, {} of its true light, is the chalk that the published rules make of it.",
            percent(ratio(shadow, wall).interval()),
            percent(ratio(second, all).interval()),
            percent(mirror.interval())
        ),
    })
}

fn results(data: &Data, spheres: &[Vec<Level>; 2]) -> Result<Vec<String>> {
    let levels = || spheres.iter().flatten();
    let z = |level: &Level| {
        let predicted = level.predicted.unwrap_or(f64::NAN);
        (level.share.value - predicted) / level.share.error.max(f64::MIN_POSITIVE)
    };
    let square: f64 = levels().map(|level| z(level).powi(2)).sum();
    let count = levels().count();
    let full = |rules: usize| -> Result<Interval> {
        let [ours, truth] = [RULES[rules].0, "corrected"];
        let all = ratio(
            mean(group(data, SPHERE, ours, UNLIMITED)?, 0),
            mean(group(data, SPHERE, truth, UNLIMITED)?, 0),
        );
        Ok(all.interval())
    };
    let room = ratio(
        mean(group(data, ROOM, "corrected", 4)?, 0),
        mean(group(data, ROOM, "corrected", UNLIMITED)?, 0),
    );
    Ok(vec![
        format!(
            "Hollow ball: {count} shares against 1 - k^N, with k = {} as published and {} corrected: chi-square {} (p = {}).",
            number(kept(0)),
            number(kept(1)),
            number(square),
            chance(chi_square_above(square, count as f64))
        ),
        format!(
            "Not dividing survivors by the threshold costs light: without a limit the hollow ball has {} times its true radiance as \
             published.",
            ranged(full(0)?)
        ),
        format!(
            "In the room, limit 4 has {} of all light, corrected.",
            percent(room.interval())
        ),
    ])
}

fn csv(data: &Data, spheres: &[Vec<Level>; 2]) -> Result<DataFile> {
    let mut csv = String::from("scene,rules,region,limit,share,low,high,predicted\n");
    let mut add = |scene: &str, rules: usize, region: &str, levels: &[Level]| {
        for level in levels {
            let interval = level.share.interval();
            let predicted = level
                .predicted
                .map_or(String::new(), |share| share.to_string());
            // Writing into a string cannot fail.
            let _ = writeln!(
                csv,
                "{scene},{},{region},{},{},{},{},{predicted}",
                RULES[rules].1, level.limit, interval.value, interval.low, interval.high
            );
        }
    };
    for (rules, levels) in spheres.iter().enumerate() {
        add("hollow ball", rules, "whole picture", levels);
    }
    let regions = data.analysis(ROOM)?.question.regions().to_vec();
    for rules in 0..RULES.len() {
        for (index, region) in regions.iter().enumerate() {
            add(
                "room",
                rules,
                &region.name,
                &levels(data, ROOM, rules, index)?,
            );
        }
    }
    Ok(DataFile {
        name: "fig9-energy.csv".into(),
        csv,
    })
}
