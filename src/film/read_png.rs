//! The record and the scene text of a PNG, without its pixels.
//!
//! Only text chunks are kept, each with a limit on its size as stored and as decompressed; the
//! `png` crate's own decompression has none (image-png issue 696).

use super::Record;
use super::bytes;
use super::text::{self, RECORD_LIMIT, SCENE_TEXT_LIMIT, STORED_LIMIT};
use super::write_png::{RECORD_KEYWORD, SCENE_KEYWORD};
use crate::error::Result;
use flate2::Crc;
use std::io::Read;
use std::path::Path;

/// The PNG standard, 5.3: no chunk is larger.
const CHUNK_LIMIT: u64 = (1 << 31) - 1;

/// Reads on from the signature to the end of the last chunk.
pub(super) fn read_texts(path: &Path, reader: &mut impl Read) -> Result<(Record, Option<String>)> {
    let (mut record, mut scene_text) = (None, None);
    loop {
        let (kind, size) = read_head(path, reader)?;
        match &kind {
            b"IEND" => break,
            b"iTXt" => match read_itxt(path, reader, size)? {
                Some((Keyword::Record, json)) => record = Some(json),
                Some((Keyword::Scene, bytes)) => scene_text = Some(bytes),
                None => {}
            },
            // With the checksum.
            _ => bytes::skip(path, reader, size + 4)?,
        }
    }
    let record = text::parse_record(path, record.as_deref())?;
    let scene_text = match scene_text {
        None => None,
        Some(bytes) => Some(text::utf8(path, "the scene text inside", bytes)?),
    };
    Ok((record, scene_text))
}

fn read_head(path: &Path, reader: &mut impl Read) -> Result<([u8; 4], u64)> {
    let size = u64::from(u32::from_be_bytes(bytes::array(path, reader)?));
    if size > CHUNK_LIMIT {
        return Err(bytes::data(path, "a chunk is larger than PNG allows"));
    }
    Ok((bytes::array(path, reader)?, size))
}

enum Keyword {
    Record,
    Scene,
}

/// The text of an international text chunk, if it is one of lampray's: keyword, 0, whether it is
/// compressed, method, language, 0, translated keyword, 0, text.
fn read_itxt(path: &Path, reader: &mut impl Read, size: u64) -> Result<Option<(Keyword, Vec<u8>)>> {
    if size > STORED_LIMIT as u64 {
        return Err(bytes::data(
            path,
            format!("a text chunk of {size} bytes is over the limit"),
        ));
    }
    let chunk = read_chunk(path, reader, size)?;
    let Some((keyword, rest)) = split(&chunk) else {
        return Ok(None);
    };
    let (keyword, what, limit) = match keyword {
        k if k == RECORD_KEYWORD.as_bytes() => (Keyword::Record, "the record inside", RECORD_LIMIT),
        k if k == SCENE_KEYWORD.as_bytes() => {
            (Keyword::Scene, "the scene text inside", SCENE_TEXT_LIMIT)
        }
        _ => return Ok(None),
    };
    let texts = rest.split_at_checked(2).and_then(|(flags, rest)| {
        let (_language, rest) = split(rest)?;
        let (_translated, rest) = split(rest)?;
        Some((flags, rest))
    });
    let text = match texts {
        Some(([0, _], text)) if text.len() <= limit => text.to_vec(),
        Some(([0, _], _)) => {
            return Err(bytes::data(
                path,
                format!("{what} is larger than {limit} bytes"),
            ));
        }
        Some(([1, 0], text)) => text::decompress(path, what, text, limit)?,
        _ => return Err(bytes::data(path, format!("{what} is a broken text chunk"))),
    };
    Ok(Some((keyword, text)))
}

/// The data of a text chunk, whose checksum is checked.
fn read_chunk(path: &Path, reader: &mut impl Read, size: u64) -> Result<Vec<u8>> {
    let chunk = bytes::vector(path, reader, size)?;
    let stored = u32::from_be_bytes(bytes::array(path, reader)?);
    let mut crc = Crc::new();
    crc.update(b"iTXt");
    crc.update(&chunk);
    if crc.sum() != stored {
        return Err(bytes::data(path, "a text chunk has a wrong checksum"));
    }
    Ok(chunk)
}

/// What stands before and after the first zero byte.
fn split(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let zero = bytes.iter().position(|byte| *byte == 0)?;
    Some((&bytes[..zero], &bytes[zero + 1..]))
}
