//! Rectangles of pixels.

/// A rectangle of pixels; `x1` and `y1` are one past its last column and row, y grows downwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Rect {
    pub x0: u32,
    pub y0: u32,
    pub x1: u32,
    pub y1: u32,
}

impl Rect {
    pub fn width(&self) -> u32 {
        self.x1 - self.x0
    }

    pub fn height(&self) -> u32 {
        self.y1 - self.y0
    }

    /// Number of pixels.
    pub fn area(&self) -> usize {
        self.width() as usize * self.height() as usize
    }

    /// One of its pixels, counted row by row.
    pub fn pixel(&self, index: usize) -> Self {
        let width = self.width() as usize;
        let (x0, y0) = (
            self.x0 + (index % width) as u32,
            self.y0 + (index / width) as u32,
        );
        Self {
            x0,
            y0,
            x1: x0 + 1,
            y1: y0 + 1,
        }
    }
}
