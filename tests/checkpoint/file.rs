//! A checkpoint is the film, to the bit, or it is refused.

use super::room::{after, room};
use crate::sample::Folder;
use lampray::Error;
use lampray::film::{Checkpoint, Film, NonFinite, previous};
use lampray::pack::Rect;
use lampray::render::{Task, record};
use std::fs;
use std::io::{Seek, SeekFrom, Write};
use std::path::Path;

/// Saves what a task has after some blocks.
fn save(path: &Path, blocks: usize) -> Checkpoint {
    let scene = room(&["image.width=3", "image.height=2"]);
    let task = Task::new(&scene);
    let mut rendering = after(&task, 32, blocks);
    rendering.film.first_non_finite = Some(NonFinite {
        sample: 7,
        y: 1,
        x: 2,
    });
    rendering.film.non_finite = 3;
    let mut record = record(&task, &rendering.devices[0], &rendering);
    rendering.film.describe(&mut record);
    let samples = [task.samples.start, task.samples.end];
    Checkpoint::save(path, &record, samples, &rendering.film, None).expect("a checkpoint");
    Checkpoint {
        record,
        samples,
        film: rendering.film,
        scouts: None,
    }
}

/// Why a file is refused.
fn reason(path: &Path) -> Option<String> {
    match Checkpoint::read(path) {
        Ok(_) => None,
        Err(Error::Data { reason, .. }) => Some(reason),
        Err(error) => panic!("{error:?}"),
    }
}

fn bits(film: &Film) -> Vec<u64> {
    let planes = [&film.sums, &film.squares];
    let sums = planes.into_iter().flat_map(|plane| plane.as_flattened());
    sums.map(|sum| sum.to_bits())
        .chain(film.counts.iter().copied())
        .collect()
}

#[test]
fn what_is_read_is_what_was_saved() {
    let folder = Folder::new();
    let path = folder.join("c");
    for blocks in [1, 2, 5, 17] {
        let saved = save(&path, blocks);
        let read = Checkpoint::read(&path).expect("a checkpoint");
        assert_eq!(read, saved);
        assert_eq!(bits(&read.film), bits(&saved.film));
        assert!(read.film.sums.iter().any(|sum| sum[0] > 0.0), "black");
    }
}

#[test]
fn every_length_but_its_own_is_refused() {
    let folder = Folder::new();
    let (whole, cut) = (folder.join("c"), folder.join("cut"));
    save(&whole, 9);
    let bytes = fs::read(&whole).expect("a checkpoint");
    for length in 0..bytes.len() {
        fs::write(&cut, &bytes[..length]).expect("a short file");
        assert!(reason(&cut).is_some(), "{length} of {} bytes", bytes.len());
    }
    fs::write(&cut, [&bytes[..], b"x"].concat()).expect("a long file");
    assert!(reason(&cut).is_some());
    fs::write(&cut, &bytes).expect("a whole file");
    assert_eq!(reason(&cut), None);
}

#[test]
fn every_flipped_bit_is_found() {
    let folder = Folder::new();
    let path = folder.join("c");
    save(&path, 9);
    let bytes = fs::read(&path).expect("a checkpoint");
    let file = fs::File::options()
        .write(true)
        .open(&path)
        .expect("it is there");
    let put = |place: usize, byte: u8| {
        let mut file = &file;
        file.seek(SeekFrom::Start(place as u64)).expect("a place");
        file.write_all(&[byte]).expect("a byte");
    };
    for (place, &byte) in bytes.iter().enumerate() {
        for bit in 0..8 {
            put(place, byte ^ (1 << bit));
            assert!(reason(&path).is_some(), "bit {bit} of byte {place}");
        }
        put(place, byte);
    }
    assert_eq!(reason(&path), None);
}

