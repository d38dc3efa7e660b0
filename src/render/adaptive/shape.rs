//! From what scouts saw to how many samples each tile gets beside the others.
//!
//! A target error E asks for two things ([`crate::film::Film::relative_error`]): that 95 % of the pixels are
//! within E, and that the mean of the picture is. For a number of samples that there are to spend, the mean square
//! of the pixels' relative errors is least where tiles get samples in proportion to their relative standard
//! deviation, and the error of the mean where it is to their standard deviation (Neyman, "On the two different
//! aspects of the representative method", 1934, section V). To bring all pixels to the same error takes the square
//! of the relative deviation; but 5 % of the pixels may be above it, and they are mostly those of the noisiest
//! tiles. So several powers of the deviation are tried on what scouts foresee, and sampling evenly, and the one
//! counts that is foreseen to cost the fewest samples ([`lags`]).
//!
//! Scouts are few, and the variance of few samples is itself so uncertain that its upper quantiles are too high:
//! a pixel's need is that of its neighbourhood (`smooth.rs`). What they miss makes a shape that is dearer than it
//! was foreseen to be. Two bounds hold that: no tile is more than [`MOST_LAG`] rungs behind another, and sampling evenly
//! wins unless a tenth is to be saved, more in pictures of few tiles.

use super::smooth::smooth;
use crate::film::{Film, QUANTILE, Tiles, needed_samples};

/// The most rungs that a tile is behind another: a factor of 8.3, 1.125^18, and of up to 14 on the lowest rungs, whose
/// steps are whole runs.
pub(super) const MOST_LAG: u64 = 18;
/// From rung to rung.
const STEP: f64 = 1.125;
/// How much the need of a neighbourhood may be over that of its pixels, each by itself.
const SPARSE: f64 = 2.0;
/// What a shape may be foreseen to cost beside sampling evenly, so that it is taken.
const WORTH: f64 = 0.9;
/// How much less that is in a picture of few tiles, over their number: of the best of several guesses the cost is
/// foreseen too low, the more so the fewer pixels it rests on.
const FEW: f64 = 0.5;

/// What scouts say of a picture. Its needs are for a target of 1; all are in proportion.
struct Foresight {
    tiles: Tiles,
    /// Samples that each pixel needs.
    needs: Vec<f64>,
    /// Variance of a sample of each pixel.
    variances: Vec<f64>,
    /// Mean of the picture times its pixels.
    total: f64,
}

/// How many rungs each tile is behind the one that gets the most.
pub(super) fn lags(scouts: &Film) -> Vec<u64> {
    let foresight = Foresight::new(scouts);
    let even = vec![0; foresight.tiles.count()];
    let worth = WORTH - FEW / even.len().max(1) as f64;
    let mut best = (worth * foresight.cost(&even), even);
    for weights in foresight.shapes() {
        let lags = behind(&weights);
        let cost = foresight.cost(&lags);
        if cost < best.0 {
            best = (cost, lags);
        }
    }
    best.1
}

/// Whole rungs that each weight is below the largest.
fn behind(weights: &[f64]) -> Vec<u64> {
    let most = weights.iter().copied().fold(0.0, f64::max);
    let of = |weight: &f64| {
        let (mut lag, mut raised) = (0, weight * STEP);
        while lag < MOST_LAG && raised <= most {
            lag += 1;
            raised *= STEP;
        }
        lag
    };
    weights.iter().map(of).collect()
}

impl Foresight {
    fn new(scouts: &Film) -> Self {
        let variances = scouts.variances();
        Self {
            tiles: Tiles::of(scouts.region),
            needs: needs(scouts, &variances),
            total: scouts.brightness() * variances.len() as f64,
            variances,
        }
    }

    /// Weights of tiles that are worth trying.
    fn shapes(&self) -> [Vec<f64>; 4] {
        let roots: Vec<f64> = self.needs.iter().map(|need| need.sqrt()).collect();
        let relative = self.mean_of_tiles(&roots);
        let of_mean = self.mean_of_tiles(&self.variances);
        let of = |values: &[f64], power: fn(f64) -> f64| values.iter().map(|x| power(*x)).collect();
        [
            of(&relative, f64::sqrt),
            of(&relative, |x| x),
            // The power 5/4: of those above 1 it did best in the rooms that ship.
            of(&relative, |x| x * x.sqrt().sqrt()),
            of(&of_mean, f64::sqrt),
        ]
    }

    fn mean_of_tiles(&self, values: &[f64]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); self.tiles.count()];
        for (pixel, value) in values.iter().enumerate() {
            let (sum, area) = &mut sums[self.tiles.of_pixel(pixel)];
            *sum += value;
            *area += 1.0;
        }
        sums.into_iter().map(|(sum, area)| sum / area).collect()
    }

    /// Samples of the whole picture that are foreseen to bring it to a target of 1.
    fn cost(&self, lags: &[u64]) -> f64 {
        let weight = |lag: &u64| (0..*lag).fold(1.0, |weight, _| weight / STEP);
        let weights: Vec<f64> = lags.iter().map(weight).collect();
        let weight = |pixel: usize| weights[self.tiles.of_pixel(pixel)];
        let pixels = 0..self.needs.len();
        let mut scales: Vec<f64> = pixels
            .clone()
            .map(|pixel| self.needs[pixel] / weight(pixel))
            .collect();
        let place = (scales.len() as f64 * QUANTILE).ceil() as usize;
        let place = place.clamp(1, scales.len().max(1)) - 1;
        let of_pixels = match scales.is_empty() {
            true => 0.0,
            false => *scales.select_nth_unstable_by(place, f64::total_cmp).1,
        };
        let variance: f64 = pixels
            .clone()
            .map(|pixel| self.variances[pixel] / weight(pixel))
            .sum();
        // A black picture has no noise.
        let of_mean = match variance > 0.0 {
            true => variance / self.total.powi(2),
            false => 0.0,
        };
        of_pixels.max(of_mean) * pixels.map(weight).sum::<f64>()
    }
}

