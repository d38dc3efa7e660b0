//! EXR files of other programs; tests/fixtures/README.md says which.

use super::craft::{RGB, attribute, block, exr};
use super::sample::{Folder, fixture, picture, write};
use lampray::Error;
use lampray::film::{Pixels, Raster, RasterFile};
use std::fs;

const WIDTH: usize = 21;
const HEIGHT: usize = 35;

/// The formulas of make.py.
fn formula(x: usize, y: usize) -> [f32; 3] {
    let pattern = (x * 7 + y * 13) % 32;
    [
        x as f32 * 0.25 - 3.0,
        (y * y) as f32 * 0.5,
        pattern as f32 / 16.0,
    ]
}

fn read(name: &str) -> Raster {
    RasterFile::open(fixture(name)).unwrap().read().unwrap()
}

fn linear(raster: &Raster) -> &[[f32; 3]] {
    match &raster.pixels {
        Pixels::Linear(pixels) => pixels,
        other => panic!("{other:?}"),
    }
}

fn assert_formula(raster: &Raster, value: impl Fn(usize, usize) -> [f32; 3]) {
    assert_eq!((raster.width, raster.height), (WIDTH as u32, HEIGHT as u32));
    let pixels = linear(raster);
    assert_eq!(pixels.len(), WIDTH * HEIGHT);
    for (number, pixel) in pixels.iter().enumerate() {
        let (x, y) = (number % WIDTH, number / WIDTH);
        assert_eq!(*pixel, value(x, y), "{x}, {y} of {}", raster.format);
    }
}

fn refusal(name: &str) -> String {
    match RasterFile::open(fixture(name)).and_then(RasterFile::read) {
        Err(Error::Data { reason, .. }) => reason,
        other => panic!("{other:?}"),
    }
}

#[test]
fn every_lossless_compression() {
    for (name, format) in [
        ("none_half", "EXR, half, uncompressed"),
        ("rle_half", "EXR, half, RLE"),
        ("zips_float", "EXR, float, ZIPS"),
        ("zip_float", "EXR, float, ZIP"),
        ("piz_half", "EXR, half, PIZ"),
        ("piz_float", "EXR, float, PIZ"),
        ("pxr24_half", "EXR, half, PXR24"),
        ("decreasing", "EXR, half, ZIP"),
        ("mitsuba_half", "EXR, half, PIZ"),
    ] {
        let raster = read(&format!("{name}.exr"));
        assert_formula(&raster, formula);
        assert_eq!(raster.format, format);
        assert_eq!(raster.left_aside, [""; 0], "{name}");
        assert_eq!(raster.origin, [0, 0]);
        assert!(raster.noise.is_none() && raster.record.is_none());
    }
    for name in ["mixed_zip.exr", "mixed_piz.exr"] {
        assert_formula(&read(name), |x, y| {
            let [r, g, b] = formula(x, y);
            [r, g, b * 16.0]
        });
    }
}

/// As OpenEXR itself reads them.
#[test]
fn every_lossy_compression() {
    for name in ["pxr24_float", "b44_half", "b44a_half"] {
        let raster = read(&format!("{name}.exr"));
        let stored = fs::read(fixture(&format!("{name}.rgb"))).unwrap();
        let (values, _) = stored.as_chunks();
        let expected: Vec<f32> = values
            .iter()
            .map(|value| f32::from_le_bytes(*value))
            .collect();
        assert_eq!(expected.len(), 11 * 13 * 3);
        assert_eq!(linear(&raster).as_flattened(), expected, "{name}");
    }
}

#[test]
fn tiles_levels_and_windows() {
    let raster = read("tiles.exr");
    assert_formula(&raster, formula);
    assert_eq!(raster.format, "EXR, half, ZIP, tiles");
    let raster = read("mipmap.exr");
    assert_formula(&raster, formula);
    assert_eq!(raster.left_aside, ["smaller levels"]);

    let file = RasterFile::open(fixture("negative_origin.exr")).unwrap();
    assert_eq!((file.width(), file.height()), (WIDTH as u32, HEIGHT as u32));
    assert_eq!(file.origin(), [-7, -40]);
    let raster = file.read().unwrap();
    assert_formula(&raster, formula);
    assert_eq!(raster.origin, [-7, -40]);
}

