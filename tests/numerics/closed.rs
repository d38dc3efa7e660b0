//! Closed spaces let no light in, nor out: beyond their walls the radiance is exactly 0, however bright
//! it is on the other side.

use super::bodies::*;
use crate::support::bench::{Bench, benches};
use crate::support::stream::Stream;
use glam::{DMat3, DVec3};
use lampray::knobs::LightStrategy;
use lampray::pack::{Packed, Sphere};

const SIDE: u32 = 16;
const SAMPLES: u32 = 16;
/// Lone bodies around the camera.
const BODIES: usize = 600;

/// The four walls, floor and ceiling of a room of half size 1 around the origin, moved and scaled.
/// `overlap` is how far the slabs reach past each other's edges.
fn room(scale: f64, middle: DVec3, turn: f64, overlap: f64) -> String {
    let mut text = String::new();
    let angle = turn.to_radians();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let mut center = DVec3::ZERO;
            center[axis] = side * 1.1;
            let mut half = DVec3::splat(1.0 + overlap);
            half[axis] = 0.1;
            // A slab turns about its own middle, so that its middle turns about the room's.
            let turned = DMat3::from_rotation_y(angle) * center;
            let (low, high) = (
                (turned - half) * scale + middle,
                (turned + half) * scale + middle,
            );
            text += &format!(
                "[[boxes]]\nmin = {:?}\nmax = {:?}\nrotation = [0.0, {turn:?}, 0.0]\nmaterial = \"white\"\n",
                low.to_array(),
                high.to_array()
            );
        }
    }
    text
}

const LAMP_OUTSIDE: &str =
    "[[spheres]]\ncenter = [0.0, 3e4, 0.0]\nradius = 1e4\nmaterial = \"lamp\"\n";
const SKY: &str = "[background]\nemission = [1e6, 1e6, 1e6]\n";

/// Closed spaces around the camera, bright outside and black within.
fn closed() -> Vec<(String, Packed)> {
    let mut all = Vec::new();
    for scale in [1e-3, 1.0, 1e3] {
        for middle in [DVec3::ZERO, DVec3::new(0.4, -0.5, 0.6) * scale] {
            for (turn, overlap) in [(0.0, 0.2), (0.0, 0.1), (30.0, 0.2)] {
                let name = format!("room {scale} {middle} {turn} {overlap}");
                all.push((
                    name,
                    SKY.to_string() + &room(scale, middle, turn, overlap) + LAMP_OUTSIDE,
                ));
            }
            for turn in [0.0, 33.0] {
                let (low, high) = (middle - DVec3::ONE * scale, middle + DVec3::ONE * scale);
                let text = format!(
                    "[[boxes]]\nmin = {:?}\nmax = {:?}\nrotation = [0.0, {turn:?}, 0.0]\nmaterial = \"white\"\n",
                    low.to_array(),
                    high.to_array()
                );
                all.push((
                    format!("box {scale} {middle} {turn}"),
                    SKY.to_string() + &text + LAMP_OUTSIDE,
                ));
            }
            let text = format!(
                "[[spheres]]\ncenter = {:?}\nradius = {:?}\nmaterial = \"white\"\n",
                middle.to_array(),
                1.8 * scale
            );
            all.push((
                format!("sphere {scale} {middle}"),
                SKY.to_string() + &text + LAMP_OUTSIDE,
            ));
        }
    }
    all.into_iter()
        .map(|(name, text)| (name, packed(&text)))
        .collect()
}

/// A body around the camera, a lamp and a bright sky outside it.
fn around_camera(number: usize, stream: &mut Stream) -> Packed {
    let mut body = Body::any(number, stream);
    let reach = body.reach();
    let place = DVec3::from_array([0; 3].map(|_| stream.between(-0.95, 0.95)));
    body.center = match body.kind {
        Kind::Sphere => 0.95 * stream.unit() * reach.0 * vector(stream),
        _ => body.axes * (place * body.half),
    };
    let mut scene = body.scene();
    scene.background = [1e6; 3];
    scene.max_bounces = 20;
    add_lamp(
        &mut scene,
        vector(stream) * 9.0 * reach.1,
        2.0 * reach.1,
        1e6,
    );
    look(&mut scene, vector(stream), 1.5, SIDE);
    scene
}

