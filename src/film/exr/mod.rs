//! OpenEXR files: lampray's own as pictures, any program's as rasters.
//!
//! ```text
//! header ─→ part ─→ layout (where blocks are) ─→ blocks ─→ planes ─┬→ picture
//!                                                                  └→ raster ←─ layers (which channels)
//! ```
//!
//! The `exr` crate allocates what a header asks for, and parts of it answer nonsense with a panic.
//! So headers and blocks are read here, with every length checked, and the crate does what is
//! left: it decompresses one block at a time, whose size is known
//! (file layout: <https://openexr.com/en/latest/OpenEXRFileLayout.html>).

mod attributes;
mod blocks;
mod channels;
mod codebook;
mod header;
mod layers;
mod layout;
mod part;
mod picture;
mod planes;
mod raster;
mod write;

pub(super) use picture::{read_picture, read_record};
pub(super) use raster::ExrFile;
pub(super) use write::write_exr;
