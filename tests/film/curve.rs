use super::sample::{Folder, picture, write};
use lampray::film::Curve;
use lampray::knobs::Encoding;
use serde_json::json;
use std::fs::File;
use std::io::BufReader;

fn srgb(linear: f64) -> u8 {
    Curve {
        exposure: 0.0,
        encoding: Encoding::Srgb,
    }
    .encode(linear)
}

fn gamma22(linear: f64) -> u8 {
    Curve {
        exposure: 0.0,
        encoding: Encoding::Gamma22,
    }
    .encode(linear)
}

#[test]
fn srgb_at_known_values() {
    // 255 * 12.92 * 0.0031308 = 10.31; 255 * 0.735357 = 187.52; 255 * 0.461356 = 117.65.
    let known = [
        (0.0, 0),
        (0.0031308, 10),
        (0.5, 188),
        (0.18, 118),
        (1.0, 255),
        (2.0, 255),
    ];
    for (linear, byte) in known {
        assert_eq!(srgb(linear), byte, "{linear}");
    }
    // Every byte comes back from the linear value that it stands for.
    for byte in 0..=255_u8 {
        let value = f64::from(byte) / 255.0;
        let linear = if value <= 0.04045 {
            value / 12.92
        } else {
            ((value + 0.055) / 1.055).powf(2.4)
        };
        assert_eq!(srgb(linear), byte);
    }
}

#[test]
fn gamma_rounds_down() {
    // 255 * 0.5^(1/2.2) = 186.08; 255 * 0.18^(1/2.2) = 116.96.
    let known = [
        (0.0, 0),
        (0.5, 186),
        (0.18, 116),
        (0.999, 254),
        (1.0, 255),
        (2.0, 255),
    ];
    for (linear, byte) in known {
        assert_eq!(gamma22(linear), byte, "{linear}");
    }
}

#[test]
fn nothing_wraps() {
    for encode in [srgb, gamma22] {
        for black in [f64::NAN, -f64::NAN, -1.0, -1e-300, f64::NEG_INFINITY, -1e30] {
            assert_eq!(encode(black), 0, "{black}");
        }
        for white in [f64::INFINITY, f64::MAX, 256.0 / 255.0, 1e30] {
            assert_eq!(encode(white), 255, "{white}");
        }
    }
}

/// Decodes with the `png` crate, which knows nothing of lampray.
fn decode(path: &std::path::Path) -> (png::Info<'static>, Vec<u8>) {
    let decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    (reader.info().clone(), bytes)
}

#[test]
fn a_png_shows_exposure_and_encoding() {
    let folder = Folder::new();
    let mut picture = picture(0..4);
    picture.mean.fill([0.25, 0.5, 1.0]);
    picture.mean[0] = [f32::NAN, -3.0, f32::INFINITY];

    write(&picture, &folder.join("plain.png"));
    let (info, bytes) = decode(&folder.join("plain.png"));
    assert_eq!((info.width, info.height), (37, 21));
    assert_eq!(
        (info.color_type, info.bit_depth),
        (png::ColorType::Rgb, png::BitDepth::Eight)
    );
    assert!(info.srgb.is_some());
    assert_eq!(bytes[..6], [0, 0, 255, 137, 188, 255]);

    picture
        .record
        .knobs
        .insert("image.exposure".into(), json!(-1));
    write(&picture, &folder.join("dark.png"));
    assert_eq!(
        decode(&folder.join("dark.png")).1[3..6],
        [srgb(0.125), 137, 188]
    );

    picture
        .record
        .knobs
        .insert("image.exposure".into(), json!(1.0));
    picture
        .record
        .knobs
        .insert("image.encoding".into(), json!("gamma22"));
    write(&picture, &folder.join("gamma.png"));
    let (info, bytes) = decode(&folder.join("gamma.png"));
    assert_eq!(bytes[3..6], [186, 255, 255]);
    assert!(info.srgb.is_none());
    assert_eq!(
        info.gama_chunk.map(|gamma| gamma.into_scaled()),
        Some(45455)
    );
}
