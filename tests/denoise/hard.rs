//! Hard inputs, sizes, devices that fail and people who will not wait.

use crate::fragile::{Fragile, SOUND};
use crate::room::{body, denoised, denoised_by, made_up, rendered, scene, shipped, shipped_with};
use lampray::Error;
use lampray::cpu::Cpu;
use lampray::denoise::{denoise, is_faint, window};
use lampray::device::{Device, DeviceKind};
use lampray::film::{Denoising, Picture};
use lampray::pack::Rect;
use lampray::render::{Spares, Task, whole};
use lampray::scene::{Assignment, Scene};
use std::ops::ControlFlow;

#[test]
fn what_is_not_finite_stays_alone() {
    let scene = scene(&body([-9.0, -9.0, -5.0], [9.0, 9.0, -4.0], "white"));
    let task = Task::new(&scene);
    let mut picture = made_up(&task, |_, _| [0.8; 3], 16);
    picture.mean[100] = [f32::NAN, 1.0, 1.0];
    picture.mean[900] = [f32::INFINITY; 3];
    picture.variance[1500] = [f32::INFINITY; 3];
    picture.variance[2200] = [f32::NAN; 3];
    picture.mean[3000] = [3e38; 3];
    picture.variance[3000] = [3e38; 3];
    picture.samples[3500] = 1.0;
    let after = denoised(&task, &picture);
    assert!(after.mean[100][0].is_nan() && after.mean[900][0].is_infinite());
    for (pixel, mean) in after.mean.iter().enumerate() {
        let finite = mean.iter().all(|value| value.is_finite() && *value >= 0.0);
        assert!(finite || [100, 900].contains(&pixel), "{pixel}: {mean:?}");
    }
    assert!(
        (after.mean[3500][0] - 0.8).abs() < 0.3,
        "{:?}",
        after.mean[3500]
    );
}

/// The same picture of a room with so many times the light, as a render gives it: the variance in 32 bits.
fn times(text: &str, plain: &Picture, factor: f64) -> (Scene, Picture) {
    let emission = |rgb: [f64; 3]| format!("emission = {:?}", rgb.map(|value| value * factor));
    let text = text
        .replace(LAMP, &emission([14.2, 13.3, 11.4]))
        .replace(SKY, &emission([0.22, 0.25, 0.3]));
    let knobs = ["image.width=48", "image.height=48"].map(|set| Assignment::parse(set).unwrap());
    let scene = Scene::parse("room.toml", &text, &knobs).unwrap();
    let mut picture = plain.clone();
    let scaled = |rgb: &[f32; 3], factor: f64| rgb.map(|value| (f64::from(value) * factor) as f32);
    picture.mean = plain.mean.iter().map(|rgb| scaled(rgb, factor)).collect();
    let variances = plain.variance.iter();
    picture.variance = variances.map(|rgb| scaled(rgb, factor * factor)).collect();
    picture.record.mean = plain.record.mean.map(|value| value * factor);
    (scene, picture)
}

const LAMP: &str = "emission = [14.2, 13.3, 11.4]";
const SKY: &str = "emission = [0.22, 0.25, 0.30]";

/// An exponent of up to 40 is off by some units in its last place, and moves a pass's weights by so much; the five
/// passes go by each other's results, and a change is taken from light up to a thousand times as bright as it.
const ROUNDING: f64 = 5.0 * 40.0 * 25.0 * f32::EPSILON as f64;

