//! A file beside the target that takes its place once it is whole.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

/// Removed when dropped, unless it has been persisted.
pub(super) struct Temporary {
    file: File,
    path: PathBuf,
    target: PathBuf,
    persisted: bool,
}

impl Temporary {
    /// Creates an empty file in the folder of `target`, readable for whom the umask says, as any
    /// program's output: crates for temporary files keep theirs from everyone else.
    pub(super) fn beside(target: &Path) -> io::Result<Temporary> {
        let folder = folder(target);
        loop {
            let path = folder.join(unique_name());
            match OpenOptions::new()
                .write(true)
                .read(true)
                .create_new(true)
                .open(&path)
            {
                Ok(file) => {
                    let target = target.into();
                    return Ok(Temporary {
                        file,
                        path,
                        target,
                        persisted: false,
                    });
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }

    pub(super) fn file(&self) -> &File {
        &self.file
    }

    /// Puts the file in the target's place: a reader sees the old file or the whole new one, also
    /// after a power failure.
    pub(super) fn persist(mut self) -> io::Result<()> {
        if let Ok(old) = fs::metadata(&self.target) {
            // A file that was kept from others stays so. Not every file system has modes.
            let _ = self.file.set_permissions(old.permissions());
        }
        self.file.flush()?;
        self.file.sync_all()?;
        fs::rename(&self.path, &self.target)?;
        self.persisted = true;
        sync_folder(folder(&self.target));
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.persisted {
            // There is no one left to tell.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// The folder of a file; `file.png` alone is in the current one.
pub(super) fn folder(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Short, whatever the target's name: names have a largest length.
fn unique_name() -> String {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let nanos = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |time| time.subsec_nanos());
    format!(".lampray-{}-{count}-{nanos}.tmp", std::process::id())
}

/// Makes the rename itself durable. Some file systems cannot sync a folder; the file is whole and
/// in its place either way, so that is no failure of the output.
fn sync_folder(folder: &Path) {
    if cfg!(unix) {
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
}
