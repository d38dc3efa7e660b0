//! Limits, HDR-FLIP's exposures, and maps.

use super::run::{diff, folder, json};

#[test]
fn limits_pass_and_fail() {
    let folder = folder(&[
        ("a.png", 16, 1, &[]),
        ("b.png", 16, 2, &[]),
        ("a.exr", 16, 1, &[]),
    ]);
    let at = folder.path();
    for (limits, code) in [
        (&["--metric", "mse", "--max", "0"][..], 1),
        (&["--metric", "mse", "--max", "1"], 0),
        (
            &[
                "--metric", "psnr", "--min", "5", "--metric", "ssim", "--min", "0.1",
            ],
            0,
        ),
        (
            &[
                "--metric", "psnr", "--min", "5", "--metric", "ssim", "--min", "0.999",
            ],
            1,
        ),
        (&["--metric", "flip", "--max", "0.5"], 0),
        (
            &["--metric", "mae", "--max", "0.001", "--allow-pixels", "1"],
            1,
        ),
        (
            &[
                "--metric",
                "mae",
                "--max",
                "0.001",
                "--allow-pixels",
                "100%",
            ],
            0,
        ),
        (&["--metric", "rmse"], 1),
        // Mistakes.
        (&["--max", "1"], 2),
        (&["--metric", "psnr", "--max", "1"], 2),
        (&["--metric", "mse", "--min", "1"], 2),
        (&["--metric", "mse", "--max", "nan"], 2),
        (&["--metric", "mse", "--max", "1", "--max", "2"], 2),
        (
            &["--metric", "psnr", "--min", "1", "--allow-pixels", "4"],
            2,
        ),
        (
            &["--metric", "mse", "--max", "1", "--allow-pixels", "many"],
            2,
        ),
        (&["--metric", "hdr-flip", "--max", "1"], 2),
        (&["--metric", "nonsense"], 2),
        (&["--metric", "mse", "--max", "-1"], 2),
        (&["--metric", "mse", "--max", "inf"], 2),
        (&["--metric", "ssim", "--min", "30"], 2),
        (&["--spp", "4"], 2),
        (&["--device", "cpu"], 2),
        (&["--alpha", "0"], 2),
        (&["--ppd", "0"], 2),
        (&["--exposures", "1,0,3"], 2),
        (&["--crop", "0,0,33,32"], 2),
    ] {
        let found = diff(at, &[&["a.png", "b.png"], limits].concat());
        assert_eq!(found.0, code, "{limits:?}: {}{}", found.1, found.2);
    }
    let (_, words, _) = diff(at, &["a.png", "b.png", "--metric", "mae", "--max", "0"]);
    assert!(
        words.contains("FAILS") && words.contains("pixels beyond each limit of mae"),
        "{words}"
    );
    let (code, failed) = json(at, &["a.png", "b.png", "--metric", "mae", "--max", "0"]);
    assert_eq!(code, 1);
    assert!(
        failed["gates"][0]["curve"]
            .as_array()
            .is_some_and(|curve| curve.len() > 3)
    );
    // A failed limit names one that passes.
    let named = |limits: &[&str]| {
        let (code, failed) = json(at, &[&["a.png", "b.png"], limits].concat());
        assert_eq!(code, 1, "{limits:?}");
        failed["gates"][0]["passing"].to_string()
    };
    let passing = named(&["--metric", "flip", "--max", "0", "--allow-pixels", "10%"]);
    let again = [
        "--metric",
        "flip",
        "--max",
        &passing,
        "--allow-pixels",
        "10%",
    ];
    assert_eq!(
        diff(at, &[&["a.png", "b.png"], &again[..]].concat()).0,
        0,
        "{passing}"
    );
    let passing = named(&["--metric", "ssim", "--min", "1"]);
    assert_eq!(
        diff(
            at,
            &["a.png", "b.png", "--metric", "ssim", "--min", &passing]
        )
        .0,
        0
    );
    // A PNG beside the EXR of the same render: the rounding to 8 bits, and what is cut off at white.
    assert_eq!(
        diff(at, &["a.exr", "a.png", "--metric", "flip", "--max", "0.02"]).0,
        0
    );
}

#[test]
fn hdr_flip_s_exposures_are_stored_and_given_again() {
    let folder = folder(&[("a.exr", 16, 1, &[]), ("b.exr", 16, 2, &[])]);
    let hdr = ["a.exr", "b.exr", "--metric", "hdr-flip"];
    let (_, first) = json(folder.path(), &hdr);
    let stored = &first["exposures"];
    let text = format!("{},{},{}", stored["start"], stored["stop"], stored["count"]);
    let again = [&hdr[..], &["--exposures", &text]].concat();
    assert_eq!(json(folder.path(), &again).1["figures"], first["figures"]);
    let other = [&hdr[..], &["--exposures", "-1,1,2"]].concat();
    assert_ne!(json(folder.path(), &other).1["figures"], first["figures"]);
}

#[test]
fn maps_are_written_whole_or_not_at_all() {
    let folder = folder(&[
        ("a.exr", 16, 1, &[]),
        ("b.exr", 16, 2, &[]),
        ("a.png", 16, 1, &[]),
    ]);
    let at = folder.path();
    for kind in ["signed", "relative", "flip", "hdr-flip", "z"] {
        for name in [format!("{kind}.png"), format!("{kind}.exr")] {
            let arguments = ["a.exr", "b.exr", "--map", name.as_str(), "--map-kind", kind];
            assert!(diff(at, &arguments).0 != 2, "{name}");
            let raster = lampray::film::RasterFile::open(at.join(&name)).expect("a map");
            let wide = if name.ends_with("png") { 320 } else { 32 };
            assert_eq!(raster.width(), wide, "{name}");
            raster.read().expect("a map that can be read");
        }
    }
    assert_eq!(diff(at, &["a.exr", "b.exr", "--map", "m.jpg"]).0, 2);
    assert_eq!(
        diff(at, &["a.exr", "b.exr", "--map", "no/folder/m.png"]).0,
        73
    );
    assert_eq!(
        diff(at, &["a.png", "b.exr", "--map", "m.png", "--map-kind", "z"]).0,
        2
    );
    assert!(!at.join("m.png").exists());
    // A map never takes a picture's place.
    let before = std::fs::read(at.join("a.exr")).expect("a picture");
    for map in ["a.exr", "./b.exr"] {
        assert_eq!(diff(at, &["a.exr", "b.exr", "--map", map]).0, 2);
    }
    assert_eq!(std::fs::read(at.join("a.exr")).expect("a picture"), before);
}
