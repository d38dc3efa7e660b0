//! Radiance has no unit of length in it. A power of two times all lengths changes no mantissa, so that
//! every film is the same bit for bit: no constant of the renderer is a length. Other factors round
//! otherwise, and leave the mean.

use super::room::{Room, SETTINGS, TRUTH, Triple};
use crate::support::bench::benches;
use crate::support::gate::{Family, Form, measure_mean};

/// The room with all lengths times `factor`.
fn scaled(factor: f64) -> Room {
    let times = |v: &mut Triple| *v = v.map(|x| factor * x);
    let mut room = Room::new();
    times(&mut room.eye);
    times(&mut room.target);
    for sphere in &mut room.spheres {
        times(&mut sphere.center);
        sphere.radius *= factor;
    }
    for cuboid in &mut room.boxes {
        times(&mut cuboid.min);
        times(&mut cuboid.max);
    }
    room
}

#[test]
fn powers_of_two_leave_the_very_film() {
    for bench in benches() {
        for sets in SETTINGS {
            let film = Room::new().film(bench, sets);
            for factor in [1024.0, 1.0 / 1024.0] {
                let other = scaled(factor).film(bench, sets);
                assert!(film == other, "{bench:?} {sets:?} {factor}");
            }
        }
    }
}

#[test]
fn a_length_that_stays_is_caught() {
    // The radius of the paper's solid-angle weight is a length.
    let fixed = ["render.preset=paper", "light.weight_radius=0.3"];
    let free = ["render.preset=paper", "light.weight_radius=307.2"];
    for bench in benches() {
        let film = Room::new().film(bench, &fixed);
        assert!(film != scaled(1024.0).film(bench, &fixed), "{bench:?}");
        assert!(film == scaled(1024.0).film(bench, &free), "{bench:?}");
        let mut room = scaled(1024.0);
        room.spheres[1].radius *= 1.0 + 1e-5;
        assert!(Room::new().film(bench, SETTINGS[0]) != room.film(bench, SETTINGS[0]));
    }
}

#[test]
fn any_factor_leaves_the_mean() {
    let mut family = Family::new("lengths", 41_000);
    let mut mutants = Family::new("lengths, mutants", 41_100);
    for (number, bench) in benches().into_iter().enumerate() {
        for (place, sets) in [SETTINGS[0], SETTINGS[5]].into_iter().enumerate() {
            let seed = 41_200 + 2 * number as u64 + place as u64;
            let plain = Room::new().case("room", sets, Form::Mean([0.0; 3]));
            let form = measure_mean(bench, &plain, seed, TRUTH);
            for factor in [1000.0, 0.001] {
                let name = format!("lengths times {factor}");
                family.check(bench, &scaled(factor).case(&name, sets, form));
                let mut mutant = scaled(factor);
                mutant.spheres[2].radius *= 1.02;
                mutants.reject(bench, &mutant.case("but one radius", sets, form));
            }
        }
    }
    family.finish();
}
