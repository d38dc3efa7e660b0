//! Files made to do harm to a reader of any program's images: refused at once, and with a reason.

use super::craft::{FLOAT, RGB, RGB8, attribute, block, exr, png, png_chunk, zlib};
use super::sample::Folder;
use lampray::Error;
use lampray::film::{Pixels, RasterFile};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// Two files at once, as they are compared.
fn outcome(path: &Path, bytes: &[u8]) -> Result<lampray::film::Raster, String> {
    fs::write(path, bytes).unwrap();
    let start = Instant::now();
    let read = || RasterFile::open(path).and_then(RasterFile::read);
    let (one, _) = rayon::join(read, read);
    let taken = start.elapsed();
    assert!(taken < Duration::from_secs(5), "{taken:?}");
    one.map_err(|error| match error {
        Error::Data { reason, .. } => reason,
        other => panic!("{other:?}"),
    })
}

fn assert_refused(path: &Path, bytes: &[u8], part: &str) {
    match outcome(path, bytes) {
        Err(reason) => assert!(reason.contains(part), "{reason}"),
        Ok(raster) => panic!("{part}: read as {} x {}", raster.width, raster.height),
    }
}

#[test]
fn sizes_out_of_all_proportion() {
    let folder = Folder::new();
    let path = folder.join("a");
    for (width, height) in [
        (0, 0),
        (0, 5),
        (65536, 65536),
        (32769, 1),
        (i32::MAX, 1),
        (32768, 32768),
    ] {
        let window = [0, 0, width - 1, height - 1];
        assert_refused(
            &path,
            &exr(0, window, 3, &RGB, &[]),
            "sides have 1 to 32768",
        );
        let bytes = png(
            width as u32,
            height as u32,
            RGB8,
            &[png_chunk(b"IDAT", &zlib(100))],
        );
        assert_refused(&path, &bytes, "sides have 1 to 32768");
    }
    let window = [i32::MIN, i32::MIN, i32::MAX, i32::MAX];
    assert_refused(
        &path,
        &exr(0, window, 0, &RGB, &[]),
        "4294967296 x 4294967296",
    );
    let window = [i32::MIN, i32::MIN, i32::MIN + 9, i32::MIN + 9];
    assert_refused(&path, &exr(0, window, 0, &RGB, &[]), "too far away");
    let window = [9, 9, 0, 0];
    assert_refused(&path, &exr(0, window, 0, &RGB, &[]), "sides have");
}

#[test]
fn pictures_that_are_only_announced() {
    let folder = Folder::new();
    let path = folder.join("a");
    // 16384 x 16384 pixels, with nothing behind the header, and with some zeros.
    let window = [0, 0, 16383, 16383];
    let mut bytes = exr(0, window, 3, &RGB, &[]);
    assert_refused(&path, &bytes, "bytes announce 3221 MB");
    bytes.resize(12_000, 0);
    assert_refused(&path, &bytes, "12 KB announce 3221 MB");
    // Each alone is small in the file, and large as pixels.
    let bytes = exr(0, window, 4, &[("Y", 1)], &[]);
    assert_refused(&path, &bytes, "announce 3221 MB");
    for kind in [RGB8, [16, 6, 0, 0, 1], [1, 0, 0, 0, 0], [1, 3, 0, 0, 1]] {
        let data = png_chunk(b"IDAT", &zlib(1 << 20));
        assert_refused(&path, &png(16384, 16384, kind, &[data]), "announce");
    }
    // A block of 4 GB in a file that is as large as its pixels would demand.
    let many: Vec<String> = (0..1024).map(|number| format!("{number:04}")).collect();
    let mut channels: Vec<(&str, u32)> = many.iter().map(|name| (name.as_str(), FLOAT)).collect();
    channels.splice(1021.., RGB);
    let mut bytes = exr(0, [0, 0, 32767, 31], 4, &channels, &[]);
    bytes.resize(22_000_000, 1);
    assert_refused(&path, &bytes, "blocks of 4294 MB are too large");
}

#[test]
fn what_is_small_enough_is_not_filled_before_it_arrives() {
    let folder = Folder::new();
    let path = folder.join("a");
    // 60 MB that are announced, and not there.
    let bytes = exr(0, [0, 0, 2235, 2235], 0, &RGB, &[]);
    assert_refused(&path, &bytes, "the file ends too early");
    let broken = [png_chunk(b"IDAT", &zlib(4000)), png_chunk(b"IDAT", &[])];
    assert_refused(&path, &png(4700, 4700, RGB8, &broken), "broken pixels");
}

