//! Where a file goes. A place is prepared before the work, so that an output that cannot be written
//! fails at once; it is filled when the work is done, and a reader sees the old file or the whole
//! new one.

use crate::error::{Error, Result};
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufWriter, Cursor, Seek, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// What a file's bytes are written into.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// An output that has been found writable. Dropping it unwritten leaves no trace.
#[derive(Debug)]
pub struct Place {
    path: PathBuf,
    /// Where the symbolic links lead.
    destination: PathBuf,
    /// A file beside the destination, to be renamed over it; none for a device or a pipe, which a
    /// rename would destroy.
    temporary: Option<NamedTempFile>,
}

impl Place {
    /// Checks that `path` can be written, and holds a place for it in its folder. Symbolic links
    /// are followed: what they point to is replaced.
    ///
    /// # Errors
    /// [`Error::Create`] with the reason.
    pub fn prepare(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        Self::look(path).map_err(|source| Error::Create {
            path: path.into(),
            source,
        })
    }

    fn look(path: &Path) -> io::Result<Self> {
        let destination = follow(path)?;
        let metadata = match fs::metadata(path) {
            Ok(metadata) => Some(metadata),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(error),
        };
        if metadata.as_ref().is_some_and(Metadata::is_dir) {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        if metadata.as_ref().is_some_and(|metadata| !is_pipe(metadata)) {
            // A file that may not be written to must not be replaced either.
            open_stream(path)?;
        }
        let stream = metadata.is_some_and(|metadata| is_stream(path, &metadata));
        let temporary = if stream {
            None
        } else {
            Some(temporary_beside(&destination)?)
        };
        Ok(Self {
            path: path.into(),
            destination,
            temporary,
        })
    }

    /// The path as it was given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether this is a device or a pipe rather than a file.
    pub fn is_stream(&self) -> bool {
        self.temporary.is_none()
    }

    /// What tells two outputs apart: the folder without links, and the name in it.
    pub fn identity(&self) -> PathBuf {
        let folder = folder(&self.destination);
        let folder = fs::canonicalize(folder).unwrap_or_else(|_| folder.into());
        match self.destination.file_name() {
            Some(name) => folder.join(name),
            None => folder,
        }
    }

    /// Lets `fill` write the file.
    ///
    /// # Errors
    /// [`Error::Write`], and a file that was there before is as it was then; [`Error::Stream`] for what is none.
    pub fn write(self, fill: impl FnOnce(&mut dyn Sink) -> io::Result<()>) -> Result<()> {
        self.fill(None, fill)
    }

    /// As [`Place::write`]; a file that was there before is kept under another name. There is no moment at
    /// which neither is there under one of the two.
    ///
    /// # Errors
    /// As [`Place::write`].
    pub fn write_keeping(
        self,
        old: &Path,
        fill: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
    ) -> Result<()> {
        self.fill(Some(old), fill)
    }

    fn fill(
        self,
        keep: Option<&Path>,
        fill: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
    ) -> Result<()> {
        let Self {
            path,
            destination,
            temporary,
        } = self;
        match temporary {
            Some(temporary) => write_file(temporary, &destination, keep, fill)
                .map_err(|source| Error::Write { path, source }),
            None => write_stream(&path, fill).map_err(|source| Error::Stream { path, source }),
        }
    }
}

/// A file beside the target, readable for whom the umask says, as any program's output: temporary
/// files are otherwise kept from everyone else. Its name is short, whatever the target's.
fn temporary_beside(target: &Path) -> io::Result<NamedTempFile> {
    let create = |path: &Path| {
        OpenOptions::new()
            .write(true)
            .read(true)
            .create_new(true)
            .open(path)
    };
    tempfile::Builder::new()
        .prefix(".lampray-")
        .suffix(".tmp")
        .make_in(folder(target), create)
}

/// Renames only what is whole and on the disk: also after a power failure a reader sees one of both.
fn write_file(
    temporary: NamedTempFile,
    target: &Path,
    keep: Option<&Path>,
    fill: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> io::Result<()> {
    let mut writer = BufWriter::with_capacity(1 << 16, temporary.as_file());
    fill(&mut writer)?;
    writer.flush()?;
    drop(writer);
    if let Ok(old) = fs::metadata(target) {
        // A file that was kept from others stays so. Not every file system has modes.
        let _ = temporary.as_file().set_permissions(old.permissions());
    }
    temporary.as_file().sync_all()?;
    if let Some(keep) = keep
        && target.exists()
    {
        fs::rename(target, keep)?;
    }
    temporary.persist(target).map_err(|failure| failure.error)?;
    sync_folder(folder(target));
    Ok(())
}

/// Some formats go back to fill in a table, which a stream cannot: the whole file is made first.
fn write_stream(path: &Path, fill: impl FnOnce(&mut dyn Sink) -> io::Result<()>) -> io::Result<()> {
    let mut bytes = Cursor::new(Vec::new());
    fill(&mut bytes)?;
    let mut stream = open_stream(path)?;
    stream.write_all(bytes.get_ref())?;
    stream.flush()
}

/// Appending matters where standard output has been redirected to the end of a file.
fn open_stream(path: &Path) -> io::Result<File> {
    OpenOptions::new().append(true).open(path)
}

/// Anything but a regular file; and what lies in /dev itself, where standard output is a link to
/// whatever the shell has opened, a regular file included.
fn is_stream(path: &Path, metadata: &Metadata) -> bool {
    let in_dev = || fs::canonicalize(folder(path)).is_ok_and(|folder| folder == Path::new("/dev"));
    !metadata.is_file() || in_dev()
}

/// Opening a pipe waits for its reader, which is not to be done before there is something to read.
#[cfg(unix)]
fn is_pipe(metadata: &Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    metadata.file_type().is_fifo()
}

#[cfg(not(unix))]
fn is_pipe(_metadata: &Metadata) -> bool {
    false
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

/// The folder of a file; `file.png` alone is in the current one.
fn folder(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Makes the rename itself durable. Some file systems cannot sync a folder; the file is whole and
/// in its place either way, so that is no failure of the output.
fn sync_folder(folder: &Path) {
    if cfg!(unix) {
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
}
