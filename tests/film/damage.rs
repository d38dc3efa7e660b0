//! Files of every kind, cut short and with bytes changed: read or refused, never a panic.

use super::sample::{Folder, Random, fixtures, picture, write};
use lampray::Error;
use lampray::film::{RasterFile, read_exr, read_record};
use std::fs;
use std::path::{Path, PathBuf};

/// Whether the file is a picture.
fn read(path: &Path) -> bool {
    let _ = (read_exr(path).is_ok(), read_record(path).is_ok());
    match RasterFile::open(path).and_then(RasterFile::read) {
        Ok(raster) => {
            assert!(raster.width > 0 && raster.height > 0);
            true
        }
        Err(Error::Data { reason, .. }) => {
            assert!(!reason.is_empty());
            false
        }
        Err(error) => panic!("{error:?}"),
    }
}

/// The fixtures and files of lampray's own.
fn files(folder: &Folder) -> Vec<PathBuf> {
    let mut files = fixtures();
    assert!(files.len() > 50);
    for name in ["own.exr", "own.png"] {
        write(&picture(0..4), &folder.join(name));
        files.push(folder.join(name));
    }
    files
}

#[test]
fn no_part_of_a_file_is_a_picture() {
    let folder = Folder::new();
    let cut = folder.join("cut");
    for file in files(&folder) {
        let bytes = fs::read(&file).unwrap();
        let parts = 24.min(bytes.len());
        for part in 0..parts {
            fs::write(&cut, &bytes[..bytes.len() * part / parts]).unwrap();
            assert!(!read(&cut), "{part}/{parts} of {}", file.display());
        }
        fs::write(&cut, &bytes[..bytes.len() - 1]).unwrap();
        assert!(!read(&cut), "{}", file.display());
    }
}

#[test]
fn no_change_of_bytes_makes_a_panic() {
    let folder = Folder::new();
    let damaged = folder.join("damaged");
    let mut random = Random(7);
    let (mut rounds, mut refused) = (0, 0);
    for file in files(&folder) {
        let bytes = fs::read(&file).unwrap();
        for round in 0..80 {
            let mut bytes = bytes.clone();
            // Half of the damage is done to the header.
            let end = if round % 2 == 0 {
                bytes.len()
            } else {
                400.min(bytes.len())
            };
            for _ in 0..1 + random.below(3) {
                let byte = &mut bytes[random.below(end)];
                *byte = match random.below(3) {
                    0 => *byte ^ 1 << random.below(8),
                    1 => random.below(256) as u8,
                    _ => [0, 0x7f, 0x80, 0xff][random.below(4)],
                };
            }
            fs::write(&damaged, &bytes).unwrap();
            rounds += 1;
            refused += usize::from(!read(&damaged));
        }
    }
    assert!(rounds > 4000);
    assert!(
        refused > rounds / 3,
        "only {refused} of {rounds} were refused"
    );
}