#[test]
fn compressed_texts_and_profiles_stay_packed() {
    let folder = Folder::new();
    let path = folder.join("a.png");
    let bomb = zlib(1 << 30);
    let pixels = png_chunk(b"IDAT", &zlib(4 * 13));
    let text = png_chunk(b"zTXt", &[b"Comment\0\0", &bomb[..]].concat());
    let other = png_chunk(b"iTXt", &[b"Comment\0\x01\0\0\0", &bomb[..]].concat());
    let profile = png_chunk(b"iCCP", &[b"Profile\0\0", &bomb[..]].concat());
    let chunks = [text, other, profile, pixels.clone()];
    let raster = outcome(&path, &png(4, 4, RGB8, &chunks)).unwrap();
    assert_eq!(raster.left_aside, ["colour profile"]);
    assert!(matches!(raster.pixels, Pixels::Bytes(pixels, _) if pixels == [[0; 3]; 16]));
    for place in [0, 1] {
        let mut chunks = vec![pixels.clone()];
        let record = [b"lampray\0\x01\0\0\0", &bomb[..]].concat();
        chunks.insert(place, png_chunk(b"iTXt", &record));
        assert_refused(&path, &png(4, 4, RGB8, &chunks), "larger than");
    }
    // More pixels than the picture has room for.
    let bytes = png(4, 4, RGB8, &[png_chunk(b"IDAT", &bomb)]);
    assert!(outcome(&path, &bytes).is_ok_and(|raster| raster.len() == 16));
}

#[test]
fn blocks_that_lie() {
    let folder = Folder::new();
    let path = folder.join("a.exr");
    let header = exr(0, [-3, -2, 0, 1], 0, &RGB, &[]);
    let blocks = [-2, -1, 0, 1].map(|y| block(y, 4, y as f32));
    let file = |offset: u64, blocks: &[Vec<u8>]| {
        let table = [offset; 4].map(u64::to_le_bytes).concat();
        [header.clone(), table, blocks.concat()].concat()
    };
    // The table is not needed, so no lie of its can do harm; nor can the order of the blocks.
    let mut shuffled = blocks.clone();
    shuffled.swap(0, 3);
    for offset in [0, 1, u64::MAX] {
        let raster = outcome(&path, &file(offset, &shuffled)).unwrap();
        assert_eq!(raster.origin, [-3, -2]);
        let expected: Vec<[f32; 3]> = (0..16).map(|pixel| [(pixel / 4) as f32 - 2.0; 3]).collect();
        assert!(matches!(raster.pixels, Pixels::Linear(pixels) if pixels == expected));
    }
    let with = |number: usize, bytes: Vec<u8>| {
        let mut blocks = blocks.clone();
        blocks[number] = bytes;
        file(0, &blocks)
    };
    assert_refused(&path, &with(1, blocks[0].clone()), "there twice");
    for y in [2, -3, i32::MAX, i32::MIN] {
        assert_refused(&path, &with(3, block(y, 4, 0.0)), "outside of the picture");
    }
    assert_refused(
        &path,
        &with(2, block(0, 5, 0.0)),
        "a block of pixels of 60 bytes",
    );
    assert_refused(&path, &with(2, block(0, 3, 0.0)), "broken pixels");
    for size in [0_u32, 49, u32::MAX] {
        let bytes = [0_u32.to_le_bytes(), size.to_le_bytes()].concat();
        assert_refused(&path, &with(2, bytes), "a block of pixels of");
    }
}

#[test]
fn attributes_that_lie() {
    let folder = Folder::new();
    let path = folder.join("a.exr");
    let start = b"\x76\x2f\x31\x01\x02\0\0\0";
    for (name, kind) in [
        ("channels", "chlist"),
        ("lampray", "string"),
        ("preview", "preview"),
    ] {
        for (size, part) in [(1 << 20, "ends too early"), (u32::MAX, "over the limit")] {
            let mut bytes = attribute(name, kind, &[]);
            let end = bytes.len() - 4;
            bytes.splice(end.., size.to_le_bytes());
            let limited = size == u32::MAX || name == "channels";
            let part = if limited { "over the limit" } else { part };
            assert_refused(&path, &[start, &bytes[..]].concat(), part);
        }
    }
    let tiles = |size: [u32; 2], mode: u8| {
        let value = [&size.map(u32::to_le_bytes).concat()[..], &[mode]].concat();
        exr(
            0x200,
            [0, 0, 3, 3],
            0,
            &RGB,
            &[attribute("tiles", "tiledesc", &value)],
        )
    };
    assert_refused(&path, &tiles([0, 4], 0), "description of tiles");
    assert_refused(&path, &tiles([4, 4], 3), "description of tiles");
    assert_refused(&path, &tiles([u32::MAX, u32::MAX], 0x12), "ends too early");
    assert_refused(
        &path,
        &exr(0x200, [0, 0, 3, 3], 0, &RGB, &[]),
        "without a description",
    );
    assert_refused(
        &path,
        &exr(
            0x800,
            [0, 0, 3, 3],
            0,
            &RGB,
            &[attribute("type", "string", b"deepscanline")],
        ),
        "deep",
    );
    assert_refused(
        &path,
        &exr(0x1000, [0, 0, 3, 3], 0, &RGB, &[]),
        "ends too early",
    );
    let twice = [("R", FLOAT), ("R", FLOAT)];
    assert_refused(&path, &exr(0, [0, 0, 3, 3], 0, &twice, &[]), "twice");
    assert_refused(
        &path,
        &exr(0, [0, 0, 3, 3], 0, &[("R", 3)], &[]),
        "a type that EXR lacks",
    );
    assert_refused(&path, &exr(0, [0, 0, 3, 3], 0, &[], &[]), "no channel");
}

