//! What decides how many samples each part of a picture gets: samples that are not in the picture.

use super::Film;
use crate::pack::Rect;
use serde::{Deserialize, Serialize};

/// Index of the first sample that decides: every sample of a picture has a smaller one.
pub const SCOUTS: u64 = 1 << 63;
/// Pixels along a side of a tile, all of which get the same number of samples.
pub const TILE: u32 = 16;

/// Samples that decide, and what they have decided so far; plain data, as a [`Film`] is.
///
/// Tiles are [`TILE`] pixels wide and high, those at the right and lower edges less, and counted row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Scouts {
    pub film: Film,
    /// Scouts of each pixel of a tile that were asked for.
    pub asked: Vec<u64>,
    /// Samples of each pixel of a tile that the picture gets; empty before that is known.
    pub wanted: Vec<u64>,
}

/// What a record says of adaptive sampling.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AdaptiveRecord {
    /// The rule that shares out the samples: `scouts`.
    pub rule: String,
    /// Pixels along a side of a tile.
    pub tile: u32,
    /// The samples that a pixel could have had, from the first on, up to and without the second; of a picture that
    /// was merged those of each part.
    pub allowed: Vec<[u64; 2]>,
    /// Samples that decided and are not in the picture, over all pixels; beyond the record's `paths`.
    pub scout_paths: u64,
    /// Their rays, shadow rays included; beyond the record's `rays`.
    pub scout_rays: u64,
    /// Those of them that were not finite.
    pub scout_non_finite: u64,
}

/// The tiles of a rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tiles {
    width: usize,
    height: usize,
}

impl Tiles {
    pub fn of(region: Rect) -> Self {
        Self {
            width: region.width() as usize,
            height: region.height() as usize,
        }
    }

    fn side() -> usize {
        TILE as usize
    }

    /// Number of tiles.
    pub fn count(&self) -> usize {
        self.width.div_ceil(Self::side()) * self.height.div_ceil(Self::side())
    }

    /// The tile of a pixel, which is counted row by row in the rectangle.
    pub fn of_pixel(&self, pixel: usize) -> usize {
        let (x, y) = (pixel % self.width, pixel / self.width);
        y / Self::side() * self.width.div_ceil(Self::side()) + x / Self::side()
    }
}

impl Scouts {
    /// None has been taken, and `first` of each pixel are asked for.
    pub fn new(region: Rect, first: u64) -> Self {
        Self {
            film: Film::new(region),
            asked: vec![first; Tiles::of(region).count()],
            wanted: Vec::new(),
        }
    }
}
