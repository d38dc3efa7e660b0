//! The second layer: squares of pixels, for differences that the mean of the picture hides.

use super::estimate::Estimate;
use super::moments::Sides;
use super::normal::{quantile, sidak};
use crate::pack::Rect;
use rayon::prelude::*;
use serde::Serialize;

/// Side of a tile, in pixels; those at the right and lower edges may be smaller.
pub const SIDE: usize = 8;

/// What the tiles say.
#[derive(Clone, Debug, Serialize)]
pub struct Tiles {
    /// Side of a tile, pixels.
    pub side: usize,
    pub count: usize,
    /// The chance of a false alarm that each channel of each tile was allowed.
    pub level: f64,
    /// Tiles that differ.
    pub failing: usize,
    /// The one that differs most clearly, whether or not it is clear enough.
    pub worst: Spot,
    /// Relative differences beyond which half of the tiles, and all but one in a hundred, are shown not
    /// to be apart: each by two one-sided tests at `alpha`, in its worst channel.
    pub margins: [f64; 2],
}

/// A place that stands out.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Spot {
    pub rect: Rect,
    /// 0 red, 1 green, 2 blue.
    pub channel: usize,
    #[serde(flatten)]
    pub estimate: Estimate,
}

/// Compares tile by tile; `alpha` is the chance of a false alarm among them all.
pub fn judge(sides: &Sides, alpha: f64, tolerance: f64) -> Tiles {
    let z = quantile(1.0 - alpha);
    let (across, down) = (sides.width.div_ceil(SIDE), sides.height.div_ceil(SIDE));
    let count = across * down;
    let level = sidak(alpha, 3.0 * count as f64);
    let (spots, margins): (Vec<Spot>, Vec<f64>) = (0..count)
        .into_par_iter()
        .map(|tile| {
            let spots = channels(sides, tile % across, tile / across, tolerance);
            (clearest(spots), widest(spots, z))
        })
        .unzip();
    let failing = spots
        .iter()
        .filter(|spot| spot.estimate.p() < level)
        .count();
    // The first of equals, so that the answer is the same every time.
    let mut worst = spots[0];
    for spot in &spots {
        if spot.estimate.z > worst.estimate.z {
            worst = *spot;
        }
    }
    Tiles {
        side: SIDE,
        count,
        level,
        failing,
        worst,
        margins: typical(margins),
    }
}

/// The median, and what all but one in a hundred are below.
fn typical(mut margins: Vec<f64>) -> [f64; 2] {
    margins.sort_by(f64::total_cmp);
    let last = margins.len() - 1;
    [margins[last / 2], margins[last * 99 / 100]]
}

/// The largest relative difference that the channels of a tile may still have.
fn widest(spots: [Spot; 3], z: f64) -> f64 {
    let margin = |spot: Spot| spot.estimate.margin(z);
    spots.map(margin).into_iter().fold(0.0, f64::max)
}

fn clearest([red, green, blue]: [Spot; 3]) -> Spot {
    let clearer = |a: Spot, b: Spot| if b.estimate.z > a.estimate.z { b } else { a };
    clearer(clearer(red, green), blue)
}

/// x0, y0, x1, y1 of a tile, the last two exclusive.
pub fn tile_at(sides: &Sides, column: usize, row: usize) -> [usize; 4] {
    let (x0, y0) = (column * SIDE, row * SIDE);
    [
        x0,
        y0,
        (x0 + SIDE).min(sides.width),
        (y0 + SIDE).min(sides.height),
    ]
}

fn channels(sides: &Sides, column: usize, row: usize, tolerance: f64) -> [Spot; 3] {
    let rect = tile_at(sides, column, row);
    [0, 1, 2].map(|channel| Spot {
        rect: sides.place(rect),
        channel,
        estimate: Estimate::new(sides.within(rect, channel), tolerance),
    })
}
