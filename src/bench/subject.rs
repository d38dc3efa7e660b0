//! What is traced: the Cornell box that ships, rooms of spheres, and scene files.

use super::room::room;
use crate::error::{Error, Result};
use crate::scene::{Assignment, Scene};
use std::path::Path;

/// `scenes/cornell.toml`, in the program: a benchmark needs no folder.
const CORNELL: &str = include_str!("../../scenes/cornell.toml");

/// A scene to be measured.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// `scenes/cornell.toml`.
    Cornell,
    /// The room of so many spheres.
    Room(usize),
    /// A scene file, read.
    File { name: String, text: String },
}

impl Subject {
    /// `cornell`, or a number of spheres such as `32`, `10k` or `1M`.
    ///
    /// # Errors
    /// [`Error::Usage`].
    pub fn parse(text: &str) -> Result<Self> {
        let text = text.trim();
        if text == "cornell" {
            return Ok(Self::Cornell);
        }
        let (digits, factor) = match text.strip_suffix(['k', 'K']) {
            Some(digits) => (digits, 1_000),
            None => match text.strip_suffix(['m', 'M']) {
                Some(digits) => (digits, 1_000_000),
                None => (text, 1),
            },
        };
        let number = digits.parse::<usize>().ok();
        let number = number.and_then(|number| number.checked_mul(factor));
        number.map(Self::Room).ok_or_else(|| {
            Error::Usage(format!(
                "--primitives {text}: give numbers of spheres, such as 32, 10k or 1M, or cornell"
            ))
        })
    }

    /// Reads a scene file.
    ///
    /// # Errors
    /// [`Error::Input`] and [`Error::Data`]; faults of the scene come with [`Subject::scene`].
    pub fn read(path: &Path) -> Result<Self> {
        Ok(Self::File {
            name: path.to_string_lossy().into_owned(),
            text: Scene::read_text(path)?,
        })
    }

    /// What the table calls it.
    pub fn name(&self) -> String {
        match self {
            Self::Cornell => "cornell".into(),
            Self::Room(spheres) => format!("room-{spheres}"),
            Self::File { name, .. } => {
                let stem = Path::new(name).file_stem().unwrap_or_default();
                stem.to_string_lossy().into_owned()
            }
        }
    }

    /// The scene, with assignments over it.
    ///
    /// # Errors
    /// Faults of the scene and of the assignments.
    pub fn scene(&self, assignments: &[Assignment]) -> Result<Scene> {
        match self {
            Self::Cornell => Scene::parse("scenes/cornell.toml", CORNELL, assignments),
            Self::Room(spheres) => room(*spheres, assignments),
            Self::File { name, text } => Scene::parse(name, text, assignments),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_with_and_without_suffix() {
        for (text, spheres) in [
            ("8", 8),
            ("0", 0),
            ("1k", 1000),
            ("10K", 10_000),
            ("1M", 1_000_000),
        ] {
            assert_eq!(Subject::parse(text).unwrap(), Subject::Room(spheres));
        }
        assert_eq!(Subject::parse(" cornell").unwrap(), Subject::Cornell);
        for text in [
            "",
            "k",
            "-1",
            "1.5k",
            "box",
            "99999999999999999999",
            "18446744073709551615k",
        ] {
            assert!(Subject::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn names_and_scenes() {
        assert_eq!(Subject::Room(1000).name(), "room-1000");
        let cornell = Subject::Cornell.scene(&[]).unwrap();
        assert_eq!((cornell.spheres.len(), cornell.boxes.len()), (3, 5));
        let file = Subject::read(Path::new("scenes/furnace.toml")).unwrap();
        assert_eq!(file.name(), "furnace");
        assert!(file.scene(&[]).is_ok());
        assert!(Subject::read(Path::new("scenes/nonesuch.toml")).is_err());
    }
}
