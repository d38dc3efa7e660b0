//! Sums of samples, and the files made of them.
//!
//! ```text
//! Tally ─add→ Film ─picture→ Picture ─Target::write→ EXR, PNG with the record inside
//!                              ↑ ←──── read_exr ────── EXR ─┐
//!                              └────────── merge ───────────┘
//! ```
//!
//! A [`Film`] sums in f64 and knows no files; a [`Picture`] is what a file holds, in f32.

mod bytes;
mod channels;
mod curve;
mod exr_header;
mod merge;
mod moments;
mod output;
mod parts;
mod picture;
mod raster;
mod read;
mod read_exr;
mod read_png;
mod record;
mod text;
mod write_exr;
mod write_png;

pub use curve::Curve;
pub use merge::merge;
pub use moments::{Film, NonFinite};
pub use output::{Format, Target, name_outputs};
pub use picture::{Aov, Features, Picture};
pub use raster::{Noise, Pixels, Raster, Transfer};
pub use read::{read_exr, read_record};
pub use record::{Record, Seconds};
pub use text::SCENE_TEXT_LIMIT;
