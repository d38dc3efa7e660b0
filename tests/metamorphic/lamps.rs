//! The light of two lamps is the sum of each one's: a lamp put out stays where it is, as a body, and
//! keeps its albedo. Holds for the mean of every estimator that is linear in what shines, whether it
//! draws both lamps, finds them by chance, or weighs the two against each other.

use super::room::{LAMPS, Room, TRUTH, Triple};
use crate::support::bench::{Bench, benches};
use crate::support::gate::{Family, Form, measure_mean};

const STRATEGIES: [&[&str]; 6] = [
    &["light.strategy=mis"],
    &["light.strategy=sample"],
    &["light.strategy=hit"],
    &[
        "light.strategy=mis",
        "light.sampler=uniform-angles",
        "render.preset=corrected",
    ],
    &["light.strategy=mis", "light.choice=tree"],
    &["light.strategy=sample", "light.choice=power"],
];

fn both() -> Room {
    Room::new().with_lamps_alone()
}

fn alone(lamp: &str) -> Room {
    let mut room = both();
    for name in LAMPS.iter().filter(|name| **name != lamp) {
        room.material(name).emission = [0.0; 3];
    }
    room
}

/// Each lamp's picture by itself, added up.
fn sum(bench: Bench, sets: &[&str], seed: u64) -> Form {
    let mut sum: (Triple, Triple) = ([0.0; 3], [0.0; 3]);
    for (number, lamp) in LAMPS.into_iter().enumerate() {
        let case = alone(lamp).case(lamp, sets, Form::Mean([0.0; 3]));
        let measured = measure_mean(bench, &case, seed + number as u64, TRUTH);
        let Form::Measured(mean, error) = measured else {
            unreachable!("what is measured has an error");
        };
        sum.0 = [0, 1, 2].map(|c| sum.0[c] + mean[c]);
        sum.1 = [0, 1, 2].map(|c| sum.1[c].hypot(error[c]));
    }
    Form::Measured(sum.0, sum.1)
}

#[test]
fn two_lamps_are_the_sum_of_each() {
    let mut family = Family::new("two lamps", 42_000);
    let mut mutants = Family::new("two lamps, mutants", 42_100);
    for (number, bench) in benches().into_iter().enumerate() {
        for (place, sets) in STRATEGIES.into_iter().enumerate() {
            let seed = 42_200 + 10 * number as u64 + 2 * place as u64;
            let form = sum(bench, sets, seed);
            family.check(bench, &both().case("both", sets, form));
            if sets.len() > 1 || sets == STRATEGIES[2] {
                continue;
            }
            // Not linear, by a little; and one lamp that is a little brighter beside the other.
            let clamped = both().case("clamped", sets, form);
            mutants.reject(bench, &clamped.set("render.clamp", 1));
            let mut brighter = both();
            let large = brighter.material(LAMPS[1]);
            large.emission = large.emission.map(|x| 1.02 * x);
            mutants.reject(bench, &brighter.case("brighter", sets, form));
        }
    }
    family.finish();
}
