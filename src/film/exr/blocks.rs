//! Reads the blocks of the first part, in the order in which the file has them.

use super::codebook;
use super::header::Header;
use super::layout::{Area, Layout};
use super::part::{Kind, Part};
use super::planes::{Planes, Wanted};
use crate::error::Result;
use crate::film::bytes;
use crate::film::limits;
use crate::panics::catch;
use exr::math::{RoundingMode, Vec2};
use exr::meta::BlockDescription;
use exr::meta::attribute::{IntegerBounds, LevelMode, TileDescription};
use exr::meta::header::Header as ExrHeader;
use exr::prelude::{ChannelDescription, Compression, LineOrder, SmallVec, Text};
use rayon::prelude::*;
use std::io::Read;
use std::path::Path;

/// No program writes larger ones: 16 lines of 16384 pixels in 256 channels are as large.
const BLOCK_LIMIT: usize = 256 << 20;
/// So many bytes, decompressed, are decompressed at once, on all cores.
const BATCH: usize = 16 << 20;
/// Tiles of one pixel each would need far more memory for their places than for their pixels.
const BATCH_BLOCKS: usize = 4096;

/// Reads the channels that are wanted; the table of offsets is what comes next in the file.
pub(super) fn read_planes(
    path: &Path,
    reader: &mut impl Read,
    header: &Header,
    wanted: &Wanted,
) -> Result<Planes> {
    let blocks = Blocks::new(path, header)?;
    header.skip_offsets(path, reader)?;
    let mut planes = Planes::new(&header.part, wanted);
    let mut progress = Progress::new(blocks.layout.blocks());
    while progress.missing > 0 {
        let batch = blocks.read_batch(reader, &mut progress)?;
        let decompressed: Vec<(Area, Vec<u8>)> = batch
            .into_par_iter()
            .map(|(area, compressed)| Ok((area, blocks.decompress(area, compressed)?)))
            .collect::<Result<_>>()?;
        for (area, pixels) in decompressed {
            planes.fill(area, &pixels);
        }
    }
    // Other parts and smaller levels may follow; a file that is cut short there is broken too.
    while progress.read < header.blocks {
        blocks.read_place(reader, &mut progress)?;
    }
    Ok(planes)
}

/// Which blocks have been read.
struct Progress {
    /// Of the first part, at full resolution.
    seen: Vec<bool>,
    missing: usize,
    /// Of all parts and levels.
    read: u64,
}

impl Progress {
    fn new(blocks: usize) -> Progress {
        Progress {
            seen: vec![false; blocks],
            missing: blocks,
            read: 0,
        }
    }
}

struct Blocks<'a> {
    path: &'a Path,
    header: &'a Header,
    layout: Layout,
    bytes_per_pixel: usize,
    /// The first part as the `exr` crate has it.
    exr: ExrHeader,
}

