//! Any program's image file: opened for its size, then decoded.

use super::Raster;
use super::exr::ExrFile;
use super::input::{Input, Kind};
use super::png::PngFile;
use crate::error::Result;
use std::path::{Path, PathBuf};

/// An EXR or PNG whose header has been read and checked, and nothing else.
///
/// So two files can be found unlike before either is decoded.
#[derive(Debug)]
pub struct RasterFile {
    path: PathBuf,
    contents: Contents,
}

#[derive(Debug)]
enum Contents {
    Exr(ExrFile),
    Png(PngFile),
}

impl RasterFile {
    /// Opens a file. What it is goes by its first bytes, whatever its name.
    ///
    /// # Errors
    ///
    /// [`crate::Error::Input`] for a file that cannot be opened, [`crate::Error::Data`] for one that
    /// is not a picture, or one that is larger than can be read.
    pub fn open(path: impl AsRef<Path>) -> Result<RasterFile> {
        let path = path.as_ref();
        let mut input = Input::open(path)?;
        let contents = match input.kind(path)? {
            Kind::Exr => Contents::Exr(ExrFile::open(path, input)?),
            Kind::Png => Contents::Png(PngFile::open(path, input)?),
        };
        Ok(RasterFile {
            path: path.into(),
            contents,
        })
    }

    pub fn width(&self) -> u32 {
        self.size()[0]
    }

    pub fn height(&self) -> u32 {
        self.size()[1]
    }

    fn size(&self) -> [u32; 2] {
        match &self.contents {
            Contents::Exr(file) => file.size(),
            Contents::Png(file) => file.size(),
        }
    }

    /// Left and top of an EXR's data window; `[0, 0]` for a PNG.
    pub fn origin(&self) -> [i32; 2] {
        match &self.contents {
            Contents::Exr(file) => file.origin(),
            Contents::Png(_) => [0, 0],
        }
    }

    /// Decodes the pixels.
    ///
    /// # Errors
    ///
    /// [`crate::Error::Data`] for a file that is broken or cut short.
    pub fn read(self) -> Result<Raster> {
        match self.contents {
            Contents::Exr(file) => file.read(&self.path),
            Contents::Png(file) => file.read(&self.path),
        }
    }
}
