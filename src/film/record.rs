//! The run record: everything needed to know what a picture is, and to render it again.

use super::Denoised;
use super::randomisations::ErrorEstimate;
use super::scouts::AdaptiveRecord;
use crate::device::DeviceInfo;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// What was rendered, how, on what and with which outcome. Travels inside every image as JSON.
///
/// Fields that a later version adds are ignored when read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Version of lampray.
    pub version: String,
    /// The scene's path as it was given, or another name for it.
    pub scene: String,
    pub scene_hash: String,
    pub shader_hash: String,
    pub preset: String,
    /// Every knob with its value, by path, as [`crate::scene::Scene::knobs`] has them.
    pub knobs: Map<String, Value>,
    /// What `render.kernel` came to: `general`, `bvh` or `baked`; empty in records older than the knob.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub kernel: String,
    /// What the rule `efficiency` learnt before the first sample; absent by any other rule.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pilot: Option<PilotRecord>,
    pub device: DeviceInfo,
    /// Every device of a picture that several took part in, by merging or because one was lost; absent for one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub devices: Vec<DeviceInfo>,
    /// Pixels of this picture.
    pub width: u32,
    /// Pixels of this picture.
    pub height: u32,
    /// x0, y0, x1, y1: the part of `image.width` x `image.height` that this picture holds, the
    /// last two exclusive; absent for all of it.
    #[serde(default)]
    pub crop: Option<[u32; 4]>,
    /// Samples a pixel that were taken: the fewest of any pixel, where they have not all the same.
    pub samples: u64,
    /// Which: from the first on, up to and without the second.
    pub sample_range: [u64; 2],
    /// All ranges, where they leave gaps in `sample_range`; absent otherwise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sample_ranges: Vec<[u64; 2]>,
    pub seed: u64,
    /// Whether all samples that were asked for have been taken.
    pub complete: bool,
    /// Why it ended before the last of them; absent where it did not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stopped: Option<Stop>,
    /// The error at which it might end earlier, relative to the mean; absent where none was asked for, and where the
    /// parts of a merged picture had not all the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target_error: Option<f64>,
    /// How the samples were shared out over the picture; absent where every pixel was to have the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptive: Option<AdaptiveRecord>,
    pub biased: bool,
    /// How it was denoised; absent for a mean of samples. `standard_error` is then that of the mean before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub denoised: Option<Denoised>,
    pub seconds: Seconds,
    pub paths: u64,
    pub rays: u64,
    pub non_finite: u64,
    /// Mean radiance over the picture.
    pub mean: [f64; 3],
    /// Standard error of `mean`; null where it is not known: a pixel has one sample alone, or one randomisation.
    pub standard_error: Option<[f64; 3]>,
    /// What standard errors and variances are made of.
    #[serde(default)]
    pub error_estimate: ErrorEstimate,
    /// Samples of one randomisation; absent where samples are independent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub randomisation: Option<u64>,
    /// Where pixels share point sets: the mean of the picture by each randomisation that all pixels have, the last
    /// perhaps of fewer samples; `standard_error` is their spread. Absent otherwise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub randomisation_means: Vec<[f64; 3]>,
    /// Files that were written.
    pub outputs: Vec<String>,
}

impl Record {
    /// The ranges of samples in the picture, in order.
    pub fn ranges(&self) -> Vec<[u64; 2]> {
        match self.sample_ranges.as_slice() {
            [] => vec![self.sample_range],
            ranges => ranges.to_vec(),
        }
    }

    /// Everything that took part in rendering.
    pub fn all_devices(&self) -> Vec<DeviceInfo> {
        match self.devices.as_slice() {
            [] => vec![self.device.clone()],
            devices => devices.to_vec(),
        }
    }

    /// One line of JSON.
    pub fn to_json(&self) -> String {
        // Keys are strings and no value can fail to be written, so there is no error to report.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// The same with spaces behind it, so that its length does not depend on how many digits the times take: equal
    /// renders give files of equal length.
    pub fn to_even_json(&self) -> String {
        /// The longest f64 in JSON, such as -2.2250738585072014e-308.
        const LONGEST: usize = 24;
        let written = |value: f64| serde_json::to_string(&value).unwrap_or_default().len();
        let Seconds {
            setup,
            render,
            total,
            longest_block,
        } = self.seconds;
        let denoising = self.denoised.as_ref().map(|denoised| denoised.seconds);
        let times = [setup, render, total, longest_block];
        let short = times.into_iter().chain(denoising);
        let short = short.map(|value| LONGEST.saturating_sub(written(value)));
        self.to_json() + &" ".repeat(short.sum())
    }
}

/// A pilot by which paths were thinned out and split. Its samples are not in the picture, and its time counts as
/// setup.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PilotRecord {
    /// Of what it found.
    pub hash: String,
    pub paths: u64,
    /// Shadow rays included.
    pub rays: u64,
}

/// Wall-clock times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Seconds {
    /// From the start to the first dispatch: device, compilation, buffers.
    pub setup: f64,
    /// Tracing alone.
    pub render: f64,
    /// All of it, writing of files excepted where the record is inside them.
    pub total: f64,
    /// The longest that the device was at one block of the work, which is one dispatch or several: so long does
    /// a signal wait, or anybody else who wants the device.
    #[serde(default)]
    pub longest_block: f64,
}

/// Why a render ended before its last sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stop {
    /// Its error was as small as was asked for.
    TargetError,
    /// It had taken as long as was asked for.
    Time,
    /// Somebody wanted it to.
    Signal,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_do_not_change_the_length() {
        let of = |setup, render, total| {
            let seconds = Seconds {
                setup,
                render,
                total,
                longest_block: render,
            };
            let record = Record {
                seconds,
                ..sample()
            };
            let text = record.to_even_json();
            assert_eq!(
                serde_json::from_str::<Record>(&text).unwrap().seconds,
                seconds
            );
            text.len()
        };
        let lengths = [of(0.1, 2.0, 3.0), of(0.073892306, 1e-300 / 3.0, 1e9 / 7.0)];
        assert_eq!(lengths[0], lengths[1]);
        assert_ne!(lengths[0], sample().to_json().len());
    }

    fn sample() -> Record {
        let text = r#"{"version":"0","scene":"s","scene_hash":"","shader_hash":"","preset":"reference","knobs":{},"kernel":"general",
            "device":{"kind":"cpu","name":"","driver":"","backend":"none","pci":""},"width":1,"height":1,"samples":1,
            "sample_range":[0,1],"seed":0,"complete":true,"biased":false,"seconds":{"setup":0.0,"render":0.0,"total":0.0},
            "paths":1,"rays":1,"non_finite":0,"mean":[0.0,0.0,0.0],"standard_error":[0.0,0.0,0.0],"outputs":[]}"#;
        serde_json::from_str(text).unwrap()
    }
}
