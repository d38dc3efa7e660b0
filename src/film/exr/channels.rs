//! The names of an EXR's channels, for writing and for reading.

use crate::film::Picture;

pub(super) const MEAN: [&str; 3] = ["R", "G", "B"];
pub(super) const VARIANCE: [&str; 3] = ["variance.R", "variance.G", "variance.B"];
pub(super) const SAMPLES: &str = "samples";
pub(super) const NORMAL: [&str; 3] = ["normal.X", "normal.Y", "normal.Z"];
pub(super) const DEPTH: &str = "depth.Z";
pub(super) const ALBEDO: [&str; 3] = ["albedo.R", "albedo.G", "albedo.B"];
pub(super) const ID: &str = "id";

/// Without these a picture cannot be read.
pub(super) const REQUIRED: [&str; 7] = [
    MEAN[0],
    MEAN[1],
    MEAN[2],
    VARIANCE[0],
    VARIANCE[1],
    VARIANCE[2],
    SAMPLES,
];

/// Whether lampray writes a channel of this name.
pub(super) fn is_known(name: &str) -> bool {
    let features = NORMAL.iter().chain(&ALBEDO).chain([&DEPTH, &ID]);
    REQUIRED.iter().chain(features).any(|known| *known == name)
}

/// The values of one channel, one a pixel.
pub(super) enum Plane<'a> {
    /// One of three interleaved values.
    Of(&'a [[f32; 3]], usize),
    Single(&'a [f32]),
}

impl Plane<'_> {
    pub(super) fn value(&self, pixel: usize) -> f32 {
        match self {
            Plane::Of(pixels, channel) => pixels[pixel][*channel],
            Plane::Single(pixels) => pixels[pixel],
        }
    }
}

/// Every channel of a picture, sorted by name as EXR demands.
pub(super) fn planes(picture: &Picture) -> Vec<(&'static str, Plane<'_>)> {
    let mut planes: Vec<_> = triple(MEAN, &picture.mean).collect();
    // What was denoised is no mean of samples: how they vary says nothing of its error.
    if picture.record.denoised.is_none() {
        planes.push((SAMPLES, Plane::Single(&picture.samples)));
        planes.extend(triple(VARIANCE, &picture.variance));
    }
    if let Some(features) = &picture.features {
        planes.extend(
            features
                .normal
                .iter()
                .flat_map(|plane| triple(NORMAL, plane)),
        );
        planes.extend(
            features
                .albedo
                .iter()
                .flat_map(|plane| triple(ALBEDO, plane)),
        );
        planes.extend(
            features
                .depth
                .iter()
                .map(|plane| (DEPTH, Plane::Single(plane))),
        );
        planes.extend(features.id.iter().map(|plane| (ID, Plane::Single(plane))));
    }
    planes.sort_by_key(|(name, _)| *name);
    planes
}

fn triple<'a>(
    names: [&'static str; 3],
    pixels: &'a [[f32; 3]],
) -> impl Iterator<Item = (&'static str, Plane<'a>)> {
    names
        .into_iter()
        .enumerate()
        .map(move |(channel, name)| (name, Plane::Of(pixels, channel)))
}
