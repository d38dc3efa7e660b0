//! From what scouts saw to how many samples each tile gets.
//!
//! A target error E asks for two things ([`crate::film::Film::relative_error`]): that 95 % of the pixels are
//! within E, and that the mean of the picture is. For the first, each pixel has its need, the samples that would
//! bring it within E. A tile gets what a quantile of its pixels need, the same quantile in all tiles, but no more
//! than a cap. The cap is at least what even sampling would take, the need that 95 % of all pixels stay below;
//! the quantile is then as low as leaves 95 % of all pixels within E; and of several caps the one counts that
//! costs the fewest samples. So no plan costs more than the even one, which is the lowest cap and the highest
//! quantile where all tiles are alike, and no tile is given up because it is hard.
//!
//! Scouts are few, and the variance of few samples is itself so uncertain that its upper quantiles are too high:
//! a pixel's need is that of its neighbourhood (`smooth.rs`).
//!
//! For the second, where the first does not do it already, samples in proportion to the standard deviation cost
//! the least (Neyman, "On the two different aspects of the representative method", 1934, section V).

use super::rungs;
use super::smooth::smooth;
use crate::film::{Film, QUANTILE, Tiles, needed_samples};

/// Caps that are tried: each so many times the one before.
const CAP_STEP: f64 = 1.25;
const CAPS: i32 = 16;
/// Quantiles that are tried, from [`QUANTILE`] to 1.
const QUANTILES: usize = 20;

/// How much the need of a neighbourhood may be over that of its pixels, each by itself.
const SPARSE: f64 = 2.0;

/// The needs of each tile's pixels, in order.
struct Needs {
    tiles: Vec<Vec<f64>>,
    pixels: usize,
}

/// What a cap and a quantile come to.
struct Offer {
    samples: Vec<f64>,
    cost: f64,
    /// Pixels within the target.
    good: usize,
}

/// Samples of each pixel of each tile: a rung of the ladder, and at most `most`.
pub(super) fn allot(scouts: &Film, target: f64, most: u64) -> Vec<u64> {
    let tiles = Tiles::of(scouts.region);
    let samples = Needs::new(tiles, &needs(scouts, target)).share(most as f64);
    let of_mean = for_mean(scouts, tiles, target, &samples);
    let larger = samples.iter().zip(of_mean);
    larger
        .map(|(pixels, mean)| rungs::reach(pixels.max(mean), most))
        .collect()
}

/// Samples that each pixel needs: by the mean and the variance of its neighbourhood. Where few pixels of that are lit
/// the two would make up to 25 times too much of it, so it is at most [`SPARSE`] times the mean of the pixels' own
/// needs, by their brightness.
fn needs(scouts: &Film, target: f64) -> Vec<f64> {
    let width = scouts.region.width() as usize;
    let brightness = scouts.brightness();
    let (means, variances) = (scouts.means(), scouts.variances());
    let need = |mean: f64, variance: f64| needed_samples(mean, variance, brightness, target);
    let own = means.iter().zip(&variances);
    let weighted: Vec<f64> = own
        .map(|(mean, variance)| mean * need(*mean, *variance))
        .collect();
    let [means, variances, weighted] =
        [means, variances, weighted].map(|plane| smooth(&plane, width));
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

impl Needs {
    fn new(tiles: Tiles, of_pixels: &[f64]) -> Self {
        let mut needs = vec![Vec::new(); tiles.count()];
        for (pixel, need) in of_pixels.iter().enumerate() {
            needs[tiles.of_pixel(pixel)].push(*need);
        }
        needs
            .iter_mut()
            .for_each(|tile| tile.sort_unstable_by(f64::total_cmp));
        Self {
            tiles: needs,
            pixels: of_pixels.len(),
        }
    }

    /// The cheapest offer that leaves enough pixels within the target; where `most` does not, what it does.
    fn share(&self, most: f64) -> Vec<f64> {
        let mut all: Vec<f64> = self.tiles.concat();
        all.sort_unstable_by(f64::total_cmp);
        let even = quantile(&all, QUANTILE);
        let caps = (0..CAPS)
            .map(|step| even * CAP_STEP.powi(step))
            .filter(|cap| *cap <= most);
        let offers = caps.filter_map(|cap| self.lowest(cap));
        let best = offers.min_by(|one, other| one.cost.total_cmp(&other.cost));
        best.unwrap_or_else(|| self.offer(most, QUANTILE)).samples
    }

    /// The lowest quantile that does under a cap.
    fn lowest(&self, cap: f64) -> Option<Offer> {
        let enough = (self.pixels as f64 * QUANTILE).ceil() as usize;
        let step = (1.0 - QUANTILE) / QUANTILES as f64;
        let mut offers = (0..=QUANTILES).map(|i| self.offer(cap, QUANTILE + i as f64 * step));
        offers.find(|offer| offer.good >= enough)
    }

    fn offer(&self, cap: f64, share: f64) -> Offer {
        let samples: Vec<f64> = self
            .tiles
            .iter()
            .map(|tile| quantile(tile, share).min(cap))
            .collect();
        let both = || self.tiles.iter().zip(&samples);
        let good = both()
            .map(|(tile, count)| tile.partition_point(|need| need <= count))
            .sum();
        let cost = both()
            .map(|(tile, count)| tile.len() as f64 * count.max(rungs::FIRST as f64))
            .sum();
        Offer {
            samples,
            cost,
            good,
        }
    }
}

/// The smallest number that a share of sorted numbers do not exceed; 0 of none.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = ((sorted.len() as f64 * share).ceil() as usize).clamp(1, sorted.len().max(1));
    sorted.get(place - 1).copied().unwrap_or(0.0)
}

