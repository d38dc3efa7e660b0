//! The metrics of linear light, limits, worst tiles and maps, on pictures small enough to be worked out
//! by hand.

use lampray::compare::verdict::Outcome;
use lampray::compare::{
    Allowed, Gate, Lines, MapKind, Metric, Pair, Study, Viewing, Wishes, chart, compare, survey,
};
use lampray::film::{Noise, Pixels, Raster, Transfer};
use lampray::pack::Rect;

fn image(width: u32, height: u32, pixels: Pixels) -> Raster {
    Raster {
        width,
        height,
        origin: [0, 0],
        pixels,
        noise: None,
        record: None,
        format: "made up".into(),
        left_aside: Vec::new(),
    }
}

fn linear(width: u32, values: &[[f32; 3]]) -> Raster {
    let height = values.len() as u32 / width;
    image(width, height, Pixels::Linear(values.to_vec()))
}

fn pair(reference: Raster, test: Raster) -> Pair {
    Pair::new(reference, test, None).expect("two pictures of one size")
}

fn value(pair: &Pair, metric: Metric) -> f64 {
    let study = Study::new(pair, Viewing::default());
    study.figure(metric).expect("a value").value
}

#[test]
fn metrics_are_what_they_are_defined_as() {
    let reference = linear(2, &[[0.5, 0.0, 2.0], [1.0, 0.25, 0.125]]);
    let test = linear(2, &[[0.75, 0.5, 1.0], [1.0, 0.25, 0.625]]);
    let pair = pair(reference, test);
    // d = 0.25, 0.5, -1, 0, 0, 0.5.
    let squared: f64 = (0.0625 + 0.25 + 1.0 + 0.25) / 6.0;
    let relative = |power: i32, plus: fn(f64) -> f64| {
        let one = |d: f64, reference: f64| d * d / plus(reference).powi(power);
        (one(0.25, 0.5) + one(0.5, 0.0) + one(1.0, 2.0) + one(0.5, 0.125)) / 6.0
    };
    for (metric, truth) in [
        (Metric::Mae, 2.25 / 6.0),
        (Metric::Mse, squared),
        (Metric::Rmse, squared.sqrt()),
        (Metric::RelMse, relative(1, |a| a * a + 0.01)),
        (Metric::Mrse, relative(2, |a| a + 0.01)),
        (Metric::Psnr, 10.0 * (1.0 / squared).log10()),
    ] {
        let found = value(&pair, metric);
        assert!(
            (found - truth).abs() < 1e-12 * truth,
            "{metric}: {found} {truth}"
        );
    }
}

/// Bytes are light by the sRGB curve before they are compared.
#[test]
fn bytes_are_compared_in_linear_light() {
    let bytes = |value: u8, transfer| image(1, 1, Pixels::Bytes(vec![[value; 3]], transfer));
    let srgb = pair(bytes(188, Transfer::Srgb), bytes(0, Transfer::Srgb));
    let light = ((188.0 / 255.0 + 0.055) / 1.055_f64).powf(2.4);
    assert!((value(&srgb, Metric::Mae) - light).abs() < 1e-7);
    let power = pair(bytes(188, Transfer::Power(2.2)), bytes(0, Transfer::Srgb));
    assert!((value(&power, Metric::Mae) - (188.0 / 255.0_f64).powf(2.2)).abs() < 1e-7);
    // A file of floats beside one of bytes.
    let mixed = pair(linear(1, &[[light as f32; 3]]), bytes(188, Transfer::Srgb));
    assert!(value(&mixed, Metric::Mae) < 1e-7);
}

/// 70 x 40 with one wrong pixel, in the last tile of the first row.
fn spotted() -> Pair {
    let reference = vec![[0.5; 3]; 70 * 40];
    let mut test = reference.clone();
    test[3 * 70 + 66] = [0.5, 3.5, 0.5];
    pair(linear(70, &reference), linear(70, &test))
}

#[test]
fn the_worst_tiles_have_places() {
    let found = survey(&spotted());
    assert_eq!(found.tiles.len(), 6);
    let worst = found.worst(5);
    assert_eq!(worst.len(), 1);
    let rect = Rect {
        x0: 64,
        y0: 0,
        x1: 70,
        y1: 32,
    };
    assert_eq!(worst[0].rect, rect);
    let pixels: f64 = 6.0 * 32.0;
    assert!((worst[0].rmse - (9.0 / (3.0 * pixels)).sqrt()).abs() < 1e-12);
    assert!((worst[0].difference - 3.0 / (3.0 * pixels)).abs() < 1e-12);
}

#[test]
fn a_crop_keeps_the_files_coordinates() {
    let whole = spotted();
    let crop = |x0, y0, x1, y1| Some(Rect { x0, y0, x1, y1 });
    let part = Pair::new(
        whole.reference.clone(),
        whole.test.clone(),
        crop(60, 2, 70, 10),
    );
    let worst = survey(&part.expect("a part")).worst(5);
    assert_eq!((worst[0].rect.x0, worst[0].rect.y0), (60, 2));
    let clean = Pair::new(
        whole.reference.clone(),
        whole.test.clone(),
        crop(0, 0, 60, 40),
    );
    assert!(survey(&clean.expect("a part")).identical);
    for wrong in [crop(0, 0, 71, 40), crop(5, 5, 5, 9), crop(9, 9, 5, 12)] {
        assert!(Pair::new(whole.reference.clone(), whole.test.clone(), wrong).is_err());
    }
}

