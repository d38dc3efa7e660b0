//! Files that are cut short, damaged or made to do harm: an error each time, never a panic.

use super::craft::{attribute, exr};
use super::sample::{Folder, Random, device, picture, write};
use lampray::Error;
use lampray::film::{Checkpoint, RasterFile, merge, read_exr, read_record};
use std::fs;
use std::io::Write;
use std::path::Path;

/// Reads in every way there is and says whether the file was accepted, by each.
fn read(path: &Path) -> [bool; 2] {
    let whole = read_exr(path).map(drop);
    let record = read_record(path).map(drop);
    [whole, record].map(|outcome| match outcome {
        Ok(()) => true,
        Err(Error::Data { reason, .. }) => {
            assert!(!reason.is_empty());
            false
        }
        Err(error) => panic!("{error:?}"),
    })
}

#[test]
fn files_that_are_cut_short() {
    let folder = Folder::new();
    let cut = folder.join("cut");
    for name in ["a.exr", "a.png"] {
        write(&picture(0..4), &folder.join(name));
        let bytes = fs::read(folder.join(name)).unwrap();
        for part in 0..50 {
            fs::write(&cut, &bytes[..bytes.len() * part / 50]).unwrap();
            assert!(!read(&cut)[0], "{part}/50 of {name} is taken for a picture");
        }
        fs::write(&cut, &bytes).unwrap();
        assert_eq!(read(&cut), [name == "a.exr", true]);
    }
}

#[test]
fn files_with_flipped_bits() {
    let folder = Folder::new();
    let damaged = folder.join("damaged");
    let mut random = Random(1);
    for name in ["a.exr", "a.png"] {
        write(&picture(0..4), &folder.join(name));
        let bytes = fs::read(folder.join(name)).unwrap();
        let mut refused = 0;
        for round in 0..3000 {
            let mut bytes = bytes.clone();
            // The header is small and does most; half of the damage is done there.
            let end = if round % 2 == 0 { bytes.len() } else { 3000 };
            for _ in 0..1 + random.below(3) {
                bytes[random.below(end)] ^= 1 << random.below(8);
            }
            fs::write(&damaged, &bytes).unwrap();
            refused += usize::from(!read(&damaged)[1]);
        }
        assert!(
            refused > 500,
            "{name}: only {refused} of 3000 damaged files were refused"
        );
    }
}

#[test]
fn inputs_that_are_something_else() {
    let folder = Folder::new();
    for path in [folder.join("missing.exr"), folder.path().to_path_buf()] {
        assert!(matches!(read_exr(&path), Err(Error::Input { .. })));
        assert!(matches!(read_record(&path), Err(Error::Input { .. })));
    }
    for bytes in [&b""[..], b"v", b"version = 1\n", b"\x89PNG", &[0; 4096]] {
        fs::write(folder.join("a.exr"), bytes).unwrap();
        assert_eq!(read(&folder.join("a.exr")), [false, false]);
    }
}

fn refusal(path: &Path) -> String {
    match read_record(path) {
        Err(Error::Data { reason, .. }) => reason,
        other => panic!("{other:?}"),
    }
}

#[test]
fn images_of_other_programs() {
    let folder = Folder::new();
    let exr = folder.join("other.exr");
    exr::prelude::write_rgb_file(&exr, 4, 4, |x, y| (x as f32, y as f32, 0.0_f32)).unwrap();
    let reason = refusal(&exr);
    assert!(reason.contains("not written by lampray"), "{reason}");
    assert!(matches!(read_exr(&exr), Err(Error::Data { .. })));

    let png = folder.join("other.png");
    let file = fs::File::create(&png).unwrap();
    let mut writer = png::Encoder::new(file, 1, 1).write_header().unwrap();
    writer.write_image_data(&[7]).unwrap();
    drop(writer);
    assert!(refusal(&png).contains("not written by lampray"));
}

