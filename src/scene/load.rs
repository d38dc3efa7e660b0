//! Reading a scene from a file or from text.

use super::assign::{self, Assignment};
use super::faults::{Faults, Mistakes};
use super::{Scene, Source, build, read};
use crate::error::{Error, Result};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Bytes of a scene file.
pub const MOST_BYTES: u64 = 16 << 20;

impl Scene {
    /// Reads and checks a scene file, with the assignments of the command line laid over it.
    pub fn load(path: &Path, assignments: &[Assignment]) -> Result<Self> {
        let text = Self::read_text(path)?;
        Self::parse(&path.to_string_lossy(), &text, assignments)
    }

    /// The text of a scene file. Its size is bounded before anything is read, and while it is, since
    /// pipes do not tell theirs.
    pub fn read_text(path: &Path) -> Result<String> {
        read_text(path)
    }

    /// Reads and checks the text of a scene; `name` is what messages call it.
    pub fn parse(name: &str, text: &str, assignments: &[Assignment]) -> Result<Self> {
        Ok(Self::inspect(name, text, assignments)?)
    }

    /// As `parse`, with the mistakes one by one.
    pub fn inspect(
        name: &str,
        text: &str,
        assignments: &[Assignment],
    ) -> std::result::Result<Self, Mistakes> {
        let source = Source {
            name: name.into(),
            text: text.into(),
        };
        let plain = without_mark(text);
        let mut faults = Faults::new(name, plain, assignments);
        if text.len() as u64 > MOST_BYTES {
            let message = too_large(text.len() as u64);
            faults.add(super::faults::Origin::File(0..0), || (message, None));
            return Err(faults.finish());
        }
        let (mut draft, whole) = read::read(plain, &mut faults);
        // Before the command line changes it: what the file says in pixels is of this size.
        draft.sweep.size = draft.size();
        assign::apply(assignments, &mut draft, &mut faults);
        match build::build(source, &draft, whole, &mut faults) {
            Some(scene) => Ok(scene),
            None => Err(faults.finish()),
        }
    }
}

/// The text without the byte order mark that some editors of Windows put first.
pub(crate) fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

fn too_large(bytes: u64) -> String {
    format!("a scene file may have 16 MiB at most; this one has {bytes} bytes")
}

fn read_text(path: &Path) -> Result<String> {
    let input = |source| Error::Input {
        path: path.into(),
        source,
    };
    let data = |reason| Error::Data {
        path: path.into(),
        reason,
    };
    let file = File::open(path).map_err(input)?;
    let about = file.metadata().map_err(input)?;
    if about.is_dir() {
        return Err(input(io::Error::new(
            io::ErrorKind::IsADirectory,
            "it is a directory; give a scene file (.toml)",
        )));
    }
    if about.len() > MOST_BYTES {
        return Err(data(too_large(about.len())));
    }
    let mut bytes = Vec::new();
    file.take(MOST_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(input)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(data("a scene file may have 16 MiB at most".into()));
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        data(format!("a scene file is UTF-8 text; byte {at} is not"))
    })
}
