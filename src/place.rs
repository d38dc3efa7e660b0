//! Where a file goes. A place is prepared before the work, so that an output that cannot be written
//! fails at once; it is filled when the work is done, and a reader sees the old file or the whole
//! new one.

mod temporary;

use crate::error::{Error, Result};
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufWriter, Cursor, Seek, Write};
use std::path::{Path, PathBuf};
use temporary::Temporary;

/// What a file's bytes are written into.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// An output that has been found writable. Dropping it unwritten leaves no trace.
#[derive(Debug)]
pub struct Place {
    path: PathBuf,
    /// Where the symbolic links lead.
    destination: PathBuf,
    /// A file in the destination's folder, to be put in its place; none for a device or a pipe, which that
    /// would destroy.
    temporary: Option<Temporary>,
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
            Some(Temporary::new(folder(&destination))?)
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
        identity(&self.destination)
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

fn identity(destination: &Path) -> PathBuf {
    let folder = folder(destination);
    let folder = fs::canonicalize(folder).unwrap_or_else(|_| folder.into());
    match destination.file_name() {
        Some(name) => folder.join(name),
        None => folder,
    }
}

/// Whether what is written to `path` comes out where standard output does; where that is nowhere it does not matter.
pub fn is_standard_output(path: &Path) -> bool {
    let leads = |path: &Path| follow(path).map(|destination| identity(&destination));
    let own = leads(path).ok();
    own.is_some_and(|own| {
        own != Path::new("/dev/null") && leads(Path::new("/dev/stdout")).ok() == Some(own)
    })
}

/// Puts in place only what is whole and on the disk: also after a power failure a reader sees one of both.
fn write_file(
    temporary: Temporary,
    target: &Path,
    keep: Option<&Path>,
    fill: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> io::Result<()> {
    let mut writer = BufWriter::with_capacity(1 << 16, &temporary.file);
    fill(&mut writer)?;
    writer.flush()?;
    drop(writer);
    if let Ok(old) = fs::metadata(target) {
        // A file that was kept from others stays so. Not every file system has modes.
        let _ = temporary.file.set_permissions(old.permissions());
    }
    temporary.file.sync_all()?;
    match keep.filter(|_| target.exists()) {
        None => temporary.put(target)?,
        Some(keep) => {
            fs::rename(target, keep)?;
            if let Err(error) = temporary.put(target) {
                fs::rename(keep, target)?;
                return Err(error);
            }
        }
    }
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
///
/// # Errors
/// Links in a circle, or one that cannot be read.
pub fn follow(path: &Path) -> io::Result<PathBuf> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let name = |entry: io::Result<fs::DirEntry>| entry.unwrap().file_name();
        let names = fs::read_dir(folder).unwrap().map(name);
        let mut names: Vec<_> = names.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Writes `text` by way of a temporary file, keeping what was there as `old`.
    fn write(temporary: Temporary, folder: &Path, text: &str) -> io::Result<()> {
        let fill = |sink: &mut dyn Sink| sink.write_all(text.as_bytes());
        write_file(
            temporary,
            &folder.join("a"),
            Some(&folder.join("old")),
            fill,
        )
    }

    /// Both ways of holding a file give the same, of which one is that of other systems.
    #[test]
    fn files_with_and_without_a_name_end_alike() {
        for hold in [Temporary::new, Temporary::named] {
            let folder = tempfile::tempdir().unwrap();
            let at = folder.path();
            write(hold(at).unwrap(), at, "one").unwrap();
            assert_eq!(names(at), ["a"]);
            write(hold(at).unwrap(), at, "two").unwrap();
            assert_eq!(names(at), ["a", "old"]);
            assert_eq!(fs::read(at.join("a")).unwrap(), b"two");
            assert_eq!(fs::read(at.join("old")).unwrap(), b"one");

            let full = |_: &mut dyn Sink| Err(io::ErrorKind::StorageFull.into());
            let outcome = write_file(hold(at).unwrap(), &at.join("a"), None, full);
            assert_eq!(outcome.unwrap_err().kind(), io::ErrorKind::StorageFull);
            assert_eq!(names(at), ["a", "old"]);
            assert_eq!(fs::read(at.join("a")).unwrap(), b"two");
        }
    }
}
