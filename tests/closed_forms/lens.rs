//! The circle of confusion: a point at depth z through a thin lens of radius A in focus at depth F is a
//! disc of radius A |1 / F - 1 / z| in the image plane at distance 1 (similar triangles), evenly bright.
//!
//! A small ball stands for the point. About its middle the picture's mean squared distance is half the
//! disc's radius squared, and half its own, as far as balls seen a little from the side are discs.

use crate::support::bench::{Bench, benches};
use lampray::scene::{Assignment, Scene};

const DEPTH: f64 = 5.0;
const RADIUS: f64 = 0.02;
const SIZE: usize = 96;
const FOV: f64 = 8.0;
const SAMPLES: u64 = 256;

fn scene(aperture: f64, focus: Option<f64>, seed: u64) -> Scene {
    let focus = focus.map_or(String::new(), |focus| format!("focus = {focus}, "));
    let text = format!(
        "version = 1
        camera = {{ position = [1.0, 2.0, 3.0], look_at = [1.0, 2.0, -2.0], fov = {FOV}, {focus}aperture = {aperture} }}
        image = {{ width = {SIZE}, height = {SIZE} }}
        spheres = [{{ center = [1.1, 1.95, {}], radius = {RADIUS}, material = \"lamp\" }}]
        materials = {{ lamp = {{ albedo = [0, 0, 0], emission = [1, 1, 1] }} }}",
        3.0 - DEPTH
    );
    let seed = Assignment::parse(&format!("render.seed={seed}")).unwrap();
    Scene::parse("lens", &text, &[seed]).unwrap_or_else(|error| panic!("{error}"))
}

/// What a picture says of its one bright spot, in the image plane at distance 1.
struct Spot {
    /// Share of the samples that meet the ball.
    share: f64,
    middle: [f64; 2],
    /// Mean squared distance from the middle, its standard error, and the mean of the fourth power.
    square: f64,
    error: f64,
    fourth: f64,
}

fn spot(bench: Bench, scene: &Scene) -> Spot {
    let film = bench.film(scene, 0..SAMPLES);
    let unit = 2.0 * (0.5 * FOV.to_radians()).tan() / SIZE as f64;
    let place = |pixel: usize| {
        let centred = |at: usize| (at as f64 + 0.5 - 0.5 * SIZE as f64) * unit;
        [centred(pixel % SIZE), centred(pixel / SIZE)]
    };
    let bright = |pixel: usize| film.mean(pixel)[0];
    let pixels = 0..SIZE * SIZE;
    let sum: f64 = pixels.clone().map(bright).sum();
    let mean = |of: &dyn Fn([f64; 2]) -> f64| {
        let weighed = pixels.clone().map(|pixel| bright(pixel) * of(place(pixel)));
        weighed.sum::<f64>() / sum
    };
    let middle = [mean(&|at| at[0]), mean(&|at| at[1])];
    let squared = |at: [f64; 2]| (at[0] - middle[0]).powi(2) + (at[1] - middle[1]).powi(2);
    let (square, fourth) = (mean(&squared), mean(&|at| squared(at).powi(2)));
    Spot {
        share: sum / (SIZE * SIZE) as f64,
        middle,
        // Counted by pixels, each axis has 1 / 12 of their width squared too much (Sheppard's correction).
        square: square - unit * unit / 6.0,
        error: ((fourth - square * square) / (sum * SAMPLES as f64)).sqrt(),
        fourth,
    }
}

/// The mean squared distance that the disc of confusion and the ball have together.
fn blur(aperture: f64, focus: f64) -> f64 {
    let confusion = aperture * (1.0 / focus - 1.0 / DEPTH).abs();
    0.5 * (confusion * confusion + (RADIUS / DEPTH).powi(2))
}

/// Terms of the order of (A / z)^2 that a disc leaves out.
const CURVED: f64 = 2e-3;

fn is_near(spot: &Spot, square: f64) -> bool {
    (spot.square - square).abs() < 4.0 * spot.error + CURVED * square
}

#[test]
fn the_circle_of_confusion_has_its_size() {
    for bench in benches() {
        let pinhole = spot(bench, &scene(0.0, None, 67_000));
        for (number, (aperture, focus)) in [
            (0.1, 2.5),
            (0.1, 20.0),
            (0.25, 4.0),
            (0.05, 1.8),
            (0.2, 5.0),
        ]
        .into_iter()
        .enumerate()
        {
            let found = spot(bench, &scene(aperture, Some(focus), 67_001 + number as u64));
            let square = blur(aperture, focus);
            println!(
                "{bench:?}, radius {aperture}, in focus at {focus}: root mean square {:.6}, by the formula {:.6}, standard error {:.1e}",
                found.square.sqrt(),
                square.sqrt(),
                0.5 * found.error / square.sqrt()
            );
            assert!(
                is_near(&found, square),
                "{bench:?} {aperture} {focus}: {} {square}",
                found.square
            );
            // The lens moves light about in the picture and leaves its sum and its middle.
            let most = 4.0 * (2.0 * pinhole.share / (SIZE * SIZE) as f64 / SAMPLES as f64).sqrt();
            assert!((found.share - pinhole.share).abs() < most + CURVED * pinhole.share);
            for axis in 0..2 {
                let off = found.middle[axis] - pinhole.middle[axis];
                let hits = found.share * (SIZE * SIZE) as f64 * SAMPLES as f64;
                assert!(
                    off.abs() < 4.0 * (square / hits).sqrt(),
                    "{bench:?} {aperture} {focus}"
                );
            }
        }
    }
}

/// An even disc has a mean fourth power of 4 / 3 of its mean square squared, and the sum of two points of
/// discs the sum of theirs and 4 times the product of the mean squares. A lens with as much light within
/// half its radius as outside of it would have 9 / 5.
#[test]
fn the_disc_is_even() {
    for bench in benches() {
        let found = spot(bench, &scene(0.1, Some(2.5), 67_100));
        let (own, all) = (0.5 * (RADIUS / DEPTH).powi(2), blur(0.1, 2.5));
        let lens = all - own;
        let even = (4.0 / 3.0 * (lens * lens + own * own) + 4.0 * lens * own) / (all * all);
        let ratio = found.fourth / found.square.powi(2);
        assert!(
            (ratio - even).abs() < 0.03,
            "{bench:?}: {ratio}, not {even}"
        );
    }
}

/// Without a distance it is where the camera looks that is sharp: here, the ball.
#[test]
fn the_plane_of_look_at_is_in_focus() {
    for bench in benches() {
        let found = spot(bench, &scene(0.2, None, 67_200));
        assert!(
            is_near(&found, blur(0.2, DEPTH)),
            "{bench:?}: {}",
            found.square
        );
    }
}

#[test]
fn the_gates_reject_small_faults() {
    for bench in benches() {
        let found = spot(bench, &scene(0.1, Some(2.5), 67_300));
        assert!(is_near(&found, blur(0.1, 2.5)));
        for (aperture, focus) in [(0.102, 2.5), (0.098, 2.5), (0.1, 2.46), (0.1, 2.54)] {
            assert!(
                !is_near(&found, blur(aperture, focus)),
                "{bench:?} {aperture} {focus}"
            );
        }
    }
}
