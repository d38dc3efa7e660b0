//! A part of a file: one picture with its channels.

use super::attributes::Attributes;
use crate::error::Result;
use crate::film::{bytes, limits};
use exr::meta::attribute::TileDescription;
use exr::prelude::{Compression, SampleType};
use std::path::Path;

/// How the pixels of a part are cut into blocks, and whether it has one value a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    ScanLines,
    Tiles,
    DeepScanLines,
    DeepTiles,
}

#[derive(Debug)]
pub(super) struct Channel {
    pub name: String,
    pub samples: SampleType,
    /// Matters to B44 only.
    pub linear: bool,
    /// 1, 1 for a value in every pixel.
    pub sampling: [i32; 2],
}

/// The part whose pixels are read: checked, of one value a pixel in every channel.
#[derive(Debug)]
pub(super) struct Part {
    pub channels: Vec<Channel>,
    pub compression: Compression,
    /// `None` for scan lines.
    pub tiling: Option<TileDescription>,
    /// Left and top of the data window, from which columns and rows are counted.
    pub origin: [i32; 2],
    pub width: u32,
    pub height: u32,
    pub record: Option<Vec<u8>>,
    pub scene: Option<Vec<u8>>,
}

impl Part {
    pub(super) fn new(path: &Path, kind: Kind, attributes: Attributes) -> Result<Part> {
        let fail = |reason: &str| Err(bytes::data(path, reason));
        if matches!(kind, Kind::DeepScanLines | Kind::DeepTiles) {
            return fail(
                "deep pixels, which have many values each, are not read; flatten them first",
            );
        }
        let (Some(channels), Some(compression), Some([left, top, right, bottom])) = (
            attributes.channels,
            attributes.compression,
            attributes.window,
        ) else {
            return fail("channels, compression or dataWindow are missing in the header");
        };
        if kind == Kind::Tiles && attributes.tiling.is_none() {
            return fail("tiles without a description of them");
        }
        let side = |first: i32, last: i32| i64::from(last) - i64::from(first) + 1;
        let [width, height] = limits::sides(path, side(left, right), side(top, bottom))?;
        if left.unsigned_abs().max(top.unsigned_abs()) > 1 << 24 {
            return fail("a data window that is too far away from the origin");
        }
        check_sampling(path, &channels)?;
        Ok(Part {
            channels,
            compression: self::compression(path, compression)?,
            tiling: attributes.tiling.filter(|_| kind == Kind::Tiles),
            origin: [left, top],
            width,
            height,
            record: attributes.record,
            scene: attributes.scene,
        })
    }

    pub(super) fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Bytes of all channels together.
    pub(super) fn bytes_per_pixel(&self) -> usize {
        let channels = self.channels.iter();
        channels
            .map(|channel| channel.samples.bytes_per_sample())
            .sum()
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.channels.iter().any(|channel| channel.name == name)
    }
}

/// The blocks of subsampled channels have sizes that the decompressors cannot be told.
fn check_sampling(path: &Path, channels: &[Channel]) -> Result<()> {
    if channels.is_empty() {
        return Err(bytes::data(path, "there is no channel in it"));
    }
    match channels.iter().find(|channel| channel.sampling != [1, 1]) {
        None => Ok(()),
        Some(Channel { name, sampling, .. }) => Err(bytes::data(
            path,
            format!(
                "channel {name:?} has one value for {} x {} pixels, which is not read; write the picture with all channels in full",
                sampling[0], sampling[1]
            ),
        )),
    }
}

fn compression(path: &Path, number: u8) -> Result<Compression> {
    let refused = match number {
        0 => return Ok(Compression::Uncompressed),
        1 => return Ok(Compression::RLE),
        2 => return Ok(Compression::ZIP1),
        3 => return Ok(Compression::ZIP16),
        4 => return Ok(Compression::PIZ),
        5 => return Ok(Compression::PXR24),
        6 => return Ok(Compression::B44),
        7 => return Ok(Compression::B44A),
        8 => "DWAA",
        9 => "DWAB",
        _ => "a newer method",
    };
    Err(bytes::data(
        path,
        format!(
            "compressed by {refused}, which is not read; write the picture again with ZIP or PIZ"
        ),
    ))
}

/// As people call it.
pub(super) fn compression_name(compression: Compression) -> &'static str {
    match compression {
        Compression::RLE => "RLE",
        Compression::ZIP1 => "ZIPS",
        Compression::ZIP16 => "ZIP",
        Compression::PIZ => "PIZ",
        Compression::PXR24 => "PXR24",
        Compression::B44 => "B44",
        Compression::B44A => "B44A",
        _ => "uncompressed",
    }
}
