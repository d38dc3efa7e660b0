//! Jobs of the guides kernel.

use super::{GuideJob, Packed, Rect};

/// Mirrors that guides look through at most: between two that face each other the rest is dim.
const MOST_MIRRORS: u32 = 8;

impl GuideJob {
    /// `fineness` by `fineness` rays for each pixel of `rect`, through no more mirrors than paths may take.
    pub fn new(scene: &Packed, rect: Rect, fineness: u32) -> Self {
        Self {
            camera: scene.camera,
            corner: [rect.x0, rect.y0],
            size: [rect.width() * fineness, rect.height() * fineness],
            fineness,
            mirrors: scene.max_bounces.min(MOST_MIRRORS),
            iterations: u32::MAX,
            _pad0: 0,
        }
    }

    /// One lane for each ray.
    pub fn lanes(&self) -> Rect {
        Rect {
            x0: 0,
            y0: 0,
            x1: self.size[0],
            y1: self.size[1],
        }
    }
}
