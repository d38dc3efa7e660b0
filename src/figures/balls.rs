//! Figure 5: three ways to scatter, and the spread between the two ends.

use super::build::{map, pictures, ratio, shown, squared_distance};
use super::data::Data;
use super::figure::*;
use crate::analysis::words::{number, percent, ranged};
use crate::analysis::{Group, Quantity};
use crate::error::Result;
use std::fmt::Write as _;

const BALLS: &str = "fig5-balls";
const SPREAD: &str = "fig5-spread";
const ENDS: &str = "fig5-ends";
const REGIONS: [&str; 3] = ["matt ball", "directional ball", "mirror ball"];
const PRESETS: [(&str, &str); 2] = [("paper", "as published"), ("corrected", "corrected")];

/// The satin ball with one spread, beside a mirror and a matt ball in its place.
struct Between {
    spread: f64,
    /// Root mean squared distance to each, over that between them.
    mirror: Quantity,
    matt: Quantity,
}

/// # Errors
/// [`crate::Error::Usage`] where runs are missing.
pub fn figure(data: &Data) -> Result<Figure> {
    let between = between(data)?;
    Ok(Figure {
        number: 5,
        title: "Scattering between a matt surface and a mirror".into(),
        claim: "Uniform scattering, directional scattering and mirror reflection on three balls: \
                the directional one is an intermediate between the other two."
            .into(),
        reading: "The angle to the mirror direction is |N(0, spread)| in radians, at most 90 degrees. As published \
                  every surface also gets a matt surface's direct light, and a lamp counts only where the camera sees it; \
                  corrected, directional and mirror surfaces get what they reflect and nothing else."
            .into(),
        verdict: verdict(&between),
        results: results(data, &between)?,
        blocks: vec![
            Block::Pictures(balls(data)?),
            Block::Pictures(strip(data)?),
            Block::Plots(distances(&between)),
        ],
        commands: data.commands(5),
        sweeps: data.pages(5),
        data: vec![csv(&between)],
    })
}

fn balls(data: &Data) -> Result<Pictures> {
    let size = data.analysis(BALLS)?.question.size();
    let mut block = pictures(
        "balls",
        "Matt, directional (spread 0.2) and mirror ball. As published the lamp's reflection is black, and the mirror is \
         lit like chalk besides reflecting.",
        &[""],
    );
    for (preset, label) in PRESETS {
        let group = data.group(BALLS, &[("render.preset", preset)])?;
        block.rows.push(PictureRow {
            label: label.into(),
            cells: vec![shown(group, size, 0.0, String::new())],
        });
    }
    Ok(block)
}

/// Spreads of the runs, narrow to wide.
fn spreads(data: &Data) -> Result<Vec<(f64, &Group)>> {
    let groups = data.analysis(SPREAD)?.groups.iter();
    let spread = |group: &Group| group.values.get("materials.satin.spread")?.as_f64();
    let mut all: Vec<_> = groups
        .filter_map(|group| Some((spread(group)?, group)))
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(all)
}

fn end<'d>(data: &'d Data, scatter: &str) -> Result<&'d Group> {
    data.group(ENDS, &[("materials.satin.scatter", scatter)])
}

/// The middle ball from mirror to matt.
fn strip(data: &Data) -> Result<Pictures> {
    let spreads = spreads(data)?;
    let mut cells = vec![cut(data, end(data, "mirror")?, "mirror".into())?];
    for (spread, group) in spreads.iter().step_by(2) {
        cells.push(cut(data, group, format!("spread {spread}"))?);
    }
    cells.push(cut(data, end(data, "diffuse")?, "matt".into())?);
    let mut block = pictures(
        "spread",
        "The directional ball with growing spread, corrected, between a mirror and a matt ball of the same albedo.",
        &[],
    );
    block.columns = vec![String::new(); cells.len()];
    block.rows.push(PictureRow {
        label: String::new(),
        cells,
    });
    Ok(block)
}

/// The part of a picture around the directional ball.
fn cut(data: &Data, group: &Group, note: String) -> Result<Shown> {
    let [width, _] = data.analysis(SPREAD)?.question.size();
    let rect = data.analysis(SPREAD)?.question.regions()[data.region(SPREAD, REGIONS[1])?].rect;
    let margin = (rect.x1 - rect.x0) / 4;
    let (x0, x1) = (
        rect.x0.saturating_sub(margin),
        (rect.x1 + margin).min(width),
    );
    let rows = rect.y0.saturating_sub(margin)..rect.y1 + margin;
    let pixels: Vec<_> = rows
        .clone()
        .flat_map(|y| (x0..x1).map(move |x| (y * width + x) as usize))
        .filter_map(|pixel| group.maps.mean.get(pixel).copied())
        .collect();
    let height = pixels.len() as u32 / (x1 - x0);
    Ok(super::build::picture(&pixels, [x1 - x0, height], 0.0, note))
}

