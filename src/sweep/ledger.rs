//! `runs.jsonl`: one line a run, only ever added to.
//!
//! Each line goes out in one write to the end of the file, under a lock, so that two processes never mix
//! theirs; a line that a kill has cut short is closed by the next one and passed over when reading.

use crate::error::{Error, Result};
use serde_json::{Map, Value};
use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// The longest line that is read.
const LONGEST: u64 = 64 << 20;

/// What an entry calls the BLAKE3 hash of its EXR's bytes.
pub(super) const HASH: &str = "exr_hash";

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    Ok,
    Failed,
    DeviceLost,
    Timeout,
}

impl Status {
    pub fn name(self) -> &'static str {
        match self {
            Status::Ok => "ok",
            Status::Failed => "failed",
            Status::DeviceLost => "device_lost",
            Status::Timeout => "timeout",
        }
    }
}

/// One line: the run's record, and what the sweep adds to it.
pub type Entry = Map<String, Value>;

/// The file, and what it held when it was last read.
#[derive(Debug)]
pub struct Ledger {
    path: PathBuf,
    /// By id, with the hash of every picture that has been written for it.
    finished: HashMap<String, Vec<String>>,
    /// Lines that are no entries: cut short by a kill.
    pub broken: usize,
    /// Where reading goes on: other processes may add lines.
    read_to: u64,
}

impl Ledger {
    /// Opens a folder's ledger, which need not be there yet.
    ///
    /// # Errors
    /// [`Error::Input`] where it is there and cannot be read.
    pub fn open(folder: &Path) -> Result<Self> {
        let mut ledger = Self {
            path: folder.join("runs.jsonl"),
            finished: HashMap::new(),
            broken: 0,
            read_to: 0,
        };
        ledger.refresh()?;
        Ok(ledger)
    }

    /// Whether a run has been finished, by this process or another one.
    ///
    /// # Errors
    /// As [`Ledger::open`].
    pub fn has(&mut self, id: &str) -> Result<bool> {
        if !self.finished.contains_key(id) {
            self.refresh()?;
        }
        Ok(self.finished.contains_key(id))
    }

    /// As [`Ledger::has`], by what has been read so far.
    pub fn knows(&self, id: &str) -> bool {
        self.finished.contains_key(id)
    }

    /// Hashes of the pictures of a finished run: more than one where two processes made it at once, none by a
    /// line of an earlier version.
    pub(super) fn hashes(&self, id: &str) -> &[String] {
        self.finished.get(id).map_or(&[], Vec::as_slice)
    }

    /// Takes a run for one that is not finished, until a new line says that it is.
    pub(super) fn forget(&mut self, id: &str) {
        self.finished.remove(id);
    }

    /// Reads the lines that have been added since.
    pub(super) fn refresh(&mut self) -> Result<()> {
        let (mut finished, mut broken) = (Vec::new(), 0);
        self.read_to = self.each(self.read_to, |entry| match entry {
            Some(entry)
                if entry.get("status").and_then(Value::as_str) == Some(Status::Ok.name()) =>
            {
                let text = |key: &str| entry.get(key).and_then(Value::as_str).map(String::from);
                finished.extend(text("id").map(|id| (id, text(HASH))));
            }
            Some(_) => {}
            None => broken += 1,
        })?;
        for (id, hash) in finished {
            self.finished.entry(id).or_default().extend(hash);
        }
        self.broken += broken;
        Ok(())
    }

    /// Every run with its last line, in the order of their first ones.
    ///
    /// # Errors
    /// As [`Ledger::open`].
    pub fn entries(&self) -> Result<Vec<Entry>> {
        let mut entries: Vec<Entry> = Vec::new();
        let mut places = std::collections::HashMap::new();
        self.each(0, |entry| {
            let Some(entry) = entry else { return };
            let id = entry
                .get("id")
                .and_then(Value::as_str)
                .unwrap_or_default()
                .to_string();
            match places.get(&id) {
                Some(&place) => entries[place] = entry,
                None => {
                    places.insert(id, entries.len());
                    entries.push(entry);
                }
            }
        })?;
        Ok(entries)
    }

