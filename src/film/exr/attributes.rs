//! The attributes of a header, each a name, a type, a size and a value.

use super::part::{Channel, Kind};
use crate::error::Result;
use crate::film::bytes;
use crate::film::text::{self, RECORD_LIMIT, STORED_LIMIT};
use exr::math::{RoundingMode, Vec2};
use exr::meta::attribute::{LevelMode, TileDescription};
use exr::prelude::SampleType;
use std::io::Read;
use std::path::Path;

/// Names of attributes, of channels, of parts and of types have at most 255 bytes.
const NAME_LIMIT: usize = 255;
/// An attribute may be skipped up to this size; a preview picture is the largest known.
const SKIP_LIMIT: usize = 256 << 20;
/// Blender's and Mitsuba's files of many layers have hundreds.
const CHANNEL_LIMIT: usize = 1024;

/// The attributes of one part, as they are collected.
#[derive(Default)]
pub(super) struct Attributes {
    pub channels: Option<Vec<Channel>>,
    pub compression: Option<u8>,
    /// Left, top, right, bottom, all of them inclusive.
    pub window: Option<[i32; 4]>,
    pub tiling: Option<TileDescription>,
    pub kind: Option<Kind>,
    pub name: Option<String>,
    /// How many, at all resolutions.
    pub blocks: Option<u32>,
    /// The attribute `lampray`.
    pub record: Option<Vec<u8>>,
    /// The attribute `lampray_scene`, still compressed.
    pub scene: Option<Vec<u8>>,
}

impl Attributes {
    /// Reads one attribute after another; `None` where not even one stands before the end.
    pub(super) fn read(path: &Path, reader: &mut impl Read) -> Result<Option<Attributes>> {
        let mut attributes = Attributes::default();
        let mut name = read_name(path, reader)?;
        if name.is_empty() {
            return Ok(None);
        }
        while !name.is_empty() {
            let kind = read_name(path, reader)?;
            let size = bytes::u32_le(path, reader)? as usize;
            attributes.read_value(path, reader, (&name, &kind), size)?;
            name = read_name(path, reader)?;
        }
        Ok(Some(attributes))
    }

    fn read_value(
        &mut self,
        path: &Path,
        reader: &mut impl Read,
        (name, kind): (&[u8], &[u8]),
        size: usize,
    ) -> Result<()> {
        let limit = match (name, kind) {
            (b"lampray", b"string") => RECORD_LIMIT,
            (b"lampray_scene", _) => STORED_LIMIT,
            (b"channels", b"chlist") => CHANNEL_LIMIT * (NAME_LIMIT + 17) + 1,
            (b"compression", b"compression") => 1,
            (b"dataWindow", b"box2i") => 16,
            (b"tiles", b"tiledesc") => 9,
            (b"chunkCount", b"int") => 4,
            (b"type" | b"name", b"string") => NAME_LIMIT,
            _ if size > SKIP_LIMIT => SKIP_LIMIT,
            _ => return bytes::skip(path, reader, size as u64),
        };
        if size > limit {
            let reason = format!("an attribute of {size} bytes is over the limit of {limit}");
            return Err(bytes::data(path, reason));
        }
        let value = bytes::vector(path, reader, size as u64)?;
        self.keep(path, name, value)
    }

    /// Keeps an attribute whose name and type are known.
    fn keep(&mut self, path: &Path, name: &[u8], value: Vec<u8>) -> Result<()> {
        let rest = &mut value.as_slice();
        match name {
            b"lampray" => self.record = Some(value),
            b"lampray_scene" => self.scene = Some(value),
            b"channels" => self.channels = Some(channels(path, rest)?),
            b"compression" => self.compression = Some(bytes::array::<1>(path, rest)?[0]),
            b"dataWindow" => {
                let mut edge = || bytes::i32_le(path, rest);
                self.window = Some([edge()?, edge()?, edge()?, edge()?]);
            }
            b"tiles" => self.tiling = Some(tiling(path, rest)?),
            b"chunkCount" => self.blocks = Some(bytes::u32_le(path, rest)?),
            b"type" => self.kind = Some(part_kind(path, &value)?),
            _ => self.name = Some(String::from_utf8_lossy(&value).into_owned()),
        }
        Ok(())
    }
}

/// A name that ends with a zero byte; empty at the end of a list.
fn read_name(path: &Path, reader: &mut impl Read) -> Result<Vec<u8>> {
    let mut name = Vec::new();
    loop {
        match bytes::array::<1>(path, reader)? {
            [0] => return Ok(name),
            _ if name.len() == NAME_LIMIT => {
                return Err(bytes::data(path, "a name in the header is too long"));
            }
            [byte] => name.push(byte),
        }
    }
}

/// A channel is a name, a type, whether it is for the eye (a byte and three of padding), and the
/// sampling.
fn channels(path: &Path, value: &mut impl Read) -> Result<Vec<Channel>> {
    let mut channels: Vec<Channel> = Vec::new();
    loop {
        let name = read_name(path, value)?;
        if name.is_empty() {
            return Ok(channels);
        }
        let name = text::utf8(path, "the name of a channel", name)?;
        let samples = match bytes::u32_le(path, value)? {
            0 => SampleType::U32,
            1 => SampleType::F16,
            2 => SampleType::F32,
            kind => {
                let reason = format!("channel {name:?} is of a type that EXR lacks, {kind}");
                return Err(bytes::data(path, reason));
            }
        };
        let [linear, _, _, _] = bytes::array(path, value)?;
        let sampling = [bytes::i32_le(path, value)?, bytes::i32_le(path, value)?];
        if channels.len() == CHANNEL_LIMIT || channels.iter().any(|channel| channel.name == name) {
            let reason = format!("channel {name:?} is there twice, or one too many");
            return Err(bytes::data(path, reason));
        }
        channels.push(Channel {
            name,
            samples,
            linear: linear != 0,
            sampling,
        });
    }
}

/// Width, height, and a byte: levels in its lower half, and in its upper one how they are rounded.
fn tiling(path: &Path, value: &mut impl Read) -> Result<TileDescription> {
    let size = [bytes::u32_le(path, value)?, bytes::u32_le(path, value)?];
    let [mode] = bytes::array(path, value)?;
    let level_mode = match mode & 15 {
        0 => Some(LevelMode::Singular),
        1 => Some(LevelMode::MipMap),
        2 => Some(LevelMode::RipMap),
        _ => None,
    };
    let rounding_mode = match mode >> 4 {
        0 => Some(RoundingMode::Down),
        1 => Some(RoundingMode::Up),
        _ => None,
    };
    match level_mode.zip(rounding_mode) {
        Some((level_mode, rounding_mode)) if !size.contains(&0) => Ok(TileDescription {
            tile_size: Vec2(size[0] as usize, size[1] as usize),
            level_mode,
            rounding_mode,
        }),
        _ => Err(bytes::data(path, "a broken description of tiles")),
    }
}

fn part_kind(path: &Path, value: &[u8]) -> Result<Kind> {
    match value {
        b"scanlineimage" => Ok(Kind::ScanLines),
        b"tiledimage" => Ok(Kind::Tiles),
        b"deepscanline" => Ok(Kind::DeepScanLines),
        b"deeptile" => Ok(Kind::DeepTiles),
        _ => Err(bytes::data(path, "a part of a type that EXR lacks")),
    }
}
