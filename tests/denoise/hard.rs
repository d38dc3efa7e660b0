//! Hard inputs, sizes, devices that fail and people who will not wait.

use crate::fragile::{Fragile, SOUND};
use crate::room::{body, denoised, denoised_by, made_up, scene, shipped};
use lampray::Error;
use lampray::cpu::Cpu;
use lampray::denoise::{denoise, window};
use lampray::device::{Device, DeviceKind};
use lampray::film::Denoising;
use lampray::pack::Rect;
use lampray::render::{Spares, Task, whole};
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
    let scene = shipped("cornell", size[0], size[1], 4);
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
    assert_eq!(
        window(&by_blocks.mean, size[0], inner),
        window(&alone.mean, crop.width(), within)
    );
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
