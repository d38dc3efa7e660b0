//! Where two pictures differ, as a picture: colours with a scale bar (PNG), or the numbers (EXR).

use super::palette::Palette;
use super::study::Study;
use crate::error::{Error, Result};
use crate::film::Format;
use crate::place::{Place, Sink};
use crate::wording::named;
use exr::math::Vec2;
use exr::prelude::{
    Encoding, Image, ImageAttributes, Layer, LayerAttributes, SpecificChannels, WritableImage,
};
use image::{Rgb, RgbImage};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};
use std::io::{self, Cursor};
use std::path::Path;

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum MapKind {
    /// Test minus reference, mean of the channels, linear light
    Signed,
    /// |test - reference| / (reference + 0.01), mean of the channels, linear light
    Relative,
    /// FLIP of the tone-mapped pictures
    Flip,
    /// HDR-FLIP
    HdrFlip,
    /// Difference in standard errors, for pictures that carry their noise
    Z,
}

/// Numbers to be shown, row by row from the top left.
#[derive(Clone, Debug)]
pub struct Chart {
    pub width: u32,
    pub height: u32,
    pub values: Vec<f32>,
    /// What the ends of the scale stand for.
    pub range: [f64; 2],
    pub palette: Palette,
    /// What is shown, in Latin letters.
    pub title: &'static str,
}

/// Finds what a map shows; `z` is there for pictures that carry their noise.
///
/// # Errors
/// [`Error::Usage`] for a map that these pictures do not support.
pub fn chart(study: &Study, kind: MapKind, z: Option<Vec<f32>>) -> Result<Chart> {
    let (values, range, palette, title) = match kind {
        MapKind::Signed => {
            let values =
                study.per_pixel(|a, b| ((b[0] - a[0]) + (b[1] - a[1]) + (b[2] - a[2])) / 3.0);
            let end = round_end(&values);
            (
                values,
                [-end, end],
                Palette::Diverging,
                "test - reference, linear light",
            )
        }
        MapKind::Relative => {
            let values = study.per_pixel(relative);
            let end = round_end(&values);
            (
                values,
                [0.0, end],
                Palette::Sequential,
                "relative error, linear light",
            )
        }
        MapKind::Flip => {
            let values = study.flip()?.values.clone();
            let end = round_end(&values);
            (values, [0.0, end], Palette::Sequential, "FLIP")
        }
        MapKind::HdrFlip => {
            let values = study.hdr_flip()?.0.values.clone();
            let end = round_end(&values);
            (values, [0.0, end], Palette::Sequential, "HDR-FLIP")
        }
        MapKind::Z => {
            let none = || {
                Error::Usage(
                    "--map-kind z: the pictures do not both carry variance and count".into(),
                )
            };
            (
                z.ok_or_else(none)?,
                [-6.0, 6.0],
                Palette::Diverging,
                "difference in standard errors",
            )
        }
    };
    Ok(Chart {
        width: study.pair.width(),
        height: study.pair.height(),
        values,
        range,
        palette,
        title,
    })
}

fn relative(reference: [f32; 3], test: [f32; 3]) -> f32 {
    let one = |channel: usize| {
        let a = reference[channel];
        (test[channel] - a).abs() / (a.abs() + super::survey::NEAR_BLACK as f32)
    };
    (one(0) + one(1) + one(2)) / 3.0
}

/// Of 1, 2, 5, 10, ... the least that 99.5 % of the pixels are within; 1 where nothing differs.
fn round_end(values: &[f32]) -> f64 {
    let mut sizes: Vec<f32> = values
        .iter()
        .map(|v| v.abs())
        .filter(|v| v.is_finite())
        .collect();
    if sizes.is_empty() {
        return 1.0;
    }
    let place = (sizes.len() - 1) * 995 / 1000;
    let (_, &mut typical, above) = sizes.select_nth_unstable_by(place, f32::total_cmp);
    let largest = above.iter().copied().fold(typical, f32::max);
    // Where few pixels differ at all, they are what is to be seen.
    let end = f64::from(if typical > 0.0 { typical } else { largest });
    if end == 0.0 {
        return 1.0;
    }
    let decade = 10f64.powf(end.log10().floor());
    let digit = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|digit| digit * decade >= 0.999_999 * end);
    digit.unwrap_or(10.0) * decade
}

/// Writes a chart, as PNG or EXR by extension.
///
/// # Errors
/// [`Error::Write`]; a file that was there before is as it was then.
pub fn write(place: Place, chart: &Chart) -> Result<()> {
    let exr = Format::of(place.path()) == Some(Format::Exr);
    place.write(|sink| {
        if exr {
            write_exr(chart, sink)
        } else {
            write_png(chart, sink)
        }
    })
}

/// Whether a map can be written there.
///
/// # Errors
/// [`Error::Usage`] for an extension other than png and exr; [`Error::Create`].
pub fn prepare(path: &Path) -> Result<Place> {
    if Format::of(path).is_none() {
        return Err(Error::Usage(format!(
            "--map {}: must end in .png or .exr",
            named(path)
        )));
    }
    Place::prepare(path)
}

