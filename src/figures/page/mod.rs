//! The figures as one page of HTML, and as one of Markdown.
//!
//! ```text
//! frame.html ← header, claims (head) ← sections (section) ← pictures, plots, tables (blocks)
//! ```

mod blocks;
mod head;
mod markdown;
mod section;
mod tables;

use super::escape::markup;
use super::plot::page_style;
use crate::error::{Error, Result};
use crate::figures::{About, Figure};

pub use markdown::markdown;

pub(super) const TITLE: &str = "A sampling technique for light display, measured";
/// What the page is, for those who come to it from elsewhere.
pub(super) const WHAT: &str = "Le Thi Kim Nga, Doan Thi Xuong and Luong Thi Mong Duyen, “A sampling technique for light display”, Quy Nhon University Journal of Science, 2021, has five figures of results. lampray renders each of them again, once with the paper’s formulas as they are printed and once with weights that are free of bias, and takes the noise of every pixel down with it, so that what the paper says can be held against numbers with 95 % intervals.";

const FRAME: &str = include_str!("frame.html");

/// The reports' look first, then what only figures have.
const STYLE: &[&str] = &[
    include_str!("../../report/style/page.css"),
    include_str!("../../report/style/controls.css"),
    include_str!("../../report/style/tables.css"),
    include_str!("figures.css"),
    include_str!("pictures.css"),
    include_str!("print.css"),
];

const SCRIPT: &[&str] = &[include_str!("page.js"), include_str!("viewer.js")];

/// `index.html`: one file that asks for nothing outside itself, and reads without its script.
///
/// # Errors
/// [`Error::Internal`] where a picture has not as many bytes as pixels.
pub fn html(figures: &[Figure], about: &About) -> Result<String> {
    let mut sections = String::new();
    for figure in figures {
        sections.push_str(&section::section(figure)?);
    }
    let parts = [
        ("{{title}}", markup(TITLE)),
        (
            "{{style}}",
            [&STYLE.concat(), page_style().as_str()].concat(),
        ),
        ("{{header}}", head::header(about)),
        ("{{links}}", head::links(figures)),
        ("{{claims}}", head::claims(figures)),
        ("{{figures}}", sections),
        ("{{script}}", SCRIPT.concat()),
    ];
    filled(FRAME, &parts)
}

/// The frame with its marks filled in order: what is filled in is not searched again.
fn filled(frame: &str, parts: &[(&str, String)]) -> Result<String> {
    let (mut page, mut rest) = (String::new(), frame);
    for (mark, part) in parts {
        let (before, after) = rest
            .split_once(mark)
            .ok_or_else(|| Error::Internal(format!("the page's frame has no {mark}")))?;
        page.push_str(before);
        page.push_str(part);
        rest = after;
    }
    page.push_str(rest);
    Ok(page)
}

/// Identifier of a figure's section.
fn anchor(figure: &Figure) -> String {
    format!("figure-{}", figure.number)
}
