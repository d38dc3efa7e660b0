//! What was chosen depends on the sample's address alone: kernels, crops and ranges agree to the last bit.

use super::dome::{Lamp, lattice, scene};
use super::sums::CHOSEN;
use crate::support::bench::benches;
use crate::support::same::{rendering, same};
use lampray::pack::{Packed, Rect, Tally};
use lampray::scene::{Assignment, Scene};

/// Forty lamps that reflect, over a floor that paths leave and come back to.
fn room(choice: &str, kernel: &str) -> Scene {
    let (directions, apart) = lattice(40, 0.2);
    let lamp = |(number, direction)| Lamp {
        direction,
        distance: 0.5 + 0.07 * number as f64,
        half: 0.8 * apart,
        emission: [1.0, 0.2 * number as f64, 3.0],
    };
    let lamps: Vec<_> = directions.into_iter().enumerate().map(lamp).collect();
    let text = scene(&lamps, 0.9, 24).replace("albedo = [0, 0, 0]", "albedo = [0.6, 0.7, 0.8]");
    let sets = [
        format!("light.choice={choice}"),
        format!("render.kernel={kernel}"),
        "render.max_bounces=5".into(),
        "camera.fov=60".into(),
        "camera.position=[0.1, 0.2, 0.4]".into(),
    ];
    let sets: Vec<_> = sets
        .iter()
        .map(|set| Assignment::parse(set).unwrap())
        .collect();
    Scene::parse("room", &text, &sets).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn kernels_choose_alike() {
    for bench in benches() {
        for choice in CHOSEN.map(|choice| choice.to_string()) {
            bench.with(|device| {
                let general = rendering(device, &room(&choice, "general"));
                for kernel in ["bvh", "baked"] {
                    let other = rendering(device, &room(&choice, kernel));
                    same(
                        &general,
                        &other,
                        &format!("{choice} by {kernel} on {bench:?}"),
                    );
                }
            });
        }
    }
}

#[test]
fn splits_choose_alike() {
    let rect = |x0, y0, x1, y1| Rect { x0, y0, x1, y1 };
    for bench in benches() {
        for choice in CHOSEN.map(|choice| choice.to_string()) {
            let packed = Packed::new(&room(&choice, "general"));
            bench.with(|device| {
                device.load(&packed).unwrap();
                let mut traced = |rect, first, count| -> Vec<Tally> {
                    device.trace(rect, first, count).unwrap()
                };
                let whole = traced(rect(0, 0, 24, 24), 0, 48);
                let crop = traced(rect(5, 7, 6, 8), 16, 16);
                // The second run of the pixel in column 5 of row 7.
                assert_eq!(
                    crop[0],
                    whole[24 * 24 + 7 * 24 + 5],
                    "{choice} on {bench:?}"
                );
                let later = traced(rect(0, 0, 24, 24), 16, 32);
                assert!(later[..] == whole[24 * 24..], "{choice} on {bench:?}");
            });
        }
    }
}
