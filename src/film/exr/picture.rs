//! Pictures from the EXR files that lampray writes.

use super::blocks::read_planes;
use super::channels::{ALBEDO, DEPTH, ID, MEAN, NORMAL, REQUIRED, SAMPLES, VARIANCE, is_known};
use super::header::Header;
use super::part::Part;
use super::planes::{Planes, Wanted};
use crate::error::Result;
use crate::film::input::Input;
use crate::film::text::{self, SCENE_TEXT_LIMIT};
use crate::film::{Features, Picture, Record, bytes, limits};
use exr::prelude::{Compression, SampleType};
use std::io::Read;
use std::path::Path;

/// No byte of zlib or RLE stands for more than this many (zlib: 1032).
const LARGEST_RATIO: u64 = 1100;

/// Reads a whole picture; the magic number has been read already.
pub(in crate::film) fn read_picture(path: &Path, input: &mut Input) -> Result<Picture> {
    let header = Header::read(path, &mut input.reader)?;
    let part = &header.part;
    let (record, scene_text) = record_of(path, part)?;
    if (record.width, record.height) != (part.width, part.height) {
        return Err(bytes::data(
            path,
            "the picture has another size than its record says",
        ));
    }
    if record.denoised.is_some() {
        let reason = "it was denoised, and holds no mean of samples with its variance: take the picture beside it";
        return Err(bytes::data(path, reason));
    }
    check(path, &header)?;
    let announced = part.pixels() as u64 * part.bytes_per_pixel() as u64;
    limits::refuse_ratio(path, input.size, announced, LARGEST_RATIO)?;
    let planes = read_planes(path, &mut input.reader, &header, &wanted(part))?;
    picture(path, part, planes, record, scene_text)
}

/// Reads the record and the scene text; the magic number has been read already.
pub(in crate::film) fn read_record(
    path: &Path,
    reader: &mut impl Read,
) -> Result<(Record, Option<String>)> {
    record_of(path, &Header::read(path, reader)?.part)
}

fn record_of(path: &Path, part: &Part) -> Result<(Record, Option<String>)> {
    let record = text::parse_record(path, part.record.as_deref())?;
    let scene_text = match &part.scene {
        None => None,
        Some(compressed) => {
            let what = "the scene text inside";
            let bytes = text::decompress(path, what, compressed, SCENE_TEXT_LIMIT)?;
            Some(text::utf8(path, what, bytes)?)
        }
    };
    Ok((record, scene_text))
}

/// Sums that another program rewrote may have been rounded, so only lampray's own shape passes.
fn check(path: &Path, header: &Header) -> Result<()> {
    let foreign = |reason: String| {
        let reason = format!("not written by lampray: {reason}");
        Err(bytes::data(path, reason))
    };
    let part = &header.part;
    if header.numbered || part.tiling.is_some() {
        return foreign("more than one part, or tiles".into());
    }
    // The lossless ones that are little more than zlib.
    let plain = [
        Compression::Uncompressed,
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
    ];
    if !plain.contains(&part.compression) {
        return foreign("compressed otherwise than by ZIP, ZIPS, RLE or not at all".into());
    }
    let known = part
        .channels
        .iter()
        .filter(|channel| is_known(&channel.name));
    if let Some(channel) = known
        .clone()
        .find(|channel| channel.samples != SampleType::F32)
    {
        return foreign(format!("channel {:?} is not float32", channel.name));
    }
    match REQUIRED.into_iter().find(|name| !part.has(name)) {
        Some(name) => Err(bytes::data(path, format!("channel {name:?} is missing"))),
        None => Ok(()),
    }
}

/// The channels that lampray knows; the first triples and the first single are always there.
fn wanted(part: &Part) -> Wanted<'static> {
    let mut wanted = Wanted {
        triples: vec![MEAN, VARIANCE],
        singles: vec![SAMPLES],
    };
    let whole = |names: &[&str; 3]| names.iter().all(|name| part.has(name));
    wanted
        .triples
        .extend([NORMAL, ALBEDO].into_iter().filter(whole));
    let there = |name: &&str| part.has(name);
    wanted.singles.extend([DEPTH, ID].into_iter().filter(there));
    wanted
}

fn picture(
    path: &Path,
    part: &Part,
    planes: Planes,
    record: Record,
    scene_text: Option<String>,
) -> Result<Picture> {
    let wanted = wanted(part);
    let mut triples = wanted.triples.into_iter().zip(planes.triples);
    let mut singles = wanted.singles.into_iter().zip(planes.singles);
    let (Some((_, mean)), Some((_, variance)), Some((_, samples))) =
        (triples.next(), triples.next(), singles.next())
    else {
        return Err(bytes::data(path, "channels are missing"));
    };
    let mut features = Features::default();
    for (names, plane) in triples {
        match names {
            NORMAL => features.normal = Some(plane),
            _ => features.albedo = Some(plane),
        }
    }
    for (name, plane) in singles {
        match name {
            DEPTH => features.depth = Some(plane),
            _ => features.id = Some(plane),
        }
    }
    Ok(Picture {
        width: part.width,
        height: part.height,
        mean,
        variance,
        samples,
        features: features.some(),
        record,
        scene_text,
    })
}
