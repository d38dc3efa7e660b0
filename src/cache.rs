//! What is cheaper to keep than to find again: files that may be deleted, damaged or refused at any
//! time, and then are found again. Nothing here fails.
//!
//! The folder is `LAMPRAY_CACHE_DIR` (empty: nothing is kept), else the system's place for caches:
//! `$XDG_CACHE_HOME/lampray` or `~/.cache/lampray`, `~/Library/Caches/lampray` on macOS,
//! `%LOCALAPPDATA%\lampray\cache` on Windows.

use crate::place::Place;
use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Names the folder; empty for none.
pub const VARIABLE: &str = "LAMPRAY_CACHE_DIR";

/// No file is larger: one that is was not written here.
const MOST_BYTES: u64 = 64 << 20;

/// Bytes of the checksum in front of what a file keeps.
const CHECKSUM: usize = 32;

/// What is kept, a file for each key.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// The start of its files' names.
    pub name: &'static str,
    /// The most files of it; the oldest go.
    pub most: usize,
}

/// A folder of such files.
#[derive(Clone, Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// The user's, where there is one.
    pub fn of_user() -> Option<Self> {
        place(|name| env::var_os(name)).map(Self)
    }

    pub fn at(path: impl Into<PathBuf>) -> Self {
        Self(path.into())
    }

    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Whether nobody but this user and the system's own can have written here.
    #[cfg(unix)]
    pub fn is_private(&self) -> bool {
        use std::os::unix::fs::PermissionsExt;
        fs::metadata(&self.0).is_ok_and(|folder| folder.permissions().mode() & 0o022 == 0)
    }

    /// On other systems a user's own folders are private as they are made.
    #[cfg(not(unix))]
    pub fn is_private(&self) -> bool {
        true
    }

    fn file(&self, kind: Kind, key: &str) -> PathBuf {
        let hash = blake3::hash(key.as_bytes()).to_hex();
        self.0.join(format!("{}-{}", kind.name, &hash[..24]))
    }

    /// What was kept under this key, if it is there and whole.
    pub fn read(&self, kind: Kind, key: &str) -> Option<Vec<u8>> {
        let path = self.file(kind, key);
        let metadata = fs::metadata(&path).ok()?;
        if !metadata.is_file() || metadata.len() > MOST_BYTES {
            return None;
        }
        let mut bytes = fs::read(path).ok()?;
        let (sum, kept) = bytes.split_at_checked(CHECKSUM)?;
        if *sum != checksum(key, kept) {
            return None;
        }
        Some(bytes.split_off(CHECKSUM))
    }

    /// Keeps bytes under a key, in the place of what was there. Whether that worked.
    pub fn write(&self, kind: Kind, key: &str, bytes: &[u8]) -> bool {
        if (bytes.len() + CHECKSUM) as u64 > MOST_BYTES || !self.make() {
            return false;
        }
        let Ok(place) = Place::prepare(self.file(kind, key)) else {
            return false;
        };
        let written = place.write(|sink| {
            sink.write_all(&checksum(key, bytes))?;
            sink.write_all(bytes)
        });
        self.prune(kind);
        written.is_ok()
    }

    pub fn remove(&self, kind: Kind, key: &str) {
        // It may be gone already, or be kept from being written to.
        let _ = fs::remove_file(self.file(kind, key));
    }

    /// Makes the folder, for this user alone.
    fn make(&self) -> bool {
        let mut builder = fs::DirBuilder::new();
        builder.recursive(true);
        #[cfg(unix)]
        {
            use std::os::unix::fs::DirBuilderExt;
            builder.mode(0o700);
        }
        self.0.is_dir() || builder.create(&self.0).is_ok()
    }

    /// Deletes the oldest files of a kind: those of programs and drivers that are long gone.
    fn prune(&self, kind: Kind) {
        let start = format!("{}-", kind.name);
        let entries = fs::read_dir(&self.0).into_iter().flatten().flatten();
        let mut files: Vec<(SystemTime, PathBuf)> = entries
            .filter(|entry| entry.file_name().to_string_lossy().starts_with(&start))
            .filter_map(|entry| Some((entry.metadata().ok()?.modified().ok()?, entry.path())))
            .collect();
        files.sort();
        for (_, path) in files.iter().rev().skip(kind.most) {
            // Another process may have been faster.
            let _ = fs::remove_file(path);
        }
    }
}

/// A file that is damaged, cut short or of another key does not have it.
fn checksum(key: &str, bytes: &[u8]) -> [u8; CHECKSUM] {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&(key.len() as u64).to_le_bytes());
    hasher.update(key.as_bytes()).update(bytes);
    *hasher.finalize().as_bytes()
}

