//! What denoising must leave as it is.

use crate::room::{body, denoised, made_up, mean, rendered, scene, shipped};
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

/// Exponential light of 16 samples: a standard error of a quarter. Filtered over its many pixels the mean stays to
/// within five of its own standard errors, 0.25 / 64 each, and the noise falls by more than the 5 that one pass of 25
/// taps could give.
#[test]
fn a_flat_wall_keeps_its_mean_and_loses_its_noise() {
    let scene = scene(&body(WALL.0, WALL.1, "white"));
    let task = Task::new(&scene);
    let picture = made_up(&task, |_, _| [0.8, 0.4, 0.2], 16);
    let after = denoised(&task, &picture);
    for (channel, expected) in [0.8, 0.4, 0.2].into_iter().enumerate() {
        let of = |picture| mean(picture, channel, 0..64, 0..64) / expected;
        assert!(
            (of(&after) - 1.0).abs() < 5.0 * 0.25 / 64.0,
            "{}",
            of(&after)
        );
        assert!((of(&after) - of(&picture)).abs() < 0.015);
        let noise = |picture: &lampray::film::Picture| {
            let apart = |pixel: &[f32; 3]| (f64::from(pixel[channel]) / expected - 1.0).powi(2);
            (picture.mean.iter().map(apart).sum::<f64>() / 4096.0).sqrt()
        };
        let [before, after] = [noise(&picture), noise(&after)];
        assert!(after * 6.0 < before, "{before} {after}");
    }
}

/// Two halves that differ in one thing alone, with the same noise of a quarter on both: each keeps its mean, up to the
/// pixels beside the edge. One that mixed with the other over 8 pixels would be off by a tenth.
fn check_halves(bodies: &str, left: [f64; 3], right: [f64; 3]) {
    let scene = scene(bodies);
    let task = Task::new(&scene);
    let half = |x: u32, _| if x < 32 { left } else { right };
    let after = denoised(&task, &made_up(&task, half, 16));
    for (columns, expected) in [(28..32, left), (32..36, right)] {
        for channel in 0..3 {
            let found = mean(&after, channel, columns.clone(), 8..56) / expected[channel];
            // 48 rows of what is left of a quarter: 0.25 / sqrt(48 * 8) is 0.013.
            assert!((found - 1.0).abs() < 0.05, "{columns:?} {channel}: {found}");
        }
    }
}

#[test]
fn a_step_in_albedo_stays() {
    let bodies = body([-9.0, -9.0, -5.0], [0.0, 9.0, -4.0], "white")
        + &body([0.0, -9.0, -5.0], [9.0, 9.0, -4.0], "dark");
    // Albedo times the same light.
    check_halves(&bodies, [0.8, 0.8, 0.8], [0.2, 0.1, 0.05]);
}

#[test]
fn a_step_in_normals_stays() {
    // A box seen on its edge.
    let bodies = "[[boxes]]\nmin = [-2.0, -9.0, -7.0]\nmax = [2.0, 9.0, -3.0]\nrotation = [0.0, 45.0, 0.0]\nmaterial = \"white\"\n";
    check_halves(bodies, [0.8; 3], [0.56; 3]);
}

#[test]
fn a_step_in_depth_stays() {
    let bodies = body([-9.0, -9.0, -5.0], [0.0, 9.0, -4.0], "white")
        + &body([-9.0, -9.0, -7.0], [9.0, 9.0, -6.0], "white");
    check_halves(&bodies, [0.8; 3], [0.56; 3]);
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
