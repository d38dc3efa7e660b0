//! What a metric takes and what it gives.

/// A picture that is asked for line by line, from any thread and in any order.
pub trait Lines: Sync {
    fn width(&self) -> u32;
    fn height(&self) -> u32;
    /// Fills `out`, as long as the picture is wide, with R, G, B of line `y`, counted from the top.
    /// What the values stand for, the metric says that asks for them.
    fn line(&self, y: u32, out: &mut [[f32; 3]]);
}

/// One value for each pixel, row-major from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    pub width: u32,
    pub height: u32,
    pub values: Vec<f32>,
}

impl Map {
    /// Mean of all values, summed in f64; 0 for a map without pixels.
    pub fn mean(&self) -> f64 {
        let sum: f64 = self.values.iter().map(|&value| f64::from(value)).sum();
        sum / self.values.len().max(1) as f64
    }
}
