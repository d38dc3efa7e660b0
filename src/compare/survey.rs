//! One pass over both pictures: the metrics in linear light, and where they differ most.

use super::{Linear, Lines, Pair};
use crate::pack::Rect;
use rayon::prelude::*;
use serde::Serialize;

/// Side of the tiles that the worst are named of, in pixels.
pub const TILE: u32 = 32;

/// What relative metrics add to the reference, so that black pixels do not decide everything.
pub const NEAR_BLACK: f64 = 0.01;

/// Sums over pixels and channels, all in linear light.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums {
    /// Channels of pixels that are finite in both pictures.
    pub values: u64,
    pub absolute: f64,
    pub squared: f64,
    /// d^2 / (reference^2 + 0.01).
    pub relative: f64,
    /// (d / (reference + 0.01))^2.
    pub mean_relative: f64,
}

impl Sums {
    fn add(&mut self, other: &Sums) {
        self.values += other.values;
        self.absolute += other.absolute;
        self.squared += other.squared;
        self.relative += other.relative;
        self.mean_relative += other.mean_relative;
    }
}

/// Pixels that are NaN or infinite in one of their channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct NonFinite {
    pub reference: u64,
    pub test: u64,
    /// Pixels that are not finite in one picture, and something else in the other.
    pub apart: u64,
    /// The first in either picture: column and row.
    pub first: Option<[u32; 2]>,
}

/// A tile and how far the pictures are apart in it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TileError {
    pub rect: Rect,
    /// Root of the mean squared error, linear light.
    pub rmse: f64,
    /// Mean of test minus reference, linear light.
    pub difference: f64,
}

/// What one pass finds.
#[derive(Clone, Debug)]
pub struct Survey {
    pub sums: Sums,
    pub non_finite: NonFinite,
    /// Whether every pixel has the same bits.
    pub identical: bool,
    /// Row by row.
    pub tiles: Vec<TileError>,
}

impl Survey {
    /// The worst tiles, the worst first, without those where nothing differs.
    pub fn worst(&self, count: usize) -> Vec<TileError> {
        let mut tiles: Vec<_> = self
            .tiles
            .iter()
            .copied()
            .filter(|tile| tile.rmse > 0.0)
            .collect();
        // A stable sort: of equals the upper left one comes first.
        tiles.sort_by(|a, b| b.rmse.total_cmp(&a.rmse));
        tiles.truncate(count);
        tiles
    }
}

/// Goes over all pixels once.
pub fn survey(pair: &Pair) -> Survey {
    let strips = pair.height().div_ceil(TILE);
    let strips: Vec<Survey> = (0..strips)
        .into_par_iter()
        .map(|strip| survey_strip(pair, strip))
        .collect();
    let mut whole = Survey {
        sums: Sums::default(),
        non_finite: NonFinite::default(),
        identical: true,
        tiles: Vec::new(),
    };
    for strip in strips {
        whole.sums.add(&strip.sums);
        whole.non_finite.reference += strip.non_finite.reference;
        whole.non_finite.test += strip.non_finite.test;
        whole.non_finite.apart += strip.non_finite.apart;
        whole.non_finite.first = whole.non_finite.first.or(strip.non_finite.first);
        whole.identical &= strip.identical;
        whole.tiles.extend(strip.tiles);
    }
    whole
}

/// Sums of one tile.
#[derive(Clone, Copy, Default)]
struct Tile {
    sums: Sums,
    signed: f64,
}

fn survey_strip(pair: &Pair, strip: u32) -> Survey {
    let width = pair.width() as usize;
    let rows = strip * TILE..((strip + 1) * TILE).min(pair.height());
    let (reference, test) = (Linear(&pair.reference), Linear(&pair.test));
    let mut lines = [vec![[0.0; 3]; width], vec![[0.0; 3]; width]];
    let mut tiles = vec![Tile::default(); width.div_ceil(TILE as usize)];
    let mut non_finite = NonFinite::default();
    let mut identical = true;
    for y in rows.clone() {
        let [first, second] = &mut lines;
        reference.line(y, first);
        test.line(y, second);
        if same_bits(first, second) && all_finite(first) {
            add_equal(&mut tiles, width);
            continue;
        }
        identical &= same_bits(first, second);
        let chunks = first
            .chunks(TILE as usize)
            .zip(second.chunks(TILE as usize));
        for (column, (tile, (first, second))) in tiles.iter_mut().zip(chunks).enumerate() {
            for (x, (a, b)) in first.iter().zip(second).enumerate() {
                if !add_pixel(tile, *a, *b) {
                    let at = [column as u32 * TILE + x as u32, y];
                    count_non_finite(&mut non_finite, *a, *b, at);
                }
            }
        }
    }
    let mut sums = Sums::default();
    for tile in &tiles {
        sums.add(&tile.sums);
    }
    let tiles = tiles.iter().enumerate();
    Survey {
        sums,
        non_finite,
        identical,
        tiles: tiles
            .map(|(column, tile)| tile_error(pair, column as u32, &rows, tile))
            .collect(),
    }
}

fn same_bits(first: &[[f32; 3]], second: &[[f32; 3]]) -> bool {
    bytemuck::cast_slice::<_, u32>(first) == bytemuck::cast_slice::<_, u32>(second)
}

fn all_finite(line: &[[f32; 3]]) -> bool {
    line.as_flattened().iter().all(|value| value.is_finite())
}

/// A line without differences still counts in the means.
fn add_equal(tiles: &mut [Tile], width: usize) {
    for (column, tile) in tiles.iter_mut().enumerate() {
        let pixels = (width - column * TILE as usize).min(TILE as usize);
        tile.sums.values += 3 * pixels as u64;
    }
}

/// Adds a pixel; false if it is not finite.
fn add_pixel(tile: &mut Tile, reference: [f32; 3], test: [f32; 3]) -> bool {
    if !reference.iter().chain(&test).all(|value| value.is_finite()) {
        return false;
    }
    tile.sums.values += 3;
    for (a, b) in reference.into_iter().zip(test) {
        let (a, b) = (f64::from(a), f64::from(b));
        let difference = b - a;
        let squared = difference * difference;
        tile.signed += difference;
        tile.sums.absolute += difference.abs();
        tile.sums.squared += squared;
        tile.sums.relative += squared / (a * a + NEAR_BLACK);
        tile.sums.mean_relative += squared / ((a + NEAR_BLACK) * (a + NEAR_BLACK));
    }
    true
}

fn count_non_finite(count: &mut NonFinite, reference: [f32; 3], test: [f32; 3], at: [u32; 2]) {
    let finite = |pixel: [f32; 3]| pixel.iter().all(|value| value.is_finite());
    count.reference += u64::from(!finite(reference));
    count.test += u64::from(!finite(test));
    let alike = |(a, b): (f32, f32)| a == b || (a.is_nan() && b.is_nan());
    count.apart += u64::from(!reference.into_iter().zip(test).all(alike));
    count.first = count.first.or(Some(at));
}

fn tile_error(pair: &Pair, column: u32, rows: &std::ops::Range<u32>, tile: &Tile) -> TileError {
    let values = tile.sums.values.max(1) as f64;
    let (x, y) = (pair.region.x0, pair.region.y0);
    TileError {
        rect: Rect {
            x0: x + column * TILE,
            y0: y + rows.start,
            x1: x + ((column + 1) * TILE).min(pair.width()),
            y1: y + rows.end,
        },
        rmse: (tile.sums.squared / values).sqrt(),
        difference: tile.signed / values,
    }
}
