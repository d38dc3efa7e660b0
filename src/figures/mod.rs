//! The paper's experiments, read from what sweeps wrote: as published, and corrected.
//!
//! ```text
//! figure (what there is to see) ─→ plot (one SVG) ──→ page (one HTML, one Markdown) ─→ files
//!                              └─→ sheet (one PNG) ─↗
//! ```

mod about;
mod escape;
mod figure;
pub mod files;
mod names;
pub mod page;
pub mod plot;
mod sheet;

pub use about::About;
pub use figure::*;
