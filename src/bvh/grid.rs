//! Boxes on a grid of 16 bits an axis, rounded outwards.

use super::bounds::Bounds;
use glam::{DVec3, Vec3};

/// Number of the last grid line.
const LAST: f64 = 65535.0;

/// The grid over what a tree holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Where line 0 of each axis is.
    pub lower: Vec3,
    /// From one line to the next.
    pub cell: Vec3,
}

impl Grid {
    /// A grid whose first and last lines enclose the bounds.
    pub fn over(bounds: &Bounds) -> Self {
        let lower = if bounds.lower.is_finite() {
            bounds.lower
        } else {
            Vec3::ZERO
        };
        let cell = |axis: usize| {
            let (low, high) = (f64::from(lower[axis]), f64::from(bounds.upper[axis]));
            let mut cell = (((high - low) / LAST) as f32).max(f32::MIN_POSITIVE);
            while low + LAST * f64::from(cell) < high {
                cell = cell.next_up();
            }
            cell
        };
        Self {
            lower,
            cell: Vec3::from_array(std::array::from_fn(cell)),
        }
    }

    /// Where a line lies.
    fn line(&self, axis: usize, number: f64) -> f64 {
        f64::from(self.lower[axis]) + number * f64::from(self.cell[axis])
    }

    /// The lines around a box: for each axis the lower in the low half of a word, the upper in the high.
    pub fn enclose(&self, bounds: &Bounds) -> [u32; 3] {
        std::array::from_fn(|axis| {
            let (low, high) = (f64::from(bounds.lower[axis]), f64::from(bounds.upper[axis]));
            let at = |x: f64| (x - f64::from(self.lower[axis])) / f64::from(self.cell[axis]);
            let (mut first, mut last) = (
                at(low).floor().clamp(0.0, LAST),
                at(high).ceil().clamp(0.0, LAST),
            );
            // The division above is rounded, and the line may lie just inside.
            while first > 0.0 && self.line(axis, first) > low {
                first -= 1.0;
            }
            while last < LAST && self.line(axis, last) < high {
                last += 1.0;
            }
            first as u32 | (last as u32) << 16
        })
    }

    /// The box that three words stand for, exactly.
    pub fn decode(&self, words: [u32; 3]) -> (DVec3, DVec3) {
        let corner = |shift: u32| {
            DVec3::from_array(std::array::from_fn(|axis| {
                self.line(axis, f64::from(words[axis] >> shift & 0xffff))
            }))
        };
        (corner(0), corner(16))
    }
}
