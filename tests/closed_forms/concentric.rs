//! Two concentric diffuse spheres, seen from between them.
//!
//! By symmetry each wall is evenly bright. Of what an outer point sees, weighted by the cosine, the
//! inner sphere fills k = (r / R)^2, so that one more reflection makes of (inner, outer)
//! (rho_i outer, rho_o (k inner + (1 - k) outer)). A limit on reflections leaves a partial sum.

use super::cross::{SAMPLERS, STRATEGIES, check_all, crossed};
use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};

const INNER: f64 = 1.0;
const OUTER: f64 = 2.0;
const EMISSION: [f64; 3] = [1.0, 2.5, 4.0];
const ALBEDO: [f64; 3] = [0.6, 0.5, 0.4];

/// The spheres, and which of them is looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spheres {
    inner_albedo: f64,
    outer_emission: f64,
    max_bounces: u32,
    look_in: bool,
}

pub(super) const PLAIN: Spheres = Spheres {
    inner_albedo: 0.4,
    outer_emission: 0.0,
    max_bounces: 3,
    look_in: false,
};

impl Spheres {
    fn truth(self, channel: usize) -> f64 {
        let k = (INNER / OUTER).powi(2);
        let mut term = (EMISSION[channel], self.outer_emission);
        let mut sum = term;
        for _ in 0..self.max_bounces {
            let (inner, outer) = term;
            let lit = k * inner + (1.0 - k) * outer;
            term = (self.inner_albedo * outer, ALBEDO[channel] * lit);
            sum = (sum.0 + term.0, sum.1 + term.1);
        }
        if self.look_in { sum.0 } else { sum.1 }
    }

    pub(super) fn case(self) -> Case {
        let (target, fov) = if self.look_in {
            ("3.0, -1.0, 0.5", 20)
        } else {
            ("6.0, -0.5, 2.0", 70)
        };
        let scene = format!(
            "version = 1
            camera = {{ position = [4.5, -0.9, 0.7], look_at = [{target}], fov = {fov} }}
            image = {{ width = 32, height = 32 }}
            render = {{ max_bounces = {} }}
            spheres = [
                {{ center = [3.0, -1.0, 0.5], radius = {INNER}, material = \"inner\" }},
                {{ center = [3.0, -1.0, 0.5], radius = {OUTER}, material = \"outer\" }},
            ]
            [materials.inner]
            albedo = [{a}, {a}, {a}]
            emission = {EMISSION:?}
            survival = 0.8
            [materials.outer]
            albedo = {ALBEDO:?}
            emission = [{e}, {e}, {e}]
            survival = 0.75",
            self.max_bounces,
            a = self.inner_albedo,
            e = self.outer_emission
        );
        let form = Form::Mean([0, 1, 2].map(|channel| self.truth(channel)));
        Case::new(format!("{self:?}"), scene, form)
    }
}

#[test]
fn every_knob_gives_the_series() {
    let mut family = Family::new("concentric spheres, crossed", 1000);
    for bench in benches() {
        check_all(&mut family, bench, &crossed(bench), |choice| {
            let spheres = Spheres {
                inner_albedo: choice.pick(&[0.4, 0.0]),
                max_bounces: choice.pick(&[2, 3, 1, 5]),
                ..PLAIN
            };
            spheres.case()
        });
    }
    family.finish();
}

/// Partial sums, the inner wall, and an outer sphere that lights itself from inside while the
/// inner one stands in the way.
#[test]
fn every_limit_gives_its_partial_sum() {
    let mut family = Family::new("concentric spheres, limits", 2000);
    for bench in benches() {
        for (n, max_bounces) in [0, 1, 2, 4, 40].into_iter().enumerate() {
            for look_in in [false, true] {
                let spheres = Spheres {
                    outer_emission: 0.5,
                    max_bounces,
                    look_in,
                    ..PLAIN
                };
                let strategy = STRATEGIES[(n + usize::from(look_in)) % 3];
                let case = spheres.case().set("light.strategy", strategy);
                family.check(bench, &case.set("light.sampler", SAMPLERS[n % 4]));
            }
        }
        // Lambert's direct light is the scattering of diffuse surfaces; with the true density it is
        // unbiased here.
        let lambert = PLAIN.case().set("light.strategy", "sample");
        family.check(bench, &lambert.set("light.direct", "lambert"));
    }
    family.finish();
}

#[test]
fn the_gate_rejects_small_faults() {
    let mut family = Family::new("concentric spheres, mutants", 3000);
    for bench in benches() {
        let case = PLAIN.case();
        let with = |path: &str, value: &str| case.clone().set(path, value);
        let literal = with("interruption.weight", "literal");
        let mutants = [
            with("materials.outer.albedo", "[0.606, 0.505, 0.404]"),
            with("materials.inner.albedo", "[0.44, 0.44, 0.44]"),
            with("materials.inner.emission", "[1.01, 2.525, 4.04]"),
            with("spheres.0.radius", "1.005"),
            with("render.max_bounces", "2"),
            with("render.max_bounces", "4"),
            with("light.strategy", "sample").set("light.weight", "solid-angle"),
            literal
                .clone()
                .set("interruption.rule", "survival")
                .set("interruption.start", 0),
            literal
                .set("interruption.rule", "throughput")
                .set("interruption.start", 0),
        ];
        for mutant in mutants {
            family.reject(bench, &mutant);
        }
    }
}
