//! What any image file holds, lampray's own or another program's, as far as comparing needs it.

use super::{Record, tables};
use std::ops::Range;

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
    /// Sample variance of one path's radiance: over `samples` the squared standard error of the mean.
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
    /// Linear light of one row.
    pub fn linear_line(&self, y: u32, line: &mut [[f32; 3]]) {
        let row = self.row(y);
        match &self.pixels {
            Pixels::Linear(pixels) => copy(&pixels[row], line, |value| value),
            Pixels::Bytes(pixels, transfer) => {
                let light = tables::light(*transfer, 255);
                copy(&pixels[row], line, |stored| light[usize::from(stored)]);
            }
            Pixels::Words(pixels, transfer) => {
                let light = tables::light(*transfer, 65535);
                copy(&pixels[row], line, |stored| light[usize::from(stored)]);
            }
        }
    }

    /// One row for looking at: light times `gain`, cut off at 0 and 1, encoded as sRGB, 0..1. NaN is
    /// black.
    pub fn display_line(&self, y: u32, gain: f32, line: &mut [[f32; 3]]) {
        let row = self.row(y);
        let display = tables::encoder();
        match &self.pixels {
            Pixels::Linear(pixels) => copy(&pixels[row], line, |light| display(light * gain)),
            // Stored as they are shown.
            Pixels::Bytes(pixels, Transfer::Srgb) if gain == 1.0 => {
                copy(&pixels[row], line, |stored| f32::from(stored) / 255.0);
            }
            Pixels::Words(pixels, Transfer::Srgb) if gain == 1.0 => {
                copy(&pixels[row], line, |stored| f32::from(stored) / 65535.0);
            }
            Pixels::Bytes(pixels, transfer) => {
                let light = tables::light(*transfer, 255);
                // A row has more values than there are bytes.
                let shown: Vec<f32> = light.iter().map(|light| display(light * gain)).collect();
                copy(&pixels[row], line, |stored| shown[usize::from(stored)]);
            }
            Pixels::Words(pixels, transfer) => {
                let light = tables::light(*transfer, 65535);
                let shown = |stored| display(light[usize::from(stored)] * gain);
                copy(&pixels[row], line, shown);
            }
        }
    }

    fn row(&self, y: u32) -> Range<usize> {
        let width = self.width as usize;
        let start = y as usize * width;
        start..start + width
    }
}

fn copy<T: Copy>(row: &[[T; 3]], line: &mut [[f32; 3]], value: impl Fn(T) -> f32) {
    for (to, stored) in line.iter_mut().zip(row) {
        *to = stored.map(&value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::curve::srgb;

    fn raster(width: u32, pixels: Pixels) -> Raster {
        Raster {
            width,
            height: 2,
            origin: [0, 0],
            pixels,
            noise: None,
            record: None,
            format: String::new(),
            left_aside: Vec::new(),
        }
    }

    fn lines(raster: &Raster, gain: f32) -> [Vec<f32>; 2] {
        let mut line = vec![[0.0; 3]; raster.width as usize];
        raster.linear_line(1, &mut line);
        let linear = line.as_flattened().to_vec();
        raster.display_line(1, gain, &mut line);
        [linear, line.as_flattened().to_vec()]
    }

    fn assert_near(found: &[f32], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            let distance = (f64::from(*found) - expected).abs();
            assert!(distance < 1e-6, "{found} is not {expected}");
        }
    }

    #[test]
    fn bytes_of_srgb() {
        let pixels = vec![[9; 3], [9; 3], [0, 10, 128], [188, 254, 255]];
        let raster = raster(2, Pixels::Bytes(pixels, Transfer::Srgb));
        let [linear, shown] = lines(&raster, 1.0);
        let light = |byte: f64| ((byte / 255.0 + 0.055) / 1.055).powf(2.4);
        let expected = [
            0.0,
            10.0 / 255.0 / 12.92,
            0.21586050011,
            light(188.0),
            light(254.0),
            1.0,
        ];
        assert_near(&linear, &expected);
        let stored = [0.0, 10.0, 128.0, 188.0, 254.0, 255.0].map(|byte| byte / 255.0);
        assert_eq!(shown, stored.map(|value| value as f32));
        // What is shown twice as bright is encoded anew.
        let [_, shown] = lines(&raster, 2.0);
        let twice = expected.map(|light| srgb((2.0 * light).min(1.0)));
        assert_near(&shown, &twice);
    }

    #[test]
    fn words_and_other_exponents() {
        let pixels = vec![[0, 32768, 65535]; 2];
        let stored = 32768.0 / 65535.0;
        let power = raster(1, Pixels::Words(pixels.clone(), Transfer::Power(2.2)));
        let [linear, shown] = lines(&power, 1.0);
        let light = f64::powf(stored, 2.2);
        assert_near(&linear, &[0.0, light, 1.0]);
        assert_near(&shown, &[0.0, srgb(light), 1.0]);
        let [_, shown] = lines(&raster(1, Pixels::Words(pixels, Transfer::Srgb)), 1.0);
        assert_near(&shown, &[0.0, stored, 1.0]);
        let bytes = raster(
            1,
            Pixels::Bytes(vec![[0, 128, 255]; 2], Transfer::Power(1.0)),
        );
        let [linear, shown] = lines(&bytes, 1.0);
        assert_near(&linear, &[0.0, 128.0 / 255.0, 1.0]);
        assert_near(&shown, &[0.0, srgb(128.0 / 255.0), 1.0]);
    }

    #[test]
    fn linear_values_stay_and_are_cut_off_only_for_looking() {
        let pixels = [
            [0.0; 3],
            [f32::NAN, f32::INFINITY, -2.0],
            [0.25, 0.5, 3.0],
            [0.0; 3],
        ];
        let raster = raster(2, Pixels::Linear([&pixels[2..], &pixels[1..3]].concat()));
        let [linear, shown] = lines(&raster, 0.5);
        assert!(linear[0].is_nan());
        assert_eq!(linear[1..], [f32::INFINITY, -2.0, 0.25, 0.5, 3.0]);
        assert_near(&shown, &[0.0, 1.0, 0.0, srgb(0.125), srgb(0.25), 1.0]);
    }
}
