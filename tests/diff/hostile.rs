//! Pictures from strangers: trouble with a reason, at once, and in little memory.

use super::craft::{FLOAT, RGB, RGB8, attribute, block, exr, png, png_chunk, zlib};
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// How a comparison of a file with itself ended.
struct End {
    code: Option<i32>,
    words: String,
    taken: Duration,
    /// Largest memory, in MB, where the system tells.
    peak: Option<u64>,
}

fn run(folder: &Path, name: &str) -> End {
    let start = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_lampray"))
        .current_dir(folder)
        .args(["diff", name, name])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let status = format!("/proc/{}/status", child.id());
    let mut peak = None;
    // The last look before the end sees all but what a millisecond can add.
    let code = loop {
        peak = high_water(&status).or(peak);
        if let Some(status) = child.try_wait().expect("a child") {
            break status.code();
        }
        thread::sleep(Duration::from_millis(1));
    };
    let mut words = String::new();
    let stderr = child.stderr.as_mut().expect("a pipe");
    stderr.read_to_string(&mut words).expect("words");
    End {
        code,
        words,
        taken: start.elapsed(),
        peak,
    }
}

fn high_water(status: &str) -> Option<u64> {
    let text = fs::read_to_string(status).ok()?;
    let line = text.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? / 1000)
}

/// A picture of 2 x 2 pixels without compression.
fn small(more: &[Vec<u8>], origin: i32, channels: &[(&str, u32)], values: [f32; 2]) -> Vec<u8> {
    let window = [origin, origin, origin + 1, origin + 1];
    let mut bytes = exr(0, window, 0, channels, more);
    // The table of offsets, which nobody needs.
    bytes.extend([0; 16]);
    bytes.extend(block(origin, 2, values[0]));
    bytes.extend(block(origin + 1, 2, values[1]));
    bytes
}

/// Name, bytes, and what the message must say.
fn traps() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let announced =
        |side: i32, compression| exr(0, [0, 0, side - 1, side - 1], compression, &RGB, &[]);
    let mut truncated = small(&[], 0, &RGB, [0.5, 0.5]);
    truncated.truncate(truncated.len() - 5);
    let huge_png = |side: u32| png(side, side, RGB8, &[png_chunk(b"IDAT", &zlib(1 << 20))]);
    let declared = {
        let mut bytes = announced(2, 0);
        let end = bytes.len() - 1;
        bytes.truncate(end);
        bytes.extend(b"preview\0preview\0\xff\xff\xff\xff");
        bytes.resize(1000, 0);
        bytes
    };
    vec![
        ("announced.exr", announced(16384, 3), "announce"),
        ("window.exr", announced(65535, 3), "sides"),
        ("nothing.exr", announced(0, 3), "sides"),
        ("declared.exr", declared, ""),
        ("truncated.exr", truncated, "ends too early"),
        (
            "nan.exr",
            small(&[], 0, &RGB, [0.5, f32::NAN]),
            "NaN or infinite",
        ),
        (
            "infinite.exr",
            small(&[], 0, &RGB, [f32::INFINITY, 0.5]),
            "NaN or infinite",
        ),
        ("bomb.png", huge_png(16384), "announce"),
        ("nothing.png", huge_png(0), "sides"),
        ("short.png", huge_png(3000), ""),
        (
            "garbage.png",
            b"\x89PNG\r\n\x1a\n and then nothing that anybody knows".to_vec(),
            "",
        ),
    ]
}

#[test]
fn traps_are_trouble_with_a_reason_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bytes, reason) in traps() {
        fs::write(folder.path().join(name), bytes).expect("a file");
        let end = run(folder.path(), name);
        assert_eq!(end.code, Some(2), "{name}: {}", end.words);
        let line = end.words.trim_end();
        assert!(!line.contains('\n') && line.len() > 20, "{name}: {line}");
        assert!(line.contains(reason), "{name}: {line}");
        assert!(
            !line.contains("panick") && !line.contains("internal"),
            "{name}: {line}"
        );
        assert!(
            end.taken < Duration::from_secs(5),
            "{name}: {:?}",
            end.taken
        );
        assert!(
            end.peak.is_none_or(|peak| peak < 300),
            "{name}: {:?} MB",
            end.peak
        );
    }
}

/// Odd, but honest: a window left of and above the origin, many layers, and text that would unpack to
/// a gigabyte and that nobody asked for.
#[test]
fn odd_files_are_compared() {
    let folder = tempfile::tempdir().expect("a folder");
    let names: Vec<String> = (0..100)
        .map(|number| format!("layer{number:03}.V"))
        .collect();
    let mut layers: Vec<(&str, u32)> = RGB.to_vec();
    layers.extend(names.iter().map(|name| (name.as_str(), FLOAT)));
    let mut many = exr(0, [0, 0, 1, 1], 0, &layers, &[]);
    many.extend([0; 16]);
    for y in 0..2_i32 {
        let pixels = vec![0; 2 * 4 * layers.len()];
        many.extend(y.to_le_bytes());
        many.extend((pixels.len() as u32).to_le_bytes());
        many.extend(pixels);
    }
    let text = [&b"Comment\0\0"[..], &zlib(1 << 30)].concat();
    let pixels = zlib(2 * (1 + 3 * 2));
    let zipped = png(
        2,
        2,
        RGB8,
        &[png_chunk(b"zTXt", &text), png_chunk(b"IDAT", &pixels)],
    );
    let owner = attribute("owner", "string", b"somebody");
    for (name, bytes) in [
        ("negative.exr", small(&[owner], -1000, &RGB, [0.5, 0.25])),
        ("layers.exr", many),
        ("text.png", zipped),
    ] {
        fs::write(folder.path().join(name), bytes).expect("a file");
        let end = run(folder.path(), name);
        assert_eq!(end.code, Some(0), "{name}: {}", end.words);
        assert!(
            end.peak.is_none_or(|peak| peak < 300),
            "{name}: {:?} MB",
            end.peak
        );
    }
}