impl<'a> Blocks<'a> {
    fn new(path: &'a Path, header: &'a Header) -> Result<Blocks<'a>> {
        let layout = Layout::new(&header.part);
        let blocks = Blocks {
            path,
            header,
            layout,
            bytes_per_pixel: header.part.bytes_per_pixel(),
            exr: exr_header(&header.part, layout),
        };
        let largest = layout.block[0] * layout.block[1] * blocks.bytes_per_pixel;
        if largest > BLOCK_LIMIT {
            let largest = limits::bytes(largest as u64);
            return blocks.fail(format!("blocks of {largest} are too large"));
        }
        Ok(blocks)
    }

    fn fail<T>(&self, reason: impl Into<String>) -> Result<T> {
        Err(bytes::data(self.path, reason))
    }

    fn size(&self, area: Area) -> usize {
        area.width * area.height * self.bytes_per_pixel
    }

    /// At least one block, and as many more as are decompressed at once.
    fn read_batch(
        &self,
        reader: &mut impl Read,
        progress: &mut Progress,
    ) -> Result<Vec<(Area, Vec<u8>)>> {
        let mut batch = Vec::new();
        let mut size = 0;
        while progress.missing > 0 && size < BATCH && batch.len() < BATCH_BLOCKS {
            if let Some(area) = self.read_place(reader, progress)? {
                batch.push((area, self.read_pixels(reader, area)?));
                size += self.size(area);
            }
        }
        Ok(batch)
    }

    /// Reads where the next block belongs. One of another part or of a smaller level is stepped
    /// over, and there is `None`.
    fn read_place(&self, reader: &mut impl Read, progress: &mut Progress) -> Result<Option<Area>> {
        progress.read += 1;
        let number = match self.header.numbered {
            true => self.integer(reader)? as usize,
            false => 0,
        };
        let Some(kind) = self.header.kinds.get(number) else {
            return self.fail("a block of a part that is not there");
        };
        let (place, level) = match kind {
            Kind::ScanLines | Kind::DeepScanLines => ([0, self.integer(reader)?], [0, 0]),
            Kind::Tiles | Kind::DeepTiles => (self.pair(reader)?, self.pair(reader)?),
        };
        if number != 0 || level != [0, 0] {
            self.skip_pixels(reader, *kind)?;
            return Ok(None);
        }
        let (block, area) = self.locate(*kind, place)?;
        if std::mem::replace(&mut progress.seen[block], true) {
            return self.fail("the same block of pixels is there twice");
        }
        progress.missing -= 1;
        Ok(Some(area))
    }

    /// Deep pixels have a size for their numbers of values, and two for the values.
    fn skip_pixels(&self, reader: &mut impl Read, kind: Kind) -> Result<()> {
        let size = match kind {
            Kind::ScanLines | Kind::Tiles => u64::from(bytes::u32_le(self.path, reader)?),
            Kind::DeepScanLines | Kind::DeepTiles => {
                let numbers = u64::from_le_bytes(bytes::array(self.path, reader)?);
                let values = u64::from_le_bytes(bytes::array(self.path, reader)?);
                bytes::skip(self.path, reader, 8)?;
                numbers.saturating_add(values)
            }
        };
        bytes::skip(self.path, reader, size)
    }

    fn pair(&self, reader: &mut impl Read) -> Result<[i32; 2]> {
        Ok([self.integer(reader)?, self.integer(reader)?])
    }

    fn integer(&self, reader: &mut impl Read) -> Result<i32> {
        bytes::i32_le(self.path, reader)
    }

    /// A tile says its column and row, scan lines the uppermost of them.
    fn locate(&self, kind: Kind, [column, row]: [i32; 2]) -> Result<(usize, Area)> {
        let row = match kind {
            Kind::Tiles => i64::from(row),
            _ => {
                let line = i64::from(row) - i64::from(self.header.part.origin[1]);
                let height = self.layout.block[1] as i64;
                if line % height != 0 {
                    return self.fail(format!("no block begins at line {row}"));
                }
                line / height
            }
        };
        let place = usize::try_from(column).ok().zip(usize::try_from(row).ok());
        match place.and_then(|(column, row)| self.layout.block_at(column, row)) {
            Some(block) => Ok(block),
            None => self.fail("a block of pixels outside of the picture"),
        }
    }

    /// A block that does not get smaller is stored as it is, so none is larger than its pixels.
    fn read_pixels(&self, reader: &mut impl Read, area: Area) -> Result<Vec<u8>> {
        let size = bytes::u32_le(self.path, reader)?;
        if size == 0 || size as usize > self.size(area) {
            return self.fail(format!("a block of pixels of {size} bytes"));
        }
        bytes::vector(self.path, reader, u64::from(size))
    }

    fn decompress(&self, area: Area, compressed: Vec<u8>) -> Result<Vec<u8>> {
        let bounds = IntegerBounds {
            // Positions are within the limits of sides.
            position: Vec2(area.x as i32, area.y as i32),
            size: Vec2(area.width, area.height),
        };
        let compression = self.header.part.compression;
        // What is as large as its pixels is stored as it is.
        let coded = compression == Compression::PIZ && compressed.len() < self.size(area);
        if coded && codebook::is_made_up(&compressed, self.size(area) / 2) {
            return self.fail("broken pixels: codes that no encoder makes");
        }
        let decompress =
            || compression.decompress_image_section_from_le(&self.exr, compressed, bounds, false);
        match catch(decompress) {
            Ok(Ok(pixels)) if pixels.len() == self.size(area) => Ok(pixels),
            Ok(Err(error)) => self.fail(format!("broken pixels: {error}")),
            Ok(Ok(_)) | Err(_) => self.fail("broken pixels: a block cannot be decompressed"),
        }
    }
}

/// A header of checked values only. Decompressors go by the order and the types of channels, not by
/// their names.
fn exr_header(part: &Part, layout: Layout) -> ExrHeader {
    let channels: SmallVec<[ChannelDescription; 5]> = part
        .channels
        .iter()
        .map(|channel| ChannelDescription {
            name: Text::default(),
            sample_type: channel.samples,
            quantize_linearly: channel.linear,
            sampling: Vec2(1, 1),
        })
        .collect();
    let blocks = match part.tiling {
        None => BlockDescription::ScanLines,
        Some(_) => BlockDescription::Tiles(TileDescription {
            tile_size: Vec2(layout.block[0], layout.block[1]),
            level_mode: LevelMode::Singular,
            rounding_mode: RoundingMode::Down,
        }),
    };
    let size = (part.width as usize, part.height as usize);
    ExrHeader::new(Text::default(), size, channels).with_encoding(
        part.compression,
        blocks,
        LineOrder::Unspecified,
    )
}
