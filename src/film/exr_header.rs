//! The header of an EXR file, read with every length checked before anything is allocated.
//!
//! The `exr` crate allocates what a header asks for, and parts of it answer nonsense in a header
//! with a panic. So the header is parsed here, and the crate is given one that was made from
//! checked values (OpenEXR file layout: <https://openexr.com/en/latest/OpenEXRFileLayout.html>).

use super::bytes;
use super::text::{self, RECORD_LIMIT, STORED_LIMIT};
use crate::error::Result;
use exr::meta::BlockDescription;
use exr::meta::header::Header;
use exr::prelude::{ChannelDescription, Compression, LineOrder, SampleType, SmallVec, Text};
use std::io::Read;
use std::path::Path;

/// Names of the attributes, of channels, and of nothing else, have at most 255 bytes.
const NAME_LIMIT: usize = 255;
/// An attribute may be skipped up to this size; a preview picture is the largest known.
const SKIP_LIMIT: usize = 256 << 20;
/// More than enough for every AOV.
const CHANNEL_LIMIT: usize = 64;
/// The largest picture, in pixels.
const PIXEL_LIMIT: u64 = 1 << 28;
const SIDE_LIMIT: i64 = 32768;
/// Of the flags, only "long names" suits a single part of scan lines.
const LONG_NAMES: u32 = 0x400;

/// What of a header matters here.
pub(super) struct ExrHeader {
    /// Names in the order of the file, all of them float32.
    pub channels: Vec<String>,
    pub compression: Compression,
    /// Top row of the data window, from which rows are counted.
    pub top: i32,
    pub width: u32,
    pub height: u32,
    /// The attribute `lampray`.
    pub record: Option<Vec<u8>>,
    /// The attribute `lampray_scene`, still compressed.
    pub scene: Option<Vec<u8>>,
}

impl ExrHeader {
    /// The same header as the `exr` crate has it.
    pub(super) fn for_exr(&self) -> Header {
        let channel = |name: &String| {
            let name = Text::from_slice_unchecked(name.as_bytes());
            ChannelDescription::new(name, SampleType::F32, false)
        };
        let channels: SmallVec<[ChannelDescription; 5]> =
            self.channels.iter().map(channel).collect();
        let size = (self.width as usize, self.height as usize);
        let mut header = Header::new(Text::from_slice_unchecked(b"lampray"), size, channels)
            .with_encoding(
                self.compression,
                BlockDescription::ScanLines,
                LineOrder::Increasing,
            );
        header.own_attributes.layer_position.1 = self.top;
        header
    }
}

/// Fields as they are collected.
#[derive(Default)]
struct Fields {
    channels: Option<Vec<String>>,
    compression: Option<Compression>,
    window: Option<[i32; 4]>,
    record: Option<Vec<u8>>,
    scene: Option<Vec<u8>>,
}

/// Reads up to the end of the header; the magic number has been read already.
pub(super) fn read_header(path: &Path, reader: &mut impl Read) -> Result<ExrHeader> {
    let parser = Parser { path };
    let version = u32::from_le_bytes(parser.bytes(reader)?);
    if version & !LONG_NAMES != 2 {
        return parser.foreign("more than one part, or tiles");
    }
    let mut fields = Fields::default();
    loop {
        let name = parser.name(reader)?;
        if name.is_empty() {
            break;
        }
        let kind = parser.name(reader)?;
        let size = u32::from_le_bytes(parser.bytes(reader)?) as usize;
        parser.attribute(reader, &name, &kind, size, &mut fields)?;
    }
    parser.finish(fields)
}

struct Parser<'a> {
    path: &'a Path,
}

