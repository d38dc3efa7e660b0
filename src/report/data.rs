//! What a report shows: filled by the analysis of a sweep, read by the page.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Everything that the page has; it goes into `report.html` as JSON.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct ReportData {
    pub title: String,
    /// The question, in the user's words or made from the axes.
    pub question: String,
    /// The command that makes the sweep again.
    pub command: String,
    /// Version of lampray.
    pub version: String,
    /// What was swept, in order.
    pub axes: Vec<AxisData>,
    /// Every run, in the order of the grid.
    pub runs: Vec<RunData>,
    /// Runs that differ in nothing but their seed, taken together.
    pub groups: Vec<GroupData>,
    /// Parts of the picture that are analysed by themselves; the first is the whole picture.
    pub regions: Vec<RegionData>,
    /// One for each expected picture.
    pub references: Vec<ReferenceData>,
    /// Pictures that the page can show: linear light.
    pub images: Vec<ImageData>,
    /// Sentences that the data say, most important first.
    pub findings: Vec<String>,
    /// What a reader must know of the page itself: what it leaves out, and why.
    pub notes: Vec<String>,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct AxisData {
    /// The knob's path.
    pub path: String,
    pub values: Vec<String>,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct RunData {
    pub id: String,
    /// ok, failed, device_lost or timeout.
    pub status: String,
    pub error: Option<String>,
    /// Value of each axis, by path.
    pub values: Map<String, Value>,
    pub seed: u64,
    pub samples: u64,
    pub device: String,
    /// Tracing alone, seconds.
    pub seconds: f64,
    pub paths: u64,
    pub rays: u64,
    pub mean: [f64; 3],
    /// Absent where it is not known.
    pub standard_error: Option<[f64; 3]>,
    /// Index into `groups`.
    pub group: Option<usize>,
    /// Index into `images`.
    pub image: Option<usize>,
}

/// A number with its 95 % interval.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct GroupData {
    /// Short name, made of the axes' values.
    pub name: String,
    /// Value of each axis but the seed, by path.
    pub values: Map<String, Value>,
    /// Index into `references`: what it is held against.
    pub reference: Option<usize>,
    pub runs: usize,
    pub samples: u64,
    /// Mean tracing time of a run, seconds.
    pub seconds: Interval,
    /// One for each region, in the order of `regions`.
    pub regions: Vec<RegionResult>,
    /// Indices into `images`: mean of the runs, bias (signed), standard deviation of one sample.
    pub mean_image: Option<usize>,
    pub bias_image: Option<usize>,
    pub deviation_image: Option<usize>,
}

/// What was found in one region, mean of the three channels.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct RegionResult {
    /// Mean radiance.
    pub mean: Interval,
    /// Mean minus the reference's, relative to it; absent without a reference.
    pub bias: Option<Interval>,
    /// Variance of one sample, mean over the pixels.
    pub variance: Interval,
    /// Mean squared error of a run's pixels against the reference.
    pub mse: Option<Interval>,
    pub relmse: Option<Interval>,
    /// Samples a pixel at which bias^2 and variance / N are equal; absent where no bias is seen.
    pub crossing: Option<f64>,
    /// 1 / (MSE x seconds).
    pub efficiency: Option<Interval>,
    /// Error at equal time over the first group's, below 1 is better; absent where the two are not held against
    /// the same reference.
    pub equal_time: Option<Interval>,
    /// Time to equal error over the first group's; absent as `equal_time` is.
    pub equal_error: Option<Interval>,
    /// same, different or not-enough-samples, against the reference at the stated margin.
    pub verdict: Option<String>,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct RegionData {
    pub name: String,
    /// x0, y0, x1, y1, the last two exclusive.
    pub rect: [u32; 4],
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct ReferenceData {
    pub name: String,
    pub samples: u64,
    pub image: Option<usize>,
    pub mean: [f64; 3],
    /// Absent where it is not known.
    pub standard_error: Option<[f64; 3]>,
}

/// Linear light, half floats, R G B interleaved, little endian, in base64.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct ImageData {
    pub name: String,
    pub width: u32,
    pub height: u32,
    /// radiance, bias or deviation.
    pub kind: String,
    pub half: String,
}
