//! Any program's PNG: as it is, and with its checksums made right, without which few changes are read.

use super::support;

pub fn run(bytes: &[u8]) {
    support::image(bytes);
    support::image(&mended(bytes));
}

/// The same chunks with the checksums that they should have.
fn mended(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let mut start = 8;
    while let Some(size) = bytes.get(start..start + 4) {
        let size = u32::from_be_bytes([size[0], size[1], size[2], size[3]]) as usize;
        let end = start + 8 + size;
        if end + 4 > bytes.len() {
            break;
        }
        let mut crc = flate2::Crc::new();
        crc.update(&bytes[start + 4..end]);
        bytes[end..end + 4].copy_from_slice(&crc.sum().to_be_bytes());
        start = end + 4;
    }
    bytes
}
