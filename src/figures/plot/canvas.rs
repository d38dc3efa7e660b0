//! SVG elements, written one after another. Classes give the colours; sizes and places are
//! attributes, so that programs that know no style sheets still lay a plot out rightly.

use super::measure::text_width;
use crate::figures::escape::markup;
use std::fmt::Write as _;

/// Sizes of letters.
pub(super) const TITLE: f64 = 14.0;
pub(super) const TEXT: f64 = 12.0;
/// From a line of text to the next.
pub(super) const LINE: f64 = 15.0;

#[derive(Default)]
pub(super) struct Canvas {
    body: String,
}

/// Where a text's place is in it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Corners of a box on the page; y grows downwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Frame {
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    pub fn grown(&self, by: f64) -> Self {
        Self {
            left: self.left - by,
            top: self.top - by,
            right: self.right + by,
            bottom: self.bottom + by,
        }
    }

    pub fn holds(&self, [x, y]: [f64; 2]) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }

    pub fn meets(&self, other: &Frame) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }
}

/// A line of text; `power` stands raised behind it.
pub(super) struct Text<'a> {
    pub class: &'a str,
    pub at: [f64; 2],
    pub anchor: Anchor,
    pub size: f64,
    pub words: &'a str,
    pub power: Option<i32>,
}

impl<'a> Text<'a> {
    pub fn new(class: &'a str, at: [f64; 2], anchor: Anchor, words: &'a str) -> Self {
        Self {
            class,
            at,
            anchor,
            size: TEXT,
            words,
            power: None,
        }
    }
}

/// A number with two digits behind the point at most.
pub(super) fn number(value: f64) -> String {
    let rounded = (value * 100.0).round() / 100.0;
    // There is no minus zero on a page.
    format!("{}", rounded + 0.0)
}

impl Canvas {
    pub fn line(&mut self, class: &str, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2]) {
        self.push(format_args!(
            "<line class=\"{class}\" x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"/>",
            number(x1),
            number(y1),
            number(x2),
            number(y2)
        ));
    }

    pub fn rect(&mut self, class: &str, frame: Frame) {
        self.push(format_args!(
            "<rect class=\"{class}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
            number(frame.left),
            number(frame.top),
            number(frame.width().max(0.0)),
            number((frame.bottom - frame.top).max(0.0))
        ));
    }

    pub fn circle(&mut self, class: &str, [x, y]: [f64; 2], radius: f64) {
        self.push(format_args!(
            "<circle class=\"{class}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>",
            number(x),
            number(y),
            number(radius)
        ));
    }

    pub fn path(&mut self, class: &str, data: &str) {
        if !data.is_empty() {
            self.push(format_args!("<path class=\"{class}\" d=\"{data}\"/>"));
        }
    }

    pub fn text(&mut self, text: &Text) {
        let anchor = match text.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let power = text.power.map_or_else(String::new, |power| {
            let sign = if power < 0 { "−" } else { "" };
            let size = number(text.size * 0.75);
            format!(
                "<tspan dy=\"-4\" font-size=\"{size}\">{sign}{}</tspan>",
                power.unsigned_abs()
            )
        });
        self.push(format_args!(
            "<text class=\"{}\" x=\"{}\" y=\"{}\"{anchor} font-size=\"{}\">{}{power}</text>",
            text.class,
            number(text.at[0]),
            number(text.at[1]),
            number(text.size),
            markup(text.words)
        ));
    }

    fn push(&mut self, element: std::fmt::Arguments) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.body, "{element}");
    }

    pub fn into_body(self) -> String {
        self.body
    }
}

/// A path through points, in pieces where it is broken.
pub(super) fn polyline(pieces: &[Vec<[f64; 2]>]) -> String {
    let mut data = String::new();
    for piece in pieces {
        for (index, [x, y]) in piece.iter().enumerate() {
            let step = if index == 0 { 'M' } else { 'L' };
            let _ = write!(data, "{step}{} {}", number(*x), number(*y));
        }
    }
    data
}

/// The box that a line of text fills.
pub(super) fn text_frame(at: [f64; 2], anchor: Anchor, words: &str, size: f64) -> Frame {
    let width = text_width(words, size, false);
    let left = match anchor {
        Anchor::Start => at[0],
        Anchor::Middle => at[0] - width / 2.0,
        Anchor::End => at[0] - width,
    };
    Frame {
        left,
        top: at[1] - 0.8 * size,
        right: left + width,
        bottom: at[1] + 0.25 * size,
    }
}
