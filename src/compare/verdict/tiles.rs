//! The second layer: squares of pixels, for differences that the mean of the picture hides.

use super::estimate::Estimate;
use super::moments::Sides;
use super::normal::sidak;
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
    let (across, down) = (sides.width.div_ceil(SIDE), sides.height.div_ceil(SIDE));
    let count = across * down;
    let level = sidak(alpha, 3.0 * count as f64);
    let spots: Vec<Spot> = (0..count)
        .into_par_iter()
        .map(|tile| worst_channel(sides, tile % across, tile / across, tolerance))
        .collect();
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
    }
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

fn worst_channel(sides: &Sides, column: usize, row: usize, tolerance: f64) -> Spot {
    let rect = tile_at(sides, column, row);
    let spot = |channel| Spot {
        rect: sides.place(rect),
        channel,
        estimate: Estimate::new(sides.within(rect, channel), tolerance),
    };
    let [red, green, blue] = [0, 1, 2].map(spot);
    let clearer = |a: Spot, b: Spot| if b.estimate.z > a.estimate.z { b } else { a };
    clearer(clearer(red, green), blue)
}
