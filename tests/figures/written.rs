//! The folder of files, as it is written.

use super::sample::{about, figures};
use lampray::figures::{Block, files};
use std::collections::BTreeMap;

#[test]
fn the_same_figures_make_the_same_files() {
    let once = files::all(&figures(), &about()).unwrap();
    assert_eq!(once, files::all(&figures(), &about()).unwrap());
    let names: Vec<&str> = once.iter().map(|(name, _)| name.as_str()).collect();
    for name in [
        "index.html",
        "claims.md",
        "figures.json",
        "fig5-balls.png",
        "fig5-energy.svg",
        "fig6-points-3.svg",
        "fig8.csv",
    ] {
        assert!(names.contains(&name), "{name} is not among {names:?}");
    }
}

#[test]
fn what_markdown_links_is_there() {
    let files: BTreeMap<String, Vec<u8>> = files::all(&figures(), &about())
        .unwrap()
        .into_iter()
        .collect();
    let page = String::from_utf8(files["claims.md"].clone()).unwrap();
    let pictures = page
        .split("src=\"")
        .skip(1)
        .filter_map(|rest| rest.split('"').next());
    let links = page
        .split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next());
    let mut seen = 0;
    for name in pictures.chain(links.filter(|link| !link.starts_with('#'))) {
        assert!(files.contains_key(name), "{name}");
        seen += 1;
    }
    assert!(seen > 15);
}

/// A sheet holds each picture's own pixels, twice as large, and is see-through between them.
#[test]
fn sheets_hold_the_pictures() {
    let all = figures();
    let Block::Pictures(pictures) = &all[0].blocks[0] else {
        panic!("no pictures");
    };
    let files: BTreeMap<String, Vec<u8>> =
        files::all(&all, &about()).unwrap().into_iter().collect();
    let sheet = image::load_from_memory(&files["fig5-balls.png"])
        .unwrap()
        .to_rgba8();
    let cell = &pictures.rows[1].cells[2];
    let (left, top) = (sheet.width() - 256, row_top(&sheet));
    for (x, y) in [(0, 0), (40, 70), (127, 127)] {
        let index = 3 * (y * 128 + x) as usize;
        for (right, down) in [(0, 0), (1, 1)] {
            let pixel = sheet.get_pixel(left + 2 * x + right, top + 2 * y + down).0;
            assert_eq!(pixel[..3], cell.rgb[index..index + 3]);
            assert_eq!(pixel[3], 255);
        }
    }
    assert_eq!(sheet.get_pixel(left - 1, top).0[3], 0);
}

/// Where the last row of pictures begins: 256 rows of whole pixels, counted from below.
fn row_top(sheet: &image::RgbaImage) -> u32 {
    let whole = |y: &u32| (1..=256).all(|x| sheet.get_pixel(sheet.width() - x, *y).0[3] == 255);
    (0..sheet.height()).rev().find(whole).unwrap() - 255
}

#[test]
fn data_and_numbers_are_written() {
    let files: BTreeMap<String, Vec<u8>> = files::all(&figures(), &about())
        .unwrap()
        .into_iter()
        .collect();
    let json: serde_json::Value = serde_json::from_slice(&files["figures.json"]).unwrap();
    assert_eq!(json["figures"].as_array().unwrap().len(), 5);
    assert_eq!(json["about"]["effort"], "full");
    assert_eq!(files["fig9.csv"], figures()[4].data[0].csv.as_bytes());
}

#[test]
fn a_folder_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let names = files::write(folder.path(), &figures(), &about()).unwrap();
    let there = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(there, names.len());
    assert!(files::write(&folder.path().join("nowhere"), &figures(), &about()).is_err());
}

#[test]
fn two_files_of_one_name_are_a_fault() {
    let mut two = figures();
    let name = two[0].data[0].name.clone();
    two[1].data[0].name = name;
    assert!(files::all(&two, &about()).is_err());
}

/// For eyes and for the check in a browser, which name a folder with FIGURES_FOLDER.
#[test]
fn sample_is_written() {
    let own = tempfile::tempdir().unwrap();
    let named = std::env::var_os("FIGURES_FOLDER");
    let folder = named.map_or(own.path().to_path_buf(), Into::into);
    let names = files::write(&folder, &figures(), &about()).unwrap();
    assert!(names.iter().any(|name| name == "index.html"));
    assert!(names.iter().all(|name| folder.join(name).is_file()));
}
