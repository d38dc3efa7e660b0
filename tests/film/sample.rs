//! Pictures to test with.

// Each test file uses a part of these.
#![allow(dead_code)]

use lampray::device::{DeviceInfo, DeviceKind};
use lampray::film::{Aov, Features, Film, Picture, Record, Seconds};
use lampray::pack::{Feature, Rect, Tally};
use serde_json::{Map, json};
use std::path::{Path, PathBuf};

/// SplitMix64 (Steele, Lea and Flood 2014): the same numbers on every machine.
pub struct Random(pub u64);

impl Random {
    pub fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// 0 to 1, without 1.
    pub fn unit(&mut self) -> f64 {
        (self.word() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn below(&mut self, end: usize) -> usize {
        (self.unit() * end as f64) as usize
    }
}

/// Unicode, quotes, a tab and the end of a line, as scene files have them.
pub const SCENE: &str =
    "version = 1\n# Größe, 明かり, \u{1f4a1}\n[materials.\"weiß\"]\talbedo = [0.1, 0.2, 0.3]\n";

/// Radiance of one path: the same for the same sample, as the renderer promises.
pub fn radiance(pixel: usize, sample: u64) -> [f64; 3] {
    let mut random = Random(pixel as u64 * 1_000_003 + sample);
    std::array::from_fn(|_| {
        let u = random.unit();
        f64::from((u * u * 3.0) as f32)
    })
}

/// What a device would measure of some samples, computed in f64.
pub fn tally(pixel: usize, samples: std::ops::Range<u64>) -> Tally {
    let n = (samples.end - samples.start) as f64;
    let mut mean = [0.0; 3];
    let mut squares = [0.0; 3];
    for channel in 0..3 {
        let values = samples
            .clone()
            .map(|sample| radiance(pixel, sample)[channel]);
        mean[channel] = values.clone().sum::<f64>() / n;
        squares[channel] = values.map(|value| (value - mean[channel]).powi(2)).sum();
    }
    let narrow = |values: [f64; 3]| values.map(|value| value as f32);
    Tally {
        mean: narrow(mean),
        rays: 3 * n as u32,
        squares: narrow(squares),
        non_finite: 0,
    }
}

/// A film of these samples, in blocks of at most eight.
pub fn film(region: Rect, samples: std::ops::Range<u64>) -> Film {
    let mut film = Film::new(region);
    for pixel in 0..region.area() {
        let mut first = samples.start;
        while first < samples.end {
            let end = samples.end.min(first + 8);
            film.add(
                pixel,
                first,
                (end - first) as u32,
                &tally(pixel, first..end),
            );
            first = end;
        }
    }
    film
}

pub const REGION: Rect = Rect {
    x0: 0,
    y0: 0,
    x1: 37,
    y1: 21,
};

/// A picture of these samples with every layer.
pub fn picture(samples: std::ops::Range<u64>) -> Picture {
    let film = film(REGION, samples.clone());
    let all = [Aov::Normal, Aov::Depth, Aov::Albedo, Aov::Id];
    let features = Features::new(&features(), &all);
    film.picture(record(samples), features, Some(SCENE.into()))
}

fn features() -> Vec<Feature> {
    let mut random = Random(5);
    let feature = |_| Feature {
        normal: [
            random.unit() as f32,
            -random.unit() as f32,
            f32::MIN_POSITIVE / 2.0,
        ],
        depth: random.unit() as f32 * 1e6,
        albedo: [random.unit() as f32, -0.0, 1.0],
        id: random.below(1 << 21) as u32,
    };
    (0..REGION.area()).map(feature).collect()
}

pub fn device(name: &str) -> DeviceInfo {
    DeviceInfo {
        kind: DeviceKind::Software,
        name: name.into(),
        driver: "22.3.6 (\"LLVM\" 15)".into(),
        backend: "vulkan".into(),
        pci: String::new(),
    }
}

pub fn record(samples: std::ops::Range<u64>) -> Record {
    let mut knobs = Map::new();
    knobs.insert("image.exposure".into(), json!(0.0));
    knobs.insert("image.encoding".into(), json!("srgb"));
    knobs.insert("render.samples".into(), json!(samples.end - samples.start));
    knobs.insert("render.seed".into(), json!(u64::MAX - 1));
    // Numbers that a careless parser rounds.
    knobs.insert("camera.fov".into(), json!(45.000000000000014));
    knobs.insert(
        "materials.weiß.albedo".into(),
        json!([0.1, 1.0 / 3.0, 2.2250738585072014e-308]),
    );
    Record {
        version: "0.1.0".into(),
        scene: "szenen/größe \u{1f4a1}\n.toml".into(),
        scene_hash: "cafe".into(),
        shader_hash: "beef".into(),
        preset: "reference".into(),
        knobs,
        kernel: "general".into(),
        pilot: None,
        device: device("llvmpipe"),
        devices: Vec::new(),
        width: 0,
        height: 0,
        crop: None,
        samples: samples.end - samples.start,
        sample_range: [samples.start, samples.end],
        sample_ranges: Vec::new(),
        seed: u64::MAX - 1,
        complete: true,
        stopped: None,
        target_error: None,
        adaptive: None,
        biased: false,
        denoised: None,
        seconds: Seconds {
            setup: 0.25,
            render: 1.0 / 3.0,
            total: 0.7,
            longest_block: 0.01,
        },
        paths: 0,
        rays: 0,
        non_finite: 0,
        mean: [0.0; 3],
        standard_error: Some([0.0; 3]),
        error_estimate: Default::default(),
        randomisation: None,
        randomisation_means: Vec::new(),
        outputs: vec!["a.exr".into()],
    }
}

/// An empty folder that goes away again.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Folder {
        Folder(tempfile::tempdir().unwrap())
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn join(&self, name: impl AsRef<Path>) -> PathBuf {
        self.0.path().join(name)
    }

    /// Names of everything in it, hidden files included.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.path()).unwrap();
        let name = |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name();
        let mut names: Vec<String> = entries
            .map(|entry| name(entry).to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

/// Writes a picture to a new file.
pub fn write(picture: &Picture, path: &Path) {
    lampray::film::Target::prepare(path)
        .unwrap()
        .write(picture)
        .unwrap();
}

/// A file of another program.
pub fn fixture(name: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    root.join("tests/fixtures").join(name)
}

/// All of them, in order.
pub fn fixtures() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(fixture("")).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    let image = |path: &PathBuf| path.extension().is_some_and(|e| e == "exr" || e == "png");
    files.retain(image);
    files.sort();
    files
}
