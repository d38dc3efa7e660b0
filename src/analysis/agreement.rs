//! Whether runs vary among each other as their own variances say.

use super::quantity::Quantity;
use super::runs::Runs;

/// The variance of a run's mean by its spread over the runs, over the same by the stored variances; 1 is
/// expected. None for a single run, or without noise.
///
/// Below 1 where runs share random numbers, above where samples of a run do, or where runs differ in
/// more than their seed. The difference x of the two estimates is 0 on average in every pixel, so the
/// sum of x^2 is the variance of the sum of x, whatever the noise is like.
pub(super) fn agreement(runs: &Runs, pixels: &[usize]) -> Option<Quantity> {
    if runs.len() < 2 {
        return None;
    }
    let (mut expected, mut excess) = (0.0, 0.0);
    let (mut squares, mut fourth) = (0.0, 0.0);
    for &index in pixels {
        let pixel = &runs.pixels[index];
        let mut x = 0.0;
        for channel in 0..3 {
            let [spread, _, _] = pixel.spread(channel, runs.len());
            let stored = pixel.variance[channel] * pixel.inverse;
            expected += stored;
            x += spread - stored;
        }
        excess += x;
        squares += x * x;
        fourth += x.powi(4);
    }
    (expected > 0.0).then(|| {
        let ratio = 1.0 + excess / expected;
        let freedom = squares * squares / fourth.max(f64::MIN_POSITIVE);
        Quantity::new(ratio, squares / (expected * expected), freedom)
    })
}
