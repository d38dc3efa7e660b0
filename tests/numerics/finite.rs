//! Samples that are not numbers: none from any legal scene, and black and counted from others.

use super::bodies::{packed, trace};
use crate::support;
use lampray::cpu::Cpu;
use lampray::device::Device;
use lampray::pack::Rect;

const PAIR: &str = "[background]\nemission = [1e12, 1e12, 1e12]\n\
    [[spheres]]\ncenter = [0.3, -0.2, -3.0]\nradius = 1.0\nmaterial = \"white\"\n\
    [[spheres]]\ncenter = [0.0, 2.5, -3.0]\nradius = 0.5\nmaterial = \"lamp\"\n";

#[test]
fn the_brightest_legal_scene_stays_finite() {
    let check = |device: &mut dyn Device| {
        let text = PAIR.to_string();
        let mut scene = packed(&text);
        // The largest emission that a scene may ask for.
        scene
            .materials
            .iter_mut()
            .filter(|m| m.emission[0] > 0.0)
            .for_each(|m| m.emission = [1e12; 3]);
        scene
            .lamps
            .iter_mut()
            .for_each(|lamp| lamp.emission = [1e12; 3]);
        for tally in trace(device, &scene, 16, 16) {
            assert!(
                tally
                    .mean
                    .iter()
                    .chain(&tally.squares)
                    .all(|x| x.is_finite()),
                "{tally:?}"
            );
            assert_eq!(tally.non_finite, 0);
        }
    };
    check(&mut Cpu::new());
    if let Some(mut gpu) = support::gpu("the brightest scene") {
        check(&mut *gpu);
    }
}

/// Samples that are not numbers: how many of each pixel's 16, and the first one's place.
fn faults(device: &mut dyn Device, emission: f32) -> Vec<u32> {
    let mut scene = packed(PAIR);
    // No scene file can ask for this, so it is put in behind the parser's back.
    scene.background = [emission, 1.0, 1.0];
    let tallies = trace(device, &scene, 16, 16);
    for (pixel, tally) in tallies.iter().enumerate() {
        assert!(
            tally.mean.iter().all(|x| x.is_finite()),
            "{pixel}: {tally:?}"
        );
        let (count, first) = (tally.non_finite & 0xffff, tally.non_finite >> 16);
        assert!(count <= 16 && first < 16);
        if pixel.is_multiple_of(37) {
            let (x0, y0) = (pixel as u32 % 16, pixel as u32 / 16);
            let (x1, y1) = (x0 + 1, y0 + 1);
            let at = Rect { x0, y0, x1, y1 };
            let single = |sample| device.trace(at, sample, 1).unwrap()[0].non_finite;
            let each: Vec<_> = (0..16).map(single).collect();
            assert_eq!(count, each.iter().sum::<u32>(), "{pixel}");
            let found = each.iter().position(|fault| *fault == 1).unwrap_or(0);
            assert_eq!(first as usize, found, "{pixel}");
        }
    }
    tallies.iter().map(|tally| tally.non_finite).collect()
}

#[test]
fn samples_that_are_not_numbers_are_counted_and_black() {
    for emission in [f32::INFINITY, f32::NAN, -f32::INFINITY] {
        let ours = faults(&mut Cpu::new(), emission);
        let total: u32 = ours.iter().map(|fault| fault & 0xffff).sum();
        assert!(total > 500, "{emission}: {total}");
        assert!(faults(&mut Cpu::new(), 1.0).iter().all(|fault| *fault == 0));
        if let Some(mut gpu) = support::gpu("samples that are not numbers") {
            let theirs = faults(&mut *gpu, emission);
            let differing = ours.iter().zip(&theirs).filter(|(a, b)| a != b).count();
            assert!(
                differing * 100 <= ours.len(),
                "{emission}: {differing} pixels count otherwise"
            );
        }
    }
}
