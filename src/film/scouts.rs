//! What decides how many samples each part of a picture gets: samples that are not in the picture.

use super::Film;
use crate::pack::Rect;
use serde::{Deserialize, Serialize};

/// Index of the first sample that decides: every sample of a picture has a smaller one.
pub const SCOUTS: u64 = 1 << 63;
/// Pixels along a side of the smallest tiles.
const SMALLEST: u32 = 16;
/// Tiles that there are at most: in large pictures they are larger, so that the pixels of one keep a device busy.
const MOST: usize = 1024;

/// Samples that decide, and what they have decided so far; plain data, as a [`Film`] is.
#[derive(Clone, Debug, PartialEq)]
pub struct Scouts {
    pub film: Film,
    /// Scouts of each pixel that were asked for.
    pub asked: u64,
    /// How far the tile that gets the most has climbed: see `render/adaptive`.
    pub rung: u64,
    /// Samples that each pixel of a tile is to have by now.
    pub wanted: Vec<u64>,
}

/// What a record says of adaptive sampling.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AdaptiveRecord {
    /// The rule that shares out the samples: `shape`.
    pub rule: String,
    /// Pixels along a side of a tile.
    pub tile: u32,
    /// The samples that a pixel could have had, from the first on, up to and without the second; of a picture that
    /// was merged those of each part, or those that it took where a part gave each pixel the same number.
    pub allowed: Vec<[u64; 2]>,
    /// Samples that decided and are not in the picture, over all pixels; beyond the record's `paths`.
    pub scout_paths: u64,
    /// Their rays, shadow rays included; beyond the record's `rays`.
    pub scout_rays: u64,
    /// Those of them that were not finite.
    pub scout_non_finite: u64,
}

/// The tiles of a rectangle of pixels, all pixels of each of which get the same number of samples. They are squares,
/// cut at the right and lower edges, and counted row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tiles {
    width: usize,
    height: usize,
    side: usize,
}

impl Tiles {
    pub fn of(region: Rect) -> Self {
        let of_side = |side: u32| Self {
            width: region.width() as usize,
            height: region.height() as usize,
            side: side as usize,
        };
        let mut side = SMALLEST;
        while of_side(side).count() > MOST {
            side *= 2;
        }
        of_side(side)
    }

    /// Pixels along a side.
    pub fn side(&self) -> u32 {
        self.side as u32
    }

    /// Number of tiles.
    pub fn count(&self) -> usize {
        self.width.div_ceil(self.side) * self.height.div_ceil(self.side)
    }

    /// The tile of a pixel, which is counted row by row in the rectangle.
    pub fn of_pixel(&self, pixel: usize) -> usize {
        let (x, y) = (pixel % self.width, pixel / self.width);
        y / self.side * self.width.div_ceil(self.side) + x / self.side
    }
}

impl Scouts {
    /// None has been asked for, and every pixel is to have `least` samples.
    pub fn new(region: Rect, least: u64) -> Self {
        Self {
            film: Film::new(region),
            asked: 0,
            rung: 0,
            wanted: vec![least; Tiles::of(region).count()],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pictures_have_large_tiles() {
        let tiles = |x1, y1| {
            Tiles::of(Rect {
                x0: 0,
                y0: 0,
                x1,
                y1,
            })
        };
        let of = |x1, y1| (tiles(x1, y1).side(), tiles(x1, y1).count());
        assert_eq!(of(1, 1), (16, 1));
        assert_eq!(of(17, 16), (16, 2));
        assert_eq!(of(512, 512), (16, 1024));
        assert_eq!(of(513, 512), (32, 272));
        assert_eq!(of(3840, 2160), (128, 510));
        assert_eq!(of(u32::MAX, 1), (1 << 22, 1024));
        assert_eq!(tiles(40, 20).of_pixel(17 * 40 + 33), 5);
    }
}
