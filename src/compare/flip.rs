//! FLIP: how strongly a person sees the difference who flips between two pictures on a screen.
//!
//! - LDR: Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020.
//! - HDR: Andersson et al., "Visualizing Errors in Rendered High Dynamic Range Images",
//!   Eurographics 2021 (short papers).
//!
//! The arithmetic of one strip is the crate `flip-rs`, version 1.7 of FLIP. Here are the strips, the
//! range of exposures and the inputs that FLIP leaves undefined.
//!
//! # Strips
//!
//! A pixel's error depends on the pixels under its filters alone. Both filters start from the picture
//! itself, so a strip with the larger of the two radii as margin above and below gives the very bits
//! of the whole picture. One thread holds one strip: about 90 bytes a pixel of it.
//!
//! # Inputs that FLIP leaves undefined
//!
//! What is not a finite number counts as 0, and so does light below 0. Light that would overflow the
//! tone curve is as white as all that the curve clips.

use super::{Lines, Map};
use crate::error::{Error, Result};
use flip_rs::{ErrorMap, FlipError, HdrOptions, RgbImage};
use rayon::prelude::*;
use std::f32::consts::PI;
use std::ops::{Range, RangeInclusive};

/// Pixels of the screen in one degree of the viewer's field: FLIP's own 67.0206, which is a screen
/// 0.7 m and 3840 pixels wide, seen from 0.7 m (distance · pixels / width · π / 180; section 3 of
/// the paper of 2020).
pub const DEFAULT_PPD: f32 = 0.7 * (3840.0 / 0.7) * (PI / 180.0);

/// The pixels per degree that can be asked for: below, the filters fall between the pixels; above, a
/// strip of a picture 17,000 pixels wide exceeds the 2^34 additions that the crate takes.
pub const PPD: RangeInclusive<f32> = 2.0..=300.0;

/// The most exposures that can be asked for.
pub const MAX_EXPOSURES: u32 = 128;

/// A strip is about that many times its margin high, so that margins cost about a quarter; less where
/// there would be fewer strips than threads.
const STRIP_MARGINS: usize = 8;

/// Where the automatic range puts white, on the tone-mapped scale (section 2.1 of the paper of 2021).
const WHITE: f64 = 0.85;

/// The tone curve (a x² + b x) / (c x² + d x + e): Narkowicz's fit of ACES with its factor of 0.6
/// taken back, FLIP's default.
const ACES: [f64; 5] = [0.36 * 2.51, 0.6 * 0.03, 0.36 * 2.43, 0.6 * 0.59, 0.14];

/// The exposures at which pictures of high dynamic range are compared: `count` of them, evenly from
/// `start` to `stop`, both included; `count` 1 is `start` alone.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Exposures {
    /// Stops: light is multiplied by 2^start.
    pub start: f32,
    /// Stops, not below `start`.
    pub stop: f32,
    /// 1 to [`MAX_EXPOSURES`].
    pub count: u32,
}

impl Exposures {
    /// The range that FLIP 1.7 takes from a reference in linear light: from the exposure that maps
    /// its greatest luminance to 0.85 to the one that maps its median luminance there, in steps of
    /// about one stop, two exposures at least.
    ///
    /// Where the median is below 2^-23, the step of an f32 at 1, which is where a picture is mostly
    /// black background, FLIP 1.7 goes on to exposures of about 24 stops (NVlabs/flip#42). Here the
    /// median of the pixels above 2^-23 takes its place: the background has no say. A reference
    /// without such a pixel is compared once, at the exposure that maps 1 to 0.85.
    pub fn of(reference: &dyn Lines) -> Exposures {
        let mut luminances = luminances(reference);
        let max = luminances.iter().copied().fold(0.0, f32::max);
        if max < f32::EPSILON {
            let start = stops(1.0);
            return Exposures {
                start,
                stop: start,
                count: 1,
            };
        }
        if median(&mut luminances) < f32::EPSILON {
            luminances.retain(|&luminance| luminance >= f32::EPSILON);
        }
        let (start, stop) = (stops(max), stops(median(&mut luminances)));
        let count = (stop - start).ceil() as u32;
        let count = count.clamp(2, MAX_EXPOSURES);
        Exposures { start, stop, count }
    }

