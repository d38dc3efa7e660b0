//! Sums of samples, and the files made of them.
//!
//! ```text
//! Tally ─add→ Film ─picture→ Picture ─Target::write→ EXR, PNG with the record inside
//!                              ↑ ←──── read_exr ────── EXR ─┐
//!                              └────────── merge ───────────┘
//!
//! any program's EXR, PNG ─RasterFile::open→ size ─read→ Raster
//! ```
//!
//! A [`Film`] sums in f64 and knows no files; a [`Picture`] is what lampray's file holds, in f32; a
//! [`Raster`] is what any file holds, as it stores it.

mod bytes;
mod checkpoint;
mod curve;
mod denoised;
mod exact;
mod exr;
mod input;
mod limits;
mod merge;
mod moments;
mod output;
mod parts;
mod picture;
mod png;
mod randomisations;
mod raster;
mod raster_file;
mod read;
mod record;
mod relative;
mod same;
mod scouts;
mod tables;
mod text;

pub use checkpoint::{Checkpoint, previous};
pub use curve::Curve;
pub use denoised::{Denoised, Denoising};
pub use merge::merge;
pub use moments::{Film, NonFinite};
pub use output::{Format, Target, name_outputs};
pub use picture::{Aov, Features, Picture};
pub use randomisations::{ErrorEstimate, Randomisations};
pub use raster::{Noise, Pixels, Raster, Transfer};
pub use raster_file::RasterFile;
pub use read::{is_png, read_exr, read_record};
pub use record::{PilotRecord, Record, Seconds, Stop};
pub use relative::{QUANTILE, RelativeError, needed_samples};
pub use scouts::{AdaptiveRecord, SCOUTS, Scouts, Tiles};
pub use text::SCENE_TEXT_LIMIT;