#[test]
fn limits_decide_and_failed_ones_draw_a_curve() {
    let pair = spotted();
    let study = Study::new(&pair, Viewing::default());
    let outcome = |limit, allowed| {
        let gate = Gate {
            metric: Metric::Mae,
            limit,
            allowed,
        };
        let wishes = Wishes {
            gates: vec![gate],
            ..Wishes::default()
        };
        let comparison = compare(&study, &wishes).expect("a comparison");
        (comparison.conclusion, comparison.gates[0].curve.len())
    };
    let mean = 3.0 / (3.0 * 70.0 * 40.0);
    assert_eq!(outcome(1.001 * mean, None), (Outcome::Same, 0));
    let (failed, steps) = outcome(0.999 * mean, None);
    assert_eq!((failed, steps > 3), (Outcome::Different, true));
    assert_eq!(outcome(0.5, Some(Allowed::Pixels(1))).0, Outcome::Same);
    assert_eq!(outcome(0.5, Some(Allowed::Pixels(0))).0, Outcome::Different);
    assert_eq!(outcome(1.0, Some(Allowed::Pixels(0))).0, Outcome::Same);
}

#[test]
fn pixels_that_are_not_finite_are_never_passed_over() {
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    let judge = |first: [f32; 3], second: [f32; 3], allow_non_finite| {
        let pair = pair(
            linear(2, &[first, [0.5; 3]]),
            linear(2, &[second, [0.5; 3]]),
        );
        let study = Study::new(&pair, Viewing::default());
        let wishes = Wishes {
            metrics: vec![Metric::Mse],
            allow_non_finite,
            ..Wishes::default()
        };
        compare(&study, &wishes)
            .map(|comparison| comparison.conclusion)
            .ok()
    };
    let bad = [nan, 0.0, 0.0];
    assert_eq!(judge(bad, bad, false), None);
    assert_eq!(judge(bad, bad, true), Some(Outcome::Same));
    assert_eq!(judge(bad, [0.0; 3], true), Some(Outcome::Different));
    assert_eq!(judge([inf; 3], [inf; 3], true), Some(Outcome::Same));
    assert_eq!(judge([inf; 3], [-inf; 3], true), Some(Outcome::Different));
    assert_eq!(judge([inf; 3], [nan; 3], true), Some(Outcome::Different));
    // The others still count in the metrics.
    let pair = pair(linear(2, &[bad, [0.5; 3]]), linear(2, &[bad, [1.0; 3]]));
    assert_eq!(value(&pair, Metric::Mse), 0.25);
}

/// Without noise in both files equality decides; with it the verdict, unless there are limits.
#[test]
fn what_decides() {
    let noisy = |value: f32, variance: f32| {
        let mut image = linear(16, &[[value; 3]; 256]);
        image.noise = Some(Noise {
            variance: vec![[variance; 3]; 256],
            samples: vec![64.0; 256],
        });
        image
    };
    let conclude = |reference: Raster, test: Raster, gates: Vec<Gate>, verdict_counts| {
        let pair = pair(reference, test);
        let wishes = Wishes {
            metrics: vec![Metric::Mse],
            gates,
            verdict_counts,
            ..Wishes::default()
        };
        let study = Study::new(&pair, Viewing::default());
        compare(&study, &wishes).expect("a comparison").conclusion
    };
    let near = |variance| (noisy(1.0, variance), noisy(1.002, variance));
    let (a, b) = near(0.001);
    assert_eq!(conclude(a, b, vec![], false), Outcome::Different);
    let (a, b) = near(0.05);
    assert_eq!(conclude(a, b, vec![], false), Outcome::Same);
    let (a, b) = near(5.0);
    assert_eq!(conclude(a, b, vec![], false), Outcome::NotEnoughSamples);
    let gate = Gate {
        metric: Metric::Mae,
        limit: 0.01,
        allowed: None,
    };
    let (a, b) = near(0.001);
    assert_eq!(
        conclude(a.clone(), b.clone(), vec![gate], false),
        Outcome::Same
    );
    assert_eq!(
        conclude(a.clone(), b.clone(), vec![gate], true),
        Outcome::Different
    );
    let bare = |mut image: Raster| {
        image.noise = None;
        image
    };
    assert_eq!(
        conclude(bare(a.clone()), b, vec![], false),
        Outcome::Different
    );
    assert_eq!(
        conclude(bare(a.clone()), bare(a), vec![], false),
        Outcome::Same
    );
}

#[test]
fn maps_show_the_numbers_that_their_titles_say() {
    let pair = spotted();
    let study = Study::new(&pair, Viewing::default());
    let pixel = 3 * 70 + 66;
    let signed = chart(&study, MapKind::Signed, None).expect("a map");
    assert_eq!((signed.values[pixel], signed.values[0]), (1.0, 0.0));
    assert_eq!(signed.range, [-1.0, 1.0]);
    let relative = chart(&study, MapKind::Relative, None).expect("a map");
    assert!((relative.values[pixel] - 3.0 / 0.51 / 3.0).abs() < 1e-6);
    assert_eq!(relative.range, [0.0, 2.0]);
    let flip = chart(&study, MapKind::Flip, None).expect("a map");
    assert!(flip.values[pixel] > 0.1 && flip.values[0] == 0.0);
    assert!(chart(&study, MapKind::Z, None).is_err());
    // A line of a picture is what the maps are made of.
    let mut line = vec![[0.0; 3]; 70];
    lampray::compare::Linear(&pair.test).line(3, &mut line);
    assert_eq!(line[66], [0.5, 3.5, 0.5]);
}
