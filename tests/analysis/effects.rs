//! What an axis changes: ratios that are known, in intervals that hold them as often as they say.

use super::coverage::{RIGHT, USUAL};
use super::worlds::{Change, Estimator, Row, World};
use lampray::analysis::{Analysis, Effect};
use lampray::report::data::Interval;
use rayon::prelude::*;
use serde_json::{Map, Value, json};

const SWEEPS: u64 = 1000;
const SAME: Change = |_| {};

fn row(values: Value, deviation: f64, seconds: f64, stream: u64) -> Row {
    let values = match values {
        Value::Object(values) => values,
        _ => Map::new(),
    };
    let estimator = Estimator {
        bias: 0.0,
        deviation,
        seconds,
        ..USUAL.estimators[0]
    };
    Row {
        values,
        estimator,
        samples: 16,
        stream,
    }
}

/// b has 0.36 times the variance of a and takes 1.5 times its time.
fn pair() -> Vec<Row> {
    vec![
        row(json!({"kind": "a"}), 1.0, 2.0, 1),
        row(json!({"kind": "b"}), 0.6, 3.0, 2),
    ]
}

/// The same in three rooms; their ratios 0.36, 0.49 and 0.64. Those of a kind may share their noise.
fn rooms(shared: bool) -> Vec<Row> {
    let room = |(number, deviation): (u64, f64)| {
        let stream = |kind: u64| match shared {
            true => kind,
            false => 2 * number + kind,
        };
        [
            row(json!({"room": number, "kind": "a"}), 1.0, 2.0, stream(0)),
            row(
                json!({"room": number, "kind": "b"}),
                deviation,
                3.0,
                stream(1),
            ),
        ]
    };
    [(1, 0.6), (2, 0.7), (3, 0.8)]
        .into_iter()
        .flat_map(room)
        .collect()
}

fn of_kind(analysis: &Analysis) -> Effect {
    let mut effects = analysis.effects().into_iter();
    effects
        .find(|effect| effect.path == "kind")
        .expect("it is an axis")
}

/// How often an interval of the axis `kind` holds its truth.
fn share(rows: &[Row], change: Change, truth: f64, of: fn(&Effect) -> Interval) -> f64 {
    let seeds = (1..=SWEEPS).into_par_iter();
    let holds = seeds.filter(|seed| {
        let interval = of(&of_kind(&USUAL.table(*seed, rows, change)));
        interval.low <= truth && truth <= interval.high
    });
    let share = holds.count() as f64 / SWEEPS as f64;
    println!("{:.1} %", 100.0 * share);
    share
}

fn of_time(effect: &Effect) -> Interval {
    effect.seconds.expect("several runs")
}

#[test]
fn a_pair_has_the_ratio_of_its_variances_and_times() {
    let share_of_noise = share(&pair(), SAME, 0.36, |effect| effect.variance);
    assert!(RIGHT.contains(&share_of_noise), "{share_of_noise}");
    let share_of_time = share(&pair(), SAME, 1.5, of_time);
    assert!(RIGHT.contains(&share_of_time), "{share_of_time}");
}

/// Third root of 0.36 x 0.49 x 0.64.
const POOLED: f64 = 0.483310449;

/// Pairs of shared seeds rise and fall together, and pairs that do not have an interval that is too wide.
#[test]
fn pairs_are_pooled_by_their_geometric_mean() {
    let together = share(&rooms(true), SAME, POOLED, |effect| effect.variance);
    assert!(RIGHT.contains(&together), "{together}");
    let apart = share(&rooms(false), SAME, POOLED, |effect| effect.variance);
    assert!(apart >= *RIGHT.start(), "{apart}");
    let one = of_kind(&USUAL.table(1, &rooms(false), SAME));
    let product: f64 = one.each.iter().product();
    assert!((product.powf(1.0 / 3.0) / one.variance.value - 1.0).abs() < 1e-9);
}

