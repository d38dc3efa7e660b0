//! The third layer: single pixels and clusters of them, for thin and small differences.

use super::estimate::{Estimate, Parts};
use super::moments::Sides;
use super::normal::{sidak, two_sided};
use super::tiles::{SIDE, Spot, tile_at};
use rayon::prelude::*;
use serde::Serialize;

/// A pixel fails where it is farther off than this in any channel.
pub const FAR: f64 = 3.0;

/// Fixed polyominoes of 1, 2, 3, ... squares: the shapes that a cluster through a given pixel can
/// have (OEIS A001168).
const SHAPES: [f64; 12] = [
    1.0, 2.0, 6.0, 19.0, 63.0, 216.0, 760.0, 2725.0, 9910.0, 36446.0, 135_268.0, 505_861.0,
];
/// One more square multiplies their number by less than this (Klarner and Rivest 1973).
const GROWTH: f64 = 4.65;

/// What the pixels say.
#[derive(Clone, Debug, Serialize)]
pub struct Pixels {
    /// Standard errors beyond which a pixel fails.
    pub far: f64,
    pub count: usize,
    pub failing: usize,
    /// How many would fail on average, at most, where nothing differs.
    pub expected: f64,
    /// Pixels of the largest cluster of failing ones that touch by their sides.
    pub largest_cluster: usize,
    /// A pixel of it.
    pub cluster_at: Option<[u32; 2]>,
    /// The chance of such a cluster, at most, where nothing differs.
    pub cluster_p: f64,
    /// The pixel that differs most clearly.
    pub worst: Spot,
    /// Whether the cluster, or the single pixel, is too unlikely.
    pub cluster_fails: bool,
    pub single_fails: bool,
}

/// z of every pixel, with the sign of its difference: that of the channel that is farthest off.
pub fn map(sides: &Sides, tolerance: f64) -> Vec<f32> {
    let mut z = vec![0.0; sides.pixels()];
    let bands = z.par_chunks_mut(SIDE * sides.width).enumerate();
    bands.for_each(|(row, band)| {
        for column in 0..sides.width.div_ceil(SIDE) {
            let rect = tile_at(sides, column, row);
            let surroundings = Surroundings::of(sides, rect);
            let [x0, y0, x1, y1] = rect;
            for y in y0..y1 {
                for x in x0..x1 {
                    let pixel = y * sides.width + x;
                    let (_, estimate) = surroundings.farthest(sides, pixel, tolerance);
                    let signed = estimate.z.copysign(estimate.difference);
                    band[pixel - row * SIDE * sides.width] = signed as f32;
                }
            }
        }
    });
    z
}

/// The tile around some pixels, channel by channel.
struct Surroundings {
    parts: [Parts; 3],
    size: usize,
}

impl Surroundings {
    fn of(sides: &Sides, rect: [usize; 4]) -> Self {
        let [x0, y0, x1, y1] = rect;
        Self {
            parts: [0, 1, 2].map(|channel| sides.within(rect, channel)),
            size: (x1 - x0) * (y1 - y0),
        }
    }

    fn farthest(&self, sides: &Sides, pixel: usize, tolerance: f64) -> (usize, Estimate) {
        let one = |channel: usize| {
            let parts = sides.at(pixel, channel, &self.parts[channel], self.size);
            (channel, Estimate::new(parts, tolerance))
        };
        let [red, green, blue] = [0, 1, 2].map(one);
        let farther =
            |a: (usize, Estimate), b: (usize, Estimate)| if b.1.z > a.1.z { b } else { a };
        farther(farther(red, green), blue)
    }
}

/// Compares pixel by pixel; `alpha` is shared by the largest cluster and the worst pixel.
pub fn judge(sides: &Sides, alpha: f64, tolerance: f64) -> Pixels {
    let z = map(sides, tolerance);
    let failing: Vec<bool> = z.iter().map(|z| f64::from(z.abs()) > FAR).collect();
    let (largest_cluster, cluster_at) = largest_cluster(&failing, sides.width);
    let chance = 3.0 * two_sided(FAR);
    let cluster_p = cluster_chance(largest_cluster, sides.pixels(), chance);
    let worst = worst(sides, &z, tolerance);
    let alone = sidak(0.5 * alpha, 3.0 * sides.pixels() as f64);
    Pixels {
        far: FAR,
        count: sides.pixels(),
        failing: failing.iter().filter(|fails| **fails).count(),
        expected: chance * sides.pixels() as f64,
        largest_cluster,
        cluster_at: cluster_at.map(|pixel| {
            let [x, y] = place(pixel, sides.width);
            let rect = sides.place([x, y, x + 1, y + 1]);
            [rect.x0, rect.y0]
        }),
        cluster_p,
        worst,
        cluster_fails: cluster_p < 0.5 * alpha,
        single_fails: worst.estimate.p() < alone,
    }
}

