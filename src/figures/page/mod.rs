//! The figures as one page of HTML, and as one of Markdown.

use crate::error::Result;
use crate::figures::{About, Figure};

/// `index.html`: one file that asks for nothing outside itself.
///
/// # Errors
/// [`crate::Error::Internal`] where a picture cannot be written as PNG.
pub fn html(figures: &[Figure], about: &About) -> Result<String> {
    let _ = (figures, about);
    Ok(String::new())
}

/// `claims.md`: what the paper claims and what was measured.
pub fn markdown(figures: &[Figure], about: &About) -> String {
    let _ = (figures, about);
    String::new()
}
