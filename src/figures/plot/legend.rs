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
    Joined(usize),
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

/// Entries down columns, as many as the width holds; returns the lower end.
fn legend(canvas: &mut Canvas, entries: &[Entry], width: f64, top: f64) -> f64 {
    let most = width - KEY - GAP;
    let names: Vec<Vec<String>> = entries
        .iter()
        .map(|entry| wrap(entry.name, TEXT, false, most))
        .collect();
    let (rows, columns) = columns(&names, width);
    let height = |lines: &Vec<String>| LINE * lines.len() as f64 + 3.0;
    // A row is as high as the highest of its entries.
    let heights: Vec<f64> = (0..rows)
        .map(|row| {
            names
                .iter()
                .skip(row)
                .step_by(rows)
                .map(height)
                .fold(0.0, f64::max)
        })
        .collect();
    for (index, (entry, lines)) in entries.iter().zip(&names).enumerate() {
        let x = columns[..index / rows].iter().sum::<f64>();
        let y = top + heights[..index % rows].iter().sum::<f64>();
        draw_key(canvas, entry.key, [x, y + LINE / 2.0]);
        for (line, words) in lines.iter().enumerate() {
            let at = [x + KEY + GAP, y + LINE * line as f64 + 11.5];
            canvas.text(&Text::new("ink", at, Anchor::Start, words));
        }
    }
    top + heights.iter().sum::<f64>()
}

/// The fewest rows whose columns fit beside each other, and the columns' widths.
fn columns(names: &[Vec<String>], width: f64) -> (usize, Vec<f64>) {
    let needed: Vec<f64> = names
        .iter()
        .map(|lines| {
            let widths = lines.iter().map(|line| text_width(line, TEXT, false));
            KEY + GAP + widths.fold(0.0, f64::max) + APART
        })
        .collect();
    let of = |rows: usize| -> Vec<f64> {
        let columns = needed.chunks(rows);
        columns
            .map(|column| column.iter().copied().fold(0.0, f64::max))
            .collect()
    };
    let fits = |rows: &usize| of(*rows).iter().sum::<f64>() - APART <= width;
    let rows = (1..=names.len()).find(fits).unwrap_or(names.len().max(1));
    (rows, of(rows))
}

fn draw_key(canvas: &mut Canvas, key: Key, [x, y]: [f64; 2]) {
    let (left, right) = ([x, y], [x + KEY, y]);
    match key {
        Key::Dots(index) => {
            canvas.circle(&format!("dot f{}", colour(index)), [x + KEY / 2.0, y], 4.0);
        }
        Key::Joined(index) => {
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
            canvas.rect(&format!("b{}", colour(index)), swatch(middle, y, 13.0, 6.0));
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
