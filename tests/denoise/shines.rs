//! Lamps in the picture: their light stays where they are seen, in every channel.

use crate::room::{denoised, rendered, shipped_with};
use lampray::film::{Denoised, Denoising, Picture};
use lampray::render::Task;

/// A room of 48 x 48 pixels without daylight, before and after.
fn room(seed: u64, knobs: &[String]) -> [Picture; 2] {
    let dark = [
        "background.emission=[0,0,0]".into(),
        format!("render.seed={seed}"),
    ];
    let knobs: Vec<_> = dark.iter().chain(knobs).cloned().collect();
    let scene = shipped_with("cornell", 48, 48, 32, &knobs);
    let task = Task::new(&scene);
    let before = rendered(&task);
    let after = denoised(&task, &before);
    [before, after]
}

fn told(picture: &Picture) -> &Denoised {
    picture.record.denoised.as_ref().unwrap()
}

/// Walls that reflect next to nothing, around a lamp a hundred thousand times as bright.
#[test]
fn a_lamp_stays_in_its_own_pixels() {
    let albedo = ["white.albedo=[1e-5,1e-5,1e-5]", "satin.albedo=[0,0,0]"];
    for (seed, emission) in [(1, 1e-3), (2, 1.0), (3, 1.0), (4, 1e6)] {
        let lamp = format!("lamp.emission=[{emission},{emission},{emission}]");
        let knobs = albedo.map(String::from).into_iter().chain([lamp]);
        let knobs: Vec<_> = knobs.map(|knob| format!("materials.{knob}")).collect();
        let [_, after] = room(seed, &knobs);
        println!("{seed} {emission}: {:?}", told(&after).change);
        assert_eq!(told(&after).warnings, [""; 0]);
    }
}

/// Beside a channel a million million times as bright a faint one keeps its mean, and one of nothing stays nothing.
#[test]
fn a_faint_channel_keeps_its_mean() {
    for emission in ["1,1e12,0", "1e12,1,0", "1,1e-9,0"] {
        for seed in [1, 2] {
            let [before, after] = room(seed, &[format!("materials.lamp.emission=[{emission}]")]);
            println!("{seed} {emission}: {:?}", told(&after).change);
            assert_eq!(told(&after).warnings, [""; 0]);
            let blue = |picture: &Picture| picture.mean.iter().map(|mean| mean[2]).sum::<f32>();
            assert_eq!([blue(&before), blue(&after)], [0.0; 2]);
        }
    }
}

/// Each channel by itself: the brightest would hide the others.
#[test]
fn the_largest_change_of_a_channel_is_told() {
    let new = |after| Denoised::new(Denoising::USUAL, [[1.0, 1e12, 0.0], after], 0, 0.0);
    let large = new([12.8, 1.01e12, 0.0]);
    assert_eq!(large.largest_change().0, "red");
    assert!((large.largest_change().1 - 11.8).abs() < 1e-12);
    assert_eq!(large.change[2], 0.0);
    assert_eq!(large.warnings.len(), 1);
    assert!(large.warnings[0].contains("the mean of red by +1180.00 %"));
    assert!(new([1.0, 0.94e12, 0.0]).warnings[0].contains("green by -6.00 %"));
    assert_eq!(new([1.04, 1e12, 0.0]).warnings, [""; 0]);
    // From nothing to something is as large as can be, and a number.
    assert!(new([1.0, 1e12, 1.0]).change[2].is_finite());
}
