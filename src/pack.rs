//! What goes to and comes from a device, as flat `#[repr(C)]` values.

use bytemuck::{Pod, Zeroable};

/// What a device measured of one pixel over one run of samples.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Tally {
    /// Mean radiance of the run's samples, R, G, B.
    pub mean: [f32; 3],
    /// Rays traced, shadow rays included.
    pub rays: u32,
    /// Sum over the run's samples of the squared distance from that mean, R, G, B.
    pub squares: [f32; 3],
    /// Samples of the run whose radiance was not finite; they count as black.
    /// Low 16 bits: how many. High 16 bits: the place in the run of the first of them.
    pub non_finite: u32,
}

/// What the ray through a pixel's centre meets first.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Feature {
    /// Unit normal facing the camera; zero where nothing is met.
    pub normal: [f32; 3],
    /// Distance in scene units; zero where nothing is met.
    pub depth: f32,
    /// Reflectance, R, G, B.
    pub albedo: [f32; 3],
    /// 0 where nothing is met, then the spheres from 1 on, then the boxes.
    pub id: u32,
}

/// A rectangle of pixels; `x1` and `y1` are one past its last column and row, y grows downwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
}
