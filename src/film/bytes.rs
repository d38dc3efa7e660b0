//! Reading from files that may be cut short or lie about lengths.

use crate::error::{Error, Result};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// A file that is there but is not what it should be.
pub(super) fn data(path: &Path, reason: impl Into<String>) -> Error {
    Error::Data {
        path: path.into(),
        reason: reason.into(),
    }
}

fn failed(path: &Path, source: io::Error) -> Error {
    match source.kind() {
        ErrorKind::UnexpectedEof => data(path, "the file ends too early"),
        _ => Error::Input {
            path: path.into(),
            source,
        },
    }
}

pub(super) fn array<const N: usize>(path: &Path, reader: &mut impl Read) -> Result<[u8; N]> {
    let mut bytes = [0; N];
    match reader.read_exact(&mut bytes) {
        Ok(()) => Ok(bytes),
        Err(error) => Err(failed(path, error)),
    }
}

/// A little-endian whole number, as EXR has them.
pub(super) fn i32_le(path: &Path, reader: &mut impl Read) -> Result<i32> {
    Ok(i32::from_le_bytes(array(path, reader)?))
}

/// The same without a sign.
pub(super) fn u32_le(path: &Path, reader: &mut impl Read) -> Result<u32> {
    Ok(u32::from_le_bytes(array(path, reader)?))
}

/// Reads `size` bytes, growing as they arrive rather than as they are announced. Limits are the
/// caller's.
pub(super) fn vector(path: &Path, reader: &mut impl Read, size: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    match reader.take(size).read_to_end(&mut bytes) {
        Ok(length) if length as u64 == size => Ok(bytes),
        Ok(_) => Err(failed(path, ErrorKind::UnexpectedEof.into())),
        Err(error) => Err(failed(path, error)),
    }
}

pub(super) fn skip(path: &Path, reader: &mut impl Read, size: u64) -> Result<()> {
    match io::copy(&mut reader.take(size), &mut io::sink()) {
        Ok(skipped) if skipped == size => Ok(()),
        Ok(_) => Err(failed(path, ErrorKind::UnexpectedEof.into())),
        Err(error) => Err(failed(path, error)),
    }
}
