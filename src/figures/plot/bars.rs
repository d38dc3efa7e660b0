//! Groups of bars.

use super::Drawn;
use super::axis::{Axis, Room};
use super::canvas::{Anchor, Canvas, Frame, LINE, TEXT, Text};
use super::frame::{self, HEIGHT};
use super::labels::{Placed, along_levels};
use super::legend::{Entry, Key, head};
use super::measure::{text_width, widest_word, wrap};
use super::style::colour;
use super::ticks::{Tick, ticks};
use crate::figures::{BarGroup, Bars};
use crate::report::data::Interval;

/// A plot is as wide as its groups need, within these.
const LEAST_WIDTH: f64 = 464.0;
const MOST_WIDTH: f64 = 1120.0;
const LEAST_BAR: f64 = 9.0;
const MOST_BAR: f64 = 34.0;
/// Share of a group's width that its bars fill.
const FILLED: f64 = 0.72;

struct Layout {
    axis: Axis,
    ticks: Vec<Tick>,
    frame: Frame,
    along: Vec<Placed>,
}

/// Names of levels stand along them, else in the legend.
pub(super) fn draw(plot: &Bars) -> Drawn {
    let axis = Axis::of(&plot.y, heights(plot).into_iter(), Room::Round);
    let ticks = ticks(&axis, 6);
    let left = frame::margin(&ticks);
    let width = (left + needed(plot)).clamp(LEAST_WIDTH, MOST_WIDTH);
    for along in [true, false] {
        let mut canvas = Canvas::default();
        let top = head(&mut canvas, &plot.title, &entries(plot, along), width);
        let top = frame::upright_name(&mut canvas, &plot.y.label, width, top);
        let frame = Frame {
            left,
            top,
            right: width,
            bottom: top + HEIGHT,
        };
        let axis = axis.clone().between(frame.bottom, frame.top);
        let levels = frame::levels(&plot.marks, &axis);
        let places = if along {
            along_levels(&levels, &frame, &filled(plot, &axis, &frame))
        } else {
            Some(Vec::new())
        };
        if let Some(along) = places {
            let ticks = ticks.clone();
            let height = fill(
                &mut canvas,
                plot,
                &Layout {
                    axis,
                    ticks,
                    frame,
                    along,
                },
            );
            return Drawn::new(canvas, width, height);
        }
    }
    unreachable!("names in a legend need no place in the plot")
}

fn entries(plot: &Bars, along: bool) -> Vec<Entry<'_>> {
    let mut entries = Vec::new();
    if plot.names.len() > 1 {
        entries.extend(plot.names.iter().enumerate().map(|(index, name)| Entry {
            key: Key::Square(colour_of(plot, index)),
            name,
        }));
    }
    if predictions(plot).next().is_some() {
        entries.push(Entry {
            key: Key::Tick,
            name: "predicted",
        });
    }
    if !along {
        entries.extend(plot.marks.iter().map(|mark| Entry {
            key: Key::Level,
            name: &mark.name,
        }));
    }
    entries
}

fn colour_of(plot: &Bars, bar: usize) -> usize {
    plot.colours.get(bar).copied().unwrap_or(bar)
}

fn intervals(plot: &Bars) -> impl Iterator<Item = &Interval> {
    plot.groups
        .iter()
        .flat_map(|group| group.bars.iter().flatten())
}

fn predictions(plot: &Bars) -> impl Iterator<Item = f64> {
    let predicted = plot
        .groups
        .iter()
        .flat_map(|group| group.predicted.iter().flatten());
    predicted.copied().filter(|value| value.is_finite())
}

fn heights(plot: &Bars) -> Vec<f64> {
    let mut heights: Vec<f64> = predictions(plot).collect();
    heights.extend(plot.marks.iter().map(|mark| mark.y));
    for interval in intervals(plot).filter(|interval| interval.value.is_finite()) {
        heights.extend([interval.value, interval.high]);
        if plot.y.logarithmic {
            // Bars have a length also where all are alike.
            heights.extend([
                interval.low.max(interval.value / 10.0),
                interval.value / 2.0,
            ]);
        } else {
            heights.push(interval.low);
        }
    }
    if !plot.y.logarithmic {
        heights.push(plot.base);
    }
    heights
}

fn bars_a_group(plot: &Bars) -> usize {
    let most = plot.groups.iter().map(|group| group.bars.len()).max();
    most.unwrap_or(0).max(plot.names.len()).max(1)
}

/// Room for bars that can be told apart, and for each word under a group.
fn needed(plot: &Bars) -> f64 {
    let bars = bars_a_group(plot) as f64 * (LEAST_BAR + 5.0) / FILLED;
    let words = plot.groups.iter().map(|group| {
        let whole = text_width(&group.name, TEXT, false);
        // Two lines or three are well read; more are not.
        widest_word(&group.name, TEXT).max(whole / 1.9) + 12.0
    });
    let widest = words.fold(bars, f64::max);
    widest * plot.groups.len() as f64
}

