//! PNG files of other programs; tests/fixtures/README.md says which.

use super::sample::{Folder, fixture, picture, write};
use lampray::film::{Pixels, Raster, RasterFile, Transfer};
use serde_json::json;

const WIDTH: usize = 13;
const HEIGHT: usize = 9;

/// The formula of make.py.
fn value(x: usize, y: usize, channel: usize, depth: u32) -> u32 {
    ((x * 41 + y * 23 + channel * 97) * 257) as u32 % (1 << depth)
}

fn read(name: &str) -> Raster {
    RasterFile::open(fixture(name)).unwrap().read().unwrap()
}

fn values(raster: &Raster) -> Vec<[u32; 3]> {
    assert_eq!((raster.width, raster.height), (WIDTH as u32, HEIGHT as u32));
    match &raster.pixels {
        Pixels::Bytes(pixels, _) => pixels.iter().map(|pixel| pixel.map(u32::from)).collect(),
        Pixels::Words(pixels, _) => pixels.iter().map(|pixel| pixel.map(u32::from)).collect(),
        other => panic!("{other:?}"),
    }
}

fn expected(pixel: impl Fn(usize, usize) -> [u32; 3]) -> Vec<[u32; 3]> {
    let places = (0..WIDTH * HEIGHT).map(|number| (number % WIDTH, number / WIDTH));
    places.map(|(x, y)| pixel(x, y)).collect()
}

#[test]
fn grey_of_every_depth() {
    for depth in [1, 2, 4, 8, 16] {
        // The whole range is used, whatever the depth.
        let scale = if depth == 16 {
            1
        } else {
            255 / ((1 << depth) - 1)
        };
        let expected = expected(|x, y| [value(x, y, 0, depth) * scale; 3]);
        for interlaced in ["", "_interlaced"] {
            let name = format!("grey_{depth}{interlaced}.png");
            let raster = read(&name);
            assert_eq!(values(&raster), expected, "{name}");
            let plural = if depth == 1 { "" } else { "s" };
            assert_eq!(raster.format, format!("PNG, {depth} bit{plural}, grey"));
            assert_eq!(raster.left_aside, [""; 0]);
        }
    }
}

#[test]
fn colours_and_alpha() {
    for depth in [8, 16] {
        for (kind, alpha) in [("grey_alpha", true), ("rgb", false), ("rgba", true)] {
            // In a row, the samples of all channels of a pixel stand together.
            let channel = |c: usize| if kind == "grey_alpha" { 0 } else { c };
            let expected = expected(|x, y| [0, 1, 2].map(|c| value(x, y, channel(c), depth)));
            for interlaced in ["", "_interlaced"] {
                let name = format!("{kind}_{depth}{interlaced}.png");
                let raster = read(&name);
                assert_eq!(values(&raster), expected, "{name}");
                assert_eq!(raster.left_aside == ["alpha"], alpha, "{name}");
            }
        }
    }
}

#[test]
fn palettes() {
    for depth in [1, 4, 8] {
        let colours = 17.min(1 << depth);
        let expected = expected(|x, y| {
            let index = value(x, y, 0, depth) % colours;
            [index * 15, 255 - index, index]
        });
        let raster = read(&format!("palette_{depth}.png"));
        assert_eq!(values(&raster), expected);
        assert!(raster.format.ends_with("palette"));
    }
}

fn transfer(raster: &Raster) -> Transfer {
    match raster.pixels {
        Pixels::Bytes(_, transfer) | Pixels::Words(_, transfer) => transfer,
        Pixels::Linear(_) => panic!("a PNG is encoded"),
    }
}

#[test]
fn what_values_stand_for() {
    assert_eq!(transfer(&read("rgb_8.png")), Transfer::Srgb);
    assert_eq!(transfer(&read("gamma_45455.png")), Transfer::Srgb);
    assert_eq!(transfer(&read("gamma_1.png")), Transfer::Power(1.0));

    // The record knows better than the chunk of gamma, which holds 1 / 2.2.
    let folder = Folder::new();
    let mut picture = picture(0..4);
    for (encoding, expected) in [("srgb", Transfer::Srgb), ("gamma22", Transfer::Power(2.2))] {
        let knobs = &mut picture.record.knobs;
        knobs.insert("image.encoding".into(), json!(encoding));
        write(&picture, &folder.join("a.png"));
        let raster = RasterFile::open(folder.join("a.png"))
            .unwrap()
            .read()
            .unwrap();
        assert_eq!(transfer(&raster), expected);
        assert_eq!(raster.record.as_ref(), Some(&picture.record));
    }
}

#[test]
fn what_is_left_aside_is_said() {
    let expected = expected(|x, y| [0, 1, 2].map(|c| value(x, y, c, 8)));
    for (name, left_aside) in [
        ("pillow_profile.png", "colour profile"),
        ("pillow_animated.png", "animation after the first frame"),
    ] {
        let raster = read(name);
        assert_eq!(values(&raster), expected, "{name}");
        assert_eq!(raster.left_aside, [left_aside]);
    }
    let transparent = read("pillow_transparent.png");
    assert_eq!(transparent.left_aside, ["alpha"]);
}