/// A header of one float32 channel after another, with this record, and nothing behind it.
fn header(width: i32, height: i32, attributes: &[Vec<u8>]) -> Vec<u8> {
    let mut channels = Vec::new();
    for name in [
        "B",
        "G",
        "R",
        "samples",
        "variance.B",
        "variance.G",
        "variance.R",
    ] {
        channels.extend([name.as_bytes(), b"\0\x02\0\0\0\0\0\0\0\x01\0\0\0\x01\0\0\0"].concat());
    }
    channels.push(0);
    let window: Vec<u8> = [0, 0, width - 1, height - 1]
        .iter()
        .flat_map(|edge: &i32| edge.to_le_bytes())
        .collect();
    let mut bytes = b"\x76\x2f\x31\x01\x02\0\0\0".to_vec();
    bytes.extend(attribute("channels", "chlist", &channels));
    bytes.extend(attribute("compression", "compression", &[3]));
    bytes.extend(attribute("dataWindow", "box2i", &window));
    bytes.extend(attributes.concat());
    bytes.push(0);
    bytes
}

#[test]
fn sizes_that_are_only_announced() {
    let folder = Folder::new();
    let path = folder.join("a.exr");
    let mut record = picture(0..4).record;
    for (width, height) in [
        (16384, 16384),
        (32768, 8192),
        (32768, 32768),
        (i32::MAX, 1),
        (0, 0),
    ] {
        (record.width, record.height) = (width as u32, height as u32);
        let record = attribute("lampray", "string", record.to_json().as_bytes());
        fs::write(&path, header(width, height, &[record])).unwrap();
        assert!(
            matches!(read_exr(&path), Err(Error::Data { .. })),
            "{width} x {height}"
        );
    }
    // A header of the same make is read.
    (record.width, record.height) = (8, 8);
    let attributes = [attribute("lampray", "string", record.to_json().as_bytes())];
    fs::write(&path, header(8, 8, &attributes)).unwrap();
    assert_eq!(read_record(&path).unwrap().0, record);
}

#[test]
fn texts_that_unpack_without_end() {
    let folder = Folder::new();
    let json = picture(0..4).record.to_json();
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    for _ in 0..256 {
        encoder.write_all(&[b'#'; 1 << 20]).unwrap();
    }
    let bomb = encoder.finish().unwrap();
    assert!(bomb.len() < 1 << 20);

    let record = attribute("lampray", "string", json.as_bytes());
    let scene = attribute("lampray_scene", "zlib", &bomb);
    fs::write(folder.join("bomb.exr"), header(8, 8, &[record, scene])).unwrap();
    assert!(refusal(&folder.join("bomb.exr")).contains("larger than"));

    for keyword in ["lampray", "lampray.scene"] {
        let file = fs::File::create(folder.join("bomb.png")).unwrap();
        let mut writer = png::Encoder::new(file, 1, 1).write_header().unwrap();
        let text = [keyword.as_bytes(), b"\0\x01\0\0\0", &bomb].concat();
        writer.write_chunk(png::chunk::iTXt, &text).unwrap();
        drop(writer);
        assert!(refusal(&folder.join("bomb.png")).contains("larger than"));
    }
}

#[test]
fn records_that_are_not_records() {
    let folder = Folder::new();
    let good = picture(0..4).record.to_json();
    let deep = "[".repeat(100_000);
    let swapped = good.replace("\"sample_range\":[0,4]", "\"sample_range\":[4,0]");
    assert_ne!(swapped, good);
    for json in [
        "",
        "{}",
        "null",
        "\u{0}",
        &deep,
        &swapped,
        &good[..good.len() - 1],
    ] {
        let record = attribute("lampray", "string", json.as_bytes());
        fs::write(folder.join("a.exr"), header(8, 8, &[record])).unwrap();
        assert!(matches!(
            read_record(folder.join("a.exr")),
            Err(Error::Data { .. })
        ));
    }
}