/// Where the bars of a group stand.
fn stands(plot: &Bars, group: usize, frame: &Frame) -> Vec<[f64; 2]> {
    let share = frame.width() / plot.groups.len() as f64;
    let many = bars_a_group(plot) as f64;
    let pitch = (share * FILLED / many).min(MOST_BAR + 4.0);
    let gap = (pitch * 0.16).min(4.0);
    let middle = frame.left + share * (group as f64 + 0.5);
    (0..bars_a_group(plot))
        .map(|bar| {
            let start = middle + pitch * (bar as f64 - many / 2.0);
            [start + gap / 2.0, start + pitch - gap / 2.0]
        })
        .collect()
}

fn base(plot: &Bars, axis: &Axis) -> f64 {
    let base = if plot.y.logarithmic {
        axis.low
    } else {
        plot.base
    };
    axis.clamped(base).unwrap_or(axis.from)
}

/// Places that bars fill, for names to avoid.
fn filled(plot: &Bars, axis: &Axis, frame: &Frame) -> Vec<[f64; 2]> {
    let mut filled = Vec::new();
    let base = base(plot, axis);
    for (index, group) in plot.groups.iter().enumerate() {
        let ticks = group.predicted.iter().zip(stands(plot, index, frame));
        filled.extend(
            ticks.filter_map(|(predicted, [left, _])| Some([left, axis.at((*predicted)?)?])),
        );
        for (bar, [left, right]) in group.bars.iter().zip(stands(plot, index, frame)) {
            let Some(top) = bar.and_then(|bar| axis.clamped(bar.high.max(bar.value))) else {
                continue;
            };
            let (upper, lower) = (top.min(base), top.max(base));
            let steps = ((lower - upper) / 6.0).ceil() as usize;
            let rows = (0..=steps).map(|step| (upper + 6.0 * step as f64).min(lower));
            filled.extend(rows.flat_map(|y| [[left, y], [(left + right) / 2.0, y], [right, y]]));
        }
    }
    filled
}

fn fill(canvas: &mut Canvas, plot: &Bars, layout: &Layout) -> f64 {
    let Layout {
        axis,
        ticks,
        frame,
        along,
    } = layout;
    frame::upright(canvas, axis, ticks, frame);
    let levels = frame::levels(&plot.marks, axis);
    for (index, group) in plot.groups.iter().enumerate() {
        draw_group(canvas, plot, group, &stands(plot, index, frame), layout);
    }
    let base = base(plot, axis);
    canvas.line("spine", [frame.left, base], [frame.right, base]);
    frame::draw_levels(canvas, &levels, frame);
    frame::name_levels(canvas, &levels, along);
    name_groups(canvas, plot, frame)
}

/// Bars, then what theory says of them, then their errors, so that none hides the next.
fn draw_group(
    canvas: &mut Canvas,
    plot: &Bars,
    group: &BarGroup,
    stands: &[[f64; 2]],
    layout: &Layout,
) {
    let Layout { axis, frame, .. } = layout;
    let base = base(plot, axis);
    let end = |bar: &Option<Interval>| {
        let value = bar.filter(|bar| axis.at(bar.value).is_some());
        value.and_then(|bar| Some((bar, axis.clamped(bar.value)?)))
    };
    for (index, (bar, &[left, right])) in group.bars.iter().zip(stands).enumerate() {
        let class = format!("amount b{}", colour(colour_of(plot, index)));
        let Some((_, end)) = end(bar) else {
            let at = [(left + right) / 2.0, base.min(frame.bottom) - 5.0];
            canvas.text(&Text::new("muted", at, Anchor::Middle, "–"));
            continue;
        };
        let (top, bottom) = (end.min(base), end.max(base));
        canvas.rect(
            &class,
            Frame {
                left,
                top,
                right,
                bottom,
            },
        );
    }
    for (&predicted, &[left, right]) in group.predicted.iter().zip(stands) {
        let held = predicted.filter(|&value| axis.holds(value));
        if let Some(y) = held.and_then(|value| axis.at(value)) {
            canvas.line("expected", [left - 3.0, y], [right + 3.0, y]);
        }
    }
    for (bar, [left, right]) in group.bars.iter().zip(stands) {
        let Some((bar, end)) = end(bar) else {
            continue;
        };
        let middle = (left + right) / 2.0;
        let [low, high] = [bar.low, bar.high].map(|y| axis.clamped(y).unwrap_or(end));
        if (low - high).abs() > 0.5 {
            canvas.line("error error-ink", [middle, low], [middle, high]);
        }
    }
}

/// Names under groups; returns the lower end.
fn name_groups(canvas: &mut Canvas, plot: &Bars, frame: &Frame) -> f64 {
    let share = frame.width() / plot.groups.len().max(1) as f64;
    let mut lower = frame.bottom + 6.0;
    for (index, group) in plot.groups.iter().enumerate() {
        let middle = frame.left + share * (index as f64 + 0.5);
        for (line, words) in wrap(&group.name, TEXT, false, share - 8.0)
            .iter()
            .enumerate()
        {
            let y = frame.bottom + 17.0 + LINE * line as f64;
            canvas.text(&Text::new("ink", [middle, y], Anchor::Middle, words));
            lower = lower.max(y + 5.0);
        }
    }
    lower
}