    /// Calls with each whole line from `start` on, `None` for one that is no entry; returns where the
    /// last whole line ended.
    fn each(&self, start: u64, mut call: impl FnMut(Option<Entry>)) -> Result<u64> {
        let input = |source| Error::Input {
            path: self.path.clone(),
            source,
        };
        let mut file = match File::open(&self.path) {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(0),
            Err(error) => return Err(input(error)),
        };
        file.seek(SeekFrom::Start(start)).map_err(input)?;
        let mut reader = BufReader::new(file);
        let (mut end, mut line) = (start, Vec::new());
        loop {
            line.clear();
            let length = reader
                .by_ref()
                .take(LONGEST)
                .read_until(b'\n', &mut line)
                .map_err(input)?;
            if line.last() != Some(&b'\n') && length < LONGEST as usize {
                // The end, or a line that somebody is still writing.
                return Ok(end);
            }
            end += length as u64;
            let text = line.trim_ascii();
            if !text.is_empty() {
                call(serde_json::from_slice(text).ok());
            }
        }
    }

    /// Adds a run.
    ///
    /// # Errors
    /// [`Error::Write`] or [`Error::Create`].
    pub fn append(&mut self, entry: &Entry) -> Result<()> {
        let mut options = OpenOptions::new();
        let file = options
            .read(true)
            .append(true)
            .create(true)
            .open(&self.path);
        let mut file = file.map_err(|source| Error::Create {
            path: self.path.clone(),
            source,
        })?;
        let mut line = Value::Object(entry.clone()).to_string();
        line.push('\n');
        let written = (|| {
            // Else a line that another process is in the midst of writing looks like one that was cut short.
            // A file system without locks costs an empty line then, which reading passes over.
            let locked = file.lock();
            if ends_open(&mut file)? {
                line.insert(0, '\n');
            }
            file.write_all(line.as_bytes())?;
            if locked.is_ok() {
                file.unlock()?;
            }
            file.sync_data()
        })();
        written.map_err(|source| Error::Write {
            path: self.path.clone(),
            source,
        })
    }
}

/// Whether the last line has no end.
fn ends_open(file: &mut File) -> std::io::Result<bool> {
    if file.metadata()?.len() == 0 {
        return Ok(false);
    }
    let mut last = [0];
    file.seek(SeekFrom::End(-1))?;
    file.read_exact(&mut last)?;
    Ok(last != [b'\n'])
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn entry(id: &str, status: &str) -> Entry {
        match json!({ "id": id, "status": status }) {
            Value::Object(entry) => entry,
            _ => Entry::new(),
        }
    }

    #[test]
    fn a_failed_run_is_not_finished_and_a_torn_line_is_passed_over() {
        let folder = tempfile::tempdir().unwrap();
        let mut ledger = Ledger::open(folder.path()).unwrap();
        assert!(!ledger.has("a").unwrap());
        ledger.append(&entry("a", "ok")).unwrap();
        ledger.append(&entry("b", "failed")).unwrap();
        // A kill in the middle of a line.
        let path = folder.path().join("runs.jsonl");
        let mut file = OpenOptions::new().append(true).open(&path).unwrap();
        file.write_all(b"{\"id\": \"c\", \"stat").unwrap();
        let mut ledger = Ledger::open(folder.path()).unwrap();
        assert!(ledger.has("a").unwrap() && !ledger.has("b").unwrap() && !ledger.has("c").unwrap());
        ledger.append(&entry("c", "ok")).unwrap();
        ledger.append(&entry("b", "ok")).unwrap();
        assert!(ledger.has("b").unwrap() && ledger.has("c").unwrap());
        assert_eq!(ledger.broken, 1);
        let ids: Vec<_> = ledger
            .entries()
            .unwrap()
            .iter()
            .map(|entry| entry["id"].to_string())
            .collect();
        assert_eq!(ids, ["\"a\"", "\"b\"", "\"c\""]);
    }

    #[test]
    fn two_that_write_at_once_never_mix_their_lines() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &'static str| {
            let path = folder.path().to_path_buf();
            std::thread::spawn(move || {
                let mut ledger = Ledger::open(&path).unwrap();
                for number in 0..50 {
                    let mut entry = entry(&format!("{name}{number}"), "ok");
                    entry.insert("filling".into(), name.repeat(20_000).into());
                    ledger.append(&entry).unwrap();
                }
            })
        };
        let threads = ["x", "y"].map(write);
        for thread in threads {
            thread.join().unwrap();
        }
        let ledger = Ledger::open(folder.path()).unwrap();
        assert_eq!((ledger.broken, ledger.finished.len()), (0, 100));
        let text = std::fs::read_to_string(ledger.path).unwrap();
        assert_eq!(text.lines().count(), 100);
    }
}