/// Standard deviations for variances; and pairs of shared noise that are taken as independent.
#[test]
fn mutants() {
    let root: Change = |run| {
        for variance in run.variance.as_flattened_mut() {
            *variance = variance.sqrt();
        }
    };
    let deviations = share(&pair(), root, 0.36, |effect| effect.variance);
    let independent = share(&rooms(true), SAME, POOLED, |effect| {
        let Interval { value, low, high } = effect.variance;
        let nearer = |end: f64| value * (end / value).powf(1.0 / 3.0_f64.sqrt());
        Interval {
            value,
            low: nearer(low),
            high: nearer(high),
        }
    });
    for share in [deviations, independent] {
        assert!(share < *RIGHT.start(), "{share}");
    }
}

const LARGE: World = World { size: 32, ..USUAL };

fn said(rows: &[Row]) -> Vec<String> {
    let findings = LARGE.table(3, rows, SAME).findings().into_iter();
    let of_axes = findings.filter(|one| one.contains("variance") || one.contains("noise is seen"));
    of_axes.collect()
}

#[test]
fn the_largest_change_is_said_first_and_none_last() {
    let at = |kind: &str, size: f64, deviation: f64, stream| {
        row(json!({"kind": kind, "size": size}), deviation, 2.0, stream)
    };
    let rows = [
        at("a", 1.0, 1.0, 0),
        at("a", 2.0, 2.0, 1),
        at("b", 1.0, 1.0, 2),
        at("b", 2.0, 2.0, 3),
    ];
    let all = said(&rows);
    assert_eq!(all.len(), 2, "{all:?}");
    assert!(all[0].starts_with("size: 2 has 4."), "{all:?}");
    assert!(
        all[0].contains(" times the variance of 1, the geometric mean of 2 settings"),
        "{all:?}"
    );
    assert!(
        all[1].starts_with("kind: no difference in noise is seen between b and a"),
        "{all:?}"
    );
    let all = said(&pair());
    assert!(all[0].starts_with("kind: b has 0.3"), "{all:?}");
    assert!(
        all[0].contains("; a sample costs 1.") && all[0].contains("times the time"),
        "{all:?}"
    );
}

/// More samples say no more of one, and runs of fewer are part of them: the most count, for axes in step, too.
#[test]
fn samples_are_no_axis_of_noise() {
    let at = |kind: &str, samples: u32, deviation: f64, stream| Row {
        samples,
        ..row(
            json!({"kind": kind, "render.samples": samples}),
            deviation,
            1.0,
            stream,
        )
    };
    let rows = [
        at("a", 16, 1.0, 0),
        at("a", 32, 1.0, 1),
        at("b", 16, 0.6, 2),
        at("b", 32, 0.6, 3),
    ];
    let effects = LARGE.table(4, &rows, SAME).effects();
    assert_eq!(effects.len(), 1);
    assert_eq!(effects[0].each.len(), 1);
    let most = LARGE
        .table(4, &[rows[1].clone(), rows[3].clone()], SAME)
        .effects();
    assert_eq!(effects[0].variance, most[0].variance);
    let step = LARGE
        .table(4, &[rows[0].clone(), rows[3].clone()], SAME)
        .effects();
    let seconds = step[0].seconds.expect("several runs").value;
    assert!(
        (seconds - 0.5).abs() < 0.05,
        "a sample of twice as many: {seconds}"
    );
}

#[test]
fn of_many_values_the_four_that_change_most_are_named() {
    let rows: Vec<Row> = (0..8)
        .map(|number| {
            row(
                json!({"size": number}),
                1.0 + 0.3 * f64::from(number),
                1.0,
                number as u64,
            )
        })
        .collect();
    let all = said(&rows);
    assert_eq!(all.len(), 5, "{all:?}");
    assert!(all[0].starts_with("size: 7 has 9."), "{all:?}");
    assert!(
        all[4].starts_with("3 more pairs of values differ less"),
        "{all:?}"
    );
}
