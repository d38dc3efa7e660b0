//! Pairs with the same expected image: how often the verdict calls them different.

use super::pictures::{Setting, compare, compare_paired, first_seed};
use crate::support::chance::{binomial_at_least, fit};
use lampray::compare::verdict::{Outcome, Terms, Verdict, quantile};
use lampray::film::Picture;

const ROOM: Setting = Setting {
    scene: "cornell",
    sets: &[],
};

/// As the verdict is by default.
const ALPHA: f64 = 0.01;

/// So many pairs, called different so often: too often for the stated rate at a level of 0.001?
fn too_often(alarms: u64, pairs: u64) -> bool {
    binomial_at_least(alarms, pairs, ALPHA) < 0.001
}

fn signed_z(verdict: &Verdict, channel: usize) -> f64 {
    let mean = verdict.pooled[channel];
    mean.z.copysign(mean.difference)
}

/// 200 pairs of fresh seeds: at most six alarms, and z of the mean is standard normal.
#[test]
fn the_stated_rate_is_kept() {
    const PAIRS: u64 = 200;
    let seed = first_seed(40_000);
    let mut alarms = 0;
    let mut z = Vec::new();
    for pair in 0..PAIRS {
        let reference = ROOM.render(48, 16, seed + 2 * pair);
        let test = ROOM.render(48, 16, seed + 2 * pair + 1);
        let verdict = compare(&reference, &test, Terms::default());
        alarms += u64::from(verdict.outcome == Outcome::Different);
        z.push(signed_z(&verdict, 1));
    }
    // Twenty cells that a standard normal number is in with the same chance.
    let cell = |z: f64| {
        (1..20)
            .filter(|k| quantile(f64::from(*k) / 20.0) < z)
            .count()
    };
    let mut counts = [0.0; 20];
    for z in &z {
        counts[cell(*z)] += 1.0;
    }
    let fit = fit(&counts, &[PAIRS as f64 / 20.0; 20]);
    println!("{PAIRS} pairs of one distribution: {alarms} called different at alpha {ALPHA}");
    println!("z of the green mean in twentieths of the normal distribution: {counts:?}");
    print_histogram(&z);
    println!("chi-square against it: p = {:.3}", fit.p);
    assert!(alarms <= 6, "{alarms} of {PAIRS}");
    assert!(fit.p > 0.001, "{fit:?}");
}

/// Half a standard error a line.
fn print_histogram(z: &[f64]) {
    for bin in -7..7 {
        let low = 0.5 * f64::from(bin);
        let inside = z.iter().filter(|z| (low..low + 0.5).contains(*z)).count();
        println!("{low:>5} {:<4} {}", inside, "#".repeat(inside));
    }
}

/// Two estimators of one image, or one with two numbers of samples; in some of them light comes by
/// rare bright paths, of which a few samples may meet none.
const PAIRS: [(&str, Setting, u64, Setting, u64); 9] = [
    ("few samples", ROOM, 4, ROOM, 4),
    ("two samples", ROOM, 2, ROOM, 2),
    ("few against many", ROOM, 8, ROOM, 128),
    ("two against many", ROOM, 2, ROOM, 64),
    ("hits against both", HITS, 16, ROOM, 16),
    ("rare hits against both", RARE_HITS, 4, SMALL_LAMP, 16),
    ("rare hits, few against many", RARE_HITS, 8, RARE_HITS, 128),
    ("mirror and lobes", BALLS, 16, BALLS_BY_AREA, 8),
    ("many lamps, many against few hits", MANY, 64, MANY_HITS, 4),
];

/// Two seeds of one sequence, and a sequence against independent samples: variances of few randomisations.
const SETS: [(&str, Setting, Setting); 4] = [
    ("stratified", STRATIFIED, STRATIFIED),
    ("sobol", SOBOL, SOBOL),
    ("blue noise", BLUE_NOISE, BLUE_NOISE),
    ("sobol against independent", SOBOL, ROOM),
];

const STRATIFIED: Setting = Setting {
    scene: "cornell",
    sets: &["render.sequence=stratified"],
};
const SOBOL: Setting = Setting {
    scene: "cornell",
    sets: &["render.sequence=sobol"],
};
const BLUE_NOISE: Setting = Setting {
    scene: "cornell",
    sets: &["render.sequence=blue-noise"],
};

