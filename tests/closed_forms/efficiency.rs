//! The rule that learns what pays, beside the closed forms: whatever a pilot found, and however far paths may
//! split, the expected picture is the same.

use super::enclosure::{SHAPES, case, whole};
use crate::support::bench::{Bench, benches};
use crate::support::gate::{Case, Family, Form};

pub const RULE: &str = "efficiency";

/// By one path or by many, tested before or after direct light, from the first hit on or later.
const WAYS: [(u32, &str, u32); 5] = [
    (1, "after-direct", 0),
    (16, "after-direct", 0),
    (5, "before-direct", 0),
    (16, "before-direct", 1),
    (8, "after-direct", 2),
];

fn by(case: Case, way: usize) -> Case {
    let (split, order, start) = WAYS[way % WAYS.len()];
    case.set("interruption.rule", RULE)
        .set("interruption.split", split)
        .set("interruption.order", order)
        .set("interruption.start", start)
}

/// Every strategy and way to scatter, with each way to thin out and split.
fn cases(bench: Bench) -> impl Iterator<Item = Case> {
    let strategies = ["mis", "sample", "hit"];
    (0..15).map(move |n| {
        let max_bounces = [2, 4, 3][n % 3];
        let form = Form::Mean(whole(max_bounces));
        let shape = SHAPES[(n / 3 + bench as usize) % 3];
        let diffuse = ["cosine", "uniform"][(n / 5) % 2];
        by(case(shape, max_bounces, form), n)
            .set("light.strategy", strategies[(n + n / 3) % 3])
            .set("scatter.diffuse", diffuse)
    })
}

#[test]
fn a_path_that_splits_gives_the_partial_sum() {
    let mut family = Family::new("enclosures, efficiency", 7700);
    for bench in benches() {
        cases(bench).for_each(|case| family.check(bench, &case));
    }
    family.finish();
}

#[test]
fn the_gate_rejects_other_sums_of_paths_that_split() {
    let mut family = Family::new("enclosures, efficiency, mutants", 7800);
    for bench in benches() {
        let split = by(case(SHAPES[0], 4, Form::Mean(whole(4))), 1);
        family.reject(bench, &split.clone().set("render.max_bounces", 3));
        family.reject(
            bench,
            &split.set("materials.wall.albedo", "[0.75, 0.505, 0.3]"),
        );
    }
}
