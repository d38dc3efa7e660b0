//! What any image file holds, lampray's own or another program's, as far as comparing needs it.

use super::Record;

/// A decoded image; all pixels row-major from the top left, channels R, G, B.
#[derive(Clone, Debug)]
pub struct Raster {
    pub width: u32,
    pub height: u32,
    /// Left and top of an EXR's data window, which may be negative; `[0, 0]` for a PNG.
    pub origin: [i32; 2],
    pub pixels: Pixels,
    /// Present where the file says how noisy it is.
    pub noise: Option<Noise>,
    /// Present in files that lampray wrote.
    pub record: Option<Record>,
    /// For people: "PNG, 8 bits", "EXR, half, PIZ".
    pub format: String,
    /// What of the file was left aside, for people: "alpha", "layers diffuse.R, diffuse.G and 4 more".
    pub left_aside: Vec<String>,
}

/// Pixels as the file stores them: encoded values are decoded line by line, when they are asked for.
#[derive(Clone, Debug)]
pub enum Pixels {
    /// Linear light.
    Linear(Vec<[f32; 3]>),
    Bytes(Vec<[u8; 3]>, Transfer),
    Words(Vec<[u16; 3]>, Transfer),
}

/// How the stored values of an image stand for light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transfer {
    /// IEC 61966-2-1, what a PNG without a word on it is taken for.
    Srgb,
    /// Stored = light^(1 / exponent).
    Power(f64),
}

impl Transfer {
    /// Light, 0..1, of a stored value, 0..1.
    pub fn decode(self, stored: f64) -> f64 {
        match self {
            Transfer::Srgb if stored <= 0.04045 => stored / 12.92,
            Transfer::Srgb => libm::pow((stored + 0.055) / 1.055, 2.4),
            Transfer::Power(exponent) => libm::pow(stored, exponent),
        }
    }
}

/// How sure each pixel is.
#[derive(Clone, Debug)]
pub struct Noise {
    /// Sample variance of one path's radiance.
    pub variance: Vec<[f32; 3]>,
    /// Samples taken, whole numbers.
    pub samples: Vec<f32>,
}

impl Raster {
    /// Number of pixels.
    pub fn len(&self) -> usize {
        self.width as usize * self.height as usize
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
