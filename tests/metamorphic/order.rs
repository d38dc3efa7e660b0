//! The order in which a scene names its bodies.
//!
//! A body's number decides nothing but ties, and there are none here: so where random numbers do not
//! depend on the order either, films are equal bit for bit. They do depend on it for lamps: lamp i of
//! a hit draws from slot i + 1. So an exchange of lamps leaves the very film where none is sampled
//! (`hit`), and the mean alone where they are.

use super::room::{Room, SETTINGS, TRUTH};
use crate::support::bench::{Bench, benches};
use crate::support::gate::{Family, Form, measure_mean};

/// Bodies shuffled, the lamps in their own order among themselves.
fn shuffled() -> Vec<Room> {
    let orders: [([usize; 4], [usize; 3]); 3] = [
        ([2, 1, 3, 0], [2, 1, 0]),
        ([1, 2, 0, 3], [1, 0, 2]),
        ([2, 3, 0, 1], [0, 2, 1]),
    ];
    orders
        .map(|(spheres, boxes)| ordered(&spheres, &boxes))
        .to_vec()
}

fn ordered(spheres: &[usize], boxes: &[usize]) -> Room {
    let room = Room::new();
    Room {
        spheres: spheres.iter().map(|&at| room.spheres[at].clone()).collect(),
        boxes: boxes.iter().map(|&at| room.boxes[at].clone()).collect(),
        ..room
    }
}

fn with_lamps_exchanged() -> Room {
    ordered(&[3, 0, 2, 1], &[1, 2, 0])
}

#[test]
fn shuffled_bodies_make_the_same_film() {
    for bench in benches() {
        for sets in SETTINGS {
            let film = Room::new().film(bench, sets);
            for room in shuffled() {
                let other = room.film(bench, sets);
                assert!(film == other, "{bench:?} {sets:?}: {:?}", room.spheres);
            }
        }
        // Materials too: they are named.
        let mut room = Room::new();
        room.materials.reverse();
        assert!(room.film(bench, SETTINGS[0]) == Room::new().film(bench, SETTINGS[0]));
    }
}

#[test]
fn exchanged_lamps_make_the_same_film_where_none_is_sampled() {
    for bench in benches() {
        let hit = SETTINGS[2];
        assert!(hit[0] == "light.strategy=hit");
        let (film, other) = (
            Room::new().film(bench, hit),
            with_lamps_exchanged().film(bench, hit),
        );
        assert!(film == other, "{bench:?}");
        // Elsewhere each lamp has drawn the other's numbers: films that differ are told apart.
        let (film, other) = [Room::new(), with_lamps_exchanged()]
            .map(|room| room.film(bench, SETTINGS[0]))
            .into();
        assert!(film != other, "{bench:?}");
    }
}

/// The room as it is, measured: what its shuffled likes are compared with.
fn truth(bench: Bench, sets: &[&str], seed: u64) -> Form {
    let case = Room::new().case("room", sets, Form::Mean([0.0; 3]));
    measure_mean(bench, &case, seed, TRUTH)
}

#[test]
fn exchanged_lamps_have_the_same_mean() {
    let mut family = Family::new("exchanged lamps", 40_000);
    let mut mutants = Family::new("exchanged lamps, mutants", 40_100);
    for (number, bench) in benches().into_iter().enumerate() {
        let form = truth(bench, SETTINGS[0], 40_200 + number as u64);
        let room = with_lamps_exchanged();
        family.check(bench, &room.case("exchanged", SETTINGS[0], form));
        let mut mutant = room.clone();
        mutant.spheres[1].radius *= 1.1;
        mutants.reject(bench, &mutant.case("larger", SETTINGS[0], form));
        let mut mutant = room;
        mutant.boxes[2].material = "glow";
        mutants.reject(bench, &mutant.case("materials mixed up", SETTINGS[0], form));
    }
    family.finish();
}
