//! The knobs that must not change an expected picture, crossed.
//!
//! [`full`] is every sampler with every strategy, rule and way to scatter; [`covering`] is sixteen of
//! them in which every pair of values stands, by Bush's orthogonal array OA(16, 5, 4, 2) (Bush
//! 1952, "Orthogonal arrays of index unity"), and the array's rows once more for the last samplers. [`crossed`] is the full cross on the twin and the covering
//! one on a graphics device, whose driver compiles each choice for a tenth of a second. Either way
//! every value meets every device. Tests of interruption start at the camera's hit.

use crate::support::bench::Bench;
use crate::support::gate::{Case, Family};
use lampray::knobs::*;

pub const SAMPLERS: [&str; 7] = [
    "uniform-angles",
    "inverse-cosine",
    "gaussian",
    "cone",
    "facing-cap",
    "facing-angles",
    "projected-cap",
];
pub const STRATEGIES: [&str; 3] = ["sample", "mis", "hit"];
pub const CHOICES: [&str; 4] = ["all", "uniform", "power", "tree"];
pub const RULES: [&str; 4] = ["none", "survival", "albedo", "throughput"];
pub const DIFFUSE: [&str; 2] = ["cosine", "uniform"];
pub const ORDERS: [&str; 2] = ["after-direct", "before-direct"];
/// Of boxes that shine and of the background, going round beside the others.
pub const SOURCES: [&str; 2] = ["hit", "sample"];
pub const POLES: [&str; 3] = ["[0, 0, 1]", "receiver", "[1, -2, 0.5]"];

/// One value of each knob, as a place in its list above.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Row {
    sampler: usize,
    pole: usize,
    strategy: usize,
    rule: usize,
    diffuse: usize,
    order: usize,
}

impl Row {
    pub fn apply(self, case: Case) -> Case {
        case.set("light.sampler", SAMPLERS[self.sampler])
            .set("light.pole", POLES[self.pole])
            .set("light.strategy", STRATEGIES[self.strategy])
            .set("light.choice", self.pick(&CHOICES))
            .set("interruption.rule", RULES[self.rule])
            .set("interruption.order", ORDERS[self.order])
            .set("interruption.start", 0)
            .set("scatter.diffuse", DIFFUSE[self.diffuse])
            .set("light.boxes", SOURCES[(self.sampler + self.rule) % 2])
            .set("light.background", SOURCES[self.background()])
    }

    fn background(self) -> usize {
        (self.strategy + self.rule + self.order) % 2
    }

    pub fn samples_background(self) -> bool {
        self.background() == 1
    }

    /// Whether every path goes on, with the albedo as its weight.
    pub fn is_plain(self) -> bool {
        RULES[self.rule] == "none" && DIFFUSE[self.diffuse] == "cosine"
    }

    /// One of a few, going round by the sum of the places: no single knob decides it.
    pub fn pick<T: Copy>(self, list: &[T]) -> T {
        let places = [self.sampler, self.strategy, self.rule, self.diffuse];
        list[places.iter().sum::<usize>() % list.len()]
    }
}

/// All 168 of sampler, strategy, rule and way to scatter, and those of the first sampler, whose law
/// turns with the pole, with the pole at the receiver too. Poles and orders go round beside them.
fn full() -> Vec<Row> {
    let mut all = Vec::new();
    for index in 0..192 {
        let (variant, strategy, rule, diffuse) =
            (index / 24, index / 8 % 3, index / 2 % 4, index % 2);
        let poles = [
            2 * ((rule + diffuse) % 2),
            (strategy + rule) % 3,
            (strategy + diffuse) % 3,
            (rule + diffuse) % 3,
            (rule + diffuse) % 3,
            (strategy + rule) % 3,
            (strategy + diffuse) % 3,
            1,
        ];
        all.push(Row {
            sampler: variant % SAMPLERS.len(),
            pole: poles[variant],
            strategy,
            rule,
            diffuse,
            order: (variant + strategy + rule / 2) % 2,
        });
    }
    all
}

