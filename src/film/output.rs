//! Where pictures go. A target is prepared before rendering, so that an output that cannot be
//! written fails at once, and written when the picture is there.

use super::temporary::{Temporary, folder};
use super::write_exr::write_exr;
use super::write_png::write_png;
use super::{Picture, Record};
use crate::error::{Error, Result};
use std::collections::HashSet;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufWriter, Cursor, Write};
use std::path::{Path, PathBuf};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Png,
    Exr,
}

impl Format {
    /// By the extension, in upper or lower case.
    pub fn of(path: &Path) -> Option<Format> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "png" => Some(Format::Png),
            "exr" => Some(Format::Exr),
            _ => None,
        }
    }
}

/// An output that has been found writable. Dropping it unwritten leaves no trace.
pub struct Target {
    path: PathBuf,
    format: Format,
    place: Place,
}

enum Place {
    /// A regular file, now or in future: written beside and renamed.
    File(Temporary),
    /// A device, a pipe or the like, which a rename would destroy: written into.
    Stream,
}

impl Target {
    /// Checks that `path` can be written, and holds a place for it in its folder.
    ///
    /// The format goes by the extension; devices and pipes without one get PNG. Symbolic links
    /// are followed: what they point to is replaced.
    pub fn prepare(path: impl AsRef<Path>) -> Result<Target> {
        let path = path.as_ref();
        Plan::new(path)?.start()
    }

    /// Prepares several outputs, no two of which may be the same file.
    pub fn prepare_all<P: AsRef<Path>>(paths: &[P]) -> Result<Vec<Target>> {
        let plans: Vec<Plan> = paths
            .iter()
            .map(|path| Plan::new(path.as_ref()))
            .collect::<Result<_>>()?;
        let mut seen = HashSet::new();
        for plan in &plans {
            if !seen.insert(plan.identity()) {
                let message = format!("output {} is given twice", plan.path.display());
                return Err(Error::Usage(message));
            }
        }
        plans.into_iter().map(Plan::start).collect()
    }

    /// The path as it was given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn format(&self) -> Format {
        self.format
    }

    /// Writes the picture. On failure a file that was there before is as it was.
    pub fn write(self, picture: &Picture) -> Result<()> {
        if let Some(fault) = picture.fault() {
            return Err(Error::Internal(fault));
        }
        let Target {
            path,
            format,
            place,
        } = self;
        let written = match place {
            Place::File(temporary) => write_file(temporary, format, picture),
            Place::Stream => write_stream(&path, format, picture),
        };
        written.map_err(|source| Error::Write { path, source })
    }
}

fn write_file(temporary: Temporary, format: Format, picture: &Picture) -> io::Result<()> {
    let mut writer = BufWriter::with_capacity(1 << 16, temporary.file());
    match format {
        Format::Png => write_png(picture, &mut writer)?,
        Format::Exr => write_exr(picture, &mut writer)?,
    }
    writer.flush()?;
    drop(writer);
    temporary.persist()
}

/// EXR goes back to fill in a table, which a stream cannot: the whole file is made first.
fn write_stream(path: &Path, format: Format, picture: &Picture) -> io::Result<()> {
    let mut bytes = Cursor::new(Vec::new());
    match format {
        Format::Png => write_png(picture, &mut bytes)?,
        Format::Exr => write_exr(picture, &mut bytes)?,
    }
    let mut stream = open_stream(path)?;
    stream.write_all(bytes.get_ref())?;
    stream.flush()
}

/// Appending matters where standard output has been redirected to the end of a file.
fn open_stream(path: &Path) -> io::Result<File> {
    OpenOptions::new().append(true).open(path)
}

/// An output whose path has been looked at, with nothing created yet.
struct Plan {
    path: PathBuf,
    format: Format,
    /// Where the symbolic links lead.
    destination: PathBuf,
    stream: bool,
}

impl Plan {
    fn new(path: &Path) -> Result<Plan> {
        let create = |source| Error::Create {
            path: path.into(),
            source,
        };
        let destination = follow(path).map_err(create)?;
        let metadata = match fs::metadata(path) {
            Ok(metadata) => Some(metadata),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(create(error)),
        };
        if metadata.as_ref().is_some_and(Metadata::is_dir) {
            return Err(create(io::ErrorKind::IsADirectory.into()));
        }
        let stream = metadata
            .as_ref()
            .is_some_and(|metadata| is_stream(path, metadata));
        let format = match Format::of(path) {
            Some(format) => format,
            None if stream && path.extension().is_none() => Format::Png,
            None => return Err(unknown_format(path)),
        };
        if metadata.is_some() && !is_pipe(metadata.as_ref()) {
            // A file that may not be written to must not be replaced either.
            open_stream(path).map_err(create)?;
        }
        Ok(Plan {
            path: path.into(),
            format,
            destination,
            stream,
        })
    }

    /// What tells two outputs apart: the folder without links, and the name in it.
    fn identity(&self) -> PathBuf {
        let folder = folder(&self.destination);
        let folder = fs::canonicalize(folder).unwrap_or_else(|_| folder.into());
        match self.destination.file_name() {
            Some(name) => folder.join(name),
            None => folder,
        }
    }

    fn start(self) -> Result<Target> {
        let Plan {
            path,
            format,
            destination,
            stream,
        } = self;
        let place = if stream {
            Place::Stream
        } else {
            let temporary = Temporary::beside(&destination);
            let create = |source| Error::Create {
                path: path.clone(),
                source,
            };
            Place::File(temporary.map_err(create)?)
        };
        Ok(Target {
            path,
            format,
            place,
        })
    }
}

fn unknown_format(path: &Path) -> Error {
    let path = path.display();
    Error::Usage(format!(
        "output {path} must end in .png or .exr, which are the formats there are"
    ))
}

/// Anything but a regular file; and what lies in /dev itself, where standard output is a link to
/// whatever the shell has opened, a regular file included.
fn is_stream(path: &Path, metadata: &Metadata) -> bool {
    let in_dev = || fs::canonicalize(folder(path)).is_ok_and(|folder| folder == Path::new("/dev"));
    !metadata.is_file() || in_dev()
}

/// Opening a pipe waits for its reader, which is not to be done before there is something to read.
fn is_pipe(metadata: Option<&Metadata>) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        metadata.is_some_and(|metadata| metadata.file_type().is_fifo())
    }
    #[cfg(not(unix))]
    {
        let _ = metadata;
        false
    }
}

/// Follows symbolic links from file to file, to one that need not exist.
fn follow(path: &Path) -> io::Result<PathBuf> {
    // As many as Linux follows.
    const LINKS: usize = 40;
    let mut path = path.to_path_buf();
    for _ in 0..LINKS {
        match fs::symlink_metadata(&path) {
            Ok(metadata) if metadata.is_symlink() => {
                path = folder(&path).join(fs::read_link(&path)?);
            }
            _ => return Ok(path),
        }
    }
    Err(io::Error::other("too many symbolic links"))
}

/// Names the outputs in a record, as they were given.
pub fn name_outputs(record: &mut Record, targets: &[Target]) {
    let name = |target: &Target| target.path.to_string_lossy().into_owned();
    record.outputs = targets.iter().map(name).collect();
}
