//! Where the blocks of a part lie.

use super::part::{Part, Tiling};

/// A rectangle of pixels, counted from the left and top of the data window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub x: usize,
    pub y: usize,
    pub width: usize,
    pub height: usize,
}

/// The grid of a part's blocks, at full resolution.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// Pixels of the picture.
    size: [usize; 2],
    /// Pixels of a block that is not cut off by the right or lower edge.
    pub block: [usize; 2],
    columns: usize,
    rows: usize,
}

impl Layout {
    pub(super) fn new(part: &Part) -> Layout {
        let size = [part.width as usize, part.height as usize];
        let block = match part.tiling {
            // A tile may be larger than the picture.
            Some(tiling) => [0, 1].map(|axis| size[axis].min(tiling.size[axis] as usize)),
            None => [
                size[0],
                size[1].min(part.compression.scan_lines_per_block()),
            ],
        };
        Layout {
            size,
            block,
            columns: size[0].div_ceil(block[0]),
            rows: size[1].div_ceil(block[1]),
        }
    }

    pub(super) fn blocks(&self) -> usize {
        self.columns * self.rows
    }

    /// Number and area of a block by its column and row, if there is such a block.
    pub(super) fn block_at(&self, column: usize, row: usize) -> Option<(usize, Area)> {
        if column >= self.columns || row >= self.rows {
            return None;
        }
        let (x, y) = (column * self.block[0], row * self.block[1]);
        let area = Area {
            x,
            y,
            width: self.block[0].min(self.size[0] - x),
            height: self.block[1].min(self.size[1] - y),
        };
        Some((row * self.columns + column, area))
    }
}

/// Blocks of a part at all its resolutions.
pub(super) fn all_chunks(part: &Part) -> u64 {
    let Some(tiling) = part.tiling else {
        return Layout::new(part).blocks() as u64;
    };
    let [columns, rows] = [0, 1].map(|axis| tiles_of_levels(part, &tiling, axis));
    match tiling.levels {
        0 => columns[0] * rows[0],
        // One row after another of ever narrower levels.
        2 => columns.iter().sum::<u64>() * rows.iter().sum::<u64>(),
        _ => columns.iter().zip(&rows).map(|(c, r)| c * r).sum(),
    }
}

/// How many tiles lie side by side in one direction, level by level.
fn tiles_of_levels(part: &Part, tiling: &Tiling, axis: usize) -> Vec<u64> {
    let size = [part.width, part.height];
    // Levels that are halved in both directions go on until both sides are 1.
    let longest = match tiling.levels {
        2 => size[axis],
        _ => size[0].max(size[1]),
    };
    let halvings = match tiling.round_up {
        true => longest.next_power_of_two().ilog2(),
        false => longest.ilog2(),
    };
    let side = |level: u32| match tiling.round_up {
        true => size[axis].div_ceil(1 << level),
        false => (size[axis] >> level).max(1),
    };
    (0..=halvings)
        .map(|level| u64::from(side(level).div_ceil(tiling.size[axis])))
        .collect()
}
