//! Where the blocks of a part lie.

use super::part::Part;
use exr::math::Vec2;
use exr::meta::attribute::TileDescription;
use exr::meta::{BlockDescription, compute_chunk_count};

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
            Some(TileDescription { tile_size, .. }) => {
                [size[0].min(tile_size.0), size[1].min(tile_size.1)]
            }
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
pub(super) fn all_blocks(part: &Part) -> u64 {
    let size = Vec2(part.width as usize, part.height as usize);
    let blocks = match part.tiling {
        Some(tiling) => BlockDescription::Tiles(tiling),
        None => BlockDescription::ScanLines,
    };
    compute_chunk_count(part.compression, size, blocks) as u64
}
