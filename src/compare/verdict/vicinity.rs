//! What the noise is like around a tile: how much noisier one estimator is there than the other, and how
//! bright the paths are that bring each one's noise.

use super::moments::Side;
use super::tiles::SIDE;

/// Tiles to each side that are looked at.
const REACH: usize = 2;

/// Sums over the noisy pixels of a tile or of several, of both pictures.
#[derive(Clone, Copy, Debug, Default)]
pub struct Whereabouts {
    variance: [f64; 2],
    /// variance^2 / mean: over `variance` it is variance over mean, each pixel counting by its
    /// variance. Were all paths of a pixel black but a few, that is how bright those are; and where
    /// paths of many kinds meet, the bright ones count.
    brightness: [f64; 2],
}

impl Whereabouts {
    fn add(&mut self, other: &Self) {
        for side in 0..2 {
            self.variance[side] += other.variance[side];
            self.brightness[side] += other.brightness[side];
        }
    }

    /// The variance of a path that each picture should have somewhere here, going by the other one:
    /// that picture's own variance there, times the ratio of the two around; or the variance with
    /// which paths as bright as those around bring as much light as the other picture finds.
    pub fn expected(&self, variances: [f64; 2], means: [f64; 2]) -> [f64; 2] {
        let side = |this: usize, other: usize| {
            if self.variance[this] == 0.0 {
                return variances[other];
            }
            let ratio = if self.variance[other] > 0.0 {
                self.variance[this] / self.variance[other]
            } else {
                1.0
            };
            let brightness = self.brightness[this] / self.variance[this];
            (variances[other] * ratio).max(means[other].abs() * brightness)
        };
        [side(0, 1), side(1, 0)]
    }
}

/// The whereabouts of every tile, channel by channel.
#[derive(Debug)]
pub struct Vicinity {
    across: usize,
    tiles: Vec<[Whereabouts; 3]>,
}

impl Vicinity {
    /// Reference and test.
    pub fn new(sides: [Side; 2], width: usize, height: usize) -> Self {
        let (across, down) = (width.div_ceil(SIDE), height.div_ceil(SIDE));
        let mut tiles = vec![[Whereabouts::default(); 3]; across * down];
        for pixel in 0..width * height {
            let tile = pixel / width / SIDE * across + pixel % width / SIDE;
            for (number, side) in sides.iter().enumerate() {
                for (channel, sums) in tiles[tile].iter_mut().enumerate() {
                    let mean = f64::from(side.mean[pixel][channel].abs());
                    let variance = f64::from(side.variance[pixel][channel]);
                    if mean > 0.0 && variance > 0.0 {
                        sums.variance[number] += variance;
                        sums.brightness[number] += variance * variance / mean;
                    }
                }
            }
        }
        let along = spread(&tiles, across, 1);
        Self {
            across,
            tiles: spread(&along, down, across),
        }
    }

    /// Around the tile that a pixel is in.
    pub fn of(&self, x: usize, y: usize, channel: usize) -> Whereabouts {
        self.tiles[y / SIDE * self.across + x / SIDE][channel]
    }
}

/// Adds up, for every tile, those up to [`REACH`] away in one direction: `length` tiles in a row,
/// `stride` apart.
fn spread(tiles: &[[Whereabouts; 3]], length: usize, stride: usize) -> Vec<[Whereabouts; 3]> {
    let near = |tile: usize| {
        let place = tile / stride % length;
        let (first, last) = (place.saturating_sub(REACH), (place + REACH).min(length - 1));
        let mut sums = [Whereabouts::default(); 3];
        for other in first..=last {
            let from = tile - place * stride + other * stride;
            for (sum, part) in sums.iter_mut().zip(&tiles[from]) {
                sum.add(part);
            }
        }
        sums
    };
    (0..tiles.len()).map(near).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_reach_two_to_each_side() {
        let one = [Whereabouts {
            variance: [1.0, 2.0],
            brightness: [3.0, 4.0],
        }; 3];
        // 7 x 6 tiles: inside 25, at an edge 15, in a corner 9.
        let along = spread(&vec![one; 42], 7, 1);
        let all = spread(&along, 6, 7);
        for (tile, count) in [(3 * 7 + 3, 25.0), (3, 15.0), (0, 9.0), (41, 9.0), (7, 12.0)] {
            assert_eq!(all[tile][1].variance, [count, 2.0 * count], "{tile}");
        }
    }

    /// One path in a thousand brings 100: mean 0.1, variance 10. Four samples that met none expect it.
    #[test]
    fn rare_light_is_expected_where_the_other_picture_finds_it() {
        let around = Whereabouts {
            variance: [0.0, 10.0],
            brightness: [0.0, 10.0 * 10.0 / 0.1],
        };
        let [_, test] = around.expected([0.0, 0.0], [0.1, 0.0]);
        assert!((test - 10.0).abs() < 1e-12, "{test}");
    }
}