/// Names in files may be long, and may hold what moves a terminal's cursor.
#[test]
fn names_that_are_made_for_a_terminal() {
    let folder = Folder::new();
    let path = folder.join("a.exr");
    let plain = |words: &str| {
        assert!(words.len() < 1000, "{} bytes", words.len());
        assert!(!words.contains(char::is_control), "{words:?}");
    };
    let bytes = exr(
        0,
        [0, 0, 0, 0],
        0,
        &[("\x1b[2J", 2), ("\x07", 2), ("c", 2)],
        &[],
    );
    fs::write(&path, bytes).unwrap();
    let error = RasterFile::open(&path).unwrap_err().to_string();
    assert!(error.contains("[2J"), "{error}");
    plain(&error);

    let (mut one, mut other) = (picture(0..4), picture(4..8));
    one.record.scene_hash = "\u{1b}[2J".repeat(1000);
    other.record.device.name = "\u{1b}]0;x\u{7}".repeat(1000);
    for (number, picture) in [&one, &picture(0..4), &other].into_iter().enumerate() {
        write(picture, &folder.join(format!("{number}.exr")));
    }
    for pair in [[0, 2], [1, 2]] {
        let files = pair.map(|number| folder.join(format!("{number}.exr")));
        let error = merge(&files, false).unwrap_err().to_string();
        plain(&error.replace(&*folder.path().to_string_lossy(), ""));
    }
}

/// A merged picture of a million devices would compare each with each.
#[test]
fn records_of_too_many_devices() {
    let folder = Folder::new();
    let path = folder.join("a.exr");
    for (count, taken) in [(4096, true), (4097, false)] {
        let mut picture = picture(0..4);
        picture.record.devices = vec![device("d"); count];
        write(&picture, &path);
        assert_eq!(read(&path)[1], taken, "{count}");
    }
}

/// A checkpoint whose checksum is right and whose head is not.
fn checkpoint(change: impl Fn(&mut serde_json::Value)) -> Vec<u8> {
    let mut record = serde_json::to_value(picture(0..4).record).unwrap();
    record["paths"] = 8.into();
    let mut head = serde_json::json!({
        "record": record, "samples": [0, 4], "region": [0, 0, 2, 1], "first_non_finite": null,
    });
    change(&mut head);
    let head = head.to_string();
    let sums = [0_u8; 2 * 48];
    let counts = [4_u64.to_le_bytes(); 2].concat();
    let length = (head.len() as u64).to_le_bytes();
    let content = [&b"lampray2"[..], &length, head.as_bytes(), &sums, &counts].concat();
    [&content[..], blake3::hash(&content).as_bytes()].concat()
}

/// What its file holds is all that there is memory for.
#[test]
fn checkpoints_of_pixels_that_are_not_there() {
    let folder = Folder::new();
    let path = folder.join("c");
    let reason = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        match Checkpoint::read(&path) {
            Ok(checkpoint) => {
                assert_eq!(checkpoint.film.paths, 8);
                "taken".to_string()
            }
            Err(error) => error.to_string(),
        }
    };
    assert_eq!(reason(&checkpoint(|_| {})), "taken");
    for (region, expected) in [
        ([5, 0, 4, 1], "of no pixels"),
        ([0, 9, 2, 8], "of no pixels"),
        ([0, 0, 0, 0], "of no pixels"),
        ([0, 0, u32::MAX, u32::MAX], "cut short"),
        ([0, 0, 1, 1], "cut short"),
    ] {
        let found = reason(&checkpoint(|head| head["region"] = region.to_vec().into()));
        assert!(found.contains(expected), "{region:?}: {found}");
    }
    let found = reason(&checkpoint(|head| head["record"]["paths"] = 9.into()));
    assert!(found.contains("no sums"), "{found}");
}

/// A digit that changed would still be a record; the checksum tells.
#[test]
fn no_bit_of_a_record_in_a_png_changes_unseen() {
    let folder = Folder::new();
    let path = folder.join("a.png");
    let picture = picture(0..4);
    write(&picture, &path);
    let bytes = fs::read(&path).unwrap();
    let json = picture.record.to_json();
    let start = bytes
        .windows(json.len())
        .position(|window| window == json.as_bytes())
        .unwrap();
    for place in start..start + json.len() {
        let mut bytes = bytes.clone();
        bytes[place] ^= 1;
        fs::write(&path, &bytes).unwrap();
        assert!(!read(&path)[1], "byte {place}");
    }
}
