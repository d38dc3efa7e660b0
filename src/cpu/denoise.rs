//! Twin of `shaders/denoise.wgsl`: one pass of an edge-avoiding a-trous wavelet filter.

use super::maths::{greater, lesser};
use crate::pack::{DenoiseJob, Estimate, Site};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

const KIND: f32 = 50.0;
const FARTHEST: f32 = 40.0;

/// Of the cubic B-spline, 1/16 (1, 4, 6, 4, 1), at -2 to 2.
fn spline(offset: i32) -> f32 {
    match offset.abs() {
        0 => 0.375,
        1 => 0.25,
        _ => 0.0625,
    }
}

/// How far two pixels' surfaces are apart: the exponent of their weight.
pub fn site_distance(job: &DenoiseJob, a: &Site, b: &Site) -> f32 {
    let (normal, other_normal) = (Vec3::from(a.normal), Vec3::from(b.normal));
    let turn = normal - other_normal;
    let across = Vec3::from(b.position) - Vec3::from(a.position);
    let lift = greater(normal.dot(across).abs(), other_normal.dot(across).abs());
    let width = greater(lesser(a.footprint, b.footprint), 1e-30);
    let steps = lesser(lift / width, 1e6);
    let other = Vec4::from(a.kind) - Vec4::from(b.kind);
    job.normal * turn.dot(turn) + job.depth * steps * steps + KIND * other.dot(other)
}

/// The same of their light. Colours count: neighbours of two walls may be as bright as each other.
fn light_distance(job: &DenoiseJob, a: &Estimate, b: &Estimate) -> f32 {
    let apart = Vec3::from(a.light) - Vec3::from(b.light);
    let square = lesser(apart.dot(apart) / 3.0, 1e30);
    job.light * square / greater(a.variance + b.variance, 1e-30)
}

fn smoothed_at(job: &DenoiseJob, sites: &[Site], estimates: &[Estimate], at: [u32; 2]) -> Estimate {
    let [width, height] = job.window;
    let place = at[1] as usize * width as usize + at[0] as usize;
    let (site, own) = (&sites[place], &estimates[place]);
    if site.spread < 0.0 {
        return *own;
    }
    let light = Vec3::from(own.light);
    // Sums of differences: pixels that all agree leave their bits alone.
    let (mut change, mut variance, mut weights) = (Vec3::ZERO, 0.0, 0.0);
    for y in -2..=2 {
        for x in -2..=2 {
            let tap = [(0, x), (1, y)]
                .map(|(axis, offset)| at[axis].checked_add_signed(offset * job.step as i32));
            let (Some(column), Some(row)) = (tap[0], tap[1]) else {
                continue;
            };
            if column >= width || row >= height {
                continue;
            }
            let index = row as usize * width as usize + column as usize;
            let other = &estimates[index];
            // A pixel on an edge is like the pixels on both sides of it as much as its own parts are.
            let mut exponent = site_distance(job, site, &sites[index]) / (1.0 + site.spread);
            if job.only_variance == 0 {
                exponent += light_distance(job, own, other);
            }
            if sites[index].spread < 0.0 || exponent > FARTHEST {
                continue;
            }
            let weight = spline(x) * spline(y) * (-exponent).exp();
            change += weight * (Vec3::from(other.light) - light);
            let share = if job.only_variance == 1 {
                weight
            } else {
                weight * weight
            };
            variance += share * other.variance;
            weights += weight;
        }
    }
    if job.only_variance == 1 {
        return Estimate {
            light: own.light,
            variance: variance / weights,
        };
    }
    Estimate {
        light: (light + change / weights).to_array(),
        variance: variance / (weights * weights),
    }
}

/// One pass over the pixels of a job, row by row.
pub fn pass(job: &DenoiseJob, sites: &[Site], estimates: &[Estimate]) -> Vec<Estimate> {
    let [width, height] = job.size;
    let row = |y: u32| {
        (0..width).map(move |x| {
            smoothed_at(
                job,
                sites,
                estimates,
                [job.corner[0] + x, job.corner[1] + y],
            )
        })
    };
    (0..height).into_par_iter().flat_map_iter(row).collect()
}
