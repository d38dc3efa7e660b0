//! How far a picture is from a reference: as numbers, and as maps that tell where.
//!
//! The metrics ask for lines and never for a whole picture, so that files of 8 bits stay as they are
//! in memory.

pub mod flip;
mod lines;
pub mod similarity;

pub use lines::{Lines, Map};
