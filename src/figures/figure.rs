//! What a figure is made of, before it is drawn: numbers, pictures and sentences.

use crate::report::data::Interval;
use serde::{Deserialize, Serialize};

/// One of the paper's experiments: what it claims, and what the runs say.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Figure {
    /// The paper's number.
    pub number: u32,
    pub title: String,
    /// What the paper shows and says, in our words.
    pub claim: String,
    /// How we read what the paper leaves open.
    pub reading: String,
    pub verdict: Verdict,
    /// Sentences made from the data, most important first.
    pub results: Vec<String>,
    /// In the order in which they are read.
    pub blocks: Vec<Block>,
    /// Commands that make the data again.
    pub commands: Vec<String>,
    /// Pages of the sweeps that the data are from, beside the page of the figures.
    pub sweeps: Vec<String>,
    /// What the data are, as files.
    pub data: Vec<DataFile>,
}

/// What is left of a claim.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    pub holds: Holds,
    /// One sentence with its numbers.
    pub text: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Holds {
    Yes,
    Partly,
    No,
    /// The data are too few to tell.
    Unknown,
}

impl Holds {
    pub fn words(self) -> &'static str {
        match self {
            Holds::Yes => "holds",
            Holds::Partly => "holds in part",
            Holds::No => "does not hold",
            Holds::Unknown => "cannot be told",
        }
    }
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Block {
    Pictures(Pictures),
    Plots(Plots),
    Table(Table),
}

/// Pictures in rows and columns, all shown with one exposure.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Pictures {
    /// A file name without an extension.
    pub name: String,
    pub caption: String,
    pub columns: Vec<String>,
    pub rows: Vec<PictureRow>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PictureRow {
    pub label: String,
    pub cells: Vec<Shown>,
}

/// A picture as a screen shows it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Shown {
    /// A line under the picture; empty for none.
    pub note: String,
    pub width: u32,
    pub height: u32,
    /// sRGB bytes, R G B, row by row from the top.
    #[serde(skip)]
    pub rgb: Vec<u8>,
}

/// Plots that stand beside each other where there is room, under one caption.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Plots {
    /// A file name without an extension.
    pub name: String,
    pub caption: String,
    pub plots: Vec<Plot>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Plot {
    Lines(Lines),
    Bars(Bars),
    Sphere(Sphere),
}

/// y against x.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Lines {
    pub title: String,
    pub x: Scale,
    pub y: Scale,
    pub series: Vec<Series>,
    /// Levels that are marked across the plot.
    pub marks: Vec<Mark>,
}

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Scale {
    pub label: String,
    pub logarithmic: bool,
    /// Ends that hold whatever the data are.
    pub low: Option<f64>,
    pub high: Option<f64>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Series {
    /// Empty where it belongs to another series and is told by its look.
    pub name: String,
    pub look: Look,
    /// Index of its colour: series that belong together have the same.
    pub colour: usize,
    pub points: Vec<Point>,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Look {
    /// Dots with error bars, joined by a thin line.
    Measured,
    /// Dots with error bars, beside a line that says how they are joined.
    Dots,
    /// Many points: a line with a band.
    Band,
    /// What theory says: a dashed line without dots.
    Predicted,
}

/// A value with its 95 % interval; low and high are the value itself where there is none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    pub low: f64,
    pub high: f64,
}

impl Point {
    pub fn exact(x: f64, y: f64) -> Self {
        Self {
            x,
            y,
            low: y,
            high: y,
        }
    }

    pub fn within(x: f64, y: Interval) -> Self {
        Self {
            x,
            y: y.value,
            low: y.low,
            high: y.high,
        }
    }
}

/// A level with a name.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Mark {
    pub name: String,
    pub y: f64,
}

/// Groups of bars that start at a base line, with error bars.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Bars {
    pub title: String,
    pub y: Scale,
    /// Where bars start; the least of the scale where it is logarithmic.
    pub base: f64,
    /// Names of the bars of each group, in the order of their colours.
    pub names: Vec<String>,
    /// Colour of each bar of a group.
    pub colours: Vec<usize>,
    pub groups: Vec<BarGroup>,
    pub marks: Vec<Mark>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct BarGroup {
    pub name: String,
    /// One for each name; none where there is no number.
    pub bars: Vec<Option<Interval>>,
    /// What theory says of each bar, a tick across it.
    pub predicted: Vec<Option<f64>>,
}

/// Points on the unit sphere, seen from a little above its pole, in perspective-free projection.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Sphere {
    pub title: String,
    /// A line under it.
    pub note: String,
    pub colour: Hue,
    /// Unit vectors; the pole is z, which is drawn upright.
    pub points: Vec<[f64; 3]>,
}

/// The paper's own colours for its three cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hue {
    Red,
    Green,
    Blue,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Table {
    pub caption: String,
    pub head: Vec<String>,
    /// Numbers are set right where all of a column are numbers.
    pub rows: Vec<Vec<String>>,
}

/// A file beside the page.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct DataFile {
    pub name: String,
    #[serde(skip)]
    pub csv: String,
}
