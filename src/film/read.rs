//! Opens an image, whatever its name, and says what it is by its first bytes.

use super::bytes;
use super::exr_header::read_header;
use super::{Picture, Record, read_exr as exr_file, read_png};
use crate::error::{Error, Result};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
const PNG_MAGIC: [u8; 8] = [137, 80, 78, 71, 13, 10, 26, 10];

/// Reads a picture from an EXR file that lampray wrote.
pub fn read_exr(path: impl AsRef<Path>) -> Result<Picture> {
    let path = path.as_ref();
    let mut input = Input::open(path)?;
    match input.kind(path)? {
        Kind::Exr => exr_file::read_picture(path, &mut input.reader, input.size),
        Kind::Png => Err(bytes::data(
            path,
            "a PNG; sums and variances are in the EXR only",
        )),
    }
}

/// Reads the record, and the scene's text if it is there, from an EXR or PNG that lampray wrote.
pub fn read_record(path: impl AsRef<Path>) -> Result<(Record, Option<String>)> {
    let path = path.as_ref();
    let mut input = Input::open(path)?;
    match input.kind(path)? {
        Kind::Exr => exr_file::record_of(path, &read_header(path, &mut input.reader)?),
        Kind::Png => read_png::read_texts(path, &mut input.reader),
    }
}

enum Kind {
    Exr,
    Png,
}

struct Input {
    reader: BufReader<File>,
    /// In bytes; `None` for what has no size, a pipe for instance.
    size: Option<u64>,
}

impl Input {
    fn open(path: &Path) -> Result<Input> {
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
    fn kind(&mut self, path: &Path) -> Result<Kind> {
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
