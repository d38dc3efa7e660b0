//! A file that is being written: one without a name, where the system has such.

use super::folder;
use std::fs::{File, OpenOptions};
use std::io::{self, Seek};
use std::path::Path;
use tempfile::TempPath;

/// A file that is being written.
#[derive(Debug)]
pub(super) struct Temporary {
    pub(super) file: File,
    /// None where the system lets a file have no name: it then goes with the program, however that ends.
    name: Option<TempPath>,
}

impl Temporary {
    /// A file in `folder`, readable for whom the umask says, as any program's output: temporary files are
    /// otherwise kept from everyone else.
    pub(super) fn new(folder: &Path) -> io::Result<Self> {
        match nameless::create(folder) {
            Some(file) => Ok(Self { file, name: None }),
            None => Self::named(folder),
        }
    }

    pub(super) fn named(folder: &Path) -> io::Result<Self> {
        let create = |path: &Path| {
            OpenOptions::new()
                .write(true)
                .read(true)
                .create_new(true)
                .open(path)
        };
        let (file, name) = hidden().make_in(folder, create)?.into_parts();
        Ok(Self {
            file,
            name: Some(name),
        })
    }

    /// Puts the file, which is whole and on the disk, where the target is or is to be.
    pub(super) fn put(self, target: &Path) -> io::Result<()> {
        let rename = |name: TempPath| name.persist(target).map_err(|failure| failure.error);
        let Self { file, name } = self;
        if let Some(name) = name {
            return rename(name);
        }
        match nameless::link(&file, target) {
            Ok(()) => return Ok(()),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(_) => return rename(copy(file, folder(target))?),
        }
        // What is there cannot be replaced but by a rename, for which the file needs a name.
        let link = |path: &Path| nameless::link(&file, path);
        let (_, name) = hidden().make_in(folder(target), link)?.into_parts();
        rename(name)
    }
}

/// Names of files that are being written: short, whatever the target's.
fn hidden() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".lampray-").suffix(".tmp");
    builder
}

/// For systems that let a file have no name and then refuse to give it one.
fn copy(mut from: File, folder: &Path) -> io::Result<TempPath> {
    let Temporary { mut file, name } = Temporary::named(folder)?;
    from.rewind()?;
    io::copy(&mut from, &mut file)?;
    file.set_permissions(from.metadata()?.permissions())?;
    file.sync_all()?;
    name.ok_or_else(|| io::Error::other("a named file has no name"))
}

/// Files without a name, which no folder holds: whatever kills the program, nothing of them is left.
#[cfg(target_os = "linux")]
mod nameless {
    use rustix::fs::{AtFlags, CWD, Mode, OFlags, linkat, open};
    use std::fs::File;
    use std::io;
    use std::os::fd::AsRawFd;
    use std::path::{Path, PathBuf};

    /// A file in `folder`, with the mode that the umask gives; none where the file system has no such files, or
    /// there would be no way to give it a name.
    pub(super) fn create(folder: &Path) -> Option<File> {
        let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
        let file = File::from(open(folder, flags, Mode::from_raw_mode(0o666)).ok()?);
        way(&file).is_symlink().then_some(file)
    }

    /// Gives a file its name, which nothing may have yet.
    pub(super) fn link(file: &File, name: &Path) -> io::Result<()> {
        Ok(linkat(CWD, way(file), CWD, name, AtFlags::SYMLINK_FOLLOW)?)
    }

    /// The only way to such a file that is open to everybody.
    fn way(file: &File) -> PathBuf {
        format!("/proc/self/fd/{}", file.as_raw_fd()).into()
    }
}

#[cfg(not(target_os = "linux"))]
mod nameless {
    use std::fs::File;
    use std::io;
    use std::path::Path;

    pub(super) fn create(_folder: &Path) -> Option<File> {
        None
    }

    pub(super) fn link(_file: &File, _name: &Path) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::io::Write;

    fn is_empty(folder: &Path) -> bool {
        fs::read_dir(folder).unwrap().next().is_none()
    }

    #[test]
    fn what_gets_no_name_is_copied() {
        let folder = tempfile::tempdir().unwrap();
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(b"whole").unwrap();
        let copied = copy(file, folder.path()).unwrap();
        assert_eq!(fs::read(&copied).unwrap(), b"whole");
        drop(copied);
        assert!(is_empty(folder.path()));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_file_that_is_being_written_has_no_name() {
        // Of all the file systems that this is said to work on, the one that every machine has.
        let folder = tempfile::tempdir_in("/dev/shm").unwrap();
        let temporary = Temporary::new(folder.path()).unwrap();
        assert!(temporary.name.is_none(), "{temporary:?}");
        assert!(is_empty(folder.path()));
    }
}
