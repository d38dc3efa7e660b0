//! Between a picture's pixels and light before albedo.

use super::sites::Lit;
use crate::film::Picture;
use crate::pack::{Estimate, Site};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::ops::RangeInclusive;

/// No variance is larger: sums of some, and their squares' weights, stay finite.
const MOST: f32 = 1e30;
/// Black that is so many times as bright as black near lamps could be shows something else.
const STRANGE: f32 = 10.0;
/// Below this a shade is black: what is divided by it would be anything.
pub(super) const BLACK: f32 = 1e-3;
/// Light beyond so many units, or that is no number, takes part in nothing: sums of it would not be finite.
const BRIGHTEST: f32 = 1e30;
/// The share of pixels that are not as bright as what is near lamps. Of 0.5, 0.75, 0.9, 0.95 and 0.99 it leaves the
/// least error over the scenes of `tests/denoise/better.rs`.
const NEAR_LAMPS: f64 = 0.95;
/// Units of radiance that leave exponents of 32 bits to spare, and 1 over them, too.
const UNITS: RangeInclusive<f64> = 1e-30..=1e30;
/// The variance of fainter light is a square that 32 bits do not hold, or not well.
const FAINT: f64 = 1e-16;

/// What radiance is counted in, so that so many times the light gives so many times the picture: the light of the
/// brighter pixels where nothing is seen to shine. Then what shines is about as bright before its emission as a
/// surface near it is before its albedo. All channels have one, so that colours weigh the same in any part of a picture;
/// but one so faint that what shines in it would count as black beside the others has its own.
pub(super) fn units(picture: &Picture, lit: &Lit) -> Vec3 {
    let light = |channel: usize| {
        move |mean: &[f32; 3], shade: &[f32; 3]| {
            (shade[channel] > BLACK).then(|| f64::from(mean[channel]) / f64::from(shade[channel]))
        }
    };
    let colour = |mean: &[f32; 3], shade: &[f32; 3]| {
        let lights = [0, 1, 2].map(|channel| light(channel)(mean, shade));
        Some((lights[0]? + lights[1]? + lights[2]?) / 3.0)
    };
    // Where all is black, that of black.
    let dark = |mean: &[f32; 3], _: &[f32; 3]| Some(brightness(mean) / f64::from(BLACK));
    let common = near_lamps(picture, lit, colour).or_else(|| near_lamps(picture, lit, dark));
    let common = common.or_else(|| usual(picture));
    let common = common.unwrap_or(1.0);
    let unit = |channel: usize| {
        let means = picture.mean.iter().map(|mean| f64::from(mean[channel]));
        let own = near_lamps(picture, lit, light(channel)).or_else(|| quantile(means, 0.5));
        let own = own.filter(|own| *own < common * f64::from(BLACK));
        let unit = own.unwrap_or(common);
        unit.clamp(*UNITS.start(), *UNITS.end()) as f32
    };
    Vec3::from_array(std::array::from_fn(unit))
}

/// The light of the brighter pixels where nothing is seen to shine, from means and shades.
fn near_lamps(
    picture: &Picture,
    lit: &Lit,
    light: impl Fn(&[f32; 3], &[f32; 3]) -> Option<f64>,
) -> Option<f64> {
    let surfaces = lit.reflected.iter().zip(&lit.shining);
    let pixels = picture.mean.iter().zip(surfaces);
    let dull = pixels.filter(|(_, (_, shining))| **shining == [0.0; 3]);
    let lights = dull.filter_map(|(mean, (reflected, _))| light(mean, reflected));
    quantile(lights, NEAR_LAMPS)
}

/// Whether a picture's light is so faint that its variance, a square, is lost in 32 bits: nothing in it, or little, is
/// then taken for noise.
pub fn is_faint(picture: &Picture) -> bool {
    usual(picture).is_some_and(|radiance| radiance < FAINT)
}

/// Median radiance of the pixels that are not black.
fn usual(picture: &Picture) -> Option<f64> {
    quantile(picture.mean.iter().map(brightness), 0.5)
}

