//! PNG files: lampray's own with their records, any program's as rasters.
//!
//! ```text
//! chunks ─→ head (what stands before the pixels) ─→ image (only what pixels need) ─→ raster
//!   └────→ texts (the record) ─────────────────────────────────────────────────────────↗
//! ```
//!
//! The `png` crate decodes the pixels. It is shown nothing else: its own decompression of texts
//! and colour profiles has no limit (image-png issue 696).

mod chunks;
mod head;
mod image;
mod pixels;
mod raster;
mod texts;
mod write;

pub(super) use raster::PngFile;
pub(super) use texts::read_record;
pub(super) use write::write_png;
