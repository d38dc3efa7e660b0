//! The record and the scene text of a PNG.
//!
//! Only text chunks of lampray's are kept, each with a limit on its size as stored and as
//! decompressed.

use super::chunks::ChunkHead;
use super::write::{RECORD_KEYWORD, SCENE_KEYWORD};
use crate::error::Result;
use crate::film::text::{self, RECORD_LIMIT, SCENE_TEXT_LIMIT, STORED_LIMIT};
use crate::film::{Record, bytes};
use std::io::Read;
use std::path::Path;

/// Reads on from the signature to the end of the last chunk.
pub(in crate::film) fn read_record(
    path: &Path,
    reader: &mut impl Read,
) -> Result<(Record, Option<String>)> {
    let mut texts = Texts::default();
    let first = ChunkHead::read(path, reader)?;
    texts.read_rest(path, reader, first)?;
    let record = text::parse_record(path, texts.record.as_deref())?;
    let scene_text = match texts.scene_text {
        None => None,
        Some(bytes) => Some(text::utf8(path, "the scene text inside", bytes)?),
    };
    Ok((record, scene_text))
}

/// Texts of lampray's, as far as they have been found.
#[derive(Debug, Default)]
pub(super) struct Texts {
    pub record: Option<Vec<u8>>,
    pub scene_text: Option<Vec<u8>>,
}

impl Texts {
    /// Reads from the data of a chunk on to the end of the last one.
    pub(super) fn read_rest(
        &mut self,
        path: &Path,
        reader: &mut impl Read,
        mut head: ChunkHead,
    ) -> Result<()> {
        while head.kind != *b"IEND" {
            self.read_chunk(path, reader, head)?;
            head = ChunkHead::read(path, reader)?;
        }
        head.skip(path, reader)
    }

    /// Takes the text out of a chunk, or steps over it.
    pub(super) fn read_chunk(
        &mut self,
        path: &Path,
        reader: &mut impl Read,
        head: ChunkHead,
    ) -> Result<()> {
        if head.kind != *b"iTXt" {
            return head.skip(path, reader);
        }
        let data = head.data(path, reader, STORED_LIMIT as u64)?;
        match international_text(path, &data)? {
            Some((Keyword::Record, json)) => self.record = Some(json),
            Some((Keyword::Scene, bytes)) => self.scene_text = Some(bytes),
            None => {}
        }
        Ok(())
    }
}

enum Keyword {
    Record,
    Scene,
}

/// The text of an international text chunk, if it is one of lampray's: keyword, 0, whether it is
/// compressed, method, language, 0, translated keyword, 0, text.
fn international_text(path: &Path, data: &[u8]) -> Result<Option<(Keyword, Vec<u8>)>> {
    let Some((keyword, rest)) = split(data) else {
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

/// What stands before and after the first zero byte.
fn split(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let zero = bytes.iter().position(|byte| *byte == 0)?;
    Some((&bytes[..zero], &bytes[zero + 1..]))
}
