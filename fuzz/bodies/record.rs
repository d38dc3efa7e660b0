//! What `rerun` and `merge` read: a picture of lampray's own, or (where the bytes are no picture) a record alone,
//! which is put into one.

use super::support;
use lampray::Error;
use lampray::film::{Picture, merge, read_exr, read_record};
use lampray::scene::{Assignment, Scene};
use std::path::Path;

/// Larger records have more knobs than lampray writes.
const MOST_KNOBS: usize = 1000;
/// For records without a scene's text.
const SCENE: &str = "version = 1\n[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\n";

pub fn run(bytes: &[u8]) {
    let picture = bytes.starts_with(b"\x89PNG") || bytes.starts_with(b"\x76\x2f\x31\x01");
    let file = match picture {
        true => support::file(bytes),
        false => support::file(&around(bytes)),
    };
    record(file.path());
    for outcome in [read_exr(file.path()), merge(&[file.path()], false)] {
        match outcome {
            Ok(picture) => whole(&picture),
            Err(error) => support::refusal(&error),
        }
    }
    let twice = merge(&[file.path(), file.path()], true);
    if let Err(error) = twice {
        support::refusal(&error);
    }
}

/// As `rerun` does.
fn record(path: &Path) {
    let (record, text) = match read_record(path) {
        Ok(found) => found,
        Err(error) => return support::refusal(&error),
    };
    let again: lampray::film::Record =
        serde_json::from_str(&record.to_json()).expect("a record is JSON");
    assert_eq!(again, record);
    if record.knobs.len() > MOST_KNOBS {
        return;
    }
    let knobs = record.knobs.iter();
    let knobs: Vec<_> = knobs
        .map(|(path, value)| Assignment::from_record(path, value))
        .collect();
    match Scene::parse(&record.scene, text.as_deref().unwrap_or(SCENE), &knobs) {
        Ok(scene) => support::taken(&scene),
        Err(error @ (Error::Knob(_) | Error::Scene(_))) => support::refusal(&error),
        Err(other) => panic!("{other}"),
    }
}

fn whole(picture: &Picture) {
    let pixels = picture.pixels();
    assert_eq!(pixels, picture.width as usize * picture.height as usize);
    assert_eq!(
        [
            picture.mean.len(),
            picture.variance.len(),
            picture.samples.len()
        ],
        [pixels; 3]
    );
}

/// An EXR of one pixel, without compression, that holds a record.
fn around(json: &[u8]) -> Vec<u8> {
    let names = [
        "B",
        "G",
        "R",
        "samples",
        "variance.B",
        "variance.G",
        "variance.R",
    ];
    let channel =
        |name: &str| [name.as_bytes(), b"\0\x02\0\0\0\0\0\0\0\x01\0\0\0\x01\0\0\0"].concat();
    let mut channels = names.map(channel).concat();
    channels.push(0);
    let mut bytes = b"\x76\x2f\x31\x01\x02\0\0\0".to_vec();
    for (name, kind, value) in [
        ("channels", "chlist", channels.as_slice()),
        ("compression", "compression", &[0]),
        ("dataWindow", "box2i", &[0; 16]),
        ("displayWindow", "box2i", &[0; 16]),
        ("lineOrder", "lineOrder", &[0]),
        ("pixelAspectRatio", "float", &1_f32.to_le_bytes()),
        ("screenWindowCenter", "v2f", &[0; 8]),
        ("screenWindowWidth", "float", &1_f32.to_le_bytes()),
        ("lampray", "string", json),
    ] {
        bytes.extend([name.as_bytes(), b"\0", kind.as_bytes(), b"\0"].concat());
        bytes.extend((value.len() as u32).to_le_bytes());
        bytes.extend(value);
    }
    bytes.push(0);
    let line = bytes.len() as u64 + 8;
    bytes.extend(line.to_le_bytes());
    bytes.extend([0; 4]);
    bytes.extend((7 * 4_u32).to_le_bytes());
    bytes.extend(
        [0_f32, 0.5, 1.0, 4.0, 0.0, 0.5, 1.0]
            .map(f32::to_le_bytes)
            .concat(),
    );
    bytes
}
