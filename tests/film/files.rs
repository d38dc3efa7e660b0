use super::sample::{Folder, SCENE, picture, write};
use lampray::Error;
use lampray::film::{Aov, Features, Picture, Record, SCENE_TEXT_LIMIT, read_exr, read_record};
use lampray::pack::Feature;
use std::fs;

/// Equal to the bit: `==` takes -0 for 0 and NaN for something else than itself.
fn assert_same_bits(a: &Picture, b: &Picture) {
    assert_eq!(bits(a), bits(b));
    assert_eq!((a.width, a.height), (b.width, b.height));
    assert_eq!(a.record, b.record);
    assert_eq!(a.scene_text, b.scene_text);
}

fn bits(picture: &Picture) -> Vec<Vec<u32>> {
    let triple = |plane: &[[f32; 3]]| plane.as_flattened().iter().map(|v| v.to_bits()).collect();
    let single = |plane: &[f32]| plane.iter().map(|v| v.to_bits()).collect();
    let mut planes = vec![
        triple(&picture.mean),
        triple(&picture.variance),
        single(&picture.samples),
    ];
    if let Some(features) = &picture.features {
        planes.push(features.normal.as_deref().map(triple).unwrap_or_default());
        planes.push(features.depth.as_deref().map(single).unwrap_or_default());
        planes.push(features.albedo.as_deref().map(triple).unwrap_or_default());
        planes.push(features.id.as_deref().map(single).unwrap_or_default());
    }
    planes
}

#[test]
fn an_exr_brings_every_channel_back_bit_for_bit() {
    let folder = Folder::new();
    let mut picture = picture(0..16);
    let odd = [
        f32::NAN,
        f32::INFINITY,
        -0.0,
        f32::MIN_POSITIVE / 4.0,
        f32::MAX,
        -1.5,
        1e-30,
    ];
    for (value, odd) in picture.mean.as_flattened_mut().iter_mut().zip(odd) {
        *value = odd;
    }
    write(&picture, &folder.join("a.exr"));
    let back = read_exr(folder.join("a.exr")).unwrap();
    assert_same_bits(&back, &picture);
    assert_eq!(bits(&back).len(), 7);

    // The test can fail: the smallest change of one value shows.
    let id = &mut picture.features.as_mut().unwrap().id.as_mut().unwrap()[500];
    *id = f32::from_bits(id.to_bits() ^ 1);
    assert_ne!(bits(&back), bits(&picture));
}

#[test]
fn layers_are_those_that_were_asked_for() {
    let folder = Folder::new();
    let mut picture = picture(0..4);
    let pixels = vec![
        Feature {
            depth: 2.5,
            ..Feature::default()
        };
        picture.pixels()
    ];
    picture.features = Features::new(&pixels, &[Aov::Depth]);
    write(&picture, &folder.join("a.exr"));
    let features = read_exr(folder.join("a.exr")).unwrap().features.unwrap();
    assert_eq!(features.depth, Some(vec![2.5; picture.pixels()]));
    assert_eq!(
        (features.normal, features.albedo, features.id),
        (None, None, None)
    );

    assert_eq!(Features::new(&pixels, &[]), None);
    picture.features = None;
    write(&picture, &folder.join("b.exr"));
    assert_eq!(read_exr(folder.join("b.exr")).unwrap().features, None);
}

#[test]
fn record_and_scene_come_back_from_both_formats() {
    let folder = Folder::new();
    let mut picture = picture(7..23);
    picture.record.crop = Some([1, 2, 38, 23]);
    for name in ["a.exr", "a.png"] {
        write(&picture, &folder.join(name));
        let (record, scene_text) = read_record(folder.join(name)).unwrap();
        assert_eq!(record, picture.record, "{name}");
        assert_eq!(scene_text.as_deref(), Some(SCENE), "{name}");
    }
    // What a file is goes by its bytes.
    fs::rename(folder.join("a.png"), folder.join("b.exr")).unwrap();
    assert_eq!(read_record(folder.join("b.exr")).unwrap().0, picture.record);
    assert!(matches!(
        read_exr(folder.join("b.exr")),
        Err(Error::Data { .. })
    ));
}

#[test]
fn scene_text_travels_up_to_its_limit() {
    let folder = Folder::new();
    let mut picture = picture(0..2);
    for (length, travels) in [(SCENE_TEXT_LIMIT, true), (SCENE_TEXT_LIMIT + 1, false)] {
        picture.scene_text = Some("#".repeat(length));
        for name in ["a.exr", "a.png"] {
            write(&picture, &folder.join(name));
            let scene_text = read_record(folder.join(name)).unwrap().1;
            assert_eq!(scene_text.is_some(), travels, "{name}");
            assert!(scene_text.is_none() || scene_text == picture.scene_text);
        }
    }
}

#[test]
fn equal_pictures_make_equal_bytes() {
    let folder = Folder::new();
    for name in ["a.exr", "b.exr", "c.exr", "a.png", "b.png", "c.png"] {
        write(&picture(0..8), &folder.join(name));
    }
    for format in ["exr", "png"] {
        let bytes = |name: &str| fs::read(folder.join(format!("{name}.{format}"))).unwrap();
        assert_eq!(bytes("a"), bytes("b"));
        assert_eq!(bytes("a"), bytes("c"));
        assert!(bytes("a").len() > 1000);
    }
}

/// Later versions may add fields; the order of today's is part of the contract.
#[test]
fn the_record_is_the_contract() {
    let record = picture(0..8).record;
    let json = record.to_json();
    let names = "version scene scene_hash shader_hash preset knobs kernel device width height crop \
        samples sample_range seed complete biased seconds paths rays non_finite mean \
        standard_error error_estimate outputs";
    let value: serde_json::Map<String, serde_json::Value> = serde_json::from_str(&json).unwrap();
    let keys: Vec<&str> = value.keys().map(String::as_str).collect();
    assert_eq!(keys, names.split_whitespace().collect::<Vec<_>>());

    let richer = json.replacen('{', "{\"weather\":{\"sun\":[1,2]},", 1);
    assert_eq!(serde_json::from_str::<Record>(&richer).unwrap(), record);
    let poorer = json.replacen("\"seed\"", "\"sead\"", 1);
    assert!(serde_json::from_str::<Record>(&poorer).is_err());
}

/// Records of before there was a choice of kernels have no name of one.
#[test]
fn a_record_without_a_kernel_is_read() {
    let record = picture(0..16).record;
    let mut json: serde_json::Value = serde_json::from_str(&record.to_json()).unwrap();
    assert_eq!(json["kernel"], "general");
    json.as_object_mut().unwrap().remove("kernel");
    let old: Record = serde_json::from_value(json).unwrap();
    assert_eq!(old.kernel, "");
    assert!(!old.to_json().contains("\"kernel\""));
}
