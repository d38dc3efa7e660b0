//! An image file that is open, whatever its name; what it is, is told by its first bytes.

use super::bytes;
use crate::error::{Error, Result};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
pub(super) const PNG_MAGIC: [u8; 8] = [137, 80, 78, 71, 13, 10, 26, 10];

pub(super) enum Kind {
    Exr,
    Png,
}

#[derive(Debug)]
pub(super) struct Input {
    pub reader: BufReader<File>,
    /// In bytes; `None` for what has no size, a pipe for instance.
    pub size: Option<u64>,
}

impl Input {
    pub(super) fn open(path: &Path) -> Result<Input> {
        let input = |source| Error::Input {
            path: path.into(),
            source,
        };
        let file = File::open(path).map_err(input)?;
        let metadata = file.metadata().map_err(input)?;
        if metadata.is_dir() {
            return Err(input(std::io::ErrorKind::IsADirectory.into()));
        }
        let size = metadata.is_file().then_some(metadata.len());
        Ok(Input {
            reader: BufReader::with_capacity(1 << 16, file),
            size,
        })
    }

    /// Reads the magic number.
    pub(super) fn kind(&mut self, path: &Path) -> Result<Kind> {
        let neither = || bytes::data(path, "neither an EXR nor a PNG");
        let mut magic = [0; 8];
        let (exr, rest) = magic.split_at_mut(EXR_MAGIC.len());
        self.reader.read_exact(exr).map_err(|_| neither())?;
        if exr == EXR_MAGIC {
            return Ok(Kind::Exr);
        }
        self.reader.read_exact(rest).map_err(|_| neither())?;
        if magic == PNG_MAGIC {
            Ok(Kind::Png)
        } else {
            Err(neither())
        }
    }
}