fn place(pixel: usize, width: usize) -> [usize; 2] {
    [pixel % width, pixel / width]
}

fn worst(sides: &Sides, z: &[f32], tolerance: f64) -> Spot {
    let mut pixel = 0;
    for (other, far) in z.iter().enumerate() {
        if far.abs() > z[pixel].abs() {
            pixel = other;
        }
    }
    let [x, y] = place(pixel, sides.width);
    let rect = tile_at(sides, x / SIDE, y / SIDE);
    let (channel, estimate) = Surroundings::of(sides, rect).farthest(sides, pixel, tolerance);
    Spot {
        rect: sides.place([x, y, x + 1, y + 1]),
        channel,
        estimate,
    }
}

/// Size of the largest set of failing pixels that touch by their sides, and its first pixel.
fn largest_cluster(failing: &[bool], width: usize) -> (usize, Option<usize>) {
    let mut seen = vec![false; failing.len()];
    let mut largest = (0, None);
    let mut stack = Vec::new();
    for start in 0..failing.len() {
        if !failing[start] || seen[start] {
            continue;
        }
        seen[start] = true;
        stack.push(start);
        let mut size = 0;
        while let Some(pixel) = stack.pop() {
            size += 1;
            let x = pixel % width;
            let left = (x > 0).then(|| pixel - 1);
            let right = (x + 1 < width).then_some(pixel + 1);
            let above = pixel.checked_sub(width);
            let below = Some(pixel + width).filter(|below| *below < failing.len());
            for next in [left, right, above, below].into_iter().flatten() {
                if failing[next] && !seen[next] {
                    seen[next] = true;
                    stack.push(next);
                }
            }
        }
        if size > largest.0 {
            largest = (size, Some(start));
        }
    }
    largest
}

/// The chance, at most, of a cluster of `size` or more failing pixels somewhere among `pixels`, each
/// failing by itself with `chance`: the expected number of places and shapes that hold one.
fn cluster_chance(size: usize, pixels: usize, chance: f64) -> f64 {
    if size == 0 {
        return 1.0;
    }
    let known = SHAPES.len();
    let shapes = |size: usize| {
        let beyond = size.saturating_sub(known) as f64;
        SHAPES[size.min(known) - 1].ln() + beyond * GROWTH.ln()
    };
    // Far beyond the table the sum is a geometric series that its first terms decide.
    let places = |size: usize| (shapes(size) + size as f64 * chance.ln()).exp();
    let sum: f64 = (size..size + 40).map(places).sum();
    (pixels as f64 * sum).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clusters_touch_by_their_sides() {
        let picture = ["#..#.", "##..#", ".#.##", "#..#."];
        let failing: Vec<bool> = picture.concat().bytes().map(|b| b == b'#').collect();
        assert_eq!(largest_cluster(&failing, 5), (4, Some(0)));
        assert_eq!(largest_cluster(&[false; 20], 5), (0, None));
        assert_eq!(largest_cluster(&[true; 20], 5), (20, Some(0)));
    }

    /// Against independent random pictures: the bound holds, and is not idle.
    #[test]
    fn the_chance_of_a_cluster_is_bounded() {
        let (width, pixels, chance, pictures) = (64, 4096, 0.05, 2000);
        let mut state = 7u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / (1u64 << 31) as f64
        };
        let mut found = [0; 12];
        for _ in 0..pictures {
            let failing: Vec<bool> = (0..pixels).map(|_| random() < chance).collect();
            let (size, _) = largest_cluster(&failing, width);
            for counted in &mut found[..=size.min(11)] {
                *counted += 1;
            }
        }
        for size in [5, 6] {
            let share = f64::from(found[size]) / f64::from(pictures);
            let bound = cluster_chance(size, pixels, chance);
            let error = (bound / f64::from(pictures)).sqrt();
            assert!(share <= bound + 4.0 * error, "{size}: {share} {bound}");
            assert!(share >= 0.2 * bound, "{size}: {share} {bound}");
        }
    }
}
