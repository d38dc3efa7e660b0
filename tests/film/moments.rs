use super::sample::{REGION, film, radiance};
use lampray::film::{Film, NonFinite};
use lampray::pack::{Rect, Tally};

fn close(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * b.abs()
}

/// 8 bytes a float and blocks of 8: what is lost is the rounding of tallies to f32.
#[test]
fn moments_equal_a_direct_computation() {
    let film = film(REGION, 3..103);
    for pixel in 0..REGION.area() {
        for channel in 0..3 {
            let values: Vec<f64> = (3..103)
                .map(|sample| radiance(pixel, sample)[channel])
                .collect();
            let mean = values.iter().sum::<f64>() / 100.0;
            let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 99.0;
            assert!(
                close(film.mean(pixel)[channel], mean, 1e-7),
                "pixel {pixel}"
            );
            assert!(
                close(film.variance(pixel)[channel], variance, 1e-6),
                "pixel {pixel}"
            );
        }
    }
    assert_eq!(film.paths, 100 * REGION.area() as u64);
    assert_eq!(film.rays, 300 * REGION.area() as u64);
}

#[test]
fn mean_of_the_picture_and_its_standard_error() {
    let film = film(REGION, 0..64);
    let pixels = REGION.area() as f64;
    for channel in 0..3 {
        let mean = (0..REGION.area())
            .map(|pixel| film.mean(pixel)[channel])
            .sum::<f64>()
            / pixels;
        let variances = (0..REGION.area()).map(|pixel| film.variance(pixel)[channel] / 64.0);
        let error = variances.sum::<f64>().sqrt() / pixels;
        assert!(close(film.picture_mean()[channel], mean, 1e-14));
        assert!(close(film.standard_error()[channel], error, 1e-14));
        // 3 u^2 has mean 1 and variance 4/5: the definitions, beside the arithmetic.
        let known = (0.8 / (64.0 * pixels)).sqrt();
        assert!((mean - 1.0).abs() < 4.0 * known, "{mean}");
        assert!(close(error, known, 0.05), "{error} {known}");
    }
}

#[test]
fn equal_samples_have_no_variance() {
    let mut film = Film::new(Rect {
        x0: 0,
        y0: 0,
        x1: 1,
        y1: 1,
    });
    let tally = Tally {
        mean: [0.1, 1e-20, 1e10],
        ..Tally::default()
    };
    for block in 0..1000 {
        film.add(0, block * 7, 7, &tally);
        let variance = film.variance(0);
        for (variance, mean) in variance.into_iter().zip(film.mean(0)) {
            assert!(
                variance >= 0.0 && variance <= 1e-12 * mean * mean,
                "{variance}"
            );
        }
    }
    assert!(close(film.mean(0)[0], f64::from(0.1_f32), 1e-14));
}

#[test]
fn few_samples() {
    let mut film = Film::new(Rect {
        x0: 0,
        y0: 0,
        x1: 2,
        y1: 1,
    });
    assert_eq!((film.mean(0), film.variance(0)), ([0.0; 3], [0.0; 3]));
    assert_eq!(
        (film.picture_mean(), film.standard_error()),
        ([0.0; 3], [0.0; 3])
    );
    film.add(
        0,
        0,
        1,
        &Tally {
            mean: [2.0, 4.0, 6.0],
            ..Tally::default()
        },
    );
    assert_eq!(
        (film.mean(0), film.variance(0)),
        ([2.0, 4.0, 6.0], [0.0; 3])
    );
    assert_eq!(film.picture_mean(), [1.0, 2.0, 3.0]);
}

#[test]
fn non_finite_samples_are_counted_and_the_first_is_found() {
    let region = Rect {
        x0: 10,
        y0: 20,
        x1: 14,
        y1: 23,
    };
    let found = |pixel: usize, first, place: u32, count: u32, film: &mut Film| {
        film.add(
            pixel,
            first,
            64,
            &Tally {
                non_finite: place << 16 | count,
                ..Tally::default()
            },
        );
    };
    let mut film = Film::new(region);
    found(3, 0, 9, 0, &mut film);
    assert_eq!((film.non_finite, film.first_non_finite), (0, None));
    found(6, 128, 5, 2, &mut film);
    found(9, 64, 63, 65535, &mut film);
    found(4, 128, 0, 1, &mut film);
    assert_eq!(film.non_finite, 2 + 65535 + 1);
    assert_eq!(
        film.first_non_finite,
        Some(NonFinite {
            sample: 127,
            y: 22,
            x: 11
        })
    );
}

#[test]
fn a_film_rebuilt_from_its_fields_goes_on_bit_for_bit() {
    let whole = film(REGION, 0..64);
    let half = film(REGION, 0..32);
    let mut rest = Film {
        region: REGION,
        ..half.clone()
    };
    for pixel in 0..REGION.area() {
        for first in (32..64).step_by(8) {
            rest.add(
                pixel,
                first,
                8,
                &super::sample::tally(pixel, first..first + 8),
            );
        }
    }
    assert_eq!(rest, whole);
    assert_ne!(half, whole);
}
