//! Two images of one size, side by side.

use super::Lines;
use super::records::{Kinship, kinship};
use crate::error::{Error, Result};
use crate::film::{Noise, Pixels, Raster, RasterFile};
use crate::pack::Rect;
use crate::wording::named;
use std::path::Path;

/// A reference and a test, of one size. Tests are judged by how far they are from references.
#[derive(Clone, Debug)]
pub struct Pair {
    pub reference: Raster,
    pub test: Raster,
    /// The part of the files that is compared, in their own pixels.
    pub region: Rect,
}

impl Pair {
    /// Reads both files, at the same time; `crop` takes a part of both.
    ///
    /// # Errors
    /// [`Error::Input`] or [`Error::Data`] for a file that cannot be read; [`Error::Data`] for two
    /// sizes, which is said before either is decoded; [`Error::Usage`] for a crop that is not inside.
    pub fn read(reference: &Path, test: &Path, crop: Option<Rect>) -> Result<Self> {
        let files = [RasterFile::open(reference)?, RasterFile::open(test)?];
        let [first, second] = [0, 1].map(|file: usize| (files[file].width(), files[file].height()));
        if first != second {
            return Err(Error::Data {
                path: test.into(),
                reason: format!(
                    "{} x {} pixels, but {} has {} x {}: only pictures of one size can be compared",
                    second.0,
                    second.1,
                    named(reference),
                    first.0,
                    first.1
                ),
            });
        }
        let [reference, test] = files;
        let (reference, test) = rayon::join(|| reference.read(), || test.read());
        Self::new(reference?, test?, crop)
    }

    /// Two images that are in memory already.
    ///
    /// # Errors
    /// [`Error::Usage`] for images of two sizes, or a crop that is not inside.
    pub fn new(reference: Raster, test: Raster, crop: Option<Rect>) -> Result<Self> {
        let size = (reference.width, reference.height);
        if size != (test.width, test.height) {
            return Err(Error::Usage("the pictures have two sizes".into()));
        }
        let whole = Rect {
            x0: 0,
            y0: 0,
            x1: size.0,
            y1: size.1,
        };
        let region = crop.unwrap_or(whole);
        if region == whole {
            return Ok(Self {
                reference,
                test,
                region,
            });
        }
        if region.x0 >= region.x1
            || region.y0 >= region.y1
            || region.x1 > size.0
            || region.y1 > size.1
        {
            return Err(Error::Usage(format!(
                "--crop: the pictures are {} x {}, and {},{},{},{} is not a part of that",
                size.0, size.1, region.x0, region.y0, region.x1, region.y1
            )));
        }
        Ok(Self {
            reference: cropped(reference, region),
            test: cropped(test, region),
            region,
        })
    }

    /// What the two records say of each other, where both files have one.
    pub fn kinship(&self) -> Option<Kinship> {
        let (reference, test) = (self.reference.record.as_ref()?, self.test.record.as_ref()?);
        Some(kinship(reference, test))
    }

    pub fn width(&self) -> u32 {
        self.reference.width
    }

    pub fn height(&self) -> u32 {
        self.reference.height
    }

    /// Number of pixels that are compared.
    pub fn len(&self) -> usize {
        self.reference.len()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether either picture can hold light beyond white.
    pub fn is_high_dynamic_range(&self) -> bool {
        [&self.reference, &self.test]
            .iter()
            .any(|image| matches!(image.pixels, Pixels::Linear(_)))
    }
}

fn cropped(image: Raster, region: Rect) -> Raster {
    let width = image.width as usize;
    let pixels = match image.pixels {
        Pixels::Linear(values) => Pixels::Linear(part(&values, width, region)),
        Pixels::Bytes(values, transfer) => Pixels::Bytes(part(&values, width, region), transfer),
        Pixels::Words(values, transfer) => Pixels::Words(part(&values, width, region), transfer),
    };
    let noise = image.noise.map(|noise| Noise {
        variance: part(&noise.variance, width, region),
        samples: part(&noise.samples, width, region),
    });
    Raster {
        width: region.width(),
        height: region.height(),
        pixels,
        noise,
        ..image
    }
}

/// The values of a rectangle, row by row.
pub(crate) fn part<T: Copy>(values: &[T], width: usize, region: Rect) -> Vec<T> {
    let rows = values
        .chunks_exact(width)
        .take(region.y1 as usize)
        .skip(region.y0 as usize);
    rows.flat_map(|row| &row[region.x0 as usize..region.x1 as usize])
        .copied()
        .collect()
}

/// An image in linear light.
pub struct Linear<'a>(pub &'a Raster);

impl Lines for Linear<'_> {
    fn width(&self) -> u32 {
        self.0.width
    }

    fn height(&self) -> u32 {
        self.0.height
    }

    fn line(&self, y: u32, out: &mut [[f32; 3]]) {
        self.0.linear_line(y, out);
    }
}

/// An image as a screen shows it: sRGB values, 0..1.
pub struct Display<'a> {
    pub image: &'a Raster,
    /// What light is multiplied by before.
    pub gain: f32,
}

impl Lines for Display<'_> {
    fn width(&self) -> u32 {
        self.image.width
    }

    fn height(&self) -> u32 {
        self.image.height
    }

    fn line(&self, y: u32, out: &mut [[f32; 3]]) {
        self.image.display_line(y, self.gain, out);
    }
}
