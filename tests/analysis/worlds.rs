//! Made-up estimators of a made-up scene.

use crate::support::stream::Stream;
use lampray::analysis::{Analysis, Group, Question, Reference, Region, Runs};
use lampray::compare::verdict::Terms;
use lampray::device::{DeviceInfo, DeviceKind};
use lampray::film::{Picture, Record, Seconds};
use serde_json::{Map, Value};

/// Colour of everything: the channels of a path rise and fall together.
pub const COLOUR: [f64; 3] = [1.0, 0.7, 0.4];

/// A path's radiance has a mean of 0 and a variance of 1, before it is scaled and moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Noise {
    Normal,
    /// Exponential: skewness 2, kurtosis 9.
    Skewed,
}

impl Noise {
    /// Two independent draws: Box and Muller (1958) have them at once.
    fn pair(self, stream: &mut Stream) -> [f64; 2] {
        let logarithm = |stream: &mut Stream| -(1.0 - stream.unit()).ln();
        let first = logarithm(stream);
        match self {
            Noise::Normal => {
                let (sine, cosine) = (std::f64::consts::TAU * stream.unit()).sin_cos();
                [sine, cosine].map(|part| (2.0 * first).sqrt() * part)
            }
            Noise::Skewed => [first - 1.0, logarithm(stream) - 1.0],
        }
    }
}

/// All relative to the truth.
#[derive(Clone, Copy, Debug)]
pub struct Estimator {
    pub bias: f64,
    /// Standard deviation of one sample.
    pub deviation: f64,
    pub noise: Noise,
    /// Mean time of a run, and its relative standard deviation.
    pub seconds: f64,
    pub jitter: f64,
}

#[derive(Clone, Copy, Debug)]
pub struct World {
    pub size: u32,
    /// Even.
    pub samples: u32,
    pub runs: usize,
    pub reference_samples: u32,
    pub reference_deviation: f64,
    pub estimators: [Estimator; 2],
}

/// How an estimator's picture is changed before it is taken in; for mutants.
pub type Change = fn(&mut Picture);

impl World {
    /// Brightness rises to the right.
    pub fn truth(&self, pixel: usize) -> f64 {
        0.5 + (pixel % self.size as usize) as f64 / f64::from(self.size)
    }

    pub fn pixels(&self) -> usize {
        (self.size * self.size) as usize
    }

    /// Mean over pixels and channels of a power of the truth.
    pub fn moment(&self, power: i32) -> f64 {
        self.mean_of(|truth| truth.powi(power))
    }

    pub fn mean_of(&self, value: impl Fn(f64) -> f64) -> f64 {
        let values = (0..self.pixels()).flat_map(|pixel| {
            let truth = self.truth(pixel);
            COLOUR.map(|colour| value(truth * colour))
        });
        values.sum::<f64>() / (3 * self.pixels()) as f64
    }

    fn run(&self, estimator: Estimator, seed: u64, stream: &mut Stream) -> Picture {
        let n = f64::from(self.samples);
        let pixel = |pixel: usize| {
            let (mut sum, mut squares) = (0.0, 0.0);
            for _ in 0..self.samples / 2 {
                let [x, y] = estimator.noise.pair(stream);
                sum += x + y;
                squares += x * x + y * y;
            }
            let truth = self.truth(pixel);
            let variance = (squares - sum * sum / n) / (n - 1.0);
            (
                truth * (1.0 + estimator.bias + estimator.deviation * sum / n),
                (truth * estimator.deviation).powi(2) * variance,
            )
        };
        let grey = (0..self.pixels()).map(pixel).collect();
        picture(self.size, self.samples, seed, grey)
    }

    /// Of so many samples that only their mean needs drawing.
    fn reference(&self, stream: &mut Stream) -> Picture {
        let n = f64::from(self.reference_samples);
        let pixel = |pixel: usize| {
            let truth = self.truth(pixel);
            let [mean, variance] = Noise::Normal.pair(stream);
            let (mean, variance) = (mean / n.sqrt(), 1.0 + variance * (2.0 / n).sqrt());
            (
                truth * (1.0 + self.reference_deviation * mean),
                (truth * self.reference_deviation).powi(2) * variance,
            )
        };
        let grey = (0..self.pixels()).map(pixel).collect();
        picture(self.size, self.reference_samples, u64::MAX, grey)
    }

