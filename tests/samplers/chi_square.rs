//! Chi-square: a million draws of every sampler on each device, by the density it is defined to have.

use super::cells::*;
use super::sampling::*;
use super::{DRAWS, LEVEL};
use crate::support::bench::{Bench, benches};
use crate::support::chance::sidak;
use glam::DVec3;
use lampray::pack::Draw;

/// The draws are unit vectors, count where they should, and state the density they have.
fn check_draws(device: Bench, of: &Sampling, draws: &[Draw]) {
    let mut off = 0;
    for draw in draws {
        let v = wide(draw);
        assert!(
            (v.length() - 1.0).abs() < 1e-5,
            "{device:?} {}: {draw:?}",
            of.name
        );
        if of.job.scattering == 1 {
            let up = v.dot(DVec3::from_array(of.job.normal.map(f64::from)));
            assert!(
                up.abs() < 1e-5 || (up > 0.0) == (draw.useful == 1),
                "{device:?}: {draw:?}"
            );
        } else {
            assert_eq!(
                draw.useful == 1,
                draw.density > 0.0,
                "{device:?} {}: {draw:?}",
                of.name
            );
        }
        if of.ring > 0.0 && draw.density == 0.0 {
            continue;
        }
        let wanted = (of.stated)(v);
        let close = (f64::from(draw.density) / wanted - 1.0).abs() < 0.01;
        off += usize::from(!close && draw.density.max(wanted as f32) > 1e-6);
    }
    // Only where the density is steep within f32's rounding of a direction: at the lobe's middle,
    // at the pole, at the rim. A wrong factor shows in every draw.
    assert!(
        off * 200 <= draws.len(),
        "{device:?} {}: {off} densities are off",
        of.name
    );
}

fn gate(bench: Bench) {
    let all = samplings();
    let level = sidak(LEVEL, all.len());
    let mut seen = (1.0, 0.0);
    for (number, of) in all.iter().enumerate() {
        let drawn = of.draws(bench, 100 + number as u32, DRAWS);
        check_draws(bench, of, &drawn);
        let right = test(of, &of.density, &drawn);
        seen = (right.p.min(seen.0), right.p.max(seen.1));
        assert!(
            right.p >= level,
            "{bench:?} {}: {right:?} at level {level:.1e}",
            of.name
        );
        let wrong = test(of, &of.mutant, &drawn);
        assert!(
            wrong.p < level,
            "{bench:?} {}: the wrong density passes: {wrong:?}",
            of.name
        );
    }
    let (low, high) = seen;
    println!(
        "{bench:?}: {} samplers, {DRAWS} draws each: p from {low:.4} to {high:.4}, level {level:.1e}",
        all.len()
    );
}

#[test]
fn samplers_draw_by_their_densities() {
    for bench in benches() {
        gate(bench);
    }
}

#[test]
fn references_integrate_to_one() {
    for of in samplings() {
        let shares = shares(&of, &of.density);
        let sum: f64 = shares[..POLAR * AROUND].iter().sum();
        let cut = shares[POLAR * AROUND];
        let (lobe, tail) = (
            of.job.scattering == 1,
            libm::erfc(5.0 / std::f64::consts::SQRT_2),
        );
        assert!((sum + of.ring - 1.0).abs() < 1e-3, "{}: {sum}", of.name);
        assert!(
            cut <= if lobe { 1e-3 + tail } else { 1e-3 },
            "{}: {cut}",
            of.name
        );
    }
}
