//! What stands before the pixels of a PNG.

use super::chunks::{ChunkHead, chunk};
use super::texts::Texts;
use crate::error::Result;
use crate::film::input::PNG_MAGIC;
use crate::film::{bytes, limits};
use std::io::Read;
use std::path::Path;

/// 256 colours of three bytes.
const PALETTE_LIMIT: u64 = 768;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Colour {
    Grey,
    Rgb,
    Palette,
    GreyAlpha,
    Rgba,
}

impl Colour {
    /// Samples of a pixel, as they are stored.
    fn samples(self) -> u64 {
        match self {
            Colour::Grey | Colour::Palette => 1,
            Colour::GreyAlpha => 2,
            Colour::Rgb => 3,
            Colour::Rgba => 4,
        }
    }
}

/// How a file says that its values stand for light; the standard has this order of preference.
#[derive(Debug, Default)]
pub(super) struct Meaning {
    /// A colour profile, or the code of a standard one.
    pub profile: bool,
    pub srgb: bool,
    /// 100000 times the exponent that stored values have of light.
    pub gamma: Option<u32>,
}

/// All that is known before the first chunk of pixels.
#[derive(Debug)]
pub(super) struct Head {
    pub width: u32,
    pub height: u32,
    /// Bits of a sample.
    pub depth: u8,
    pub colour: Colour,
    pub interlaced: bool,
    pub meaning: Meaning,
    /// Whether a colour or the palette is transparent.
    pub transparent: bool,
    pub animated: bool,
    pub texts: Texts,
    /// Signature and chunks that the pixels cannot be decoded without, as they stand in the file.
    pub needed: Vec<u8>,
    /// The first chunk of pixels, whose data comes next in the file.
    pub image: ChunkHead,
}

impl Head {
    /// Reads on from the signature.
    pub(super) fn read(path: &Path, reader: &mut impl Read) -> Result<Head> {
        let mut head = Head::begin(path, reader)?;
        loop {
            let chunk = ChunkHead::read(path, reader)?;
            match &chunk.kind {
                b"IDAT" => {
                    head.image = chunk;
                    return Ok(head);
                }
                b"IEND" => return Err(bytes::data(path, "a PNG without pixels")),
                _ => head.take(path, reader, chunk)?,
            }
        }
    }

    /// The first chunk is the only one that every file has at the same place.
    fn begin(path: &Path, reader: &mut impl Read) -> Result<Head> {
        let fail = |reason: &str| Err(bytes::data(path, reason));
        let first = ChunkHead::read(path, reader)?;
        if first.kind != *b"IHDR" {
            return fail("a PNG that does not begin with its header");
        }
        let data = first.data(path, reader, 13)?;
        let &[
            w0,
            w1,
            w2,
            w3,
            h0,
            h1,
            h2,
            h3,
            depth,
            colour,
            0,
            0,
            interlace @ 0..=1,
        ] = data.as_slice()
        else {
            return fail("the header is broken");
        };
        let side = |bytes| i64::from(u32::from_be_bytes(bytes));
        let sides = limits::sides(path, side([w0, w1, w2, w3]), side([h0, h1, h2, h3]))?;
        let colour = match (colour, depth) {
            (0, 1 | 2 | 4 | 8 | 16) => Colour::Grey,
            (2, 8 | 16) => Colour::Rgb,
            (3, 1 | 2 | 4 | 8) => Colour::Palette,
            (4, 8 | 16) => Colour::GreyAlpha,
            (6, 8 | 16) => Colour::Rgba,
            _ => return fail("a kind of colours that PNG lacks"),
        };
        Ok(Head {
            width: sides[0],
            height: sides[1],
            depth,
            colour,
            interlaced: interlace == 1,
            meaning: Meaning::default(),
            transparent: false,
            animated: false,
            texts: Texts::default(),
            needed: [&PNG_MAGIC[..], &chunk(*b"IHDR", &data)].concat(),
            image: first,
        })
    }

    fn take(&mut self, path: &Path, reader: &mut impl Read, head: ChunkHead) -> Result<()> {
        match &head.kind {
            b"PLTE" => {
                let palette = head.data(path, reader, PALETTE_LIMIT)?;
                self.needed.extend(chunk(*b"PLTE", &palette));
            }
            b"gAMA" => {
                let data = head.data(path, reader, 4)?;
                self.meaning.gamma = data.try_into().ok().map(u32::from_be_bytes);
            }
            b"sRGB" => {
                head.data(path, reader, 1)?;
                self.meaning.srgb = true;
            }
            b"iCCP" | b"cICP" => {
                self.meaning.profile = true;
                head.skip(path, reader)?;
            }
            b"tRNS" => {
                self.transparent = true;
                head.skip(path, reader)?;
            }
            b"acTL" => {
                self.animated = true;
                head.skip(path, reader)?;
            }
            _ => self.texts.read_chunk(path, reader, head)?,
        }
        Ok(())
    }

    /// Bytes that the pixels decompress to.
    pub(super) fn decoded_bytes(&self) -> u64 {
        let bits = u64::from(self.width) * self.colour.samples() * u64::from(self.depth);
        u64::from(self.height) * (bits.div_ceil(8) + 1)
    }

    /// Bytes of the pixels as they are compared.
    pub(super) fn raster_bytes(&self) -> u64 {
        let sample = if self.depth == 16 { 2 } else { 1 };
        u64::from(self.width) * u64::from(self.height) * 3 * sample
    }
}