    /// A whole sweep. The changes are of the reference and of the runs.
    pub fn sweep(&self, seed: u64, changes: [Change; 2]) -> Analysis {
        let mut stream = Stream::new(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
        let [change_reference, change_run] = changes;
        let mut reference = self.reference(&mut stream);
        change_reference(&mut reference);
        let reference = Reference::new("reference", reference).expect("it has noise");
        let size = [self.size; 2];
        let question = Question::new(size, vec![reference], Vec::new(), Terms::default(), 2);
        let question = question.expect("of one size");
        let groups = ["first", "second"].into_iter().zip(self.estimators);
        let groups: Vec<Group> = groups
            .map(|(name, estimator)| {
                let mut runs = Runs::new(name, Map::new());
                for seed in 0..self.runs as u64 {
                    let mut picture = self.run(estimator, seed, &mut stream);
                    change_run(&mut picture);
                    let jitter = estimator.jitter * Noise::Normal.pair(&mut stream)[0];
                    let seconds = estimator.seconds * (1.0 + jitter);
                    runs.add(&picture, seconds).expect("a run");
                }
                question.answer(runs, Some(0)).expect("a group")
            })
            .collect();
        Analysis::new(question, groups, None).expect("two groups")
    }
}

/// A group with values: rows of the same stream have the same random numbers.
#[derive(Clone, Debug)]
pub struct Row {
    pub values: Map<String, Value>,
    pub estimator: Estimator,
    /// Even.
    pub samples: u32,
    pub stream: u64,
}

impl World {
    /// A sweep of groups with values, without a reference.
    pub fn table(&self, seed: u64, rows: &[Row], change: Change) -> Analysis {
        let size = [self.size; 2];
        let question = Question::new(size, Vec::new(), Vec::new(), Terms::default(), rows.len());
        let question = question.expect("a question");
        let group = |row: &Row| {
            let mut stream =
                Stream::new((seed * 64 + row.stream).wrapping_mul(0x2545_f491_4f6c_dd1d));
            let world = World {
                samples: row.samples,
                ..*self
            };
            let mut runs = Runs::new(
                &Value::Object(row.values.clone()).to_string(),
                row.values.clone(),
            );
            for number in 0..self.runs as u64 {
                let mut picture = world.run(row.estimator, number, &mut stream);
                change(&mut picture);
                let jitter = row.estimator.jitter * Noise::Normal.pair(&mut stream)[0];
                let seconds = row.estimator.seconds * (1.0 + jitter);
                runs.add(&picture, seconds).expect("a run");
            }
            question.answer(runs, None).expect("a group")
        };
        let groups = rows.iter().map(group).collect();
        Analysis::new(question, groups, None).expect("groups")
    }
}

/// Mean and variance of each pixel before it is coloured.
pub fn picture(width: u32, samples: u32, seed: u64, grey: Vec<(f64, f64)>) -> Picture {
    let height = grey.len() as u32 / width;
    let coloured = |(mean, variance): &(f64, f64)| {
        (
            COLOUR.map(|colour| (mean * colour) as f32),
            COLOUR.map(|colour| (variance * colour * colour) as f32),
        )
    };
    let (mean, variance) = grey.iter().map(coloured).unzip();
    Picture {
        width,
        height,
        mean,
        variance,
        samples: vec![samples as f32; grey.len()],
        features: None,
        record: record(samples.into(), seed),
        scene_text: None,
    }
}

fn record(samples: u64, seed: u64) -> Record {
    Record {
        version: String::new(),
        scene: String::new(),
        scene_hash: String::new(),
        shader_hash: String::new(),
        preset: String::new(),
        knobs: Map::new(),
        kernel: "general".into(),
        pilot: None,
        denoised: None,
        device: DeviceInfo {
            kind: DeviceKind::Cpu,
            name: String::new(),
            driver: String::new(),
            backend: String::new(),
            pci: String::new(),
        },
        devices: Vec::new(),
        width: 0,
        height: 0,
        crop: None,
        samples,
        sample_range: [0, samples],
        sample_ranges: Vec::new(),
        seed,
        complete: true,
        stopped: None,
        target_error: None,
        adaptive: None,
        biased: false,
        seconds: Seconds::default(),
        paths: 0,
        rays: 0,
        non_finite: 0,
        mean: [0.0; 3],
        standard_error: Some([0.0; 3]),
        error_estimate: Default::default(),
        randomisation: None,
        randomisation_means: Vec::new(),
        outputs: Vec::new(),
    }
}

/// A region by its corners.
pub fn region(name: &str, [x0, y0, x1, y1]: [u32; 4]) -> Region {
    Region {
        name: name.into(),
        rect: lampray::pack::Rect { x0, y0, x1, y1 },
    }
}