/// Twenty-eight rows with every pair of values: sixteen, and the twelve of the last samplers. Columns are a, b and a + k b over the field of four
/// elements, k = 1, w, w^2; the last one's two bits are two knobs. The second device has other triples.
pub fn covering(bench: Bench) -> Vec<Row> {
    const BY_W: [usize; 4] = [0, 2, 3, 1];
    let row = |index: usize| {
        let (a, b) = (index / 4 % 4, index % 4);
        let last = a ^ BY_W[BY_W[b]];
        Row {
            sampler: if index < 16 { a } else { a + 3 },
            pole: [0, 1, 2, 1][a ^ BY_W[b]],
            strategy: [0, 1, 2, 1][a ^ b ^ (bench as usize)],
            rule: b,
            diffuse: last % 2,
            order: last / 2,
        }
    };
    (0..16).chain(20..32).map(row).collect()
}

/// The full cross on the twin, the covering one on a graphics device.
pub fn crossed(bench: Bench) -> Vec<Row> {
    match bench {
        Bench::Twin => full(),
        Bench::Vulkan => covering(bench),
    }
}

/// Checks the case of each choice.
pub fn check_all(family: &mut Family, bench: Bench, choices: &[Row], case: impl Fn(Row) -> Case) {
    for &choice in choices {
        family.check(bench, &choice.apply(case(choice)));
    }
}

/// A choice's values in the order of [`SIZES`].
fn values(choice: &Row) -> [usize; 6] {
    let Row {
        sampler,
        pole,
        strategy,
        rule,
        diffuse,
        order,
    } = *choice;
    [sampler, strategy, rule, diffuse, order, pole]
}

const SIZES: [usize; 6] = [7, 3, 4, 2, 2, 3];

fn count<T: std::hash::Hash + Eq>(choices: &[Row], of: impl Fn([usize; 6]) -> T) -> usize {
    let all: std::collections::HashSet<_> = choices.iter().map(|one| of(values(one))).collect();
    all.len()
}

#[test]
fn the_covering_cross_holds_every_pair() {
    for bench in [Bench::Twin, Bench::Vulkan] {
        for i in 0..6 {
            for j in i + 1..6 {
                let pairs = count(&covering(bench), |v| (v[i], v[j]));
                assert_eq!(pairs, SIZES[i] * SIZES[j], "{bench:?}: {i} with {j}");
            }
        }
    }
    let both = [covering(Bench::Twin), covering(Bench::Vulkan)].concat();
    assert!(count(&both, |v| (v[0], v[1], v[2])) >= 28);
}

#[test]
fn boxes_and_backgrounds_are_sampled_and_left_in_turn() {
    for choices in [full(), covering(Bench::Twin), covering(Bench::Vulkan)] {
        for strategy in 0..STRATEGIES.len() {
            let of = |choice: &&Row| choice.strategy == strategy;
            let kinds = |choice: &Row| ((choice.sampler + choice.rule) % 2, choice.background());
            let all: std::collections::HashSet<_> = choices.iter().filter(of).map(kinds).collect();
            assert_eq!(all.len(), 4, "{strategy}");
        }
    }
}

#[test]
fn the_full_cross_holds_all_of_them() {
    let all = full();
    assert_eq!(count(&all, |v| [v[0], v[1], v[2], v[3]]), 168);
    let aimed: Vec<_> = all
        .iter()
        .filter(|c| (c.sampler, c.pole) == (0, 1))
        .copied()
        .collect();
    assert_eq!(count(&aimed, |v| [v[1], v[2], v[3]]), 24);
    for i in 0..6 {
        for j in i + 1..6 {
            assert_eq!(
                count(&all, |v| (v[i], v[j])),
                SIZES[i] * SIZES[j],
                "{i} {j}"
            );
        }
    }
}

/// A value that is added to a knob belongs here too; the rule that learns has a cross of its own.
#[test]
fn every_value_of_the_knobs_is_crossed() {
    fn check<T: std::fmt::Display>(all: &[T], listed: &[&str]) {
        let names: std::collections::HashSet<_> = all.iter().map(T::to_string).collect();
        assert_eq!(names, listed.iter().map(|name| name.to_string()).collect());
    }
    check(LightSampler::ALL, &SAMPLERS);
    check(LightStrategy::ALL, &STRATEGIES);
    check(LightChoice::ALL, &CHOICES);
    check(LightSource::ALL, &SOURCES);
    let rules = [&RULES[..], &[super::efficiency::RULE]].concat();
    check(InterruptionRule::ALL, &rules);
    check(InterruptionOrder::ALL, &ORDERS);
    check(ScatterDiffuse::ALL, &DIFFUSE);
}
