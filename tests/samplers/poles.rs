//! Where points crowd: both angles even against even by area, and the two samplers that are even by
//! area against each other, by tests of two samples that know nothing of a density.

use super::cells::{AROUND, POLAR, counts};
use super::light::{Place, light};
use super::sampling::*;
use super::{DRAWS, LEVEL};
use crate::support::bench::{Bench, benches};
use crate::support::chance::*;
use lampray::knobs::LightSampler;
use lampray::pack::Draw;
use std::f64::consts::{FRAC_2_PI, PI};

/// Four standard errors of a share, and of an empirical distribution at one place.
const MARGIN: f64 = 4.0 * 0.5 / 1e3;
/// Tests of two samples on one device: three for each pair.
const TESTS: usize = 3;

/// Points of a lamp and their heights over its equator, sorted.
struct Points {
    of: Sampling,
    draws: Vec<Draw>,
}

impl Points {
    fn new(bench: Bench, sampler: LightSampler, family: u32) -> Self {
        let of = light(sampler, Place::Far, false);
        let draws = of.draws(bench, family, DRAWS);
        Self { of, draws }
    }

    fn sorted(&self, axis: glam::DVec3) -> Vec<f64> {
        let mut all: Vec<_> = self.draws.iter().map(|draw| wide(draw).dot(axis)).collect();
        all.sort_by(f64::total_cmp);
        all
    }
}

/// Largest distance between a sample's distribution and that of heights even by area.
fn distance_to_even(heights: &[f64]) -> f64 {
    let count = heights.len() as f64;
    let apart = heights.iter().enumerate().map(|(place, z)| {
        let even = 0.5 * (1.0 + z);
        let (below, at) = (place as f64 / count, (place + 1) as f64 / count);
        (below - even).abs().max((at - even).abs())
    });
    apart.fold(0.0, f64::max)
}

/// Between 1 - acos(z) / pi and (1 + z) / 2, at z = sqrt(1 - 4 / pi^2): 0.1053.
fn distance_of_even_angles() -> f64 {
    let z = (1.0 - FRAC_2_PI * FRAC_2_PI).sqrt();
    0.5 * (1.0 + z) - (1.0 - z.acos() / PI)
}

#[test]
fn points_crowd_at_the_poles_as_the_paper_says() {
    assert!((distance_of_even_angles() - 0.1053).abs() < 5e-5);
    let even = 1.0 - (PI / 6.0).cos();
    for bench in benches() {
        for (sampler, share, distance) in [
            (
                LightSampler::UniformAngles,
                1.0 / 3.0,
                distance_of_even_angles(),
            ),
            (LightSampler::InverseCosine, even, 0.0),
            (LightSampler::Gaussian, even, 0.0),
        ] {
            let points = Points::new(bench, sampler, 2);
            let heights = points.sorted(points.of.axis);
            let cap = (PI / 6.0).cos();
            let near = heights.iter().filter(|z| z.abs() > cap).count() as f64 / DRAWS as f64;
            let apart = distance_to_even(&heights);
            println!(
                "{bench:?} {sampler}: {near:.4} within 30 degrees of a pole, distance {apart:.4}"
            );
            assert!((near - share).abs() < MARGIN, "{sampler}: {near}");
            assert!((apart - distance).abs() < MARGIN, "{sampler}: {apart}");
        }
    }
}

/// p of two samples being of one law: of heights along two axes (Kolmogorov and Smirnov), and of
/// cells (chi-square; both samples have one size).
fn one_law(a: &Points, b: &Points) -> [f64; TESTS] {
    let root = (DRAWS as f64 / 2.0).sqrt();
    let axis = a.of.axis;
    let heights = [axis, axis.any_orthonormal_vector()].map(|axis| {
        let apart = distance_of_sorted(&a.sorted(axis), &b.sorted(axis));
        kolmogorov_above(root * apart)
    });
    let (ours, theirs) = (counts(&a.of, &a.draws), counts(&a.of, &b.draws));
    let cells = POLAR * AROUND;
    let apart = |(a, b): (&f64, &f64)| (a - b).powi(2) / (a + b).max(1.0);
    let statistic = ours[..cells].iter().zip(&theirs).map(apart).sum();
    let p = chi_square_above(statistic, cells as f64 - 1.0);
    [heights[0], heights[1], p]
}

#[test]
fn inverse_cosine_and_gaussian_have_one_law() {
    let level = sidak(LEVEL, TESTS);
    for bench in benches() {
        let inverse = Points::new(bench, LightSampler::InverseCosine, 3);
        let gaussian = Points::new(bench, LightSampler::Gaussian, 4);
        let p = one_law(&inverse, &gaussian);
        println!("{bench:?}: inverse-cosine and gaussian: p {p:.3?}, level {level:.1e}");
        assert!(p.iter().all(|p| *p >= level), "{bench:?}: {p:?}");
    }
}

/// The other side of the test above: it does find a law that differs, also where one draw in
/// twenty-five follows it.
#[test]
fn even_angles_have_another_law() {
    let level = sidak(LEVEL, TESTS);
    for bench in benches() {
        let inverse = Points::new(bench, LightSampler::InverseCosine, 3);
        let mut angles = Points::new(bench, LightSampler::UniformAngles, 5);
        let p = one_law(&inverse, &angles);
        assert!(p[0] < level && p[2] < level, "{bench:?}: {p:?}");
        let axis = inverse.of.axis;
        let apart = distance_of_sorted(&inverse.sorted(axis), &angles.sorted(axis));
        assert!(
            (apart - distance_of_even_angles()).abs() < MARGIN,
            "{apart}"
        );
        let gaussian = Points::new(bench, LightSampler::Gaussian, 4);
        for (place, draw) in gaussian.draws.iter().enumerate() {
            if !place.is_multiple_of(25) {
                angles.draws[place] = *draw;
            }
        }
        let p = one_law(&inverse, &angles);
        println!(
            "{bench:?}: one draw in 25 by even angles: p {:.1e}",
            p[0].min(p[1]).min(p[2])
        );
        assert!(p.iter().any(|p| *p < level), "{bench:?}: {p:?}");
    }
}