#[test]
fn so_many_times_the_light_is_so_many_times_the_picture() {
    let path = format!("{}/scenes/cornell.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.contains(LAMP) && text.contains(SKY));
    let plain = rendered(&Task::new(&shipped("cornell", 48, 48, 16)));
    let smoothed = |factor: f64| {
        let (scene, picture) = times(&text, &plain, factor);
        let after = denoised(&Task::new(&scene), &picture);
        (picture, after)
    };
    let (before, one) = smoothed(1.0);
    assert_ne!(before.mean, one.mean);
    for factor in [1e-15, 1e10] {
        let (picture, many) = smoothed(factor);
        assert!(!is_faint(&picture));
        let pixels = many.mean.iter().zip(&one.mean).zip(&before.mean);
        for (pixel, ((many, one), before)) in pixels.enumerate() {
            for channel in 0..3 {
                let [many, one, before] = [many, one, before].map(|rgb| f64::from(rgb[channel]));
                let allowed = ROUNDING * one.max(before);
                let off = (many / factor - one).abs();
                assert!(off <= allowed, "{factor} {pixel}: {many} {one} {before}");
            }
        }
    }
    // Its variance would be 1e-60, and is nothing in 32 bits: nothing is taken for noise.
    let (picture, left) = smoothed(1e-30);
    assert!(is_faint(&picture));
    assert_eq!(left.mean, picture.mean);
}

#[test]
fn one_pixel_is_a_picture() {
    let scene = shipped("cornell", 1, 1, 4);
    let task = Task::new(&scene);
    let picture = made_up(&task, |_, _| [0.5; 3], 4);
    assert_eq!(denoised(&task, &picture).mean, picture.mean);
}

/// A window holds all that its pixels look at.
#[test]
fn blocks_change_nothing() {
    let size = [600, 300];
    // Nothing shines, so that the unit of light, which goes by the whole picture, rounds otherwise and no more.
    let dark = ["materials.lamp", "background"].map(|what| format!("{what}.emission=[0,0,0]"));
    let scene = shipped_with("cornell", size[0], size[1], 4, &dark);
    let task = Task::new(&scene);
    let picture = made_up(&task, |x, y| [f64::from(x + y) / 400.0 + 0.1; 3], 4);
    let mut device: Box<dyn Device> = Box::new(Fragile::new(usize::MAX, SOUND));
    let by_blocks = denoised_by(&mut device, &task, &picture, false).unwrap();
    // Part of it alone, whose blocks lie elsewhere.
    let crop = Rect {
        x0: 150,
        y0: 20,
        x1: 450,
        y1: 280,
    };
    let part = Task {
        region: crop,
        ..Task::new(&scene)
    };
    let mut small = picture.clone();
    small.mean = window(&picture.mean, size[0], crop);
    small.variance = window(&picture.variance, size[0], crop);
    small.samples = window(&picture.samples, size[0], crop);
    (small.width, small.height) = (crop.width(), crop.height());
    let alone = denoised(&part, &small);
    // Far from the crop's edges both have looked at the same pixels: 2 * (3 + 31) is the filter's reach.
    let inner = Rect {
        x0: 220,
        y0: 90,
        x1: 380,
        y1: 210,
    };
    let within = Rect {
        x0: 70,
        y0: 70,
        x1: 230,
        y1: 190,
    };
    let whole_pixels = window(&by_blocks.mean, size[0], inner);
    let pairs = whole_pixels.iter().flatten();
    let crop_pixels = window(&alone.mean, crop.width(), within);
    for (whole, crop) in pairs.zip(crop_pixels.iter().flatten()) {
        let off = f64::from((whole - crop).abs());
        assert!(off <= ROUNDING * f64::from(*whole), "{whole} {crop}");
    }
    assert_eq!(whole(&scene).area(), by_blocks.mean.len());
}

#[test]
fn a_device_that_is_lost_is_replaced_by_the_twin() {
    let scene = shipped("cornell", 40, 40, 4);
    let task = Task::new(&scene);
    let picture = made_up(&task, |_, _| [0.5; 3], 4);
    let wanted = denoised(&task, &picture).mean;
    for calls in [0, 1, 2, 4] {
        let mut device: Box<dyn Device> = Box::new(Fragile::new(calls, SOUND));
        let got = denoised_by(&mut device, &task, &picture, true).unwrap();
        assert_eq!(got.mean, wanted, "lost after {calls} calls");
        assert_eq!(device.info().kind, DeviceKind::Cpu);
        let mut device: Box<dyn Device> = Box::new(Fragile::new(calls, SOUND));
        let refused = denoised_by(&mut device, &task, &picture, false);
        assert!(matches!(refused, Err(Error::DeviceLost(_))));
    }
}

#[test]
fn who_will_not_wait_gets_nothing() {
    let scene = shipped("cornell", 40, 40, 4);
    let task = Task::new(&scene);
    let picture = made_up(&task, |_, _| [0.5; 3], 4);
    for patience in 0..4 {
        let mut asked = 0;
        let mut watch = |share: f64| {
            assert!((0.0..=1.0).contains(&share));
            asked += 1;
            match asked > patience {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        };
        let spares = Spares {
            anew: &mut || panic!("unasked"),
            any: true,
            tell: &mut |_| (),
        };
        let mut device: Box<dyn Device> = Box::new(Cpu::new());
        let made = denoise(
            &mut device,
            &task,
            &picture,
            Denoising::USUAL,
            spares,
            &mut watch,
        );
        assert!(made.unwrap().is_none());
        assert_eq!(asked, patience + 1);
    }
}

#[test]
fn a_record_that_asks_for_nonsense_is_not_sound() {
    let usual = Denoising::USUAL;
    assert!(usual.is_sound());
    for passes in [0, 9, u32::MAX] {
        assert!(!Denoising { passes, ..usual }.is_sound());
    }
    for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            !Denoising {
                light: width,
                ..usual
            }
            .is_sound()
        );
        assert!(
            !Denoising {
                normal: width,
                ..usual
            }
            .is_sound()
        );
        assert!(
            !Denoising {
                depth: width,
                ..usual
            }
            .is_sound()
        );
    }
}
