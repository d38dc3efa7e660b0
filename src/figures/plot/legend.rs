//! The head of a plot: its title, and what its marks mean.

use super::canvas::{Anchor, Canvas, Frame, LINE, TEXT, TITLE, Text};
use super::measure::{text_width, wrap};
use super::style::colour;

/// Width of a key and its distance from the name.
const KEY: f64 = 22.0;
const GAP: f64 = 7.0;
/// Between two entries of a row.
const APART: f64 = 18.0;

/// What a mark looks like, with the index of its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Key {
    Dots(usize),
    Band(usize),
    Dashes(usize),
    Square(usize),
    /// A tick across a bar.
    Tick,
    Level,
}

#[derive(Clone, Debug)]
pub(super) struct Entry<'a> {
    pub key: Key,
    pub name: &'a str,
}

/// Draws title and legend; returns where what follows begins.
pub(super) fn head(canvas: &mut Canvas, title: &str, entries: &[Entry], width: f64) -> f64 {
    let mut y = 0.0;
    if !title.trim().is_empty() {
        for line in wrap(title, TITLE, true, width) {
            y += LINE + 2.0;
            let at = [0.0, y - 4.0];
            canvas.text(&Text {
                size: TITLE,
                ..Text::new("ink title", at, Anchor::Start, &line)
            });
        }
        y += 7.0;
    }
    if entries.is_empty() {
        return y;
    }
    legend(canvas, entries, width, y) + 6.0
}

/// Entries in rows; returns the lower end.
fn legend(canvas: &mut Canvas, entries: &[Entry], width: f64, top: f64) -> f64 {
    let (mut x, mut y, mut lower) = (0.0, top, top);
    for entry in entries {
        let lines = wrap(entry.name, TEXT, false, width - KEY - GAP);
        let widest = lines
            .iter()
            .map(|line| text_width(line, TEXT, false))
            .fold(0.0, f64::max);
        let needed = KEY + GAP + widest;
        if x > 0.0 && x + needed > width {
            (x, y) = (0.0, lower);
        }
        draw_key(canvas, entry.key, [x, y + LINE / 2.0]);
        for (index, line) in lines.iter().enumerate() {
            let at = [x + KEY + GAP, y + LINE * index as f64 + 11.5];
            canvas.text(&Text::new("ink", at, Anchor::Start, line));
        }
        x += needed + APART;
        lower = lower.max(y + LINE * lines.len() as f64 + 3.0);
    }
    lower
}

fn draw_key(canvas: &mut Canvas, key: Key, [x, y]: [f64; 2]) {
    let (left, right) = ([x, y], [x + KEY, y]);
    match key {
        Key::Dots(index) => {
            let index = colour(index);
            canvas.line(&format!("joined s{index}"), left, right);
            canvas.circle(&format!("dot f{index}"), [x + KEY / 2.0, y], 4.0);
        }
        Key::Band(index) => {
            let index = colour(index);
            canvas.rect(&format!("band f{index}"), swatch(x, y, KEY, 5.0));
            canvas.line(&format!("curve s{index}"), left, right);
        }
        Key::Dashes(index) => {
            canvas.line(&format!("predicted d{}", colour(index)), left, right);
        }
        Key::Square(index) => {
            let middle = x + (KEY - 13.0) / 2.0;
            canvas.rect(&format!("f{}", colour(index)), swatch(middle, y, 13.0, 6.0));
        }
        Key::Tick => canvas.line("expected", [x + 2.0, y], [x + KEY - 2.0, y]),
        Key::Level => canvas.line("mark", left, right),
    }
}

fn swatch(left: f64, middle: f64, width: f64, half: f64) -> Frame {
    Frame {
        left,
        top: middle - half,
        right: left + width,
        bottom: middle + half,
    }
}
