//! EXR and PNG files made byte by byte, with whatever is to be wrong in them.

use std::io::Write;

pub fn attribute(name: &str, kind: &str, value: &[u8]) -> Vec<u8> {
    let mut bytes = [name.as_bytes(), b"\0", kind.as_bytes(), b"\0"].concat();
    bytes.extend((value.len() as u32).to_le_bytes());
    bytes.extend(value);
    bytes
}

pub const FLOAT: u32 = 2;
pub const RGB: [(&str, u32); 3] = [("B", FLOAT), ("G", FLOAT), ("R", FLOAT)];

/// The magic number and a header; the window is left, top, right, bottom.
pub fn exr(
    flags: u32,
    window: [i32; 4],
    compression: u8,
    channels: &[(&str, u32)],
    more: &[Vec<u8>],
) -> Vec<u8> {
    let mut list = Vec::new();
    for (name, kind) in channels {
        list.extend([name.as_bytes(), b"\0"].concat());
        list.extend([*kind, 0, 1, 1].map(u32::to_le_bytes).concat());
    }
    list.push(0);
    let mut bytes = b"\x76\x2f\x31\x01".to_vec();
    bytes.extend((2 | flags).to_le_bytes());
    bytes.extend(attribute("channels", "chlist", &list));
    bytes.extend(attribute("compression", "compression", &[compression]));
    let window = window.map(i32::to_le_bytes).concat();
    bytes.extend(attribute("dataWindow", "box2i", &window));
    bytes.extend(more.concat());
    bytes.push(0);
    bytes
}

/// The lines of a block without compression, all of one value.
pub fn block(y: i32, width: usize, value: f32) -> Vec<u8> {
    let pixels = [value; 3].repeat(width).into_iter().map(f32::to_le_bytes);
    let pixels: Vec<u8> = pixels.flatten().collect();
    [
        &y.to_le_bytes()[..],
        &(pixels.len() as u32).to_le_bytes(),
        &pixels,
    ]
    .concat()
}

pub fn png_chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let mut crc = flate2::Crc::new();
    crc.update(kind);
    crc.update(data);
    let size = (data.len() as u32).to_be_bytes();
    [&size, &kind[..], data, &crc.sum().to_be_bytes()].concat()
}

/// `kind` is depth, colours, compression, filter, interlacing.
pub fn png(width: u32, height: u32, kind: [u8; 5], chunks: &[Vec<u8>]) -> Vec<u8> {
    let header = [&width.to_be_bytes()[..], &height.to_be_bytes(), &kind].concat();
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    bytes.extend(png_chunk(b"IHDR", &header));
    bytes.extend(chunks.concat());
    bytes.extend(png_chunk(b"IEND", &[]));
    bytes
}

pub fn zlib(zeros: usize) -> Vec<u8> {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    let part = vec![0; zeros.min(1 << 20)];
    for start in (0..zeros).step_by(1 << 20) {
        encoder
            .write_all(&part[..part.len().min(zeros - start)])
            .unwrap();
    }
    encoder.finish().unwrap()
}

pub const RGB8: [u8; 5] = [8, 2, 0, 0, 0];
