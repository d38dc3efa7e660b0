//! What stands around data: grid, axes, and names of levels.

use super::axis::Axis;
use super::canvas::{Anchor, Canvas, Frame, LINE, TEXT, Text};
use super::labels::Placed;
use super::measure::wrap;
use super::ticks::{Tick, ticks_abreast};
use crate::figures::Mark;

/// Height of the part that holds the data.
pub(super) const HEIGHT: f64 = 232.0;
/// Between an axis and its numbers.
const GAP: f64 = 8.0;

/// Room that the numbers of an upright axis need.
pub(super) fn margin(ticks: &[Tick]) -> f64 {
    let widths = ticks.iter().filter_map(|tick| tick.label.as_ref());
    widths
        .map(|label| label.width())
        .fold(16.0, f64::max)
        .ceil()
        + GAP
}

/// The upright axis's name stands above it, where it can be read without turning the head.
pub(super) fn upright_name(canvas: &mut Canvas, name: &str, width: f64, top: f64) -> f64 {
    let mut y = top;
    if !name.trim().is_empty() {
        for line in wrap(name, TEXT, false, width) {
            y += LINE;
            canvas.text(&Text::new("muted", [0.0, y - 3.5], Anchor::Start, &line));
        }
    }
    y + 12.0
}

/// Lines across the plot with their numbers.
pub(super) fn upright(canvas: &mut Canvas, axis: &Axis, ticks: &[Tick], frame: &Frame) {
    for tick in ticks {
        let Some(y) = axis.at(tick.value) else {
            continue;
        };
        let Some(label) = &tick.label else {
            canvas.line("minor", [frame.left - 4.0, y], [frame.left, y]);
            continue;
        };
        let class = if tick.value == 0.0 { "spine" } else { "rule" };
        canvas.line(class, [frame.left, y], [frame.right, y]);
        let at = [frame.left - GAP, y + 4.0];
        canvas.text(&Text {
            power: label.power,
            ..Text::new("muted", at, Anchor::End, &label.words)
        });
    }
}

/// The axis under the plot with its numbers and its name; returns the lower end.
pub(super) fn lying(
    canvas: &mut Canvas,
    axis: &Axis,
    name: &str,
    frame: &Frame,
    width: f64,
) -> f64 {
    let bottom = frame.bottom;
    canvas.line("spine", [frame.left, bottom], [frame.right, bottom]);
    for tick in ticks_abreast(axis) {
        let Some(x) = axis.at(tick.value) else {
            continue;
        };
        let length = if tick.label.is_some() { 5.0 } else { 3.0 };
        canvas.line("spine", [x, bottom], [x, bottom + length]);
        if let Some(label) = &tick.label {
            let at = [x, bottom + 18.0];
            canvas.text(&Text {
                power: label.power,
                ..Text::new("muted", at, Anchor::Middle, &label.words)
            });
        }
    }
    lying_name(canvas, name, frame, bottom + 22.0, width)
}

fn lying_name(canvas: &mut Canvas, name: &str, frame: &Frame, top: f64, width: f64) -> f64 {
    if name.trim().is_empty() {
        return top + 2.0;
    }
    let middle = (frame.left + frame.right) / 2.0;
    let most = 2.0 * middle.min(width - middle);
    let mut y = top;
    for line in wrap(name, TEXT, false, most) {
        y += LINE;
        canvas.text(&Text::new(
            "muted",
            [middle, y - 1.5],
            Anchor::Middle,
            &line,
        ));
    }
    y + 3.0
}

/// The levels that an axis holds, with their places.
pub(super) fn levels<'a>(marks: &'a [Mark], axis: &Axis) -> Vec<(&'a str, f64)> {
    marks
        .iter()
        .filter(|mark| axis.holds(mark.y))
        .filter_map(|mark| Some((mark.name.as_str(), axis.at(mark.y)?)))
        .collect()
}

pub(super) fn draw_levels(canvas: &mut Canvas, levels: &[(&str, f64)], frame: &Frame) {
    for &(_, y) in levels {
        canvas.line("mark", [frame.left, y], [frame.right, y]);
    }
}

pub(super) fn name_levels(canvas: &mut Canvas, levels: &[(&str, f64)], places: &[Placed]) {
    for (&(name, _), place) in levels.iter().zip(places) {
        let class = "muted halo mark-name";
        canvas.text(&Text::new(class, place.at, place.anchor, name));
    }
}