/// The same bytes with another head, and a checksum that is right.
fn with_head(bytes: &[u8], change: impl Fn(&str) -> String) -> Vec<u8> {
    let length = u64::from_le_bytes(bytes[8..16].try_into().expect("eight bytes")) as usize;
    let head = change(std::str::from_utf8(&bytes[16..16 + length]).expect("a head"));
    let end = bytes.len() - 32;
    let mut all = bytes[..8].to_vec();
    all.extend((head.len() as u64).to_le_bytes());
    all.extend(head.as_bytes());
    all.extend(&bytes[16 + length..end]);
    let hash = blake3::hash(&all);
    all.extend(hash.as_bytes());
    all
}

/// Heads that a right checksum makes no better.
#[test]
fn heads_that_do_not_fit_are_refused() {
    let folder = Folder::new();
    let (whole, other) = (folder.join("c"), folder.join("other"));
    save(&whole, 9);
    let bytes = fs::read(&whole).expect("a checkpoint");
    let refused = |change: &dyn Fn(&str) -> String| {
        let changed = with_head(&bytes, change);
        fs::write(&other, changed).expect("a checkpoint");
        reason(&other).unwrap_or_default()
    };
    let region = |text: &'static str| {
        move |head: &str| {
            let changed = head.replace("\"region\":[0,0,3,2]", &format!("\"region\":{text}"));
            assert_ne!(changed, head);
            changed
        }
    };
    assert_eq!(refused(&|head| head.into()), "", "the head as it is");
    for (text, why) in [
        ("[0,0,32768,32768]", "cut short"),
        ("[0,0,4294967295,4294967295]", "cut short"),
        ("[3,2,0,0]", "no pixels"),
        ("[0,0,3]", "head"),
        ("[0,0,-3,2]", "head"),
    ] {
        let found = refused(&region(text));
        assert!(found.contains(why), "{text}: {found}");
    }
    let paths = refused(&|head| head.replace("\"paths\":", "\"paths\":1"));
    assert!(paths.contains("no sums of a render"), "{paths}");
    let mut long = bytes.clone();
    long[8..16].copy_from_slice(&u64::MAX.to_le_bytes());
    fs::write(&other, long).expect("a checkpoint");
    assert!(reason(&other).is_some_and(|found| found.contains("cut short")));
}

#[test]
fn sums_that_are_no_numbers_are_refused() {
    let folder = Folder::new();
    let path = folder.join("c");
    let Checkpoint {
        record,
        samples,
        mut film,
        ..
    } = save(&path, 9);
    for value in [f64::NAN, f64::INFINITY] {
        film.sums[1][2] = value;
        Checkpoint::save(&path, &record, samples, &film, None).expect("a checkpoint");
        let found = reason(&path).unwrap_or_default();
        assert!(found.contains("no sums of a render"), "{found}");
    }
    let nothing = Film::new(Rect {
        x0: 0,
        y0: 0,
        x1: 3,
        y1: 2,
    });
    Checkpoint::save(&path, &record, samples, &nothing, None).expect("a checkpoint");
    assert!(reason(&path).is_some(), "a film without the record's paths");
}

#[test]
fn saving_keeps_the_one_before() {
    let folder = Folder::new();
    let path = folder.join("c");
    let saved: Vec<_> = [1, 2, 3].map(|blocks| save(&path, blocks)).into();
    assert_eq!(folder.names(), ["c", "c.previous"]);
    assert_eq!(Checkpoint::read(&path).expect("the last"), saved[2]);
    let before = previous(&path);
    assert_eq!(Checkpoint::read(&before).expect("the one before"), saved[1]);

    let newest = || Checkpoint::newest(&path).expect("one of both");
    assert_eq!(newest(), Some((saved[2].clone(), None)));
    fs::write(&path, "damaged").expect("a damaged file");
    let (found, remark) = newest().expect("the one before");
    assert_eq!(found, saved[1]);
    assert!(remark.is_some_and(|text| text.contains("c.previous")));
    fs::write(&before, "damaged").expect("a damaged file");
    assert!(matches!(Checkpoint::newest(&path), Err(Error::Data { .. })));
    fs::remove_file(&path).expect("it is there");
    assert!(matches!(Checkpoint::newest(&path), Err(Error::Data { .. })));
    fs::remove_file(&before).expect("it is there");
    assert_eq!(newest(), None);
}