/// No program at hand writes levels that are smaller in one direction only.
#[test]
fn levels_by_direction() {
    let folder = Folder::new();
    for (mode, levels) in [(2, 3), (0x12, 4)] {
        let side = 4 + i32::from(levels == 4);
        let size = [8_u32, 8].map(u32::to_le_bytes).concat();
        let tiles = attribute("tiles", "tiledesc", &[&size[..], &[mode]].concat());
        let mut bytes = exr(0x200, [0, 0, side - 1, side - 1], 0, &RGB, &[tiles]);
        bytes.extend(vec![0; levels * levels * 8]);
        // The full resolution comes last.
        for number in (0..levels * levels).rev() {
            let (x, y) = ((number % levels) as i32, (number / levels) as i32);
            bytes.extend([0, 0, x, y].map(i32::to_le_bytes).concat());
            let pixels = if number == 0 { side * side } else { 1 };
            bytes.extend((pixels * 12).to_le_bytes());
            let value = (number as f32 + 0.5).to_le_bytes();
            bytes.extend(value.repeat(pixels as usize * 3));
        }
        let path = folder.join("a.exr");
        fs::write(&path, &bytes).unwrap();
        let raster = RasterFile::open(&path).unwrap().read().unwrap();
        assert_eq!(linear(&raster), vec![[0.5; 3]; (side * side) as usize]);
        // Nothing is left over.
        fs::write(&path, &bytes[..bytes.len() - 1]).unwrap();
        assert!(RasterFile::open(&path).unwrap().read().is_err());
    }
}

/// It may have come through a program that copies attributes; one that is broken is a fault.
#[test]
fn records_of_other_pictures() {
    let folder = Folder::new();
    let path = folder.join("a.exr");
    let json = picture(0..4).record.to_json();
    for (json, accepted) in [(&json[..], true), (&json[1..], false)] {
        let record = attribute("lampray", "string", json.as_bytes());
        let mut bytes = exr(0, [0, 0, 3, 0], 0, &RGB, &[record]);
        bytes.extend([0; 8]);
        bytes.extend(block(0, 4, 1.5));
        fs::write(&path, &bytes).unwrap();
        match RasterFile::open(&path).and_then(RasterFile::read) {
            Ok(raster) => {
                assert!(accepted && raster.record.is_none());
                let note = "the record, which is of a picture of another size";
                assert_eq!(raster.left_aside, [note]);
            }
            Err(Error::Data { reason, .. }) => {
                assert!(
                    !accepted && reason.contains("the record inside"),
                    "{reason}"
                );
            }
            Err(error) => panic!("{error:?}"),
        }
    }
}

#[test]
fn the_first_of_many_parts() {
    let raster = read("parts.exr");
    assert_formula(&raster, formula);
    assert_eq!(raster.left_aside, ["parts depth and diffuse"]);
}

#[test]
fn the_picture_among_other_channels() {
    let blender = read("blender_names.exr");
    assert_formula(&blender, formula);
    assert_eq!(blender.format, "EXR, half, ZIP, layer ViewLayer.Combined");
    let others = "channels Composite.Vector.R, ViewLayer.Depth.Z and 3 more";
    assert_eq!(blender.left_aside, ["alpha", others]);

    let pbrt = read("pbrt.exr");
    assert_formula(&pbrt, formula);
    assert_eq!(pbrt.left_aside, ["channels Albedo.B, Albedo.G and 17 more"]);
    // Its variance is of another make, and no number of samples stands beside it.
    assert!(pbrt.noise.is_none());

    let layers = read("layers.exr");
    assert_formula(&layers, formula);
    assert_eq!(layers.format, "EXR, half, ZIP, layer cold");
    assert_eq!(layers.left_aside, ["channels warm.B, warm.G and 1 more"]);

    let grey = read("grey.exr");
    assert_formula(&grey, |x, y| [formula(x, y)[1]; 3]);
    assert_eq!(grey.format, "EXR, half, ZIP, grey");

    let aov = read("mitsuba_aov.exr");
    assert_eq!(linear(&aov), [[0.75; 3]; 48]);
    let others = "channels depth.T, image.A and 3 more";
    assert_eq!(aov.left_aside, [others]);
}