/// 40 pairs of each, of eight randomisations of 16 samples: as often as stated at most.
#[test]
fn the_stated_rate_is_kept_with_randomisations() {
    let mut seed = first_seed(90_000);
    for (name, first, second) in SETS {
        let mut alarms = 0;
        for _ in 0..40 {
            let reference = first.render(16, 128, seed);
            let test = second.render(16, 128, seed + 1);
            let verdict = compare(&reference, &test, Terms::default());
            alarms += u64::from(verdict.outcome == Outcome::Different);
            seed += 2;
        }
        println!("{name}: {alarms} of 40 pairs called different");
        assert!(!too_often(alarms, 40), "{name}: {alarms}");
    }
}

const HITS: Setting = Setting {
    scene: "cornell",
    sets: &["light.strategy=hit"],
};
const SMALL_LAMP: Setting = Setting {
    scene: "cornell-small-lamp",
    sets: &["render.preset=reference"],
};
const RARE_HITS: Setting = Setting {
    scene: "cornell-small-lamp",
    sets: &["render.preset=reference", "light.strategy=hit"],
};
const BALLS: Setting = Setting {
    scene: "three-balls",
    sets: &["render.preset=reference"],
};
const BALLS_BY_AREA: Setting = Setting {
    scene: "three-balls",
    sets: &["render.preset=corrected", "light.sampler=uniform-angles"],
};

const MANY: Setting = Setting {
    scene: "many-lamps",
    sets: &["light.strategy=sample"],
};
const MANY_HITS: Setting = Setting {
    scene: "many-lamps",
    sets: &["light.strategy=hit", "scatter.diffuse=uniform"],
};

#[test]
fn neither_rare_light_nor_unequal_counts_alarm() {
    const EACH: u64 = 25;
    let mut seed = first_seed(50_000);
    let mut all = 0;
    for (name, first, samples, second, others) in PAIRS {
        let mut alarms = 0;
        for _ in 0..EACH {
            let reference = first.render(48, samples, seed);
            let test = second.render(48, others, seed + 1);
            seed += 2;
            let verdict = compare(&reference, &test, Terms::default());
            alarms += u64::from(verdict.outcome == Outcome::Different);
        }
        println!("{name}: {alarms} of {EACH} called different");
        assert!(!too_often(alarms, EACH), "{name}: {alarms} of {EACH}");
        all += alarms;
    }
    assert!(!too_often(all, EACH * PAIRS.len() as u64), "{all} in all");
}

/// Estimators of one image that draw the same random numbers: what they share is little or much.
const RELATED: [(&str, Setting, u64, Setting, u64); 7] = [
    ("hits against both, 4", HITS, 4, ROOM, 4),
    ("hits against both, 16", HITS, 16, ROOM, 16),
    ("rare hits against both", RARE_HITS, 8, SMALL_LAMP, 8),
    ("many lamps", MANY_HITS, 8, MANY, 8),
    ("another rule", BY_ALBEDO, 16, ROOM, 16),
    ("another sampler", BALLS, 16, BALLS_BY_AREA, 16),
    ("the first samples of many", ROOM, 4, ROOM, 64),
];
const BY_ALBEDO: Setting = Setting {
    scene: "cornell",
    sets: &["interruption.rule=albedo", "interruption.start=0"],
};

#[test]
fn paired_pictures_of_one_image_do_not_alarm() {
    const EACH: u64 = 20;
    let mut seed = first_seed(70_000);
    let mut all = 0;
    for (name, first, samples, second, others) in RELATED {
        let mut alarms = 0;
        for _ in 0..EACH {
            let reference = first.render(48, samples, seed);
            let test = second.render(48, others, seed);
            seed += 1;
            let verdict = compare_paired(&reference, &test, Terms::default());
            alarms += u64::from(verdict.outcome == Outcome::Different);
        }
        println!("paired, {name}: {alarms} of {EACH} called different");
        assert!(!too_often(alarms, EACH), "{name}: {alarms} of {EACH}");
        all += alarms;
    }
    assert!(!too_often(all, EACH * RELATED.len() as u64), "{all} in all");
}

/// Files that state too little noise: the count of alarms must show it.
#[test]
fn a_variance_that_is_too_small_shows() {
    const EACH: u64 = 20;
    let lowered = |mut picture: Picture| {
        for pixel in &mut picture.variance {
            *pixel = pixel.map(|variance| 0.1 * variance);
        }
        picture
    };
    let seed = first_seed(60_000);
    let mut alarms = 0;
    for pair in 0..EACH {
        let reference = lowered(ROOM.render(48, 64, seed + 2 * pair));
        let test = lowered(ROOM.render(48, 64, seed + 2 * pair + 1));
        let verdict = compare(&reference, &test, Terms::default());
        alarms += u64::from(verdict.outcome == Outcome::Different);
    }
    assert!(too_often(alarms, EACH), "only {alarms} of {EACH}");
}
