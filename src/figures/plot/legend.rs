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

/// Entries in as many columns as the width holds; returns the lower end.
fn legend(canvas: &mut Canvas, entries: &[Entry], width: f64, top: f64) -> f64 {
    let most = width - KEY - GAP;
    let names: Vec<Vec<String>> = entries
        .iter()
        .map(|entry| wrap(entry.name, TEXT, false, most))
        .collect();
    let columns = columns(&names, width);
    let (mut y, mut lower) = (top, top);
    for (index, (entry, lines)) in entries.iter().zip(&names).enumerate() {
        let column = index % columns.len();
        if column == 0 {
            y = lower;
        }
        let x = columns[..column].iter().sum::<f64>();
        draw_key(canvas, entry.key, [x, y + LINE / 2.0]);
        for (index, line) in lines.iter().enumerate() {
            let at = [x + KEY + GAP, y + LINE * index as f64 + 11.5];
            canvas.text(&Text::new("ink", at, Anchor::Start, line));
        }
        lower = lower.max(y + LINE * lines.len() as f64 + 3.0);
    }
    lower
}

/// Widths of the columns: the most that fit beside each other.
fn columns(names: &[Vec<String>], width: f64) -> Vec<f64> {
    let needed: Vec<f64> = names
        .iter()
        .map(|lines| {
            let widths = lines.iter().map(|line| text_width(line, TEXT, false));
            KEY + GAP + widths.fold(0.0, f64::max) + APART
        })
        .collect();
    let of = |many: usize| -> Vec<f64> {
        let column = |first| needed.iter().skip(first).step_by(many).copied();
        (0..many)
            .map(|first| column(first).fold(0.0, f64::max))
            .collect()
    };
    let fits = |columns: &Vec<f64>| columns.iter().sum::<f64>() - APART <= width;
    (1..=names.len())
        .rev()
        .map(of)
        .find(fits)
        .unwrap_or_else(|| of(1))
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