/// A sky of one colour.
#[test]
fn blender_itself() {
    let half = read("blender_half.exr");
    assert_eq!(linear(&half), [[0.25, 0.5, 0.75]; 12 * 8]);
    assert_eq!(half.format, "EXR, half, PIZ");
    assert_eq!(half.left_aside, ["alpha"]);
    let layers = read("blender_multilayer.exr");
    assert_eq!(linear(&layers), [[0.25, 0.5, 0.75]; 12 * 8]);
    assert_eq!(layers.format, "EXR, float, ZIP, layer ViewLayer.Combined");
    let others = "parts ViewLayer.Depth, ViewLayer.Normal and 1 more";
    assert_eq!(layers.left_aside, ["alpha", others]);
    let png = read("blender_16.png");
    assert_eq!(png.format, "PNG, 16 bits");
    assert!(matches!(png.pixels, Pixels::Words(pixels, _) if pixels == [pixels[0]; 12 * 8]));
}

#[test]
fn noise_comes_along() {
    let raster = read("noise.exr");
    assert_formula(&raster, formula);
    assert_eq!(raster.left_aside, ["alpha"]);
    let noise = raster.noise.unwrap();
    assert_eq!(noise.variance, [[0.5, 0.25, 0.125]; WIDTH * HEIGHT]);
    assert_eq!(noise.samples, [64.0; WIDTH * HEIGHT]);
}

#[test]
fn values_that_are_not_finite_are_kept() {
    let raster = read("odd_values.exr");
    let red: Vec<u32> = linear(&raster)
        .iter()
        .map(|pixel| pixel[0].to_bits())
        .collect();
    assert!(f32::from_bits(red[0]).is_nan());
    let least = 1.0 / 16_777_216.0;
    let expected = [f32::INFINITY, f32::NEG_INFINITY, -0.0, least, 65504.0];
    assert_eq!(red[1..], expected.map(f32::to_bits));
    assert_eq!(linear(&raster)[0][1], 65504.0);
}

#[test]
fn what_is_not_read_is_refused_with_a_remedy() {
    for (name, reasons) in [
        ("dwaa_half.exr", ["DWAA", "ZIP"]),
        ("blender_dwaa.exr", ["DWAA", "PIZ"]),
        ("subsampled.exr", ["\"RY\"", "2 x 2"]),
        (
            "no_picture.exr",
            ["neither R, G and B nor Y", "channels N.X, N.Y and 1 more"],
        ),
    ] {
        let reason = refusal(name);
        for part in reasons {
            assert!(reason.contains(part), "{reason}");
        }
    }
}

#[test]
fn lampray_s_own_picture() {
    let folder = Folder::new();
    let picture = picture(0..8);
    write(&picture, &folder.join("a.exr"));
    let raster = RasterFile::open(folder.join("a.exr"))
        .unwrap()
        .read()
        .unwrap();
    assert_eq!(linear(&raster), picture.mean);
    assert_eq!(raster.record.as_ref(), Some(&picture.record));
    assert_eq!(
        raster.left_aside,
        ["channels albedo.B, albedo.G and 6 more"]
    );
    let noise = raster.noise.unwrap();
    assert_eq!(noise.variance, picture.variance);
    assert_eq!(noise.samples, picture.samples);
}
