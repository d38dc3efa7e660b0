//! Lamps over a floor: albedo times the sum of L F, whichever of them are asked for their light.

use super::dome::{Lamp, lattice, scene};
use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};
use glam::DVec3;

const ALBEDO: f64 = 0.7;
const CHOICES: [&str; 3] = ["uniform", "power", "tree"];
const SAMPLERS: [&str; 4] = ["cone", "uniform-angles", "inverse-cosine", "gaussian"];

/// Lamps of several sizes, distances and colours over the horizon; with three or more of them, as many
/// again below the floor as a third of them, which are drawn in vain.
fn lamps(count: usize) -> Vec<Lamp> {
    let (directions, apart) = lattice(count, 0.3);
    let above = directions
        .into_iter()
        .enumerate()
        .map(|(index, direction)| {
            let turn = |step: f64| (step * (index + 1) as f64).fract();
            let highest = 0.95 * (0.5 * std::f64::consts::PI - direction.y.acos());
            Lamp {
                direction,
                distance: 0.6 + 1.4 * turn(0.618_034),
                half: (apart * (0.4 + 0.55 * turn(0.754_878))).min(highest),
                emission: [1.0, 0.3 + turn(0.569_84), 1.5]
                    .map(|x| x * (0.3 + 3.0 * turn(0.414_21))),
            }
        });
    let below = (0..count / 3).map(|index| Lamp {
        direction: DVec3::new(0.1 * index as f64 + 0.05, -1.0, 0.3).normalize(),
        distance: 1.5,
        half: 0.5 * apart,
        emission: [4.0; 3],
    });
    above.chain(below).collect()
}

fn case(count: usize) -> Case {
    let lamps = lamps(count);
    let light = lamps.iter().map(Lamp::light);
    let sum = light.fold([0.0; 3], |sum, light| [0, 1, 2].map(|c| sum[c] + light[c]));
    let truth = Form::Mean(sum.map(|x| ALBEDO * x));
    Case::new(format!("{count} lamps"), scene(&lamps, ALBEDO, 32), truth).within(0.016)
}

/// Lamps, and the kernels that trace them. `bits` holds that kernels make one picture.
const CROWDS: [(usize, &str); 5] = [
    (1, "general"),
    (2, "baked"),
    (3, "general"),
    (30, "baked"),
    (300, "bvh"),
];

#[test]
fn lamps_add_up_by_every_choice() {
    let mut family = Family::new("chosen lamps", 61_000);
    for bench in benches() {
        for (size, (count, kernel)) in CROWDS.into_iter().enumerate() {
            for (place, choice) in CHOICES.into_iter().enumerate() {
                // The paper's samplers are too noisy for any but a good choice among many.
                let sampler = match (count, choice) {
                    (30.., "uniform" | "power") => "cone",
                    _ => SAMPLERS[(size + place) % 4],
                };
                for strategy in ["sample", "mis"] {
                    let case = case(count)
                        .set("light.choice", choice)
                        .set("light.strategy", strategy)
                        .set("light.sampler", sampler)
                        .set("render.kernel", kernel);
                    family.check(bench, &case);
                }
            }
        }
    }
    family.finish();
}

/// What the paper's Lambert light takes of mirrors is literal; which lamp it asks is not.
#[test]
fn lamps_add_up_as_published() {
    let mut family = Family::new("chosen lamps, literal", 61_500);
    for bench in benches() {
        for choice in CHOICES {
            let case = case(12)
                .set("light.choice", choice)
                .set("light.direct", "lambert")
                .set("light.sampler", "uniform-angles");
            family.check(bench, &case);
        }
    }
    family.finish();
}

/// One lamp of 12 that is out, or a fiftieth more of all of them, is told apart.
#[test]
fn the_gate_rejects_other_lamps() {
    let mut family = Family::new("chosen lamps, mutants", 61_700);
    for bench in benches() {
        let case = |choice| case(12).set("light.choice", choice);
        family.reject(
            bench,
            &case("tree").set("materials.lamp7.emission", "[0, 0, 0]"),
        );
        family.reject(
            bench,
            &case("power").set("materials.floor.albedo", "[0.714, 0.714, 0.714]"),
        );
    }
}
