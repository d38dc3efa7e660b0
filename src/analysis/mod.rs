//! What the pictures of a sweep say of bias, variance and cost, each number with a 95 % interval.
//!
//! ```text
//! Picture, seconds ─Runs::add→ Runs (a group: runs that differ in nothing but the seed)
//! Runs ─Question::answer→ Group ─┐
//! its reference ──↗              ├─Analysis::new→ ratios to a baseline, findings → report::data::ReportData
//! other groups ──────────────────┘
//! ```
//!
//! This room neither renders nor writes files. [`Runs`] takes pictures one after another and keeps, for
//! each pixel, only means and sums of squares, so memory does not grow with the number of runs; a
//! [`Group`] keeps numbers and three pictures.
//!
//! # The model
//!
//! K runs of N independent samples; m is a pixel's mean in one run, v its sample variance, r and v_r / n_r
//! the reference's mean and the variance of that mean. Pixels share no random numbers. All sums are
//! over the pixels of a region, all figures are the mean of the three channels.
//!
//! | figure | estimate | its variance |
//! |---|---|---|
//! | mean | mean of m | sum of v / (N K) |
//! | bias | mean of m - r | the same, plus sum of v_r / n_r |
//! | variance of one sample | mean of v | its spread over the runs, pixel by pixel |
//! | bias^2 | (m - r)^2 - v / (N K) - v_r / n_r, m the mean of all runs | see [`Energy`] |
//! | MSE of a run | bias^2 + v / N | see [`Energy`] |
//! | relMSE | the same, over r^2 + 0.01 | the same |
//! | N* | v / bias^2 | delta method on its logarithm |
//! | efficiency | 1 / (MSE x seconds) | delta method on its logarithm |
//! | an axis's value over its first: variance, time of one sample | geometric mean over pairs of groups, see [`Effect`] | delta method on its logarithm |
//! | equal time, equal error | see [`equal_time`], [`equal_error`] | delta method on their logarithms |
//!
//! An unbiased estimate of bias^2 is below 0 about every other time where there is no bias; it stays so
//! here, and whoever draws it on a scale that has no negative numbers cuts it off there.
//!
//! Intervals are an estimate plus and minus its standard error times Student's quantile, with the degrees
//! of freedom of the variance (Welch 1947, Satterthwaite 1946). Channels are of the same paths and rise
//! and fall together; how closely is not in the files, so they are taken as fully correlated, and the
//! error of their mean is the mean of their errors. By Cauchy's inequality that is never too small.
//!
//! The tests hold every interval against 2000 made-up sweeps of 400 pixels: they cover in 93 to 97 % of them.
//! Where there is no bias and pixels are few, those of bias^2 and MSE are too wide: 97 % with 400 and
//! 98 % with a hundred, since their variance is estimated from the same squares as they are. Where N* is barely clear, it is
//! stated too low, as all is that is stated only where it is clear. Noise of rare bright paths, which
//! a few hundred samples have not met, is in no interval.
//!
//! Ratios and efficiencies are products of positive numbers: their logarithm is nearer to normal than they
//! are, and A over B then has the interval of B over A turned round. The delta method (Oehlert 1992) is
//! taken rather than a bootstrap over seeds, which with the three to ten seeds of a sweep has too few
//! values to draw from and covers too rarely, and needs all pictures at once. Groups are taken as
//! independent; those that share seeds share noise, which as a rule makes their ratio steadier than its
//! interval says.
//!
//! Group and reference must share no random numbers: the reference takes a seed of its own. A question
//! has one reference for each expected picture, and each group says which one it is held against; ratios
//! are only of groups that share theirs.

mod agreement;
mod cell;
mod changes;
mod effects;
mod energy;
mod fill;
mod findings;
mod group;
mod images;
mod quantity;
mod question;
mod ratios;
mod reference;
mod room;
mod runs;
mod sweep;
pub(crate) mod words;

pub use effects::Effect;
pub use energy::Energy;
pub use group::{Group, Maps, RegionFigures};
pub use images::{Kind, image, picture_image};
pub use quantity::{Channels, Quantity};
pub use question::{Question, Region};
pub use ratios::{Cost, crossing, efficiency, equal_error, equal_time, seconds};
pub use reference::Reference;
pub use runs::Runs;
pub use sweep::{Against, Analysis};
