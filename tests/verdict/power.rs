//! Pairs that differ: that the verdict finds it, says where, or says how many samples it wants.

use super::pictures::{Setting, compare, compare_paired};
use lampray::compare::verdict::{Outcome, Terms};

const ROOM: Setting = Setting {
    scene: "cornell",
    sets: &[],
};
/// Every white albedo one percent higher.
const BRIGHTER: Setting = Setting {
    scene: "cornell",
    sets: &["materials.white.albedo=[0.7676, 0.7575, 0.7373]"],
};

#[test]
fn one_percent_of_albedo_is_found_at_256_samples() {
    let reference = ROOM.render(128, 256, 1);
    let verdict = compare(&reference, &BRIGHTER.render(128, 256, 2), Terms::default());
    assert_eq!(verdict.outcome, Outcome::Different);
    assert!(verdict.pooled_fails, "{:?}", verdict.pooled);
    let green = verdict.pooled[1];
    let relative = green.difference / green.reference;
    assert!((0.005..0.03).contains(&relative), "{relative}");
}

/// Too few samples say so, and how many would do; those then do.
#[test]
fn the_number_of_samples_asked_for_suffices() {
    for (changed, outcome) in [(BRIGHTER, Outcome::Different), (ROOM, Outcome::Same)] {
        let few = compare(
            &ROOM.render(32, 4, 3),
            &changed.render(32, 4, 4),
            Terms::default(),
        );
        assert_eq!(few.outcome, Outcome::NotEnoughSamples);
        let needed = few.needed.expect("how many are needed");
        assert!(needed.test > 4 && needed.test < 5000, "{needed:?}");
        let reference = ROOM.render(32, needed.reference, 5);
        let enough = compare(
            &reference,
            &changed.render(32, needed.test, 6),
            Terms::default(),
        );
        println!("4 samples are too few; {needed:?} say {:?}", enough.outcome);
        assert_eq!(enough.outcome, outcome);
    }
}

/// What "same" promises is no more than what the samples show.
#[test]
fn same_holds_for_the_margin_that_the_samples_support() {
    let (reference, test) = (ROOM.render(64, 128, 7), ROOM.render(64, 128, 8));
    let at = |margin| {
        let terms = Terms {
            margin,
            ..Terms::default()
        };
        compare(&reference, &test, terms)
    };
    let supported = at(0.01).supported_margin;
    assert!((1e-4..0.01).contains(&supported), "{supported}");
    assert_eq!(at(1.001 * supported).outcome, Outcome::Same);
    let tighter = at(0.999 * supported);
    assert_eq!(tighter.outcome, Outcome::NotEnoughSamples);
    // Errors fall with the root of the number.
    let factor = |margin| at(margin).needed.map_or(0, |needed| needed.test) as f64;
    let ratio = factor(0.1 * supported) / factor(0.2 * supported);
    assert!((3.9..4.1).contains(&ratio), "{ratio}");
}

/// A change that the mean of the picture hides, because it is small or sums to nothing.
#[test]
fn a_local_change_is_found_where_it_is() {
    let reference = ROOM.render(128, 64, 9);
    let mut test = ROOM.render(128, 64, 10);
    // A square of six pixels a side, half of it much brighter and half much darker.
    for y in 50..56 {
        for x in 82..88 {
            let gain = if x < 85 { 1.9 } else { 0.1 };
            test.mean[y * 128 + x] = test.mean[y * 128 + x].map(|value| value * gain);
        }
    }
    let verdict = compare(&reference, &test, Terms::default());
    assert_eq!(verdict.outcome, Outcome::Different);
    assert!(!verdict.pooled_fails);
    let pixels = verdict.pixels.expect("a third layer");
    let found = pixels.cluster_at.expect("a cluster");
    println!(
        "cluster of {} at {found:?}, chance {:.1e}",
        pixels.largest_cluster, pixels.cluster_p
    );
    assert!(
        (82..88).contains(&found[0]) && (50..56).contains(&found[1]),
        "{found:?}"
    );
    // All of it brighter by a little: the tile shows it, single pixels do not.
    let mut test = ROOM.render(128, 64, 11);
    for y in 48..56 {
        for x in 80..88 {
            test.mean[y * 128 + x] = test.mean[y * 128 + x].map(|value| value * 1.15);
        }
    }
    let verdict = compare(&reference, &test, Terms::default());
    assert_eq!(verdict.outcome, Outcome::Different);
    let tiles = verdict.tiles.expect("a second layer");
    assert_eq!(
        (tiles.worst.rect.x0, tiles.worst.rect.y0, tiles.failing),
        (80, 48, 1)
    );
}

/// The same random numbers show what independent ones would need thousands of samples for; and the
/// same pictures are the same.
#[test]
fn paired_pictures_are_far_sharper() {
    let slightly = Setting {
        scene: "cornell",
        sets: &["materials.white.albedo=[0.76, 0.75075, 0.73]"],
    };
    let (reference, test) = (ROOM.render(64, 16, 12), slightly.render(64, 16, 12));
    let paired = compare_paired(&reference, &test, Terms::default());
    assert_eq!(paired.outcome, Outcome::Different);
    assert!(paired.pixels.is_none());
    let independent = compare(&reference, &test, Terms::default());
    assert_ne!(independent.outcome, Outcome::Different);
    let same = compare_paired(&reference, &reference, Terms::default());
    assert_eq!((same.outcome, same.supported_margin), (Outcome::Same, 0.0));
}

/// Differences of 32-bit arithmetic do not count, where there is no noise to hide them either.
#[test]
fn rounding_is_no_difference() {
    let mut reference = ROOM.render(32, 16, 13);
    for variance in &mut reference.variance {
        *variance = [0.0; 3];
    }
    let mut test = reference.clone();
    let scale = |picture: &mut lampray::film::Picture, factor: f32| {
        for pixel in &mut picture.mean {
            *pixel = pixel.map(|value| value * factor);
        }
    };
    scale(&mut test, 1.000_005);
    assert_eq!(
        compare(&reference, &test, Terms::default()).outcome,
        Outcome::Same
    );
    scale(&mut test, 1.00001);
    assert_eq!(
        compare(&reference, &test, Terms::default()).outcome,
        Outcome::Different
    );
}
