//! The pixel filters: where in the image a path starts, by the camera's own function on each device
//! and with the numbers that a path's start is given.
//!
//! The filters are drawn from and never evaluated, so that the renderer states no density: its
//! samples all weigh the same. That the drawn places have the tent's law is the whole claim.

use super::{DRAWS, LEVEL};
use crate::support;
use crate::support::bench::{Bench, benches};
use crate::support::chance::{Fit, fit, sidak};
use glam::{DVec2, Vec2};
use lampray::cpu::camera::sample_film;
use lampray::cpu::random::{random_key, random_unit};
use lampray::knobs::{Choice, Filter};
use lampray::pack::{ProbeInput, Strategy, words};
use lampray::shader::Probe;

const PIXEL: [u32; 2] = [37, 5];
/// Cells along each side of the square of places from -1 to 2 pixels from the corner.
const SIDE: usize = 60;

/// Share of a filter left of a place, in pixels from the corner that it stands on: the same law
/// along x and y.
type Left = fn(f64) -> f64;

fn even(x: f64) -> f64 {
    x.clamp(0.0, 1.0)
}

/// Density 1 - |x| on [-1, 1].
fn tent(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    match x < 0.0 {
        true => 0.5 * (1.0 + x).powi(2),
        false => 1.0 - 0.5 * (1.0 - x).powi(2),
    }
}

fn law(filter: Filter) -> Left {
    match filter {
        Filter::Box => even,
        Filter::Tent => tent,
    }
}

/// The numbers that the start of a path draws its place from: vertex 0, slot 0.
fn numbers() -> Vec<Vec2> {
    let first = (1u64 << 32) - 1000;
    let draw = |sample: u64| {
        let u = random_unit(random_key([9, 4], PIXEL, words(first + sample)), 0, 0);
        Vec2::new(u[0], u[1])
    };
    (0..DRAWS as u64).map(draw).collect()
}

/// Places in the image that a device starts at, in pixels from the pixel's upper left corner.
fn places(bench: Bench, filter: Filter) -> Vec<DVec2> {
    let corner = Vec2::new(PIXEL[0] as f32, PIXEL[1] as f32);
    if bench == Bench::Twin {
        let place = |u| sample_film(filter, PIXEL, u) - corner;
        return numbers().into_iter().map(|u| place(u).as_dvec2()).collect();
    }
    let strategy = Strategy {
        filter,
        ..support::strategy()
    };
    let input = |u: Vec2| ProbeInput {
        a: [corner.x, corner.y, 0.0, 0.0],
        b: [u.x, u.y, 0.0, 0.0],
        ..ProbeInput::default()
    };
    let inputs: Vec<_> = numbers().into_iter().map(input).collect();
    let mut gpu = support::gpu("pixel filters").expect("only benches that are there");
    let outputs = gpu.probe(&strategy, Probe::SampleFilm, &inputs).unwrap();
    let place = |film: [f32; 4]| (Vec2::new(film[0], film[1]) - corner).as_dvec2();
    outputs.iter().map(|output| place(output.a)).collect()
}

/// Chi-square of places against a law about (`x`, `y`); nothing may lie where the law has nothing.
fn test(places: &[DVec2], law: Left, x: f64, y: f64) -> Fit {
    let edge = |cell: usize| 3.0 * cell as f64 / SIDE as f64 - 1.0;
    let share = |cell: usize, from: f64| law(edge(cell + 1) - from) - law(edge(cell) - from);
    let expected: Vec<_> = (0..SIDE * SIDE)
        .map(|cell| share(cell / SIDE, y) * share(cell % SIDE, x) * places.len() as f64)
        .collect();
    let mut counts = vec![0.0; SIDE * SIDE];
    for place in places {
        // A place on the far edge itself is rounding's.
        let cell = (*place + 1.0) * SIDE as f64 / 3.0;
        let [column, row] = [cell.x, cell.y].map(|at| (at as usize).min(SIDE - 1));
        counts[row * SIDE + column] += 1.0;
    }
    fit(&counts, &expected)
}

/// The tent stands on the pixel's lower left corner, as in the paper's base code; y points down.
fn corner(filter: Filter) -> (f64, f64) {
    match filter {
        Filter::Box => (0.0, 0.0),
        Filter::Tent => (0.0, 1.0),
    }
}

#[test]
fn places_follow_their_filter() {
    let level = sidak(LEVEL, Filter::ALL.len());
    for bench in benches() {
        for &filter in Filter::ALL {
            let (x, y) = corner(filter);
            let right = test(&places(bench, filter), law(filter), x, y);
            println!("{bench:?} {filter}: p {:.4}, level {level:.1e}", right.p);
            assert!(right.p >= level, "{bench:?} {filter}: {right:?}");
        }
    }
}

#[test]
fn another_filter_is_refused() {
    let level = sidak(LEVEL, Filter::ALL.len());
    let wider: Left = |x| tent(x / 1.01);
    let flat: Left = |x| even(0.5 * (x + 1.0));
    for bench in benches() {
        let places = places(bench, Filter::Tent);
        for (law, x, y) in [
            (even as Left, 0.0, 1.0),
            (flat, 0.0, 1.0),
            (wider, 0.0, 1.0),
            (tent, 0.0, 0.0),
            (tent, 0.0, 0.99),
            (tent, 0.5, 0.5),
        ] {
            let wrong = test(&places, law, x, y);
            assert!(wrong.p < level, "{bench:?} {x} {y}: {wrong:?}");
        }
    }
}

/// The law integrates to 1, and so does what the twin's own function makes of it: its slope is the
/// inverse of the density, 1 - |x|, and it covers [-1, 1].
#[test]
fn the_tent_integrates_to_one() {
    use lampray::cpu::camera::tent as drawn;
    const STEPS: u32 = 4096;
    let mut mass = 0.0;
    for step in 0..STEPS {
        let at = |step: u32| f64::from(drawn(step as f32 / STEPS as f32));
        let (low, high) = (at(step), at((step + 1).min(STEPS)));
        assert!(high > low, "{step}");
        mass += (1.0 - (0.5 * (low + high)).abs()) * (high - low);
    }
    assert!((mass - 1.0).abs() < 1e-3, "{mass}");
}
