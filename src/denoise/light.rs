//! Between a picture's pixels and light before albedo.

use crate::cpu::denoise::luminance;
use crate::film::Picture;
use crate::pack::Estimate;
use glam::Vec3;
use rayon::prelude::*;

/// Rec. 709.
const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];
/// No variance is larger: sums of some, and their squares' weights, stay finite.
const MOST: f32 = 1e30;

/// Light and the variance of its luminance, for every pixel.
///
/// Channels of a path rise and fall together, so their standard errors are added; that is right or too much.
pub(super) fn estimates(picture: &Picture, shades: &[[f32; 3]]) -> Vec<Estimate> {
    let everywhere = picture.record.mean.map(|value| value as f32);
    let estimate = |pixel: usize| {
        let (mean, shade) = (Vec3::from(picture.mean[pixel]), Vec3::from(shades[pixel]));
        let light = finite(mean / shade);
        let count = picture.samples[pixel];
        let error = |channel: usize| {
            let variance = picture.variance[pixel][channel] / count;
            LUMINANCE[channel] * variance.max(0.0).sqrt() / shade[channel]
        };
        // One sample says nothing of its noise: it is as uncertain as it, and what is around it, is bright.
        let error = match count < 2.0 {
            true => luminance(light) + luminance(finite(Vec3::from(everywhere) / shade)),
            false => error(0) + error(1) + error(2),
        };
        Estimate {
            light: light.to_array(),
            variance: (error * error).min(MOST),
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

/// Mean over pixels.
pub(super) fn mean_of(pixels: &[[f32; 3]]) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for pixel in pixels {
        for (sum, value) in sums.iter_mut().zip(pixel) {
            *sum += f64::from(*value);
        }
    }
    sums.map(|sum| sum / pixels.len().max(1) as f64)
}
