//! What an image file holds.

use super::{Curve, Noise, Pixels, Raster, Record, Transfer};
use crate::knobs::Encoding;
use crate::pack::Feature;

/// A finished picture; all pixels row-major from the top left, channels R, G, B.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    /// Mean radiance, linear.
    pub mean: Vec<[f32; 3]>,
    /// Sample variance of one path's radiance; of randomisations, what their means say it would be. Divided by
    /// `samples` it is the squared standard error of the mean. This and `samples` are empty where the record says that
    /// the picture was denoised.
    pub variance: Vec<[f32; 3]>,
    /// Samples taken; whole numbers.
    pub samples: Vec<f32>,
    pub features: Option<Features>,
    pub record: Record,
    /// The scene file's text, for rendering again.
    pub scene_text: Option<String>,
}

impl Picture {
    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Why the picture cannot be written, if it cannot: a plane of another length.
    pub(super) fn fault(&self) -> Option<String> {
        let features = self.features.iter().flat_map(Features::lengths);
        let noise = [self.variance.len(), self.samples.len()];
        let noise = noise.into_iter().filter(|_| self.record.denoised.is_none());
        let lengths = noise.chain([self.mean.len()]);
        let pixels = self.pixels();
        let wrong = lengths.chain(features).find(|length| *length != pixels);
        wrong.map(|length| format!("a plane has {length} pixels, the picture has {pixels}"))
    }

    /// The picture as reading its EXR gives it.
    pub fn raster(&self) -> Raster {
        Raster {
            pixels: Pixels::Linear(self.mean.clone()),
            noise: self.record.denoised.is_none().then(|| Noise {
                variance: self.variance.clone(),
                samples: self.samples.clone(),
            }),
            ..self.bare_raster()
        }
    }

    /// The picture as reading its PNG gives it.
    pub fn encoded_raster(&self) -> Raster {
        let curve = Curve::of(&self.record);
        let gain = curve.gain();
        let encode = |rgb: &[f32; 3]| rgb.map(|value| curve.encode(f64::from(value) * gain));
        let transfer = match curve.encoding {
            Encoding::Srgb => Transfer::Srgb,
            Encoding::Gamma22 => Transfer::Power(2.2),
        };
        let bytes = self.mean.iter().map(encode).collect();
        Raster {
            pixels: Pixels::Bytes(bytes, transfer),
            ..self.bare_raster()
        }
    }

    fn bare_raster(&self) -> Raster {
        Raster {
            width: self.width,
            height: self.height,
            origin: [0, 0],
            pixels: Pixels::Linear(Vec::new()),
            noise: None,
            record: Some(self.record.clone()),
            format: "rendered".into(),
            left_aside: Vec::new(),
        }
    }

    /// Samples of a pixel, exactly: f32 counts above 2^24 are rounded, the record's is not.
    pub(super) fn count(&self, pixel: usize) -> u64 {
        let rounded = self.samples[pixel];
        if rounded == self.record.samples as f32 {
            self.record.samples
        } else {
            rounded as u64
        }
    }
}

/// One of the layers that `--aov` adds to an EXR.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, clap::ValueEnum)]
pub enum Aov {
    /// Unit normal facing the camera
    Normal,
    /// Distance from the camera, scene units
    Depth,
    /// Reflectance
    Albedo,
    /// Number of the primitive: 0 for none, then spheres, then boxes
    Id,
}

/// What the rays through the pixels' centres meet first: the layers that were asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Features {
    pub normal: Option<Vec<[f32; 3]>>,
    pub depth: Option<Vec<f32>>,
    pub albedo: Option<Vec<[f32; 3]>>,
    /// Whole numbers up to 2^24, which f32 holds exactly.
    pub id: Option<Vec<f32>>,
}

impl Features {
    /// Keeps the layers that were asked for; `None` if that is none.
    pub fn new(pixels: &[Feature], asked: &[Aov]) -> Option<Features> {
        let mut features = Features::default();
        for aov in asked {
            match aov {
                Aov::Normal => features.normal = plane(pixels, |pixel| pixel.normal),
                Aov::Depth => features.depth = plane(pixels, |pixel| pixel.depth),
                Aov::Albedo => features.albedo = plane(pixels, |pixel| pixel.albedo),
                Aov::Id => features.id = plane(pixels, |pixel| pixel.id as f32),
            }
        }
        features.some()
    }

    /// `None` where there is no layer at all.
    pub(super) fn some(self) -> Option<Features> {
        (self != Features::default()).then_some(self)
    }

    /// The layers that both hold with the same bits.
    pub(super) fn common(self, other: Option<&Features>) -> Option<Features> {
        let other = other?;
        let common = Features {
            normal: self
                .normal
                .filter(|plane| same(plane, other.normal.as_ref())),
            depth: self.depth.filter(|plane| same(plane, other.depth.as_ref())),
            albedo: self
                .albedo
                .filter(|plane| same(plane, other.albedo.as_ref())),
            id: self.id.filter(|plane| same(plane, other.id.as_ref())),
        };
        common.some()
    }

    fn lengths(&self) -> impl Iterator<Item = usize> {
        let triples = [self.normal.as_ref(), self.albedo.as_ref()]
            .into_iter()
            .flatten();
        let singles = [self.depth.as_ref(), self.id.as_ref()]
            .into_iter()
            .flatten();
        triples.map(Vec::len).chain(singles.map(Vec::len))
    }
}

fn plane<T>(pixels: &[Feature], value: impl Fn(&Feature) -> T) -> Option<Vec<T>> {
    Some(pixels.iter().map(value).collect())
}

/// Compares bits, so that a NaN does not make a plane differ from itself.
fn same<T: bytemuck::NoUninit>(plane: &[T], other: Option<&Vec<T>>) -> bool {
    other.is_some_and(|other| {
        bytemuck::cast_slice::<T, u8>(plane) == bytemuck::cast_slice::<T, u8>(other)
    })
}