    /// Whether pictures can be compared at these.
    fn check(&self) -> Result<()> {
        let ordered = self.start <= self.stop && self.start.is_finite() && self.stop.is_finite();
        if ordered && (1..=MAX_EXPOSURES).contains(&self.count) {
            return Ok(());
        }
        Err(Error::Usage(format!(
            "exposures for FLIP from {} to {}, {} of them: the first must not be above the last, \
             and there can be 1 to {MAX_EXPOSURES}",
            self.start, self.stop, self.count
        )))
    }
}

/// FLIP error, 0 (alike) to 1, of each pixel of pictures as a screen shows them: lines hold sRGB
/// encoded values, clipped to 0..1. `ppd` is the pixels per degree, in [`PPD`].
pub fn ldr(reference: &dyn Lines, test: &dyn Lines, ppd: f32) -> Result<Map> {
    strips([reference, test], ppd, finite, |reference, test| {
        flip_rs::ldr_flip(reference, test, ppd)
    })
}

/// FLIP error, 0 (alike) to 1, of each pixel of pictures in linear light, Rec. 709 primaries: the
/// greatest of the errors that [`ldr`] finds at each of the exposures, tone-mapped by ACES.
pub fn hdr(reference: &dyn Lines, test: &dyn Lines, ppd: f32, exposures: Exposures) -> Result<Map> {
    exposures.check()?;
    let mut options = HdrOptions::default();
    options.ppd = ppd;
    options.start_exposure = Some(exposures.start);
    // The crate takes a range that is one point for a single exposure, whatever the count.
    let single = exposures.count == 1;
    options.stop_exposure = Some(if single {
        exposures.start
    } else {
        exposures.stop
    });
    options.num_exposures = Some(exposures.count.max(2) as usize);
    options.return_exposure_map = false;
    // The curve squares its input: 2^60 is far beyond its white and its square is still finite.
    let greatest = (60.0 - exposures.stop).exp2();
    let light = |value: f32| finite(value).clamp(0.0, greatest);
    strips([reference, test], ppd, light, |reference, test| {
        flip_rs::hdr_flip(reference, test, options).map(|result| result.error_map)
    })
}

/// The map, put together from strips that `evaluate` works on in parallel; `clean` is applied to
/// every value that goes in.
fn strips(
    [reference, test]: [&dyn Lines; 2],
    ppd: f32,
    clean: impl Fn(f32) -> f32 + Sync,
    evaluate: impl Fn(&RgbImage<f32>, &RgbImage<f32>) -> Flip + Sync,
) -> Result<Map> {
    check(reference, test, ppd)?;
    let (width, height) = (reference.width() as usize, reference.height() as usize);
    let margin = margin(ppd);
    let rows = strip_rows(height, margin);
    let mut values = vec![0.0; width * height];
    let strips = values.par_chunks_mut(width * rows).enumerate();
    strips.try_for_each(|(index, out)| {
        let first = index * rows;
        let top = first.saturating_sub(margin);
        let lines = top..(first + rows + margin).min(height);
        let cut = |picture| cut(picture, lines.clone(), &clean);
        let map = evaluate(&cut(reference)?, &cut(test)?).map_err(refusal)?;
        let inner = (first - top) * width;
        out.copy_from_slice(&map.pixels()[inner..inner + out.len()]);
        Ok::<(), Error>(())
    })?;
    let (width, height) = (reference.width(), reference.height());
    Ok(Map {
        width,
        height,
        values,
    })
}

/// What the crate gives for one strip.
type Flip = std::result::Result<ErrorMap, FlipError>;

