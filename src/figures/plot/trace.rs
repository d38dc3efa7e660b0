//! One series on the page: where its points are, and what of its line is inside the frame.

use super::axis::Axis;
use super::canvas::{Canvas, Frame, number, polyline};
use super::style::colour;
use crate::figures::{Look, Point, Series};
use std::fmt::Write as _;

/// The two axes and the frame that they span.
pub(super) struct Field {
    pub x: Axis,
    pub y: Axis,
    pub frame: Frame,
}

impl Field {
    fn at(&self, x: f64, y: f64) -> Option<[f64; 2]> {
        Some([self.x.at(x)?, self.y.at(y)?])
    }

    /// The points that both axes can show, whether or not inside the frame; in runs that are
    /// broken where one is missing.
    fn runs<'a>(&self, series: &'a Series) -> Vec<Vec<(&'a Point, [f64; 2])>> {
        let mut runs = vec![Vec::new()];
        for point in &series.points {
            match (self.at(point.x, point.y), runs.last_mut()) {
                (Some(at), Some(run)) => run.push((point, at)),
                _ => runs.push(Vec::new()),
            }
        }
        runs.retain(|run| !run.is_empty());
        runs
    }

    /// Where a series ends inside the frame.
    pub fn end(&self, series: &Series) -> Option<[f64; 2]> {
        let points = self.runs(series).into_iter().flatten();
        points
            .map(|(_, at)| at)
            .filter(|&at| self.frame.holds(at))
            .max_by(|a, b| a[0].total_cmp(&b[0]))
    }

    /// The line of a series, cut at the frame.
    fn line(&self, series: &Series) -> Vec<Vec<[f64; 2]>> {
        let mut pieces: Vec<Vec<[f64; 2]>> = Vec::new();
        for run in self.runs(series) {
            for pair in run.windows(2) {
                let Some([start, end]) = clipped(pair[0].1, pair[1].1, &self.frame) else {
                    continue;
                };
                match pieces.last_mut() {
                    Some(piece) if piece.last() == Some(&start) => piece.push(end),
                    _ => pieces.push(vec![start, end]),
                }
            }
        }
        pieces
    }

    /// Places that a series fills, close enough together that no letter fits between them.
    pub fn filled(&self, series: &Series) -> Vec<[f64; 2]> {
        let mut filled = Vec::new();
        for pair in self.line(series).iter().flat_map(|piece| piece.windows(2)) {
            between(pair[0], pair[1], &mut filled);
        }
        for (point, at) in self.runs(series).into_iter().flatten() {
            let ends = [point.low, point.high].map(|y| self.y.clamped(y).unwrap_or(at[1]));
            between([at[0], ends[0]], [at[0], ends[1]], &mut filled);
        }
        filled
    }

    pub fn draw_band(&self, canvas: &mut Canvas, series: &Series) {
        let class = format!("band f{}", colour(series.colour));
        for run in self.runs(series) {
            let ends =
                |point: &Point| Some([self.y.clamped(point.low)?, self.y.clamped(point.high)?]);
            let inside = run.iter().filter(|(point, _)| self.x.holds(point.x));
            let edges: Vec<(f64, [f64; 2])> = inside
                .filter_map(|(point, at)| Some((at[0], ends(point)?)))
                .collect();
            let upper = edges.iter().map(|(x, ends)| [*x, ends[1]]);
            let lower = edges.iter().rev().map(|(x, ends)| [*x, ends[0]]);
            let outline: Vec<[f64; 2]> = upper.chain(lower).collect();
            if outline.len() > 3 {
                canvas.path(&class, &format!("{}Z", polyline(&[outline])));
            }
        }
    }

    pub fn draw_line(&self, canvas: &mut Canvas, series: &Series) {
        let index = colour(series.colour);
        let class = match series.look {
            Look::Measured => format!("joined s{index}"),
            Look::Band => format!("curve s{index}"),
            Look::Predicted => format!("predicted d{index}"),
            Look::Dots => return,
        };
        canvas.path(&class, &polyline(&self.line(series)));
    }

    /// Error bars first, then the dots on them.
    pub fn draw_dots(&self, canvas: &mut Canvas, series: &Series) {
        let index = colour(series.colour);
        let points: Vec<(&Point, [f64; 2])> = self.runs(series).into_iter().flatten().collect();
        let mut bars = String::new();
        for (point, [x, y]) in points.iter().filter(|(point, _)| self.x.holds(point.x)) {
            let [low, high] = [point.low, point.high].map(|end| self.y.clamped(end).unwrap_or(*y));
            if (low - high).abs() > 0.5 {
                // Writing to a string cannot fail.
                let _ = write!(bars, "M{} {}V{}", number(*x), number(low), number(high));
            }
        }
        canvas.path(&format!("error s{index}"), &bars);
        let radius = if points.len() > 60 { 2.2 } else { 4.0 };
        for (point, at) in points {
            if self.frame.holds(at) {
                canvas.circle(&format!("dot f{index}"), at, radius);
            } else if self.x.holds(point.x) {
                canvas.path(&format!("beyond f{index}"), &arrow(at, &self.frame));
            }
        }
    }

    /// A line with one point has no length: it is a dot.
    pub fn draw_lone(&self, canvas: &mut Canvas, series: &Series) {
        for run in self.runs(series).iter().filter(|run| run.len() == 1) {
            if self.frame.holds(run[0].1) {
                canvas.circle(&format!("dot f{}", colour(series.colour)), run[0].1, 3.0);
            }
        }
    }
}

/// Says that a point is beyond the frame, where it left it.
fn arrow([x, y]: [f64; 2], frame: &Frame) -> String {
    let (edge, away) = if y < frame.top {
        (frame.top, -6.0)
    } else {
        (frame.bottom, 6.0)
    };
    let corners = [[x - 4.0, edge - away], [x + 4.0, edge - away], [x, edge]];
    format!("{}Z", polyline(&[corners.to_vec()]))
}

fn between(start: [f64; 2], end: [f64; 2], filled: &mut Vec<[f64; 2]>) {
    const STEP: f64 = 5.0;
    let length = (end[0] - start[0]).hypot(end[1] - start[1]);
    let steps = (length / STEP).ceil().clamp(1.0, 1000.0) as usize;
    for step in 0..=steps {
        let share = step as f64 / steps as f64;
        filled.push([0, 1].map(|axis| start[axis] + share * (end[axis] - start[axis])));
    }
}

/// The part of a segment inside the frame, after Liang and Barsky.
fn clipped(start: [f64; 2], end: [f64; 2], frame: &Frame) -> Option<[[f64; 2]; 2]> {
    let (mut enter, mut leave) = (0.0, 1.0);
    let bounds = [[frame.left, frame.right], [frame.top, frame.bottom]];
    for axis in 0..2 {
        let step = end[axis] - start[axis];
        let [low, high] = bounds[axis].map(|bound| bound - start[axis]);
        if step == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (near, far) = if step > 0.0 { (low, high) } else { (high, low) };
        enter = f64::max(enter, near / step);
        leave = f64::min(leave, far / step);
    }
    let along = |share: f64| [0, 1].map(|axis| start[axis] + share * (end[axis] - start[axis]));
    // The ends themselves where nothing is cut: pieces are joined where they are equal.
    let first = if enter == 0.0 { start } else { along(enter) };
    let last = if leave == 1.0 { end } else { along(leave) };
    (enter <= leave).then_some([first, last])
}