impl Parser<'_> {
    fn fail<T>(&self, reason: impl Into<String>) -> Result<T> {
        Err(bytes::data(self.path, reason))
    }

    fn foreign<T>(&self, reason: &str) -> Result<T> {
        self.fail(format!("not written by lampray: {reason}"))
    }

    fn bytes<const N: usize>(&self, reader: &mut impl Read) -> Result<[u8; N]> {
        bytes::array(self.path, reader)
    }

    /// A name that ends with a zero byte; empty at the end of a list.
    fn name(&self, reader: &mut impl Read) -> Result<Vec<u8>> {
        let mut name = Vec::new();
        loop {
            match self.bytes::<1>(reader)? {
                [0] => return Ok(name),
                _ if name.len() == NAME_LIMIT => {
                    return self.fail("a name in the header is too long");
                }
                [byte] => name.push(byte),
            }
        }
    }

    fn value(&self, reader: &mut impl Read, size: usize, limit: usize) -> Result<Vec<u8>> {
        if size > limit {
            return self.fail(format!(
                "an attribute of {size} bytes is over the limit of {limit}"
            ));
        }
        bytes::vector(self.path, reader, size as u64)
    }

    fn skip(&self, reader: &mut impl Read, size: usize) -> Result<()> {
        if size > SKIP_LIMIT {
            return self.fail(format!("an attribute of {size} bytes is too large"));
        }
        bytes::skip(self.path, reader, size as u64)
    }

    fn attribute(
        &self,
        reader: &mut impl Read,
        name: &[u8],
        kind: &[u8],
        size: usize,
        fields: &mut Fields,
    ) -> Result<()> {
        match (name, kind) {
            (b"lampray", b"string") => {
                fields.record = Some(self.value(reader, size, RECORD_LIMIT)?);
            }
            (b"lampray_scene", _) => fields.scene = Some(self.value(reader, size, STORED_LIMIT)?),
            (b"channels", b"chlist") => {
                let limit = CHANNEL_LIMIT * (NAME_LIMIT + 17) + 1;
                let value = self.value(reader, size, limit)?;
                fields.channels = Some(self.channels(&value)?);
            }
            (b"compression", b"compression") => {
                fields.compression = Some(self.compression(&self.value(reader, size, 1)?)?);
            }
            (b"dataWindow", b"box2i") => {
                let value = self.value(reader, size, 16)?;
                fields.window = Some(self.window(&value)?);
            }
            (b"type", b"string") => {
                if self.value(reader, size, NAME_LIMIT)? != b"scanlineimage" {
                    return self.foreign("not an image of scan lines");
                }
            }
            _ => self.skip(reader, size)?,
        }
        Ok(())
    }

    /// A channel is a name, a type (2 is float32), a byte and three of padding, and the sampling.
    fn channels(&self, mut value: &[u8]) -> Result<Vec<String>> {
        let mut channels = Vec::new();
        loop {
            let name = self.name(&mut value)?;
            if name.is_empty() {
                return Ok(channels);
            }
            let name = text::utf8(self.path, "the name of a channel", name)?;
            let kind = i32::from_le_bytes(self.bytes(&mut value)?);
            self.bytes::<4>(&mut value)?;
            let sampling =
                [self.bytes(&mut value)?, self.bytes(&mut value)?].map(i32::from_le_bytes);
            if kind != 2 || sampling != [1, 1] {
                return self.foreign(&format!("channel {name:?} is not float32 for every pixel"));
            }
            if channels.len() == CHANNEL_LIMIT || channels.contains(&name) {
                return self.fail(format!("channel {name:?} is there twice, or one too many"));
            }
            channels.push(name);
        }
    }

    /// The lossless ones that are little more than zlib; the others were not written by lampray.
    fn compression(&self, value: &[u8]) -> Result<Compression> {
        match value {
            [0] => Ok(Compression::Uncompressed),
            [1] => Ok(Compression::RLE),
            [2] => Ok(Compression::ZIP1),
            [3] => Ok(Compression::ZIP16),
            _ => self.foreign("compressed otherwise than by ZIP, ZIPS, RLE or not at all"),
        }
    }

    fn window(&self, value: &[u8]) -> Result<[i32; 4]> {
        let mut value = value;
        let mut corner = || -> Result<i32> { Ok(i32::from_le_bytes(self.bytes(&mut value)?)) };
        Ok([corner()?, corner()?, corner()?, corner()?])
    }

    fn finish(&self, fields: Fields) -> Result<ExrHeader> {
        let (Some(channels), Some(compression), Some([left, top, right, bottom])) =
            (fields.channels, fields.compression, fields.window)
        else {
            return self.fail("channels, compression or dataWindow are missing in the header");
        };
        let width = i64::from(right) - i64::from(left) + 1;
        let height = i64::from(bottom) - i64::from(top) + 1;
        let sides = [width, height]
            .iter()
            .all(|side| (1..=SIDE_LIMIT).contains(side));
        if !sides || (width * height) as u64 > PIXEL_LIMIT || top.unsigned_abs() > 1 << 24 {
            return self.fail(format!(
                "{width} x {height} pixels are not a picture of lampray's"
            ));
        }
        // Within 1..=32768, as just checked.
        let (width, height) = (width as u32, height as u32);
        let (record, scene) = (fields.record, fields.scene);
        Ok(ExrHeader {
            channels,
            compression,
            top,
            width,
            height,
            record,
            scene,
        })
    }
}
