//! How large a picture may be, and how much larger than its file.

use super::bytes::data;
use crate::error::Result;
use std::path::Path;

const SIDE_LIMIT: i64 = 32768;
/// The largest picture, in pixels.
const PIXEL_LIMIT: i64 = 1 << 28;
/// What is smaller, in bytes, is decoded however small its file is.
const DECODED_LIMIT: u64 = 64 << 20;
/// The same for the pixels that it becomes, as half values and bits grow; those of a 4K picture fit.
const RASTER_LIMIT: u64 = 100 << 20;
/// A file of a larger picture may be smaller than it by this factor: noise and edges of a real
/// picture cannot be compressed as zeros can.
const RATIO: u64 = 200;

/// The sides of a picture, if they are within the limits.
pub(super) fn sides(path: &Path, width: i64, height: i64) -> Result<[u32; 2]> {
    let within = |side| (1..=SIDE_LIMIT).contains(&side);
    if !within(width) || !within(height) || width * height > PIXEL_LIMIT {
        return Err(data(
            path,
            format!(
                "{width} x {height} pixels: sides have 1 to {SIDE_LIMIT} pixels, and a picture has at most {PIXEL_LIMIT}"
            ),
        ));
    }
    // Both were found within 1..=32768.
    Ok([width as u32, height as u32])
}

/// Refuses a file that announces too much: `decoded` bytes in it, `raster` bytes as pixels.
pub(super) fn refuse_bomb(
    path: &Path,
    file_size: Option<u64>,
    decoded: u64,
    raster: u64,
) -> Result<()> {
    if decoded <= DECODED_LIMIT && raster <= RASTER_LIMIT {
        return Ok(());
    }
    refuse_ratio(path, file_size, decoded.max(raster), RATIO)
}

/// Refuses a file that would have to grow by more than `ratio`. What has no size, such as a pipe,
/// passes.
pub(super) fn refuse_ratio(
    path: &Path,
    file_size: Option<u64>,
    announced: u64,
    ratio: u64,
) -> Result<()> {
    match file_size {
        Some(size) if size.saturating_mul(ratio) < announced => Err(data(
            path,
            format!(
                "{} announce {}: the file is too small for the picture",
                bytes(size),
                bytes(announced)
            ),
        )),
        _ => Ok(()),
    }
}

/// For people: "800 MB".
pub(super) fn bytes(count: u64) -> String {
    match count {
        0..10_000 => format!("{count} bytes"),
        10_000..10_000_000 => format!("{} KB", count / 1000),
        10_000_000..10_000_000_000 => format!("{} MB", count / 1_000_000),
        _ => format!("{} GB", count / 1_000_000_000),
    }
}
