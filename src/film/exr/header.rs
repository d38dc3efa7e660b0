//! All that stands before the blocks: the flags, the attributes of each part, the table of offsets.

use super::attributes::Attributes;
use super::layout;
use super::part::{Kind, Part};
use crate::error::Result;
use crate::film::bytes;
use std::io::Read;
use std::path::Path;

/// Flags of the version.
const TILES: u32 = 0x200;
const LONG_NAMES: u32 = 0x400;
const DEEP: u32 = 0x800;
const PARTS: u32 = 0x1000;

const PART_LIMIT: usize = 1024;

/// The first part, and what is needed to step over the others.
#[derive(Debug)]
pub(super) struct Header {
    pub part: Part,
    pub kinds: Vec<Kind>,
    /// Whether blocks say which part they belong to; a file of parts may hold only one.
    pub numbered: bool,
    /// Names of the parts after the first.
    pub others: Vec<String>,
    /// Blocks of all parts and levels, each with an entry in the table of offsets.
    pub blocks: u64,
}

impl Header {
    /// Reads up to the end of the attributes; the magic number has been read already.
    pub(super) fn read(path: &Path, reader: &mut impl Read) -> Result<Header> {
        let fail = |reason: &str| Err(bytes::data(path, reason));
        let version = bytes::u32_le(path, reader)?;
        if version & !(TILES | LONG_NAMES | DEEP | PARTS) != 2 {
            return fail("an EXR of another version than 2, or with unknown flags");
        }
        let numbered = version & PARTS != 0;
        let mut parts = Vec::new();
        while let Some(attributes) = Attributes::read(path, reader)? {
            parts.push(attributes);
            if !numbered {
                break;
            }
            if parts.len() == PART_LIMIT {
                return fail("more parts than any program writes");
            }
        }
        Header::new(path, version, parts)
    }

    fn new(path: &Path, version: u32, parts: Vec<Attributes>) -> Result<Header> {
        let numbered = version & PARTS != 0;
        let kinds: Option<Vec<Kind>> = parts.iter().map(|part| kind(version, part)).collect();
        let counted: Option<u64> = parts.iter().map(|part| part.blocks.map(u64::from)).sum();
        let others = parts.iter().enumerate().skip(1).map(name).collect();
        let (Some(kinds), Some(first)) = (kinds, parts.into_iter().next()) else {
            return Err(bytes::data(
                path,
                "a part without its type, or no part at all",
            ));
        };
        let part = Part::new(path, kinds[0], first)?;
        let blocks = match counted {
            Some(blocks) if numbered => blocks,
            None if numbered => {
                return Err(bytes::data(path, "a part without the number of its blocks"));
            }
            _ => layout::all_blocks(&part),
        };
        Ok(Header {
            part,
            kinds,
            numbered,
            others,
            blocks,
        })
    }

    /// Steps over the table of offsets: it is for jumping to blocks, and here all are read, one
    /// after another. So it may say what it likes.
    pub(super) fn skip_offsets(&self, path: &Path, reader: &mut impl Read) -> Result<()> {
        bytes::skip(path, reader, self.blocks.saturating_mul(8))
    }
}

/// `None` where it has to be said and is not.
fn kind(version: u32, part: &Attributes) -> Option<Kind> {
    let flag = |flag: u32| version & flag != 0;
    match part.kind {
        // The flag of a single part stands above its attribute.
        Some(kind) if flag(PARTS) || flag(DEEP) => Some(kind),
        _ if flag(TILES) => Some(Kind::Tiles),
        None if flag(PARTS) => None,
        None if flag(DEEP) => Some(Kind::DeepScanLines),
        _ => Some(Kind::ScanLines),
    }
}

fn name((number, part): (usize, &Attributes)) -> String {
    let number = || format!("number {}", number + 1);
    part.name.clone().unwrap_or_else(number)
}
