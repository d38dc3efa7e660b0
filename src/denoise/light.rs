//! Between a picture's pixels and light before albedo.

use crate::film::Picture;
use crate::pack::Estimate;
use glam::Vec3;
use rayon::prelude::*;

/// No variance is larger: sums of some, and their squares' weights, stay finite.
const MOST: f32 = 1e30;

/// Light and its variance, for every pixel.
pub(super) fn estimates(picture: &Picture, shades: &[[f32; 3]]) -> Vec<Estimate> {
    let everywhere = Vec3::from(picture.record.mean.map(|value| value as f32));
    let estimate = |pixel: usize| {
        let (mean, shade) = (Vec3::from(picture.mean[pixel]), Vec3::from(shades[pixel]));
        let light = finite(mean / shade);
        let count = picture.samples[pixel];
        // One sample says nothing of its noise: it is as uncertain as it, and what is around it, is bright.
        let squares = match count < 2.0 {
            true => (light + finite(everywhere / shade)).powf(2.0),
            false => Vec3::from(picture.variance[pixel]) / count / (shade * shade),
        };
        let variance = squares.max(Vec3::ZERO).element_sum() / 3.0;
        Estimate {
            light: light.to_array(),
            // Of no number nothing is known, and the neighbours' is taken.
            variance: if variance.is_nan() {
                0.0
            } else {
                variance.min(MOST)
            },
        }
    };
    (0..picture.pixels())
        .into_par_iter()
        .map(estimate)
        .collect()
}

/// A pixel that is not finite takes part in nothing, whatever stands here for it.
fn finite(light: Vec3) -> Vec3 {
    if light.is_finite() { light } else { Vec3::ZERO }
}

/// The picture's mean radiance with what changed of the light; a pixel whose light did not keeps its bits.
pub(super) fn means(
    picture: &Picture,
    shades: &[[f32; 3]],
    smoothed: &[Estimate],
) -> Vec<[f32; 3]> {
    let mean = |pixel: usize| {
        let (mean, shade) = (Vec3::from(picture.mean[pixel]), Vec3::from(shades[pixel]));
        let change = Vec3::from(smoothed[pixel].light) - finite(mean / shade);
        // A weighted mean of what is not negative is not, but for rounding.
        let changed = (mean + shade * change).max(mean.min(Vec3::ZERO));
        if change == Vec3::ZERO {
            mean.to_array()
        } else {
            changed.to_array()
        }
    };
    (0..picture.pixels()).into_par_iter().map(mean).collect()
}

/// Mean over pixels; what is no number counts as nothing.
pub(super) fn mean_of(pixels: &[[f32; 3]]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for pixel in pixels {
        for (sum, value) in sums.iter_mut().zip(pixel) {
            *sum += f64::from(if value.is_finite() { *value } else { 0.0 });
        }
    }
    sums.map(|sum| sum / pixels.len().max(1) as f64)
}