/// Samples of each tile that the mean of the picture needs over what the tiles have: none where it is within the
/// target already.
fn for_mean(scouts: &Film, tiles: Tiles, target: f64, samples: &[f64]) -> Vec<f64> {
    let variances = scouts.variances();
    let (mut sums, mut areas) = (vec![0.0; tiles.count()], vec![0.0; tiles.count()]);
    for (pixel, variance) in variances.iter().enumerate() {
        sums[tiles.of_pixel(pixel)] += variance;
        areas[tiles.of_pixel(pixel)] += 1.0;
    }
    let allowed = (target * scouts.brightness() * variances.len() as f64).powi(2);
    let least = rungs::FIRST as f64;
    let now: f64 = sums
        .iter()
        .zip(samples)
        .map(|(sum, count)| sum / count.max(least))
        .sum();
    if now <= allowed {
        return vec![0.0; tiles.count()];
    }
    let deviation = |(sum, area): (&f64, &f64)| (sum / area).sqrt();
    let deviations: Vec<f64> = sums.iter().zip(&areas).map(deviation).collect();
    let total: f64 = deviations
        .iter()
        .zip(&areas)
        .map(|(deviation, area)| deviation * area)
        .sum();
    deviations
        .iter()
        .map(|deviation| deviation * total / allowed)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pack::{Rect, Tally};

    /// A film of 32 scouts whose pixels have a mean of 1 and a standard deviation each.
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
                let squares = [31.0 * deviation(x, y).powi(2); 3];
                let tally = Tally {
                    mean: [1.0; 3],
                    squares,
                    rays: 32,
                    non_finite: 0,
                };
                film.add((y * width + x) as usize, 0, 32, &tally);
            }
        }
        film
    }

    fn need(deviation: f64, target: f64) -> f64 {
        needed_samples(1.0, deviation * deviation, 1.0, target)
    }

    /// Needs of tiles of a hundred pixels.
    fn share(tiles: &[[f64; 100]], most: f64) -> Vec<f64> {
        let tiles: Vec<_> = tiles.iter().map(|tile| tile.to_vec()).collect();
        let pixels = 100 * tiles.len();
        Needs { tiles, pixels }.share(most)
    }

    #[test]
    fn equal_tiles_get_what_even_sampling_takes() {
        let film = film(64, 48, |_, _| 2.0);
        let rung = rungs::reach(need(2.0, 0.1), 100_000);
        assert_eq!(allot(&film, 0.1, 100_000), vec![rung; 12]);
        assert_eq!(allot(&film, 0.1, 200), vec![200; 12]);
    }

    #[test]
    fn noisy_tiles_get_more_and_none_more_than_it_needs() {
        assert_eq!(
            share(&[[1600.0; 100], [90.0; 100], [250.0; 100]], 1e6),
            [1600.0, 90.0, 250.0]
        );
    }

    /// Of a hundred tiles four are hopeless: they get no less than the others, which are not held to them.
    #[test]
    fn hopeless_tiles_get_no_less_than_even_sampling_would_give_them() {
        let mut tiles = [[100.0; 100]; 100];
        tiles[..4].fill([1e9; 100]);
        assert_eq!(share(&tiles, 1e6), [100.0; 100]);
    }

    /// Whatever the needs are, the plan costs no more than the even one, and brings as many pixels within the target.
    #[test]
    fn no_plan_costs_more_than_the_even_one() {
        let hash = |tile: usize, pixel: usize| ((tile * 7919 + pixel * 104_729) % 1009) as f64;
        let tile = |tile: usize| {
            let mut needs: [f64; 100] =
                std::array::from_fn(|pixel| hash(tile, pixel).powi(1 + tile as i32 % 3));
            needs.sort_unstable_by(f64::total_cmp);
            needs
        };
        let tiles: Vec<_> = (0..60).map(tile).collect();
        let mut all = tiles.concat();
        all.sort_unstable_by(f64::total_cmp);
        let even = quantile(&all, QUANTILE);
        let got = share(&tiles, f64::INFINITY);
        let cost: f64 = got.iter().sum::<f64>() / 60.0;
        assert!(cost <= even, "{cost} {even}");
        let both = tiles.iter().zip(&got);
        let good: usize = both
            .map(|(tile, count)| tile.partition_point(|need| need <= count))
            .sum();
        assert!(good >= 5700, "{good}");
    }

    #[test]
    fn a_picture_without_noise_gets_the_least() {
        assert_eq!(
            allot(&film(20, 20, |_, _| 0.0), 0.01, 5000),
            vec![rungs::FIRST; 4]
        );
        assert_eq!(allot(&film(20, 20, |_, _| 0.0), 0.01, 7), vec![7; 4]);
    }

    /// One pixel of very many shines: 95 % of them need nothing, but the mean does.
    #[test]
    fn the_mean_of_the_picture_is_within_the_target_too() {
        let film = film(64, 64, |x, y| if x == 24 && y == 24 { 300.0 } else { 0.0 });
        let got = allot(&film, 0.001, 1_000_000);
        let wanted = (300.0_f64 / (0.001 * 4096.0)).powi(2);
        assert_eq!(got[5], rungs::reach(wanted, 1_000_000));
        assert!(
            got.iter()
                .enumerate()
                .all(|(tile, count)| tile == 5 || *count == rungs::FIRST)
        );
    }
}
