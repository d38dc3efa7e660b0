//! y against x.

use super::Drawn;
use super::axis::{Axis, Room};
use super::canvas::{Anchor, Canvas, Frame, TEXT, Text};
use super::frame::{self, HEIGHT};
use super::labels::{Placed, along_levels, spread};
use super::legend::{Entry, Key, head};
use super::measure::text_width;
use super::style::colour;
use super::ticks::{Tick, ticks};
use super::trace::Field;
use crate::figures::{Lines, Look, Scale, Series};

const WIDTH: f64 = 464.0;
/// Names beside line ends may take this much of it.
const MOST_BESIDE: f64 = 132.0;
/// So far may such a name be from its line's height, and its line's end from the frame.
const MOST_MOVED: f64 = 26.0;
const MOST_SHORT: f64 = 0.05;
/// More lines than this are told apart in a legend.
const MOST_NAMED: usize = 6;

/// Where names go.
#[derive(Clone, Copy)]
struct Plan {
    /// Names of series beside the ends of their lines, else in a legend.
    beside: bool,
    /// Names of levels along them, else in a legend.
    along: bool,
}

/// A plan that was found to work.
struct Layout {
    field: Field,
    ticks: Vec<Tick>,
    beside: Vec<Beside>,
    along: Vec<Placed>,
}

/// A name at the end of its line.
struct Beside {
    series: usize,
    end: [f64; 2],
    y: f64,
}

/// The first plan that works; the last one always does.
pub(super) fn draw(plot: &Lines) -> Drawn {
    let flags = [(true, true), (false, true), (true, false), (false, false)];
    for (beside, along) in flags {
        let plan = Plan { beside, along };
        let mut canvas = Canvas::default();
        let entries = entries(plot, plan);
        let top = head(&mut canvas, &plot.title, &entries, WIDTH);
        let top = frame::upright_name(&mut canvas, &plot.y.label, WIDTH, top);
        if let Some(layout) = lay_out(plot, plan, top) {
            let height = fill(&mut canvas, plot, &layout);
            return Drawn::new(canvas, WIDTH, height);
        }
    }
    unreachable!("names in a legend need no place in the plot")
}

fn entries(plot: &Lines, plan: Plan) -> Vec<Entry<'_>> {
    let mut entries = Vec::new();
    if !plan.beside {
        entries.extend(named(plot).map(|(_, series)| Entry {
            key: match series.look {
                Look::Measured => Key::Joined(series.colour),
                Look::Dots => Key::Dots(series.colour),
                Look::Band => Key::Band(series.colour),
                Look::Predicted => Key::Dashes(series.colour),
            },
            name: &series.name,
        }));
    }
    if !plan.along {
        entries.extend(plot.marks.iter().map(|mark| Entry {
            key: Key::Level,
            name: &mark.name,
        }));
    }
    entries
}

fn named(plot: &Lines) -> impl Iterator<Item = (usize, &Series)> {
    let series = plot.series.iter().enumerate();
    series.filter(|(_, series)| !series.name.trim().is_empty())
}

fn lay_out(plot: &Lines, plan: Plan, top: f64) -> Option<Layout> {
    let points = || plot.series.iter().flat_map(|series| &series.points);
    let x = Axis::of(&plot.x, points().map(|point| point.x), Room::Tight);
    let y = Axis::of(&plot.y, heights(plot).into_iter(), Room::Round);
    let bottom = top + HEIGHT;
    let y = y.between(bottom, top);
    let ticks = ticks(&y, 6);
    let frame = Frame {
        left: frame::margin(&ticks),
        top,
        right: WIDTH - room_beside(plot, plan)?,
        bottom,
    };
    let x = x.between(frame.left, frame.right);
    let field = Field { x, y, frame };
    let beside = if plan.beside {
        beside(plot, &field)?
    } else {
        Vec::new()
    };
    let levels = frame::levels(&plot.marks, &field.y);
    let along = if plan.along {
        let data: Vec<[f64; 2]> = plot
            .series
            .iter()
            .flat_map(|each| field.filled(each))
            .collect();
        along_levels(&levels, &frame, &data)?
    } else {
        Vec::new()
    };
    Some(Layout {
        field,
        ticks,
        beside,
        along,
    })
}

