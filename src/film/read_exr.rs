//! Pictures from the EXR files that lampray writes.

use super::bytes;
use super::channels::{ALBEDO, DEPTH, ID, MEAN, NORMAL, REQUIRED, SAMPLES, VARIANCE, is_known};
use super::exr_header::{ExrHeader, read_header};
use super::text::{self, SCENE_TEXT_LIMIT};
use super::{Features, Picture, Record};
use crate::error::Result;
use exr::block::UncompressedBlock;
use exr::block::chunk::{Chunk, CompressedBlock, CompressedScanLineBlock};
use exr::meta::MetaData;
use exr::meta::Requirements;
use std::io::Read;
use std::path::Path;

/// No byte of zlib or RLE stands for more than this many (zlib: 1032).
const LARGEST_RATIO: u64 = 1100;

/// Reads a whole picture; the magic number has been read already. `file_size` is `None` for pipes.
pub(super) fn read_picture(
    path: &Path,
    reader: &mut impl Read,
    file_size: Option<u64>,
) -> Result<Picture> {
    let header = read_header(path, reader)?;
    let (record, scene_text) = record_of(path, &header)?;
    if (record.width, record.height) != (header.width, header.height) {
        return Err(bytes::data(
            path,
            "the picture has another size than its record says",
        ));
    }
    let pixels = u64::from(header.width) * u64::from(header.height);
    let bytes = pixels * header.channels.len() as u64 * 4;
    if file_size.is_some_and(|size| size.saturating_mul(LARGEST_RATIO) < bytes) {
        return Err(bytes::data(
            path,
            "the file is too small for the picture that it announces",
        ));
    }
    let mut planes = Planes::new(path, &header)?;
    read_blocks(path, reader, &header, &mut planes)?;
    planes.picture(&header, record, scene_text)
}

/// The record and the scene text of a header.
pub(super) fn record_of(path: &Path, header: &ExrHeader) -> Result<(Record, Option<String>)> {
    let record = text::parse_record(path, header.record.as_deref())?;
    let scene_text = match &header.scene {
        None => None,
        Some(compressed) => {
            let what = "the scene text inside";
            let bytes = text::decompress(path, what, compressed, SCENE_TEXT_LIMIT)?;
            Some(text::utf8(path, what, bytes)?)
        }
    };
    Ok((record, scene_text))
}

/// Reads the blocks in the order in which the file has them.
fn read_blocks(
    path: &Path,
    reader: &mut impl Read,
    header: &ExrHeader,
    planes: &mut Planes,
) -> Result<()> {
    let meta = MetaData {
        requirements: Requirements {
            file_format_version: 2,
            is_single_layer_and_tiled: false,
            has_long_names: true,
            has_deep_data: false,
            has_multiple_layers: false,
        },
        headers: std::iter::once(header.for_exr()).collect(),
    };
    let blocks = meta.headers[0].chunk_count;
    // The table of offsets is for jumping to blocks; here all are read, one after another.
    bytes::skip(path, reader, blocks as u64 * 8)?;
    let mut seen = vec![false; blocks];
    for _ in 0..blocks {
        let compressed = read_block(path, reader, meta.headers[0].max_block_byte_size())?;
        let chunk = Chunk {
            layer_index: 0,
            compressed_block: CompressedBlock::ScanLine(compressed),
        };
        let block = UncompressedBlock::decompress_chunk(chunk, &meta, false)
            .map_err(|error| bytes::data(path, format!("broken pixels: {error}")))?;
        let number = block.index.pixel_position.y() / header.compression.scan_lines_per_block();
        if std::mem::replace(&mut seen[number], true) {
            return Err(bytes::data(path, "the same rows of pixels are there twice"));
        }
        planes.fill(&block);
    }
    Ok(())
}

fn read_block(
    path: &Path,
    reader: &mut impl Read,
    limit: usize,
) -> Result<CompressedScanLineBlock> {
    let y_coordinate = i32::from_le_bytes(bytes::array(path, reader)?);
    let size = u32::from_le_bytes(bytes::array(path, reader)?);
    if size == 0 || size as usize > limit {
        return Err(bytes::data(
            path,
            format!("a block of pixels of {size} bytes"),
        ));
    }
    let compressed_pixels_le = bytes::vector(path, reader, u64::from(size))?;
    Ok(CompressedScanLineBlock {
        y_coordinate,
        compressed_pixels_le,
    })
}

/// One plane a channel, in the order of the file; `None` for channels that lampray does not know.
struct Planes<'a> {
    path: &'a Path,
    channels: Vec<(&'a str, Option<Vec<f32>>)>,
    width: usize,
}

impl<'a> Planes<'a> {
    fn new(path: &'a Path, header: &'a ExrHeader) -> Result<Planes<'a>> {
        let (width, height) = (header.width as usize, header.height as usize);
        let plane = |name: &'a String| {
            let known = is_known(name).then(|| vec![0.0; width * height]);
            (name.as_str(), known)
        };
        let planes = Planes {
            path,
            channels: header.channels.iter().map(plane).collect(),
            width,
        };
        for name in REQUIRED {
            if !header.channels.iter().any(|channel| channel == name) {
                return Err(bytes::data(path, format!("channel {name:?} is missing")));
            }
        }
        Ok(planes)
    }

    /// A block holds row after row, and in each of them channel after channel.
    fn fill(&mut self, block: &UncompressedBlock) {
        let row_bytes = self.width * 4;
        let mut lines = block.data.chunks_exact(row_bytes);
        for row in 0..block.index.pixel_size.y() {
            let start = (block.index.pixel_position.y() + row) * self.width;
            for (_, plane) in &mut self.channels {
                // Also an unknown channel's line has to be stepped over.
                let (Some(line), Some(plane)) = (lines.next(), plane) else {
                    continue;
                };
                let values = line
                    .chunks_exact(4)
                    .map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]]));
                for (pixel, value) in plane[start..start + self.width].iter_mut().zip(values) {
                    *pixel = value;
                }
            }
        }
    }

    fn take(&mut self, name: &str) -> Option<Vec<f32>> {
        self.channels
            .iter_mut()
            .find(|(channel, _)| *channel == name)?
            .1
            .take()
    }

    fn take_triple(&mut self, names: [&str; 3]) -> Option<Vec<[f32; 3]>> {
        let [x, y, z] = names.map(|name| self.take(name));
        let pixels = x?.into_iter().zip(y?).zip(z?);
        Some(pixels.map(|((x, y), z)| [x, y, z]).collect())
    }

    fn picture(
        mut self,
        header: &ExrHeader,
        record: Record,
        scene_text: Option<String>,
    ) -> Result<Picture> {
        let path = self.path;
        let missing = || bytes::data(path, "channels are missing");
        let features = Features {
            normal: self.take_triple(NORMAL),
            depth: self.take(DEPTH),
            albedo: self.take_triple(ALBEDO),
            id: self.take(ID),
        };
        Ok(Picture {
            width: header.width,
            height: header.height,
            mean: self.take_triple(MEAN).ok_or_else(missing)?,
            variance: self.take_triple(VARIANCE).ok_or_else(missing)?,
            samples: self.take(SAMPLES).ok_or_else(missing)?,
            features: features.some(),
            record,
            scene_text,
        })
    }
}
