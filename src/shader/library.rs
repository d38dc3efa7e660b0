//! The files of `shaders/`, in the binary, and those of other builds.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

macro_rules! library {
    ($($name:literal),+ $(,)?) => {
        /// Name and text of each shader file.
        pub const LIBRARY: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../shaders/", $name, ".wgsl")))),+];
    };
}

library!(
    "background",
    "baked",
    "box",
    "branch",
    "bvh",
    "camera",
    "canary",
    "denoise",
    "choice",
    "cap",
    "efficiency",
    "features",
    "glass",
    "guides",
    "interruption",
    "light",
    "light_tree",
    "loops",
    "maths",
    "points",
    "probe",
    "random",
    "rectangle",
    "ray",
    "rough",
    "scatter",
    "scene",
    "sequence",
    "sphere",
    "trace",
);

/// A set of shader files: this program's, or what a report of an earlier build holds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Library(BTreeMap<String, String>);

impl Default for Library {
    fn default() -> Self {
        let own = LIBRARY.iter();
        let files = own.map(|(name, text)| (String::from(*name), String::from(*text)));
        Self(files.collect())
    }
}

impl Library {
    /// Whether these are the files of this program.
    pub fn is_own(&self) -> bool {
        let same = |(name, text): &(&str, &str)| self.0.get(*name).is_some_and(|own| own == text);
        self.0.len() == LIBRARY.len() && LIBRARY.iter().all(same)
    }

    /// Name and text of each file, by name.
    pub fn files(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(name, text)| (&**name, &**text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_files_are_known_and_others_told_from_them() {
        let own = Library::default();
        assert!(own.is_own() && own.files().count() == LIBRARY.len());
        let text = serde_json::to_string(&own).unwrap();
        let read: Library = serde_json::from_str(&text).unwrap();
        assert_eq!(read, own);
        let other: Library = serde_json::from_str(&text.replacen("fn ", "fn  ", 1)).unwrap();
        assert!(!other.is_own());
    }
}