/// The folder that an environment asks for.
fn place(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    if let Some(named) = variable(VARIABLE) {
        return (!named.is_empty()).then(|| PathBuf::from(named));
    }
    // A relative path would keep files in whatever folder the program runs in.
    let absolute = |name| {
        let path = variable(name).map(PathBuf::from);
        path.filter(|path| path.is_absolute())
    };
    if cfg!(windows) {
        return absolute("LOCALAPPDATA").map(|path| path.join("lampray").join("cache"));
    }
    let of_home = match cfg!(target_os = "macos") {
        true => "Library/Caches",
        false => ".cache",
    };
    let home = || absolute("HOME").map(|home| home.join(of_home));
    let caches = absolute("XDG_CACHE_HOME").or_else(home)?;
    Some(caches.join("lampray"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const KIND: Kind = Kind {
        name: "test",
        most: 3,
    };

    fn folder() -> (tempfile::TempDir, Folder) {
        let outer = tempfile::tempdir().unwrap();
        let inner = Folder::at(outer.path().join("a/b"));
        (outer, inner)
    }

    #[test]
    fn what_is_kept_comes_back_under_its_key_alone() {
        let (_outer, folder) = folder();
        assert_eq!(folder.read(KIND, "one"), None);
        assert!(folder.write(KIND, "one", b"first"));
        assert!(folder.write(KIND, "one", b"second"));
        assert_eq!(folder.read(KIND, "one").unwrap(), b"second");
        assert_eq!(folder.read(KIND, "two"), None);
        // A file that was given another's name is not that other.
        fs::rename(folder.file(KIND, "one"), folder.file(KIND, "two")).unwrap();
        assert_eq!(folder.read(KIND, "two"), None);
    }

    #[test]
    fn every_damage_is_found() {
        let (_outer, folder) = folder();
        assert!(folder.write(KIND, "key", b"what is kept"));
        let path = folder.file(KIND, "key");
        let whole = fs::read(&path).unwrap();
        for place in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[place] ^= 1;
            fs::write(&path, &damaged).unwrap();
            assert_eq!(folder.read(KIND, "key"), None, "byte {place}");
            fs::write(&path, &whole[..place]).unwrap();
            assert_eq!(folder.read(KIND, "key"), None, "cut at {place}");
        }
        fs::write(&path, &whole).unwrap();
        assert_eq!(folder.read(KIND, "key").unwrap(), b"what is kept");
    }

    #[test]
    fn the_oldest_files_go() {
        let (_outer, folder) = folder();
        for key in ["a", "b", "c", "d", "e"] {
            assert!(folder.write(KIND, key, key.as_bytes()));
            let now = SystemTime::now();
            let file = fs::File::options()
                .write(true)
                .open(folder.file(KIND, key))
                .unwrap();
            // Clocks of file systems are coarse.
            let age = std::time::Duration::from_secs(100 - u64::from(key.as_bytes()[0] - b'a'));
            file.set_modified(now - age).unwrap();
        }
        assert!(folder.write(KIND, "f", b"f"));
        let left = ["a", "b", "c", "d", "e", "f"].map(|key| folder.read(KIND, key).is_some());
        assert_eq!(left, [false, false, false, true, true, true]);
    }

    #[test]
    fn a_place_that_is_no_folder_keeps_nothing() {
        let (outer, _) = folder();
        let file = outer.path().join("file");
        fs::write(&file, "not a folder").unwrap();
        let folder = Folder::at(&file);
        assert!(!folder.write(KIND, "key", b"kept"));
        assert_eq!(folder.read(KIND, "key"), None);
        assert_eq!(fs::read(&file).unwrap(), b"not a folder");
        // Nor does a folder in the place of a file.
        let folder = Folder::at(outer.path());
        fs::create_dir(folder.file(KIND, "key")).unwrap();
        assert!(!folder.write(KIND, "key", b"kept"));
        assert_eq!(folder.read(KIND, "key"), None);
    }

    #[cfg(unix)]
    #[test]
    fn a_new_folder_is_private() {
        use std::os::unix::fs::PermissionsExt;
        let (outer, folder) = folder();
        assert!(!folder.is_private());
        assert!(folder.write(KIND, "key", b"kept") && folder.is_private());
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o777)).unwrap();
        assert!(!folder.is_private());
        drop(outer);
    }

    #[test]
    fn two_writers_leave_one_whole_file() {
        let (_outer, folder) = folder();
        let texts = [vec![b'a'; 100_000], vec![b'b'; 50_000]];
        std::thread::scope(|scope| {
            for text in &texts {
                let folder = &folder;
                scope.spawn(move || {
                    for _ in 0..20 {
                        assert!(folder.write(KIND, "key", text));
                        assert!(folder.read(KIND, "key").is_some());
                    }
                });
            }
        });
        assert!(texts.contains(&folder.read(KIND, "key").unwrap()));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(not(windows))]
    #[test]
    fn the_folder_is_the_systems_unless_named() {
        let of = |set: &[(&str, &str)]| {
            place(|name| {
                let found = set.iter().find(|(known, _)| *known == name);
                found.map(|(_, value)| OsString::from(value))
            })
        };
        let path = |text: &str| Some(PathBuf::from(text));
        let home = ("HOME", "/home/a");
        let own = match cfg!(target_os = "macos") {
            true => "/home/a/Library/Caches/lampray",
            false => "/home/a/.cache/lampray",
        };
        assert_eq!(of(&[home]), path(own));
        assert_eq!(of(&[home, ("XDG_CACHE_HOME", "/x")]), path("/x/lampray"));
        assert_eq!(of(&[home, ("XDG_CACHE_HOME", "here")]), path(own));
        assert_eq!(of(&[home, (VARIABLE, "there")]), path("there"));
        assert_eq!(of(&[home, (VARIABLE, "")]), None);
        assert_eq!(of(&[]), None);
    }
}