/// Some lines of a picture as the crate takes them.
fn cut(
    picture: &dyn Lines,
    lines: Range<usize>,
    clean: impl Fn(f32) -> f32,
) -> Result<RgbImage<f32>> {
    let width = picture.width() as usize;
    let mut pixels = vec![[0.0; 3]; width * lines.len()];
    for (y, line) in lines.clone().zip(pixels.chunks_mut(width)) {
        picture.line(y as u32, line);
    }
    let mut channels = pixels.into_flattened();
    channels.iter_mut().for_each(|value| *value = clean(*value));
    RgbImage::new(width, lines.len(), channels).map_err(refusal)
}

/// Lines that a pixel's error depends on, above and below: 3σ of the widest Gaussian of the contrast
/// sensitivity (b = 0.04 degrees², σ = √(b / 2π²)) and of the edge detector (σ = 0.082 / 2 degrees),
/// as the paper of 2020 says in sections 4.1 and 4.2.
fn margin(ppd: f32) -> usize {
    let contrast = 3.0 * (0.04 / (2.0 * PI * PI)).sqrt() * ppd;
    let edges = 3.0 * 0.5 * 0.082 * ppd;
    // One more, for the crate rounds on its own.
    contrast.max(edges).ceil() as usize + 1
}

/// Height of a strip: every thread gets as many strips as every other.
fn strip_rows(height: usize, margin: usize) -> usize {
    let strips = height.div_ceil(STRIP_MARGINS * margin);
    let strips = strips.next_multiple_of(rayon::current_num_threads());
    height.div_ceil(strips)
}

/// Whether the two can be compared at all.
fn check(reference: &dyn Lines, test: &dyn Lines, ppd: f32) -> Result<()> {
    let size = |picture: &dyn Lines| (picture.width(), picture.height());
    let ((width, height), other) = (size(reference), size(test));
    if (width, height) != other || width == 0 || height == 0 {
        return Err(Error::Usage(format!(
            "pictures of {width}x{height} and {}x{} pixels cannot be compared",
            other.0, other.1
        )));
    }
    if !PPD.contains(&ppd) {
        return Err(Error::Usage(format!(
            "FLIP at {ppd} pixels per degree: it takes {} to {}",
            PPD.start(),
            PPD.end()
        )));
    }
    Ok(())
}

/// All that could go wrong is checked before; what is left is a picture too wide for so many pixels
/// per degree.
fn refusal(error: FlipError) -> Error {
    Error::Usage(format!("FLIP: {error}"))
}

/// What is not a number, or infinite, is 0.
fn finite(value: f32) -> f32 {
    if value.is_finite() { value } else { 0.0 }
}

/// Rec. 709 luminance of every pixel, cleaned as [`hdr`] cleans.
fn luminances(picture: &dyn Lines) -> Vec<f32> {
    let mut line = vec![[0.0; 3]; picture.width() as usize];
    let mut luminances = Vec::with_capacity(line.len() * picture.height() as usize);
    for y in 0..picture.height() {
        picture.line(y, &mut line);
        luminances.extend(line.iter().map(|pixel| {
            let [r, g, b] = pixel.map(|value| finite(value).max(0.0));
            (0.2126 * r + 0.7152 * g + 0.0722 * b).min(f32::MAX)
        }));
    }
    luminances
}

/// The upper median, as FLIP takes it. There must be one value at least.
fn median(values: &mut [f32]) -> f32 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f32::total_cmp).1
}

/// The exposure, in stops, that maps a luminance to [`WHITE`]: the curve is there at the greater root
/// of a quadratic.
fn stops(luminance: f32) -> f32 {
    let [a, b, c, d, e] = ACES;
    let (a, b, c) = (a - WHITE * c, b - WHITE * d, -WHITE * e);
    let root = ((b * b - 4.0 * a * c).sqrt() - b) / (2.0 * a);
    (root / f64::from(luminance)).log2() as f32
}