/// Many layers are no harm.
#[test]
fn hundreds_of_layers() {
    let folder = Folder::new();
    let names: Vec<String> = (0..300).map(|number| format!("Z{number:03}.R")).collect();
    let mut channels = RGB.to_vec();
    channels.extend(names.iter().map(|name| (name.as_str(), FLOAT)));
    let mut bytes = exr(0, [0, 0, 0, 0], 0, &channels, &[]);
    bytes.extend([0; 8]);
    bytes.extend([0_u32.to_le_bytes(), (303 * 4_u32).to_le_bytes()].concat());
    bytes.extend((0..303).flat_map(|value| (value as f32).to_le_bytes()));
    let raster = outcome(&folder.join("a"), &bytes).unwrap();
    assert_eq!(raster.left_aside, ["channels Z000.R, Z001.R and 298 more"]);
    assert!(matches!(raster.pixels, Pixels::Linear(pixels) if pixels == [[2.0, 1.0, 0.0]]));
}

#[test]
fn chunks_that_lie() {
    let folder = Folder::new();
    let path = folder.join("a.png");
    let pixels = png_chunk(b"IDAT", &zlib(4 * 13));
    let one = std::slice::from_ref(&pixels);
    let good = png(4, 4, RGB8, one);
    assert!(outcome(&path, &good).is_ok());
    let at = good
        .windows(4)
        .position(|window| window == b"IDAT")
        .unwrap();
    for (size, part) in [
        (1_u32 << 30, "ends too early"),
        (u32::MAX, "larger than PNG allows"),
    ] {
        let mut bytes = good.clone();
        bytes[at - 4..at].copy_from_slice(&size.to_be_bytes());
        assert_refused(&path, &bytes, part);
    }
    let mut bytes = good.clone();
    bytes[at + 9] ^= 1;
    assert_refused(&path, &bytes, "broken pixels");
    assert_refused(&path, &png(4, 4, RGB8, &[]), "without pixels");
    assert_refused(&path, &png(4, 4, [8, 3, 0, 0, 0], one), "broken pixels");
    let text = png_chunk(b"tEXt", b"x\0y");
    let late = [pixels.clone(), text, pixels.clone()];
    assert!(outcome(&path, &png(4, 4, RGB8, &late)).is_ok());
    for kind in [
        [8, 1, 0, 0, 0],
        [3, 0, 0, 0, 0],
        [16, 3, 0, 0, 0],
        [4, 2, 0, 0, 0],
    ] {
        assert_refused(&path, &png(4, 4, kind, one), "that PNG lacks");
    }
    for kind in [[8, 2, 1, 0, 0], [8, 2, 0, 1, 0], [8, 2, 0, 0, 2]] {
        assert_refused(&path, &png(4, 4, kind, one), "the header is broken");
    }
}

/// Bits from the most significant one on.
#[derive(Default)]
struct Bits(Vec<u8>, usize);

impl Bits {
    fn put(&mut self, value: u32, count: usize) {
        for bit in (0..count).rev() {
            if self.1.is_multiple_of(8) {
                self.0.push(0);
            }
            let byte = self.0.len() - 1;
            self.0[byte] |= ((value >> bit & 1) as u8) << (7 - self.1 % 8);
            self.1 += 1;
        }
    }
}

/// A PIZ block of a few thousand values whose codes of 30 bits differ in the last 16 only, the
/// last of them each time, and of runs of one.
fn slow_block(values: usize) -> Vec<u8> {
    let mut table = Bits::default();
    for _ in 0..65537 {
        table.put(30, 6);
    }
    let mut data = Bits::default();
    let room = values * 2 - 8192 - table.0.len() - 4000;
    let slow = room * 8 / 30;
    for _ in 0..slow {
        data.put(65535, 30);
    }
    let mut left = values - slow;
    while left > 0 {
        let run = left.min(255);
        data.put(65536, 30);
        data.put(run as u32, 8);
        left -= run;
    }
    let sizes = [0, 65536, table.0.len() as u32, data.1 as u32, 0];
    let coded = [sizes.map(u32::to_le_bytes).concat(), table.0, data.0].concat();
    let head = [0_u16.to_le_bytes(), 8191_u16.to_le_bytes()].concat();
    let size = (coded.len() as u32).to_le_bytes();
    [&head[..], &[255; 8192], &size, &coded].concat()
}

/// Read as it stands, this takes 20 seconds.
#[test]
fn codes_that_take_for_ever() {
    let folder = Folder::new();
    let block = slow_block(8192 * 32);
    assert!(block.len() < 8192 * 32 * 2);
    let mut bytes = exr(0, [0, 0, 8191, 31], 4, &[("Y", 1)], &[]);
    bytes.extend([0; 12]);
    bytes.extend((block.len() as u32).to_le_bytes());
    bytes.extend(block);
    assert_refused(&folder.join("a.exr"), &bytes, "codes that no encoder makes");
}