/// What the upright axis is to hold. On a logarithmic one, an interval that reaches far down would
/// take the room from the values themselves.
fn heights(plot: &Lines) -> Vec<f64> {
    const MOST_BELOW: f64 = 10.0;
    let Scale { logarithmic, .. } = plot.y;
    let points = || plot.series.iter().flat_map(|series| &series.points);
    let mut heights: Vec<f64> = plot.marks.iter().map(|mark| mark.y).collect();
    for point in points().filter(|point| point.x.is_finite() && point.y.is_finite()) {
        let low = if logarithmic {
            point.low.max(point.y / MOST_BELOW)
        } else {
            point.low
        };
        heights.extend([point.y, low, point.high]);
    }
    heights
}

/// None where names are too long or too many to stand beside lines.
fn room_beside(plot: &Lines, plan: Plan) -> Option<f64> {
    const NONE: f64 = 14.0;
    if !plan.beside || named(plot).next().is_none() {
        return Some(NONE);
    }
    let widths = named(plot).map(|(_, series)| text_width(&series.name, TEXT, false));
    let widest = widths.fold(0.0, f64::max);
    (widest <= MOST_BESIDE && named(plot).count() <= MOST_NAMED).then_some(widest + 14.0)
}

fn beside(plot: &Lines, field: &Field) -> Option<Vec<Beside>> {
    let mut found = Vec::new();
    for (index, series) in named(plot) {
        let end = field.end(series)?;
        if field.frame.right - end[0] > (MOST_SHORT * field.frame.width()).max(12.0) {
            return None;
        }
        found.push((index, end));
    }
    let wanted: Vec<f64> = found.iter().map(|(_, end)| end[1]).collect();
    let places = spread(&wanted, field.frame.top, field.frame.bottom - 4.0)?;
    let moved = wanted
        .iter()
        .zip(&places)
        .map(|(from, to)| (from - to).abs());
    if moved.fold(0.0, f64::max) > MOST_MOVED {
        return None;
    }
    let beside = found.into_iter().zip(places);
    Some(
        beside
            .map(|((series, end), y)| Beside { series, end, y })
            .collect(),
    )
}

/// Draws from what is behind to what is in front; returns the height.
fn fill(canvas: &mut Canvas, plot: &Lines, layout: &Layout) -> f64 {
    let Layout { field, ticks, .. } = layout;
    frame::upright(canvas, &field.y, ticks, &field.frame);
    let height = frame::lying(canvas, &field.x, &plot.x.label, &field.frame, WIDTH);
    let levels = frame::levels(&plot.marks, &field.y);
    frame::draw_levels(canvas, &levels, &field.frame);
    let of = |look| plot.series.iter().filter(move |series| series.look == look);
    of(Look::Band).for_each(|series| field.draw_band(canvas, series));
    for look in [Look::Measured, Look::Band, Look::Predicted] {
        of(look).for_each(|series| field.draw_line(canvas, series));
    }
    for look in [Look::Band, Look::Predicted] {
        of(look).for_each(|series| field.draw_lone(canvas, series));
    }
    for look in [Look::Measured, Look::Dots] {
        of(look).for_each(|series| field.draw_dots(canvas, series));
    }
    frame::name_levels(canvas, &levels, &layout.along);
    for beside in &layout.beside {
        name_line(
            canvas,
            &plot.series[beside.series],
            beside,
            field.frame.right,
        );
    }
    height
}

fn name_line(canvas: &mut Canvas, series: &Series, beside: &Beside, right: f64) {
    let index = colour(series.colour);
    let predicted = series.look == Look::Predicted;
    if (beside.y - beside.end[1]).abs() > 4.0 {
        let start = [beside.end[0] + 5.0, beside.end[1]];
        canvas.line(&format!("leader s{index}"), start, [right + 7.0, beside.y]);
    }
    let class = format!("{}{index}", if predicted { 't' } else { 'f' });
    let at = [right + 10.0, beside.y + 4.0];
    canvas.text(&Text::new(&class, at, Anchor::Start, &series.name));
}
