//! Rough mirrors: the law of the drawn directions from what is done to an even point of a cap.

use super::sampling::*;
use crate::support;
use crate::support::bench::benches;
use glam::DVec3;
use lampray::knobs::{Choice, Scatter};
use lampray::pack::{Material, PointsJob, Strategy};
use std::f64::consts::{PI, TAU};

/// Density by solid angle: even over the cap of unit vectors above -b, as reflections of the arriving
/// direction with its x and y times alpha; the facets that make those, with x and y times alpha, reflect
/// the arriving direction itself. Each step has its Jacobian: 4 times the cosine for a reflection, and
/// alpha^2 over the cube of the new length for a facet's normal.
fn drawn(alpha: f64, i: DVec3, o: DVec3) -> f64 {
    let squash = |v: DVec3| DVec3::new(alpha * v.x, alpha * v.y, v.z);
    let sum = i + o;
    let shortened = squash(i).normalize();
    let facet = DVec3::new(sum.x / alpha, sum.y / alpha, sum.z).normalize();
    let reach = (1.0 + i.truncate().length()).powi(2);
    let squared = alpha * alpha;
    let bound = (1.0 - squared) * reach / (reach + squared * i.z * i.z) * shortened.z;
    let height = (2.0 * shortened.dot(facet) * facet - shortened).z;
    if height < -bound {
        return 0.0;
    }
    let even = 1.0 / (TAU * (1.0 + bound));
    let (before, after) = (shortened.dot(facet), i.dot(sum.normalize()));
    even * before * squash(facet).length().powi(3) / (squared * after)
}

pub fn rough(alpha: f64, degrees: f64) -> Sampling {
    let normal = DVec3::new(0.1, 0.7, -0.5).normalize();
    let (x, y) = normal.any_orthonormal_pair();
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let incoming = -(sine * (0.6 * x + 0.8 * y) + cosine * normal);
    let local = move |v: DVec3| DVec3::new(v.dot(x), v.dot(y), v.dot(normal));
    let density = move |v: DVec3| drawn(alpha, local(-incoming), local(v));
    let mutant = move |v: DVec3| drawn((1.05 * alpha).min(0.98), local(-incoming), local(v));
    Sampling {
        name: format!("rough {alpha} {degrees}"),
        strategy: Strategy {
            rough_surfaces: true,
            ..support::strategy()
        },
        job: PointsJob {
            material: Material {
                albedo: [0.8; 3],
                scatter: Scatter::Rough.index(),
                survival: 1.0,
                shape: alpha as f32,
                ..Material::default()
            },
            normal: narrow(normal),
            incoming: narrow(incoming),
            scattering: 1,
            ..job()
        },
        axis: incoming - 2.0 * normal.dot(incoming) * normal,
        limit: PI,
        midpoints: 48,
        density: Box::new(density),
        stated: Box::new(density),
        ring: 0.0,
        mutant: Box::new(mutant),
    }
}

/// No direction is drawn beyond the cap's rim, and the share that it leaves below the surface is the
/// density's.
#[test]
fn the_share_below_is_the_densitys() {
    const COUNT: usize = 200_000;
    const STEPS: usize = 800;
    for bench in benches() {
        for (alpha, degrees) in [(0.1, 80.0), (0.4, 30.0), (0.4, 80.0), (1.0, 60.0)] {
            let of = rough(alpha, degrees);
            let normal = DVec3::from_array(of.job.normal.map(f64::from));
            let (x, y) = normal.any_orthonormal_pair();
            let (high, wide_step) = (0.5 * PI / STEPS as f64, TAU / STEPS as f64);
            let mut below = 0.0;
            for place in 0..STEPS * STEPS {
                let (sine, cosine) = ((0.5 + (place / STEPS) as f64) * high).sin_cos();
                let (up, along) = ((0.5 + (place % STEPS) as f64) * wide_step).sin_cos();
                let v = sine * (along * x + up * y) - cosine * normal;
                below += (of.density)(v) * sine * high * wide_step;
            }
            let lost = |draw: &lampray::pack::Draw| draw.useful == 0;
            let draws = of.draws(bench, 7, COUNT);
            let share = draws.iter().filter(|draw| lost(draw)).count() as f64 / COUNT as f64;
            let error = (below * (1.0 - below) / COUNT as f64).sqrt();
            println!(
                "{bench:?} {}: {share:.4} below, by quadrature {below:.4}",
                of.name
            );
            assert!(
                (share - below).abs() < 4.0 * error + 2e-4,
                "{bench:?} {}: {share} {below}",
                of.name
            );
        }
    }
}
