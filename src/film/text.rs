//! The texts that travel inside an image: the record as JSON, the scene compressed.

use super::Record;
use super::bytes::data;
use crate::error::Result;
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use std::io::{self, Read, Write};
use std::path::Path;

/// The largest scene text that travels inside an image, in bytes; of a larger one the record has
/// name and hash.
pub const SCENE_TEXT_LIMIT: usize = 1 << 20;
/// The largest record, in bytes.
pub(super) const RECORD_LIMIT: usize = 16 << 20;
/// Devices of a merged picture: each new one is compared with all of them.
const DEVICE_LIMIT: usize = 4096;
/// The largest piece of text in a file, as it is stored, in bytes.
pub(super) const STORED_LIMIT: usize = 64 << 20;

/// The scene text that travels with a picture, if it is small enough.
pub(super) fn portable(scene_text: Option<&str>) -> Option<&str> {
    scene_text.filter(|text| text.len() <= SCENE_TEXT_LIMIT)
}

pub(super) fn compress(text: &str) -> io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(text.as_bytes())?;
    encoder.finish()
}

/// Decompresses at most `limit` bytes.
pub(super) fn decompress(
    path: &Path,
    what: &str,
    compressed: &[u8],
    limit: usize,
) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut decoder = ZlibDecoder::new(compressed).take(limit as u64 + 1);
    if let Err(error) = decoder.read_to_end(&mut bytes) {
        return Err(data(
            path,
            format!("{what} cannot be decompressed: {error}"),
        ));
    }
    if bytes.len() > limit {
        return Err(data(path, format!("{what} is larger than {limit} bytes")));
    }
    Ok(bytes)
}

pub(super) fn utf8(path: &Path, what: &str, bytes: Vec<u8>) -> Result<String> {
    String::from_utf8(bytes).map_err(|_| data(path, format!("{what} is not UTF-8 text")))
}

/// Parses and checks a record; `json` is `None` where the file has none.
pub(super) fn parse_record(path: &Path, json: Option<&[u8]>) -> Result<Record> {
    let Some(json) = json else {
        return Err(data(
            path,
            "not written by lampray: there is no record inside",
        ));
    };
    let record: Record = serde_json::from_slice(json)
        .map_err(|error| data(path, format!("the record inside cannot be read: {error}")))?;
    let ranges = record.ranges();
    let ordered = ranges.iter().all(|[first, end]| first <= end);
    let disjoint = ranges.windows(2).all(|pair| pair[0][1] <= pair[1][0]);
    if !ordered || !disjoint {
        return Err(data(
            path,
            "the sample ranges of the record inside are not in order",
        ));
    }
    if record.devices.len() > DEVICE_LIMIT {
        let reason = format!("the record inside names over {DEVICE_LIMIT} devices");
        return Err(data(path, reason));
    }
    Ok(record)
}

/// A record that says another size than the picture has is of a picture that this one was cut out
/// of; it is left aside.
pub(super) fn of_size(
    record: Record,
    width: u32,
    height: u32,
    left_aside: &mut Vec<String>,
) -> Option<Record> {
    if (record.width, record.height) == (width, height) {
        return Some(record);
    }
    left_aside.push("the record, which is of a picture of another size".into());
    None
}
