//! 8-bit RGB for looking at, with the record and the scene text as text chunks.

use crate::film::{Curve, Picture, text};
use crate::knobs::Encoding;
use png::text_metadata::ITXtChunk;
use png::{BitDepth, ColorType, Encoder, EncodingError, ScaledFloat, SrgbRenderingIntent};
use rayon::prelude::*;
use std::io::{self, Write};

/// Keyword of the record's chunk.
pub(super) const RECORD_KEYWORD: &str = "lampray";
/// Keyword of the scene text's chunk.
pub(super) const SCENE_KEYWORD: &str = "lampray.scene";

/// Writes a picture whose planes all have its size, shown as its record's knobs say.
pub(in crate::film) fn write_png(picture: &Picture, writer: impl Write) -> io::Result<()> {
    encode(picture, writer).map_err(|error| match error {
        EncodingError::IoError(error) => error,
        error => io::Error::other(error.to_string()),
    })
}

fn encode(picture: &Picture, writer: impl Write) -> Result<(), EncodingError> {
    let curve = Curve::of(&picture.record);
    let mut encoder = Encoder::new(writer, picture.width, picture.height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    match curve.encoding {
        Encoding::Srgb => encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric),
        // The chunk holds 100000 / 2.2.
        Encoding::Gamma22 => encoder.set_source_gamma(ScaledFloat::from_scaled(45455)),
    }
    let mut writer = encoder.write_header()?;
    writer.write_text_chunk(&ITXtChunk::new(
        RECORD_KEYWORD,
        picture.record.to_even_json(),
    ))?;
    if let Some(scene_text) = text::portable(picture.scene_text.as_deref()) {
        let mut chunk = ITXtChunk::new(SCENE_KEYWORD, scene_text);
        chunk.compressed = true;
        writer.write_text_chunk(&chunk)?;
    }
    writer.write_image_data(&bytes(&picture.mean, curve))?;
    writer.finish()
}

fn bytes(mean: &[[f32; 3]], curve: Curve) -> Vec<u8> {
    let gain = curve.gain();
    let mut bytes = vec![0; mean.len() * 3];
    let encode = |(rgb, radiance): (&mut [u8], &[f32; 3])| {
        for (byte, value) in rgb.iter_mut().zip(radiance) {
            *byte = curve.encode(f64::from(*value) * gain);
        }
    };
    bytes
        .par_chunks_exact_mut(3)
        .with_min_len(1024)
        .zip(mean)
        .for_each(encode);
    bytes
}