fn brightness(mean: &[f32; 3]) -> f64 {
    mean.iter().copied().map(f64::from).sum::<f64>() / 3.0
}

/// Of the numbers that are above 0; `share` is below 1.
fn quantile(values: impl Iterator<Item = f64>, share: f64) -> Option<f64> {
    let mut values: Vec<_> = values
        .filter(|value| value.is_finite() && *value > 0.0)
        .collect();
    let place = (values.len() as f64 * share) as usize;
    let order = f64::total_cmp;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(place, order).1)
}

/// What the light of each pixel was multiplied by on its last way to the eye: albedo and mirrors, or its emission in
/// units.
pub(super) fn shades(lit: &Lit, units: Vec3) -> Vec<[f32; 3]> {
    let per_unit = units.recip();
    let shade = |(reflected, shining): (&[f32; 3], &[f32; 3])| {
        let shining = (Vec3::from(*shining) * per_unit).min(Vec3::splat(BRIGHTEST));
        let shade = Vec3::from(*reflected) + shining;
        shade.max(Vec3::splat(BLACK)).to_array()
    };
    lit.reflected.iter().zip(&lit.shining).map(shade).collect()
}

/// Marks the sites of light that is no number, or too bright: also for black, as where some paths met a lamp or a wall
/// between the rays of the guides. Divided by black it would be light that is nowhere.
pub(super) fn leave_out(picture: &Picture, units: Vec3, shades: &[[f32; 3]], sites: &mut [Site]) {
    let per_unit = units.recip();
    let pixels = picture.mean.iter().zip(shades);
    for (site, (mean, shade)) in sites.iter_mut().zip(pixels) {
        let light = Vec3::from(*mean).abs() * per_unit;
        let valid = light.cmple(Vec3::splat(BRIGHTEST)).all();
        let black = Vec3::from(*shade).cmple(Vec3::splat(BLACK));
        let strange = black & light.cmpgt(Vec3::splat(STRANGE * BLACK));
        if !valid || strange.any() {
            site.spread = -1.0;
        }
    }
}

/// Light and its variance, for every pixel, in the units and their squares.
pub(super) fn estimates(picture: &Picture, units: Vec3, shades: &[[f32; 3]]) -> Vec<Estimate> {
    let per_unit = units.recip();
    let everywhere = DVec3::from(picture.record.mean) * per_unit.as_dvec3();
    let everywhere = everywhere.as_vec3();
    let estimate = |pixel: usize| {
        let (mean, shade) = (Vec3::from(picture.mean[pixel]), Vec3::from(shades[pixel]));
        let light = finite(mean * per_unit / shade);
        let count = picture.samples[pixel];
        // One sample says nothing of its noise: it is as uncertain as it, and what is around it, is bright.
        let squares = match count < 2.0 {
            true => (light + finite(everywhere / shade)).powf(2.0),
            // One factor at a time: the square of the unit may be more than 32 bits hold.
            false => {
                let variance = Vec3::from(picture.variance[pixel]) * per_unit * per_unit;
                variance / count / (shade * shade)
            }
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
    units: Vec3,
    shades: &[[f32; 3]],
    smoothed: &[Estimate],
) -> Vec<[f32; 3]> {
    let mean = |pixel: usize| {
        let (mean, shade) = (Vec3::from(picture.mean[pixel]), Vec3::from(shades[pixel]));
        let change = Vec3::from(smoothed[pixel].light) - finite(mean * units.recip() / shade);
        // A weighted mean of what is not negative is not, but for rounding.
        let changed = (mean + shade * change * units).max(mean.min(Vec3::ZERO));
        if change == Vec3::ZERO || !changed.is_finite() {
            mean.to_array()
        } else {
            changed.to_array()
        }
    };
    (0..picture.pixels()).into_par_iter().map(mean).collect()
}

/// Pixels of one sample: nothing is known of their variance.
pub(super) fn of_unknown_variance(picture: &Picture) -> u64 {
    let counts = picture.samples.iter();
    counts.filter(|count| **count < 2.0).count() as u64
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
