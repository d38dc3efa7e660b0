//! Light is linear in what shines, and its channels do not mix. Both hold for every sample, and both
//! are exact in floating point: a factor that is a power of two touches no mantissa, and no channel
//! takes part in another's arithmetic but through the largest of three.

use super::room::{Room, SETTINGS, Triple};
use crate::support::bench::benches;
use lampray::film::Film;

/// Whether a film is another's with every sample times `factor`.
fn is_scaled(film: &Film, by: &Film, factor: f64) -> bool {
    let times = |all: &[Triple], k: f64| all.iter().map(|v| v.map(|x| k * x)).collect::<Vec<_>>();
    film.sums == times(&by.sums, factor)
        && film.squares == times(&by.squares, factor * factor)
        && film.rays == by.rays
}

fn brighter(room: &Room, factor: f64) -> Room {
    room.clone()
        .shining(|emission| emission.map(|x| factor * x))
}

#[test]
fn four_times_the_light_is_four_times_the_picture() {
    for bench in benches() {
        for sets in SETTINGS {
            let room = Room::new();
            let (one, four) = (
                room.film(bench, sets),
                brighter(&room, 4.0).film(bench, sets),
            );
            assert!(
                one.picture_mean().iter().all(|mean| *mean > 0.1),
                "a black picture"
            );
            assert!(is_scaled(&four, &one, 4.0), "{bench:?} {sets:?}");
        }
    }
}

#[test]
fn light_that_is_not_four_times_is_caught() {
    for bench in benches() {
        let (room, sets) = (Room::new(), SETTINGS[0]);
        let one = room.film(bench, sets);
        // A clamp is not linear.
        let clamped = [sets, &["render.clamp=6.0"]].concat();
        let (dim, bright) = (
            room.film(bench, &clamped),
            brighter(&room, 4.0).film(bench, &clamped),
        );
        assert!(!is_scaled(&bright, &dim, 4.0), "{bench:?}: a clamp");
        // One unit in the last place of 32 bits more.
        let more = brighter(&room, 4.0 + 4.0 / f64::from(1 << 23));
        assert!(!is_scaled(&more.film(bench, sets), &one, 4.0), "{bench:?}");
        for name in ["glow", "small", "large"] {
            let mut part = brighter(&room, 4.0);
            part.material(name).emission = room.clone().material(name).emission;
            let film = part.film(bench, sets);
            assert!(!is_scaled(&film, &one, 4.0), "{bench:?}: all but {name}");
        }
    }
}

fn swapped(v: Triple) -> Triple {
    [v[2], v[1], v[0]]
}

fn with_swapped_colours(room: &Room) -> Room {
    let mut room = room.clone().shining(swapped);
    for material in &mut room.materials {
        material.albedo = swapped(material.albedo);
    }
    room
}

fn is_swapped(film: &Film, other: &Film) -> bool {
    let swap = |all: &[Triple]| all.iter().copied().map(swapped).collect::<Vec<_>>();
    film.sums == swap(&other.sums) && film.squares == swap(&other.squares)
}

#[test]
fn red_for_blue_is_blue_for_red() {
    for bench in benches() {
        for sets in SETTINGS {
            let room = Room::new();
            let film = room.film(bench, sets);
            let other = with_swapped_colours(&room).film(bench, sets);
            assert!(is_swapped(&other, &film), "{bench:?} {sets:?}");
            assert!(!is_swapped(&film, &film), "a grey picture");
        }
    }
}

#[test]
fn a_colour_that_stays_is_caught() {
    for bench in benches() {
        for name in ["floor", "mirror", "satin", "glow", "large"] {
            let room = Room::new();
            let film = room.film(bench, SETTINGS[0]);
            let mut part = with_swapped_colours(&room);
            part.material(name).albedo = room.clone().material(name).albedo;
            let other = part.film(bench, SETTINGS[0]);
            assert!(!is_swapped(&other, &film), "{bench:?}: {name}");
        }
    }
}
