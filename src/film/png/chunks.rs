//! The chunks that a PNG consists of: size, type, data, checksum.

use crate::error::Result;
use crate::film::bytes;
use flate2::Crc;
use std::io::Read;
use std::path::Path;

/// The PNG standard, 5.3: no chunk is larger.
const CHUNK_LIMIT: u64 = (1 << 31) - 1;

/// What a chunk begins with.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChunkHead {
    pub kind: [u8; 4],
    /// Bytes of data.
    pub size: u64,
}

impl ChunkHead {
    pub(super) fn read(path: &Path, reader: &mut impl Read) -> Result<ChunkHead> {
        let size = u64::from(u32::from_be_bytes(bytes::array(path, reader)?));
        if size > CHUNK_LIMIT {
            return Err(bytes::data(path, "a chunk is larger than PNG allows"));
        }
        let kind = bytes::array(path, reader)?;
        Ok(ChunkHead { kind, size })
    }

    /// Steps over data and checksum.
    pub(super) fn skip(self, path: &Path, reader: &mut impl Read) -> Result<()> {
        bytes::skip(path, reader, self.size + 4)
    }

    /// The data, if there are no more than `limit` bytes, whose checksum is checked.
    pub(super) fn data(self, path: &Path, reader: &mut impl Read, limit: u64) -> Result<Vec<u8>> {
        let name = self.kind.escape_ascii();
        if self.size > limit {
            let reason = format!("a chunk {name} of {} bytes is over the limit", self.size);
            return Err(bytes::data(path, reason));
        }
        let data = bytes::vector(path, reader, self.size)?;
        let stored = u32::from_be_bytes(bytes::array(path, reader)?);
        if checksum(self.kind, &data) != stored {
            let reason = format!("a chunk {name} has a wrong checksum");
            return Err(bytes::data(path, reason));
        }
        Ok(data)
    }
}

/// A whole chunk, as it stands in a file.
pub(super) fn chunk(kind: [u8; 4], data: &[u8]) -> Vec<u8> {
    // Chunks that are made here are smaller than any limit.
    let size = (data.len() as u32).to_be_bytes();
    let checksum = checksum(kind, data).to_be_bytes();
    [&size, &kind, data, &checksum].concat()
}

fn checksum(kind: [u8; 4], data: &[u8]) -> u32 {
    let mut crc = Crc::new();
    crc.update(&kind);
    crc.update(data);
    crc.sum()
}
