//! Decodes the pixels of a PNG: as colours, without alpha, in as few copies as can be.

use super::head::{Colour, Head};
use png::{Decoder, DecodingError, Reader, Transformations};
use std::io::{BufRead, Seek};

/// Pixels of one or of two bytes a sample.
pub(super) enum Values {
    Bytes(Vec<[u8; 3]>),
    Words(Vec<[u16; 3]>),
}

pub(super) fn decode(
    image: &mut (impl BufRead + Seek),
    head: &Head,
) -> Result<Values, DecodingError> {
    let mut decoder = Decoder::new(image);
    // Palettes become colours, and bits bytes.
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info()?;
    let pixels = head.width as usize * head.height as usize;
    let values = if head.depth == 16 {
        Values::Words(words(&mut reader, head, pixels)?)
    } else {
        Values::Bytes(bytes(&mut reader, head, pixels)?)
    };
    // To the checksum of the last chunk of pixels.
    reader.finish()?;
    Ok(values)
}

fn bytes<R: BufRead + Seek>(
    reader: &mut Reader<R>,
    head: &Head,
    pixels: usize,
) -> Result<Vec<[u8; 3]>, DecodingError> {
    let mut values = vec![[0; 3]; pixels];
    match head.colour {
        Colour::Rgb | Colour::Palette => {
            reader.next_frame(values.as_flattened_mut())?;
        }
        Colour::Grey => rows(reader, head, &mut values, |[grey]: [u8; 1]| [grey; 3])?,
        Colour::GreyAlpha => rows(reader, head, &mut values, |[grey, _]| [grey; 3])?,
        Colour::Rgba => rows(reader, head, &mut values, |[r, g, b, _]| [r, g, b])?,
    }
    Ok(values)
}

/// Samples of two bytes stand with the greater one first.
fn words<R: BufRead + Seek>(
    reader: &mut Reader<R>,
    head: &Head,
    pixels: usize,
) -> Result<Vec<[u16; 3]>, DecodingError> {
    let word = |high, low| u16::from_be_bytes([high, low]);
    let mut values = vec![[0; 3]; pixels];
    match head.colour {
        Colour::Rgb | Colour::Palette => {
            reader.next_frame(bytemuck::cast_slice_mut(&mut values))?;
            for value in values.as_flattened_mut() {
                *value = u16::from_be(*value);
            }
        }
        Colour::Grey => rows(reader, head, &mut values, |[h, l]| [word(h, l); 3])?,
        Colour::GreyAlpha => rows(reader, head, &mut values, |[h, l, _, _]| [word(h, l); 3])?,
        Colour::Rgba => rows(reader, head, &mut values, |[r, s, g, h, b, c, _, _]| {
            [word(r, s), word(g, h), word(b, c)]
        })?,
    }
    Ok(values)
}

/// Decodes pixels of `N` bytes row by row; interlaced ones, whose rows come in pieces, at once.
fn rows<R: BufRead + Seek, T, const N: usize>(
    reader: &mut Reader<R>,
    head: &Head,
    values: &mut [T],
    value: impl Fn([u8; N]) -> T,
) -> Result<(), DecodingError> {
    let width = head.width as usize;
    let store = |values: &mut [T], row: &[u8]| {
        for (to, stored) in values.iter_mut().zip(row.as_chunks().0) {
            *to = value(*stored);
        }
    };
    if head.interlaced {
        let mut stored = vec![0; values.len() * N];
        reader.next_frame(&mut stored)?;
        store(values, &stored);
        return Ok(());
    }
    let mut row = vec![0; width * N];
    for values in values.chunks_exact_mut(width) {
        reader.read_row(&mut row)?;
        store(values, &row);
    }
    Ok(())
}
