//! The paper's experiments, read from what sweeps wrote: as published, and corrected.
//!
//! ```text
//! studies ─sweep→ DIR/data ─Data::read→ balls, points, lamps, times, limits ─→ Figure
//!
//! Figure (what there is to see) ─→ plot (one SVG) ──→ page (one HTML, one Markdown) ─→ files
//!                              └─→ sheet (one PNG) ─↗
//! ```
//!
//! [`studies`] says what has to be rendered, sweep by sweep; whoever renders it writes it where [`study_folder`],
//! [`points_file`] and [`Made`] say. From there on nothing is rendered: changing a plot costs a second.

mod about;
mod balls;
mod build;
mod data;
mod escape;
mod figure;
pub mod files;
mod lamps;
mod limits;
mod names;
pub mod page;
pub mod plot;
mod points;
mod sheet;
mod study;
mod times;

pub use about::About;
pub use data::{CASES, Data, Made, MadeFigure, POINTS, points_file, study_folder};
pub use figure::*;
pub use study::{Effort, Study, studies};

use crate::error::{Error, Result};

/// The paper's figures that are measured.
pub const NUMBERS: [u32; 5] = [5, 6, 7, 8, 9];

/// One figure, from data that are there.
///
/// # Errors
/// [`Error::Usage`] for another number, or where runs are missing.
pub fn figure(data: &Data, number: u32) -> Result<Figure> {
    match number {
        5 => balls::figure(data),
        6 => points::figure(data),
        7 => lamps::figure(data),
        8 => times::figure(data),
        9 => limits::figure(data),
        other => Err(Error::Usage(format!(
            "there is no figure {other}: there are 5 to 9"
        ))),
    }
}
