//! Whether two noisy pictures have the same expected image.
//!
//! Both files carry, for every pixel, the variance of one path and the number of paths, so the noise
//! of their difference is known and no threshold has to be guessed. Three layers look at it: the
//! mean of the whole picture, tiles of 8 x 8 pixels, and single pixels with the largest cluster of
//! those that are far off. Each has a third of the chance of a false alarm, `alpha`, and Sidak's
//! share of that for each of its tests.
//!
//! - One layer says no: **different**, by how much, and where.
//! - None does, and the samples would have shown a difference of `margin` in the mean of the picture
//!   (two one-sided tests, Schuirmann 1987): **same**, with the margin that they support.
//! - Otherwise there are **not enough samples**, and about so many are needed.
//!
//! "Same" speaks of the mean of the picture; [`Tiles`] states what is known of its parts.
//!
//! Pictures that were made of the same random numbers are compared as paired: what their difference
//! varies by is read from its spread over the pixels, which are independent of each other, and the third
//! layer, for which there is no such spread, is left out. Where a pixel has fewer than four samples, its
//! variance is too uncertain for layers that look at few pixels, and the mean alone is judged.
//!
//! Samples of a picture with another `render.sequence` than `independent` are no independent ones: its variances
//! are made of randomisations, and those are counted wherever samples are above. The errors of its pixels are taken
//! as independent all the same. With `blue-noise` they shun each other, so that sums over pixels vary less than is
//! taken here: alarms are rarer than `alpha` says.

mod estimate;
mod moments;
mod needed;
mod normal;
mod pixels;
mod tiles;
mod vicinity;

pub use estimate::{Estimate, Parts};
pub use moments::{Relation, Side, Sides};
pub use needed::Needed;
pub use normal::{quantile, student, two_sided};
pub use pixels::Pixels;
pub use tiles::{Spot, Tiles};

use normal::sidak;
use serde::Serialize;

/// How sure, and of what.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Terms {
    /// Chance of calling pictures different that are not, 0..1.
    pub alpha: f64,
    /// Relative difference of the mean that "same" must be able to exclude.
    pub margin: f64,
    /// Relative difference that does not count, anywhere: at least what 32-bit arithmetic leaves.
    pub tolerance: f64,
}

impl Default for Terms {
    fn default() -> Self {
        Self {
            alpha: 0.01,
            margin: 0.01,
            tolerance: 1e-5,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    Same,
    Different,
    NotEnoughSamples,
}

/// The verdict with its reasons.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    pub outcome: Outcome,
    #[serde(flatten)]
    pub terms: Terms,
    pub paired: bool,
    /// The picture's mean: red, green, blue.
    pub pooled: [Estimate; 3],
    /// The chance of a false alarm that each of them was allowed.
    pub pooled_level: f64,
    pub pooled_fails: bool,
    /// Absent where a pixel has fewer than four samples.
    pub tiles: Option<Tiles>,
    /// Absent where a pixel has fewer than four samples, and for paired pictures.
    pub pixels: Option<Pixels>,
    /// The smallest relative margin within which the means are shown to be equal.
    pub supported_margin: f64,
    /// Where there are not enough samples: how many there should be.
    pub needed: Option<Needed>,
}

/// Samples of each pixel, or randomisations, from which on the variances of few pixels can be relied on.
const LEAST: f64 = 4.0;

/// Number of layers.
fn layers(sides: &Sides) -> f64 {
    if sides.relation.paired { 2.0 } else { 3.0 }
}

/// Compares two pictures of one size, every pixel of which has two samples or more.
pub fn judge(sides: &Sides, terms: Terms) -> Verdict {
    let alpha = terms.alpha / layers(sides);
    let pooled = [0, 1, 2].map(|channel| Estimate::new(sides.everywhere(channel), terms.tolerance));
    let pooled_level = sidak(alpha, 3.0);
    let pooled_fails = pooled.iter().any(|mean| mean.p() < pooled_level);
    let enough = sides.fewest_estimates() >= LEAST;
    let tiles = enough.then(|| tiles::judge(sides, alpha, terms.tolerance));
    let pixels =
        (!sides.relation.paired && enough).then(|| pixels::judge(sides, alpha, terms.tolerance));
    let differ = pooled_fails
        || tiles.as_ref().is_some_and(|tiles| tiles.failing > 0)
        || pixels
            .as_ref()
            .is_some_and(|pixels| pixels.cluster_fails || pixels.single_fails);
    let supported_margin = needed::supported_margin(&pooled, terms.alpha);
    let outcome = match differ {
        true => Outcome::Different,
        false if supported_margin <= terms.margin => Outcome::Same,
        false => Outcome::NotEnoughSamples,
    };
    let needed =
        (outcome == Outcome::NotEnoughSamples).then(|| needed::needed(sides, &pooled, terms));
    Verdict {
        outcome,
        terms,
        paired: sides.relation.paired,
        pooled,
        pooled_level,
        pooled_fails,
        tiles,
        pixels,
        supported_margin,
        needed,
    }
}

/// z of every pixel, with the sign of its difference.
pub fn z_map(sides: &Sides, terms: Terms) -> Vec<f32> {
    pixels::map(sides, terms.tolerance)
}
