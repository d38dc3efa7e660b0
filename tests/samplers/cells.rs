//! Cells of the unit sphere, what each should hold, and what it does hold.

use super::sampling::*;
use crate::support::chance::{Fit, fit};
use glam::DVec3;
use lampray::pack::Draw;
use std::f64::consts::TAU;

/// Cells from the axis to the limit, and around it.
pub const POLAR: usize = 20;
pub const AROUND: usize = 32;

/// A place on the unit sphere as (polar angle, azimuth) about the axis.
pub fn angles(v: DVec3, axes: (DVec3, DVec3, DVec3)) -> (f64, f64) {
    let (x, y, z) = (v.dot(axes.0), v.dot(axes.1), v.dot(axes.2));
    let around = y.atan2(x);
    (
        x.hypot(y).atan2(z),
        if around < 0.0 { around + TAU } else { around },
    )
}

pub fn axes(z: DVec3) -> (DVec3, DVec3, DVec3) {
    let (x, y) = z.any_orthonormal_pair();
    (x, y, z)
}

/// Share of the draws that each cell should have, by midpoints; then the rest beyond the limit.
pub fn shares(of: &Sampling, density: &Density) -> Vec<f64> {
    let fine = of.midpoints;
    let (x, y, z) = axes(of.axis);
    let (high, wide) = (
        of.limit / (POLAR * fine) as f64,
        TAU / (AROUND * fine) as f64,
    );
    let mut shares = vec![0.0; POLAR * AROUND];
    for i in 0..POLAR * fine {
        let (sine, cosine) = ((i as f64 + 0.5) * high).sin_cos();
        for j in 0..AROUND * fine {
            let (up, along) = ((j as f64 + 0.5) * wide).sin_cos();
            let v = sine * (along * x + up * y) + cosine * z;
            shares[i / fine * AROUND + j / fine] += density(v) * sine * high * wide;
        }
    }
    let rest = 1.0 - of.ring - shares.iter().sum::<f64>();
    shares.push(rest.max(0.0));
    shares.push(of.ring);
    shares
}

/// Draws in each cell, beyond the limit, and on the ring.
pub fn counts(of: &Sampling, draws: &[Draw]) -> Vec<f64> {
    let axes = axes(of.axis);
    let mut counts = vec![0.0; POLAR * AROUND + 2];
    for draw in draws {
        let (polar, around) = angles(wide(draw), axes);
        let (row, column) = (
            polar / of.limit * POLAR as f64,
            around / TAU * AROUND as f64,
        );
        // A rounding error beyond the limit is not beyond it.
        let within = polar < of.limit * (1.0 + 1e-5);
        let ring = of.ring > 0.0 && draw.density == 0.0;
        let cell = match (ring, within) {
            (true, _) => POLAR * AROUND + 1,
            (false, false) => POLAR * AROUND,
            _ => (row as usize).min(POLAR - 1) * AROUND + (column as usize).min(AROUND - 1),
        };
        counts[cell] += 1.0;
    }
    counts
}

/// Chi-square of draws against a density.
pub fn test(of: &Sampling, density: &Density, draws: &[Draw]) -> Fit {
    let expected: Vec<_> = shares(of, density)
        .iter()
        .map(|p| p * draws.len() as f64)
        .collect();
    fit(&counts(of, draws), &expected)
}