fn between(data: &Data) -> Result<Vec<Between>> {
    let question = &data.analysis(SPREAD)?.question;
    let rect = question.regions()[data.region(SPREAD, REGIONS[1])?].rect;
    let width = question.size()[0];
    let (mirror, matt) = (end(data, "mirror")?, end(data, "diffuse")?);
    let whole = squared_distance(mirror, matt, width, rect);
    let to = |group: &Group, end: &Group| ratio(squared_distance(group, end, width, rect), whole);
    let each = spreads(data)?.into_iter().map(|(spread, group)| Between {
        spread,
        mirror: to(group, mirror),
        matt: to(group, matt),
    });
    Ok(each.collect())
}

/// Root of an estimate of a square, which may be below 0.
fn root(square: Quantity) -> crate::report::data::Interval {
    map(square.interval(), |value| value.max(0.0).sqrt())
}

fn distances(between: &[Between]) -> Plots {
    let series = |name: &str, colour, of: fn(&Between) -> Quantity| Series {
        name: name.into(),
        look: Look::Measured,
        colour,
        points: between
            .iter()
            .map(|one| Point::within(one.spread, root(of(one))))
            .collect(),
    };
    let lines = Lines {
        title: "How far the directional ball is from both ends".into(),
        x: Scale {
            label: "spread, radians".into(),
            logarithmic: true,
            ..Scale::default()
        },
        y: Scale {
            label: "distance, mirror to matt = 1".into(),
            low: Some(0.0),
            ..Scale::default()
        },
        series: vec![
            series("to the mirror ball", 0, |one| one.mirror),
            series("to the matt ball", 1, |one| one.matt),
        ],
        marks: Vec::new(),
    };
    Plots {
        name: "distance".into(),
        caption: "Root mean squared distance of the ball's expected picture to that of a mirror and of a matt ball in its \
                  place, noise taken away; 95 % intervals."
            .into(),
        plots: vec![Plot::Lines(lines)],
    }
}

/// Between: clearly away from both ends, and nearer to each than they are to each other.
fn is_between(one: &Between) -> bool {
    [one.mirror, one.matt]
        .into_iter()
        .map(root)
        .all(|distance| distance.low > 0.0 && distance.value < 1.0)
}

fn verdict(between: &[Between]) -> Verdict {
    let inside: Vec<f64> = between
        .iter()
        .filter(|one| is_between(one))
        .map(|one| one.spread)
        .collect();
    let (Some(first), Some(last), Some(widest)) = (inside.first(), inside.last(), between.last())
    else {
        return Verdict {
            holds: Holds::No,
            text: "No spread gives a ball that is clearly away from both ends and nearer to each than they are to each other.".into(),
        };
    };
    let left = root(widest.matt);
    let end = match left.low > 0.0 {
        true => format!(
            "however wide, it does not become matt: at {} radians {} of the way is left",
            widest.spread,
            ranged(left)
        ),
        false => format!("at {} it cannot be told from a matt ball", widest.spread),
    };
    Verdict {
        holds: Holds::Yes,
        text: format!(
            "It is between the two for spreads from {first} to {last} radians. Narrower ones cannot be told from a mirror with these samples; {end}."
        ),
    }
}

fn results(data: &Data, between: &[Between]) -> Result<Vec<String>> {
    let mut sentences = Vec::new();
    for (preset, label) in PRESETS {
        let group = data.group(BALLS, &[("render.preset", preset)])?;
        for name in REGIONS {
            let figures = &group.regions[data.region(BALLS, name)?];
            let Some(bias) = figures.relative_bias else {
                continue;
            };
            let level = Quantity::over(&figures.mean).value;
            let apart = map(figures.energy.bias_squared().interval(), |square| {
                square.max(0.0).sqrt() / level
            });
            sentences.push(match apart.low > 0.0 {
                true => format!(
                    "The {name}, {label}: its pixels are {} off the truth (root mean square), its mean {}.",
                    percent(apart),
                    percent(bias.interval())
                ),
                false => format!(
                    "The {name}, {label}: no bias is seen, neither in its pixels nor in its mean, {}.",
                    percent(bias.interval())
                ),
            });
        }
    }
    if let Some(narrow) = between.first() {
        let reach = root(narrow.mirror);
        let apart = match reach.low > 0.0 {
            true => format!(
                "is {} of the way from the mirror to the matt ball",
                ranged(reach)
            ),
            false => format!(
                "cannot be told from the mirror: at most {} of the way to the matt ball",
                number(reach.high)
            ),
        };
        sentences.push(format!(
            "With a spread of {} radians the ball {apart}.",
            narrow.spread
        ));
    }
    Ok(sentences)
}

fn csv(between: &[Between]) -> DataFile {
    let mut csv = String::from(
        "spread,to_mirror,to_mirror_low,to_mirror_high,to_matt,to_matt_low,to_matt_high\n",
    );
    for one in between {
        let [a, b] = [one.mirror, one.matt].map(root);
        // Writing into a string cannot fail.
        let _ = writeln!(
            csv,
            "{},{},{},{},{},{},{}",
            one.spread, a.value, a.low, a.high, b.value, b.low, b.high
        );
    }
    DataFile {
        name: "fig5-distance.csv".into(),
        csv,
    }
}