/// Every path goes on to its last reflection, and none brings anything.
fn check_dark(bench: Bench, name: &str, scene: &Packed, samples: u32) -> u64 {
    let tallies = bench.with(|device| trace(device, scene, SIDE, samples));
    let lit = tallies
        .iter()
        .filter(|tally| tally.mean != [0.0; 3])
        .count();
    let rays: u64 = tallies.iter().map(|tally| u64::from(tally.rays)).sum();
    let whole = u64::from(SIDE * SIDE * samples * scene.max_bounces);
    assert_eq!(lit, 0, "{bench:?} {name}: pixels with light from outside");
    assert!(
        rays > whole,
        "{bench:?} {name}: paths end early, after {rays} rays"
    );
    rays
}

#[test]
fn closed_spaces_are_dark() {
    for bench in benches() {
        let mut rays = 0;
        for (name, scene) in closed() {
            rays += check_dark(bench, &name, &scene, SAMPLES);
        }
        let mut stream = Stream::new(35);
        for number in 0..BODIES {
            let scene = around_camera(number, &mut stream);
            rays += check_dark(bench, &format!("body {number}"), &scene, 1);
        }
        println!("{bench:?}: {rays} rays, none of which gets out");
    }
}

/// A lamp in a body of any kind, camera and body in a large white ball under no sky. `share` is the
/// lamp's radius over that of the largest ball in the body: above 1 it stands out.
fn lamp_shut_in(number: usize, stream: &mut Stream, share: f64) -> Packed {
    let mut body = Body::any(number, stream);
    let (inner, outer) = body.reach();
    let toward = vector(stream);
    body.center = 6.0 * outer * toward;
    let mut scene = body.scene();
    let ball = Sphere {
        radius: (20.0 * outer) as f32,
        ..Sphere::default()
    };
    // Before the others, so that the lamp's number is that of its place.
    scene.spheres.insert(0, ball);
    scene.strategy.sphere_count += 1;
    scene.background = [0.0; 3];
    scene.max_bounces = 8;
    add_lamp(&mut scene, body.center, share * inner, 1e6);
    look(&mut scene, toward, 1.0, SIDE);
    scene
}

/// Occluders close to the lamp, far from what it would light. Shadow rays are traced, and all are blocked.
#[test]
fn lamps_that_are_shut_in_light_nothing() {
    for bench in benches() {
        let mut stream = Stream::new(36);
        let mut rays = 0;
        for number in 0..BODIES / 2 {
            let mut scene = lamp_shut_in(number, &mut stream, 0.6);
            if number % 2 == 1 {
                scene.strategy.light_strategy = LightStrategy::Sample;
            }
            rays += check_dark(bench, &format!("lamp {number}"), &scene, 2);
        }
        println!("{bench:?}: {rays} rays, none of which finds a lamp that is shut in");
    }
}

#[test]
fn a_lamp_that_stands_out_is_seen() {
    for bench in benches() {
        let mut stream = Stream::new(36);
        for number in 0..30 {
            let scene = lamp_shut_in(number, &mut stream, 1.05);
            let lit = bench.with(|device| trace(device, &scene, SIDE, 2));
            let any = lit.iter().any(|tally| tally.mean != [0.0; 3]);
            assert!(any, "{bench:?} {number}");
        }
    }
}

/// Slabs that stop short of each other's edges by a thousandth let light in.
#[test]
fn a_gap_is_seen() {
    let text = SKY.to_string() + &room(1.0, DVec3::ZERO, 0.0, -0.001) + LAMP_OUTSIDE;
    for bench in benches() {
        let lit = bench.with(|device| trace(device, &packed(&text), SIDE, SAMPLES));
        assert!(lit.iter().any(|tally| tally.mean != [0.0; 3]), "{bench:?}");
    }
}
