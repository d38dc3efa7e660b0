//! A far lamp behind a straight edge: the share of it that a literal estimator sees.
//!
//! `theory::share` says what each law of points makes of it.
//!
//! The cone draws near points alone, so that the literal weight of its samples is too large by 4 q / 3 of
//! itself: it has no column among the literal ones.

use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};
use lampray::theory::{Drawn, share};
use std::f64::consts::PI;

/// Radius over distance. What a far lamp's forms leave out is of the order of q^2: 3e-5, a thirtieth
/// of the standard errors here.
const Q: f64 = 0.005;
const HEIGHT: f64 = 2.0;

const LAWS: [Drawn; 4] = [Drawn::Truth, Drawn::Area, Drawn::Along, Drawn::Across];
const LITERAL: [Drawn; 3] = [Drawn::Area, Drawn::Along, Drawn::Across];

/// The knobs that draw so.
fn ways(drawn: Drawn) -> Vec<(&'static str, &'static str)> {
    match drawn {
        Drawn::Truth => vec![("cone", "[0, 0, 1]")],
        Drawn::Area => vec![("inverse-cosine", "[1, 0, 0]"), ("gaussian", "receiver")],
        Drawn::Along => vec![("uniform-angles", "[1, 0, 0]")],
        Drawn::Across => vec![
            ("uniform-angles", "[0, 0, 1]"),
            ("uniform-angles", "[0, 1, 0]"),
            ("uniform-angles", "receiver"),
        ],
    }
}

#[test]
fn the_known_figures_come_out() {
    let table = [
        (0.25, [0.657, 0.625, 0.580, 0.692]),
        (0.50, [0.804, 0.750, 0.667, 0.815]),
        (0.75, [0.928, 0.875, 0.770, 0.915]),
    ];
    for (h, figures) in table {
        for (law, figure) in LAWS.into_iter().zip(figures) {
            let found = share(law, h);
            println!("h {h}, {law:?}: {found:.5} for {figure}");
            assert!((found - figure).abs() <= 0.0006, "{law:?} at {h}: {found}");
        }
    }
    for law in LAWS {
        assert!((share(law, 1.0) - 1.0).abs() < 1e-6, "{law:?}");
        assert!((share(law, -0.3) + share(law, 0.3) - 1.0).abs() < 1e-12);
    }
    // Where the literal estimators are most wrong.
    let off = |law: Drawn, h: f64| (share(law, h) - share(Drawn::Truth, h)).abs();
    assert!((off(Drawn::Area, (1.0 - PI * PI / 16.0).sqrt()) - 0.058).abs() < 5e-4);
    assert!((off(Drawn::Along, 0.5f64.sqrt()) - 0.5 / PI).abs() < 1e-9);
}

const ALBEDO: [f64; 3] = [0.8, 0.5, 0.25];
const EMISSION: [f64; 3] = [3.0, 1.0, 7.0];
const EDGES: [f64; 4] = [0.25, 0.5, 0.75, -0.5];

/// A face under a lamp, half way a thin box with its edge at `h`: free is what is on the other side.
/// Of the box's two edges the one that sticks out most counts.
fn case(h: f64, share: f64) -> Case {
    let (low, high) = (0.5 * HEIGHT, 0.5 * HEIGHT + 0.001);
    let edge = h * Q * if h > 0.0 { high } else { low };
    let scene = format!(
        "version = 1
        camera = {{ position = [-0.2, 0.15, 0.1], look_at = [0, 0, 0], fov = 0.002 }}
        image = {{ width = 32, height = 32 }}
        render = {{ max_bounces = 1 }}
        light = {{ strategy = \"sample\" }}
        spheres = [{{ center = [0.0, {HEIGHT}, 0.0], radius = {}, material = \"lamp\" }}]
        [[boxes]]
        min = [-0.4, -0.2, -0.4]
        max = [0.4, 0.0, 0.4]
        material = \"white\"
        [[boxes]]
        min = [{edge}, {low}, -0.5]
        max = [0.5, {high}, 0.5]
        material = \"black\"
        [materials.white]
        albedo = {ALBEDO:?}
        [materials.black]
        albedo = [0.0, 0.0, 0.0]
        [materials.lamp]
        albedo = [0.0, 0.0, 0.0]
        emission = {EMISSION:?}",
        Q * HEIGHT
    );
    let truth = [0, 1, 2].map(|channel| ALBEDO[channel] * EMISSION[channel] * Q * Q * share);
    Case::new(format!("edge at {h}"), scene, Form::Mean(truth))
}

fn with(case: Case, (sampler, pole): (&str, &str)) -> Case {
    case.set("light.sampler", sampler).set("light.pole", pole)
}

#[test]
fn the_literal_estimator_sees_the_share_of_its_points() {
    let mut family = Family::new("penumbra, literal", 35_000);
    for bench in benches() {
        for law in LITERAL {
            for way in ways(law) {
                for h in EDGES {
                    let case = with(case(h, share(law, h)), way).within(0.004);
                    family.check(bench, &case.set("light.weight", "solid-angle"));
                }
            }
        }
    }
    family.finish();
}

#[test]
fn the_unbiased_estimator_sees_the_truth() {
    let mut family = Family::new("penumbra, unbiased", 36_000);
    for bench in benches() {
        for law in LAWS {
            for way in ways(law) {
                for h in EDGES {
                    let case = with(case(h, share(Drawn::Truth, h)), way);
                    family.check(bench, &case.set("light.weight", "pdf"));
                }
            }
        }
    }
    family.finish();
}

#[test]
fn the_gate_tells_the_shares_apart() {
    let mut family = Family::new("penumbra, mutants", 37_000);
    for bench in benches() {
        let literal = |seen: Drawn, drawn: Drawn, h: f64| {
            let case = with(case(h, share(seen, h)), ways(drawn)[0]);
            case.set("light.weight", "solid-angle")
        };
        for h in [0.25, 0.5] {
            for (drawn, seen) in LITERAL.into_iter().flat_map(|a| LAWS.map(|b| (a, b))) {
                if seen != drawn {
                    family.reject(bench, &literal(seen, drawn, h));
                }
            }
            // True densities have none of the paper's shares, and an edge a hundredth off has another.
            let unbiased = literal(Drawn::Area, Drawn::Area, h).set("light.weight", "pdf");
            family.reject(bench, &unbiased);
            let edge = format!("[{}, 1.0, -0.5]", (h + 0.01) * Q * 1.001);
            family.reject(
                bench,
                &literal(Drawn::Area, Drawn::Area, h).set("boxes.1.min", edge),
            );
        }
    }
}