/// Samples that each pixel needs for a target of 1: by the mean and the variance of its neighbourhood. Where few
/// pixels of that are lit the two would make up to 25 times too much of it, so it is at most [`SPARSE`] times the
/// mean of the pixels' own needs, by their brightness.
fn needs(scouts: &Film, variances: &[f64]) -> Vec<f64> {
    let width = scouts.region.width() as usize;
    let brightness = scouts.brightness();
    let means = scouts.means();
    let need = |mean: f64, variance: f64| needed_samples(mean, variance, brightness, 1.0);
    let own = means.iter().zip(variances);
    let weighted: Vec<f64> = own
        .map(|(mean, variance)| mean * need(*mean, *variance))
        .collect();
    let [means, variances, weighted] =
        [&means, variances, &weighted].map(|plane| smooth(plane, width));
    let of_pixel = |pixel: usize| {
        let by_moments = need(means[pixel], variances[pixel]);
        let own = SPARSE * weighted[pixel] / means[pixel];
        // A pixel without any light around it has no noise either.
        if means[pixel] > 0.0 {
            by_moments.min(own)
        } else {
            0.0
        }
    };
    (0..means.len()).map(of_pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pack::{Rect, Tally};

    /// A film of 16 scouts whose pixels have a mean of 1 and a standard deviation each.
    fn film(width: u32, height: u32, deviation: impl Fn(u32, u32) -> f32) -> Film {
        let region = Rect {
            x0: 0,
            y0: 0,
            x1: width,
            y1: height,
        };
        let mut film = Film::new(region);
        for y in 0..height {
            for x in 0..width {
                let squares = [15.0 * deviation(x, y).powi(2); 3];
                let tally = Tally {
                    mean: [1.0; 3],
                    squares,
                    rays: 16,
                    non_finite: 0,
                };
                film.add((y * width + x) as usize, 0, 16, &tally);
            }
        }
        film
    }

    #[test]
    fn lags_are_whole_rungs_and_bounded() {
        assert_eq!(
            behind(&[8.0, 7.2, 8.0 / 1.125, 4.0, 0.1, 0.0]),
            [0, 0, 1, 5, MOST_LAG, MOST_LAG]
        );
        assert_eq!(behind(&[0.0; 3]), [MOST_LAG; 3]);
    }

    #[test]
    fn equal_tiles_are_sampled_evenly() {
        assert_eq!(lags(&film(64, 48, |_, _| 2.0)), [0; 12]);
        assert_eq!(lags(&film(64, 48, |_, _| 0.0)), [0; 12]);
        assert_eq!(lags(&film(5, 5, |_, _| 1.0)), [0]);
    }

    /// Four columns of tiles, each twice as noisy as the one before: more for more noise, and no tile
    /// further behind than that.
    #[test]
    fn noisy_tiles_get_more() {
        let lags = lags(&film(64, 64, |x, _| 0.25 * (1 << (x / 16)) as f32));
        for row in lags.chunks(4) {
            assert!(row.is_sorted_by(|one, other| one > other), "{row:?}");
            assert_eq!([row[0], row[3]], [MOST_LAG, 0]);
        }
    }

    /// One tile of 64 is hopeless. It is fewer than 5 % of the pixels, and the others are not held back by it.
    #[test]
    fn hopeless_tiles_do_not_take_from_the_others() {
        let noise = film(128, 128, |x, y| if x < 16 && y < 16 { 60.0 } else { 1.0 });
        assert_eq!(lags(&noise), [0; 64]);
    }

    /// One pixel of very many shines: 95 % of them need nothing, but the mean does.
    #[test]
    fn the_mean_of_the_picture_counts_too() {
        let lags = lags(&film(
            64,
            64,
            |x, y| {
                if x == 24 && y == 24 { 300.0 } else { 0.0 }
            },
        ));
        let lit = |(tile, lag): (usize, &u64)| (tile == 5) == (*lag == 0);
        assert!(lags.iter().enumerate().all(lit), "{lags:?}");
    }

    /// Whatever scouts saw, the shape is foreseen to cost no more than sampling evenly.
    #[test]
    fn no_shape_is_foreseen_to_cost_more() {
        for seed in 0..20 {
            let noise = film(50, 70, |x, y| {
                let hash = (x / 9 * 7919 + y / 7 * 104_729 + seed * 31) % 1009;
                (hash as f32 / 100.0).powi(1 + (x / 16 % 3) as i32)
            });
            let foresight = Foresight::new(&noise);
            let got = lags(&noise);
            let even = vec![0; got.len()];
            assert!(foresight.cost(&got) <= foresight.cost(&even));
            assert!(got == even || foresight.cost(&got) < WORTH * foresight.cost(&even));
            assert!(got.contains(&0));
        }
    }
}
