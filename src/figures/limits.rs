//! Figure 9: pictures with limits on reflections, and the light that each adds.

use super::build::{chance, furthest, paired_ratio, pictures, ratio, shown};
use super::data::{Data, mean};
use super::figure::*;
use super::study::{THRESHOLD, UNLIMITED};
use crate::analysis::words::{number, percent, ranged};
use crate::analysis::{Group, Quantity};
use crate::error::Result;
use crate::pack::Rect;
use crate::theory::energy_share;
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
    let question = &data.analysis(study)?.question;
    let (width, rect) = (question.size()[0], question.regions()[region].rect);
    let all = group(data, study, preset, UNLIMITED)?;
    let level = |limit: u32| {
        Ok(Level {
            limit,
            share: share(group(data, study, preset, limit)?, all, width, rect, region),
            predicted: (study == SPHERE).then(|| energy_share(kept(rules), limit)),
        })
    };
    let limits = LIMITS.into_iter().filter(|limit| *limit != UNLIMITED);
    limits.map(level).collect()
}

/// Both errors are too large, one by what regions hold of different shares, one by what runs of equal seeds
/// share: the smaller is the better one. Where there is no light at all there is no share.
fn share(part: &Group, all: &Group, width: u32, rect: Rect, region: usize) -> Quantity {
    let paired = paired_ratio(part, all, width, rect);
    let apart = ratio(mean(part, region), mean(all, region));
    match (paired.value.is_finite(), paired.error < apart.error) {
        (false, _) => Quantity::exact(0.0),
        (true, true) => paired,
        (true, false) => Quantity {
            value: paired.value,
            ..apart
        },
    }
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
            "The limit is the number of surfaces that a path may meet, each with its direct light: limit 1 is direct light alone. The room is \
             open to the front, and dark there: the lamp is its only light. Beside it, a hollow ball of albedo rho around a lamp of a quarter of \
             its radius, whose light can be summed by hand: of what its wall reflects, the lamp takes 1/16 away and k = (1 - 1/16) rho is \
             reflected again, times the threshold t = {THRESHOLD} where survivors are not divided by it, as published. No limit is {UNLIMITED}."
        ),
        verdict: verdict(data)?,
        results: results(data, &spheres)?,
        blocks: vec![
            Block::Pictures(rooms(data)?),
            Block::Plots(plots(data, &spheres)?),
            Block::Table(table(&spheres)),
        ],
        commands: data.commands(9),
        sweeps: data.pages(9),
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
    let room = |rules: usize| -> Result<Vec<Series>> {
        let regions = data.analysis(ROOM)?.question.regions().iter().enumerate();
        let series = |(colour, region): (usize, &crate::analysis::Region)| {
            let levels = levels(data, ROOM, rules, colour)?;
            Ok(measured(&levels, &region.name, colour))
        };
        regions.map(series).collect()
    };
    Ok(Plots {
        name: "energy".into(),
        caption: "Share of the light that is there with each limit: in the hollow ball, dashed its closed form, and in the room by region."
            .into(),
        plots: vec![
            lines("Hollow ball", sphere),
            lines("Room, as published", room(0)?),
            lines("Room, corrected", room(1)?),
        ],
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
    let region = data.region(ROOM, region)?;
    Ok(mean(group(data, ROOM, preset, limit)?, region))
}

fn verdict(data: &Data) -> Result<Verdict> {
    let shadow = in_room(data, "paper", 1, "shadow")?;
    let wall = in_room(data, "paper", 1, "back wall")?;
    let of = |preset: &str| ratio_of_limits(data, preset, "shadow", 2);
    let (published, corrected) = (of("paper")?, of("corrected")?);
    let mirror = ratio(
        in_room(data, "paper", 1, "mirror ball")?,
        in_room(data, "paper", UNLIMITED, "mirror ball")?,
    );
    let true_mirror = ratio_of_limits(data, "corrected", "mirror ball", 1)?;
    let dark = shadow.interval().high < 0.01 * wall.value;
    let lit = published.is_above_zero();
    let how_dark = match shadow.value == 0.0 {
        true => "black (not one sample found light)".to_string(),
        false => format!(
            "{} of the back wall's light",
            percent(ratio(shadow, wall).interval())
        ),
    };
    Ok(Verdict {
        holds: match (dark, lit) {
            (true, true) => Holds::Yes,
            (true, false) | (false, true) => Holds::Partly,
            (false, false) => Holds::No,
        },
        text: format!(
            "The shadow of the mirror ball is {how_dark} with limit 1; limit 2 brings {} of the light that it has in the end as published, {} \
             corrected. The mirror ball has {} of its light with limit 1 as published, for it is lit like chalk; corrected, {}: what it shows then \
             is the lamp.",
            percent(published.interval()),
            percent(corrected.interval()),
            percent(mirror.interval()),
            percent(true_mirror.interval())
        ),
    })
}

/// Share of a region's light that is there with a limit.
fn ratio_of_limits(data: &Data, preset: &str, region: &str, limit: u32) -> Result<Quantity> {
    let question = &data.analysis(ROOM)?.question;
    let region = data.region(ROOM, region)?;
    let rect = question.regions()[region].rect;
    let part = group(data, ROOM, preset, limit)?;
    let all = group(data, ROOM, preset, UNLIMITED)?;
    Ok(share(part, all, question.size()[0], rect, region))
}

fn results(data: &Data, spheres: &[Vec<Level>; 2]) -> Result<Vec<String>> {
    let z = |level: &Level| {
        let predicted = level.predicted.unwrap_or(f64::NAN);
        (level.share.value - predicted) / level.share.error.max(f64::MIN_POSITIVE)
    };
    let (worst, p) = furthest(spheres.iter().flatten().map(z));
    let at = |preset: &str, limit: u32| -> Result<Quantity> {
        Ok(mean(group(data, SPHERE, preset, limit)?, 0))
    };
    let in_the_end = ratio(at("paper", UNLIMITED)?, at("corrected", UNLIMITED)?);
    let direct = ratio(at("paper", 1)?, at("corrected", 1)?);
    let threshold = ratio(in_the_end, direct);
    let expected = (1.0 - kept(1)) / (1.0 - kept(0));
    let room = ratio_of_limits(data, "corrected", "whole picture", 4)?;
    Ok(vec![
        format!(
            "Hollow ball: {} shares against 1 - k^N, with k = {} as published and {} corrected: the furthest is {} standard errors off \
             (p = {} for so many).",
            spheres.iter().flatten().count(),
            number(kept(0)),
            number(kept(1)),
            number(worst),
            chance(p)
        ),
        format!(
            "Without a limit the hollow ball has {} times its true radiance as published. Not dividing survivors by the threshold makes {} of \
             that (theory {}), the weight of the lamp's points {}.",
            ranged(in_the_end.interval()),
            ranged(threshold.interval()),
            number(expected),
            ranged(direct.interval())
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