/// The numbers in all three channels, which any viewer shows.
fn write_exr(chart: &Chart, sink: &mut dyn Sink) -> io::Result<()> {
    let width = chart.width as usize;
    let pixel = |at: Vec2<usize>| {
        let value = chart.values[at.y() * width + at.x()];
        (value, value, value)
    };
    let size = (width, chart.height as usize);
    let layer = Layer::new(
        size,
        LayerAttributes::named("difference"),
        Encoding::SMALL_LOSSLESS,
        SpecificChannels::rgb(pixel),
    );
    let attributes =
        ImageAttributes::new(exr::meta::attribute::IntegerBounds::from_dimensions(size));
    let written = Image::empty(attributes)
        .with_layer(layer)
        .write()
        .to_buffered(sink);
    written.map_err(|error| io::Error::other(error.to_string()))
}

/// Small pictures are enlarged to about so many pixels across.
const SMALLEST: u32 = 320;
/// Height of the scale bar, of a line of text and of what is around them.
const BAR: u32 = 14;
const LINE: u32 = 16;
const EDGE: u32 = 6;
const PAPER: [u8; 3] = [255, 255, 255];
const INK: [u8; 3] = [40, 44, 52];

fn write_png(chart: &Chart, sink: &mut dyn Sink) -> io::Result<()> {
    let mut bytes = Cursor::new(Vec::new());
    let drawn = draw(chart).write_to(&mut bytes, image::ImageFormat::Png);
    drawn.map_err(|error| io::Error::other(error.to_string()))?;
    sink.write_all(bytes.get_ref())
}

/// The chart, its scale bar below it, and what the colours mean.
fn draw(chart: &Chart) -> RgbImage {
    let zoom = (SMALLEST.div_ceil(chart.width)).max(1);
    let (width, height) = (chart.width * zoom, chart.height * zoom);
    let page = width.max(SMALLEST);
    let mut image = RgbImage::from_pixel(page, height + 3 * EDGE + BAR + 2 * LINE, Rgb(PAPER));
    let [low, high] = chart.range;
    for y in 0..height {
        for x in 0..width {
            let value = chart.values[((y / zoom) * chart.width + x / zoom) as usize];
            let colour = chart
                .palette
                .colour((f64::from(value) - low) / (high - low));
            image.put_pixel(x, y, Rgb(colour));
        }
    }
    draw_scale(&mut image, chart, height + EDGE);
    image
}

fn draw_scale(image: &mut RgbImage, chart: &Chart, top: u32) {
    let (left, right) = (EDGE, image.width() - EDGE);
    for x in left..right {
        let place = f64::from(x - left) / f64::from(right - left - 1);
        for y in top..top + BAR {
            image.put_pixel(x, y, Rgb(chart.palette.colour(place)));
        }
    }
    let [low, high] = chart.range;
    let labels = [
        (left, low),
        ((left + right) / 2, 0.5 * (low + high)),
        (right, high),
    ];
    for (x, value) in labels {
        let text = number(value);
        let wide = text_width(&text);
        let start = x
            .saturating_sub(wide / 2)
            .clamp(left, right.saturating_sub(wide).max(left));
        draw_text(image, &text, start, top + BAR + EDGE / 2);
    }
    let beyond = |value: &&f32| f64::from(**value) < low || f64::from(**value) > high;
    let share = chart.values.iter().filter(beyond).count() as f64 / chart.values.len() as f64;
    let title = if share > 0.0 {
        format!("{}; {:.2} % beyond", chart.title, 100.0 * share)
    } else {
        chart.title.to_string()
    };
    let title = title.as_str();
    let start = image.width().saturating_sub(text_width(title)) / 2;
    draw_text(image, title, start, top + BAR + EDGE / 2 + LINE);
}

/// Short, and exact for what a scale ends at.
fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-3..1e4).contains(&size) {
        format!("{}", (value * 1e6).round() / 1e6)
    } else {
        format!("{value:.0e}")
    }
}

fn text_width(text: &str) -> u32 {
    let letter = get_raster_width(FontWeight::Regular, RasterHeight::Size16);
    (text.len() * letter) as u32
}

/// Draws what fits on the page.
fn draw_text(image: &mut RgbImage, text: &str, left: u32, top: u32) {
    let mut x = left;
    for letter in text.chars() {
        let Some(raster) = get_raster(letter, FontWeight::Regular, RasterHeight::Size16) else {
            continue;
        };
        for (row, line) in raster.rows().enumerate() {
            for (column, &dark) in line.iter().enumerate() {
                let (x, y) = (x + column as u32, top + row as u32);
                if let Some(pixel) = image.get_pixel_mut_checked(x, y) {
                    let blend = |channel: usize| {
                        let (paper, ink) = (u32::from(pixel.0[channel]), u32::from(INK[channel]));
                        ((paper * (255 - u32::from(dark)) + ink * u32::from(dark)) / 255) as u8
                    };
                    *pixel = Rgb([0, 1, 2].map(blend));
                }
            }
        }
        x += raster.width() as u32;
    }
}
