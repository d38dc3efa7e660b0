//! References: blessed when asked, and limits measured.

use super::run::{diff, folder, json};
use serde_json::Value;
use std::fs;

#[test]
fn references_change_only_when_asked_to() {
    let folder = folder(&[
        ("a.exr", 64, 1, &[]),
        ("same.exr", 64, 2, &[]),
        ("other.exr", 64, 3, &["spheres.1.radius=0.3"]),
    ]);
    let at = folder.path();
    let bytes = |name: &str| fs::read(at.join(name)).expect("a file");
    let before = bytes("a.exr");
    assert_eq!(diff(at, &["a.exr", "other.exr"]).0, 1);
    assert_eq!(bytes("a.exr"), before);
    diff(at, &["a.exr", "same.exr", "--margin", "0.5", "--bless"]);
    assert_eq!(bytes("a.exr"), before);
    assert_eq!(diff(at, &["a.exr", "other.exr", "--bless"]).0, 0);
    assert_eq!(bytes("a.exr"), bytes("other.exr"));
    assert_eq!(diff(at, &["a.exr", "same.exr", "--bless=all"]).0, 0);
    assert_eq!(bytes("a.exr"), bytes("same.exr"));
    // A first reference.
    assert_eq!(diff(at, &["first.exr", "same.exr"]).0, 2);
    assert_eq!(diff(at, &["first.exr", "same.exr", "--bless"]).0, 0);
    assert_eq!(bytes("first.exr"), bytes("same.exr"));
    // A name stays true: no EXR becomes a PNG.
    assert_eq!(diff(at, &["new.png", "same.exr", "--bless"]).0, 2);
    assert!(!at.join("new.png").exists());
    assert_eq!(
        diff(at, &["a.exr", "other.exr", "--bless", "--crop", "0,0,8,8"]).0,
        2
    );
    // Never by what is not a picture.
    assert_eq!(diff(at, &["new.exr", "s.toml", "--bless"]).0, 2);
    assert!(!at.join("new.exr").exists());
}

#[test]
fn calibrate_proposes_a_limit_that_good_pictures_keep() {
    let folder = folder(&[
        ("a.exr", 16, 1, &[]),
        ("b.exr", 16, 77, &[]),
        ("other.exr", 16, 3, &["materials.lamp.emission=[14,14,14]"]),
    ]);
    let at = folder.path();
    let calibrate = [
        "--calibrate",
        "s.toml",
        "--samples",
        "16",
        "--metric",
        "rmse",
        "--metric",
        "ssim",
        "--device",
        "cpu",
    ];
    let (code, found) = json(at, &calibrate);
    assert_eq!(code, 0);
    let limit = |index: usize| found["proposals"][index]["limit"].to_string();
    let gates = |test: &str| {
        let (rmse, ssim) = (limit(0), limit(1));
        let arguments = [
            "a.exr", test, "--metric", "rmse", "--max", &rmse, "--metric", "ssim", "--min", &ssim,
        ];
        diff(at, &arguments).0
    };
    assert_eq!((gates("b.exr"), gates("other.exr")), (0, 1), "{found}");
    assert_eq!(found["proposals"][0]["comparisons"], 6);
    // Against a file that stays.
    let (code, against) = json(at, &[&["a.exr"], &calibrate[..]].concat());
    assert_eq!(
        (code, &against["proposals"][0]["comparisons"]),
        (0, &12.into())
    );
    // The size is looked at before anything is rendered.
    let wide = [&["a.exr"], &calibrate[..], &["--width", "33"]].concat();
    assert!(diff(at, &wide).2.contains("33 x 32"));
    // What so few comparisons say of so rare an event is no limit.
    let rare = [
        "--calibrate",
        "s.toml",
        "--samples",
        "1",
        "--metric",
        "flip",
        "--device",
        "cpu",
        "--seeds",
        "8",
        "--false-alarms",
        "1e-6",
    ];
    assert_eq!(json(at, &rare).1["proposals"][0]["limit"], Value::Null);
    assert_eq!(diff(at, &["--calibrate", "none.toml"]).0, 2);
    assert_eq!(diff(at, &["--calibrate", "s.toml", "--seeds", "1"]).0, 2);
}
