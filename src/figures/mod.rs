//! The paper's experiments, read from what sweeps wrote: as published, and corrected.

mod figure;

pub use figure::*;
mod study;
pub use study::{Effort, Study, studies};
