//! Finding a table of a scene's text again, to point at it.

use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Where materials, spheres, boxes and tables stand, for warnings.
pub(crate) struct Places<'t> {
    root: DeTable<'t>,
}

impl<'t> Places<'t> {
    pub(crate) fn of(text: &'t str) -> Self {
        let root = DeTable::parse(text).map_or_else(|_| DeTable::new(), Spanned::into_inner);
        Self { root }
    }

    /// The header of `camera`, `materials.white`, `spheres.0`, if the text has it.
    pub(crate) fn find(&self, path: &str) -> Option<Range<usize>> {
        let (section, item) = path.split_once('.').unwrap_or((path, ""));
        let value = self.root.get(section)?;
        match value.get_ref() {
            _ if item.is_empty() => Some(value.span()),
            DeValue::Table(table) => table.get(item).map(Spanned::span),
            DeValue::Array(items) => items.get(item.parse::<usize>().ok()?).map(Spanned::span),
            _ => None,
        }
    }
}
