//! What denoising must leave as it is.

use crate::fragile::{Fault, SOUND};
use crate::room::{body, denoised, denoised_with, made_up, mean, rendered, scene, shipped};
use lampray::render::Task;

#[test]
fn a_picture_without_noise_keeps_its_bits() {
    let scene = shipped("cornell", 48, 48, 16);
    let task = Task::new(&scene);
    let mut picture = rendered(&task);
    picture.variance.fill([0.0; 3]);
    let after = denoised(&task, &picture);
    assert_eq!(after.mean, picture.mean);
}

const WALL: ([f64; 3], [f64; 3]) = ([-9.0, -9.0, -5.0], [9.0, 9.0, -4.0]);

/// A flat wall by exponential light of 16 samples, a standard error of a quarter: its noise before and after.
///
/// Filtered over its many pixels the mean stays to within five of its own standard errors, 0.25 / 64 each.
fn noise_of_a_wall(fault: Fault) -> [f64; 2] {
    let scene = scene(&body(WALL.0, WALL.1, "white"));
    let task = Task::new(&scene);
    let picture = made_up(&task, |_, _| [0.8, 0.4, 0.2], 16);
    let after = denoised_with(fault, &task, &picture);
    for (channel, expected) in [0.8, 0.4, 0.2].into_iter().enumerate() {
        let of = |picture| mean(picture, channel, 0..64, 0..64) / expected;
        assert!(
            (of(&after) - 1.0).abs() < 5.0 * 0.25 / 64.0,
            "{}",
            of(&after)
        );
        assert!((of(&after) - of(&picture)).abs() < 0.015);
    }
    [&picture, &after].map(|picture| {
        let apart = |pixel: &[f32; 3]| (f64::from(pixel[0]) / 0.8 - 1.0).powi(2);
        (picture.mean.iter().map(apart).sum::<f64>() / 4096.0).sqrt()
    })
}

/// By how much noise falls: measured are 6.6, and 4.3 where the taps of every pass are neighbours.
const FALL: f64 = 5.3;

#[test]
fn a_flat_wall_keeps_its_mean_and_loses_its_noise() {
    let [before, after] = noise_of_a_wall(SOUND);
    println!("noise {before:.4} -> {after:.4}: {:.1}", before / after);
    assert!(after * FALL < before, "{before} {after}");
}

#[test]
fn taps_that_stay_together_is_caught() {
    let [before, after] = noise_of_a_wall(|job, _, _| job.step = 1);
    println!("noise {before:.4} -> {after:.4}: {:.1}", before / after);
    assert!(after * FALL > before, "{before} {after}");
}

/// Two halves that differ in one thing alone, with the same noise on both.
struct Halves {
    bodies: String,
    left: [f64; 3],
    right: [f64; 3],
    /// 16 leave a noise of a quarter, 400 of a twentieth.
    samples: u32,
}

impl Halves {
    /// The first mean beside the edge that is not kept. One that mixed with the other half over 8 pixels would be off
    /// by a tenth or more.
    fn lost(&self, fault: Fault) -> Option<String> {
        let scene = scene(&self.bodies);
        let task = Task::new(&scene);
        let half = |x: u32, _| if x < 32 { self.left } else { self.right };
        let after = denoised_with(fault, &task, &made_up(&task, half, self.samples));
        for (columns, expected) in [(28..32, self.left), (32..36, self.right)] {
            for (channel, expected) in expected.into_iter().enumerate() {
                let found = mean(&after, channel, columns.clone(), 8..56) / expected;
                // Of 48 rows: less than 0.25 / sqrt(48) where one row is as another.
                if (found - 1.0).abs() > 0.05 {
                    return Some(format!("{columns:?} {channel}: {found}"));
                }
            }
        }
        None
    }
}

fn albedo() -> Halves {
    Halves {
        bodies: body([-9.0, -9.0, -5.0], [0.0, 9.0, -4.0], "white")
            + &body([0.0, -9.0, -5.0], [9.0, 9.0, -4.0], "dark"),
        // Albedo times the same light.
        left: [0.8, 0.8, 0.8],
        right: [0.2, 0.1, 0.05],
        samples: 16,
    }
}

/// A box seen on its edge.
fn normals() -> Halves {
    Halves {
        bodies: "[[boxes]]\nmin = [-2.0, -9.0, -7.0]\nmax = [2.0, 9.0, -3.0]\nrotation = [0.0, 45.0, 0.0]\nmaterial = \"white\"\n".into(),
        left: [0.8; 3],
        right: [0.56; 3],
        samples: 16,
    }
}

fn depth() -> Halves {
    Halves {
        bodies: body([-9.0, -9.0, -5.0], [0.0, 9.0, -4.0], "white")
            + &body([-9.0, -9.0, -7.0], [9.0, 9.0, -6.0], "white"),
        ..normals()
    }
}

/// No guide knows of it: that the noise is much smaller than the step must be enough.
fn shadow() -> Halves {
    Halves {
        bodies: body(WALL.0, WALL.1, "white"),
        left: [0.8, 0.6, 0.4],
        right: [0.4, 0.3, 0.2],
        samples: 400,
    }
}

/// As bright, in another colour.
fn colour() -> Halves {
    Halves {
        left: [0.4, 0.2, 0.2],
        right: [0.2, 0.24, 0.2],
        ..shadow()
    }
}

#[test]
fn steps_stay() {
    for (what, halves) in [
        ("albedo", albedo()),
        ("normals", normals()),
        ("depth", depth()),
        ("shadow", shadow()),
        ("colour", colour()),
    ] {
        assert_eq!(halves.lost(SOUND), None, "{what}");
    }
}

#[test]
fn ignoring_guides_is_caught() {
    let fault: Fault = |job, _, _| (job.normal, job.depth) = (0.0, 0.0);
    for halves in [normals(), depth()] {
        assert!(halves.lost(fault).is_some());
    }
}

#[test]
fn ignoring_the_variance_is_caught() {
    let fault: Fault = |_, _, estimates| {
        estimates
            .iter_mut()
            .for_each(|estimate| estimate.variance = 0.5);
    };
    for halves in [shadow(), colour()] {
        assert!(halves.lost(fault).is_some());
    }
}

#[test]
fn a_white_furnace_stays_white() {
    let text = "background.emission = [1, 1, 1]\nmaterials.ball.albedo = [1, 1, 1]\n\
        [[spheres]]\ncenter = [0, 0, -4]\nradius = 1.0\nmaterial = \"ball\"\n";
    let scene = scene(text);
    let task = Task::new(&scene);
    // Every path brings the light of the background, whatever it met: no noise at all.
    let clean = rendered(&task);
    assert_eq!(denoised(&task, &clean).mean, clean.mean);
    // With noise on it, its mean stays to within 1 %, everywhere to within 10 %.
    let after = denoised(&task, &made_up(&task, |_, _| [1.0; 3], 16));
    for channel in 0..3 {
        let all = mean(&after, channel, 0..64, 0..64);
        assert!((all - 1.0).abs() < 0.02, "{all}");
        for (x, y) in (0..8).flat_map(|x| (0..8).map(move |y| (8 * x, 8 * y))) {
            let tile = mean(&after, channel, x..x + 8, y..y + 8);
            assert!((tile - 1.0).abs() < 0.1, "{x} {y}: {tile}");
        }
    }
}
