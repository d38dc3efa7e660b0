//! Equal pictures, tiny pictures, values that are no numbers, and what is refused.

use super::pictures::{Picture, bytes, light};
use lampray::compare::flip::{self, DEFAULT_PPD, Exposures, MAX_EXPOSURES, PPD};
use lampray::compare::similarity::{SHORTEST, WINDOW, ms_ssim, ssim};
use lampray::error::Error;

const ONE: Exposures = Exposures {
    start: 0.0,
    stop: 0.0,
    count: 1,
};

#[test]
fn equal_pictures_are_exactly_alike() {
    for (width, height) in [(1, 1), (3, 5), (200, 180)] {
        let coded = bytes("grains", width, height).reference;
        let map = flip::ldr(&coded, &coded, DEFAULT_PPD).unwrap();
        assert!(map.values.iter().all(|&value| value == 0.0));
        assert_eq!((map.width, map.height, map.mean()), (width, height, 0.0));
        let lit = light("range", width, height).reference;
        let map = flip::hdr(&lit, &lit, DEFAULT_PPD, Exposures::of(&lit)).unwrap();
        assert!(map.values.iter().all(|&value| value == 0.0));
        if let Some((mean, map)) = ssim(&coded, &coded) {
            assert!(mean == 1.0 && map.values.iter().all(|&value| value == 1.0));
        }
        assert_eq!(ms_ssim(&coded, &coded), (width == 200).then_some(1.0));
    }
}

#[test]
fn errors_stay_between_nothing_and_one() {
    let (black, white) = (Picture::filled(30, 20, 0.0), Picture::filled(30, 20, 1.0));
    let map = flip::ldr(&black, &white, DEFAULT_PPD).unwrap();
    assert!(map.values.iter().all(|value| (0.9..=1.0).contains(value)));
    let bright = Picture::filled(30, 20, 1e30);
    let map = flip::hdr(&black, &bright, DEFAULT_PPD, ONE).unwrap();
    assert!(map.values.iter().all(|value| (0.9..=1.0).contains(value)));
}

#[test]
fn too_small_pictures_have_no_similarity() {
    let sizes = [(1, 1), (3, 5), (WINDOW - 1, 300), (300, WINDOW - 1)];
    for (width, height) in sizes {
        let pair = bytes("grains", width, height);
        assert!(ssim(&pair.reference, &pair.test).is_none());
    }
    let pair = bytes("grains", WINDOW, WINDOW);
    assert!(ssim(&pair.reference, &pair.test).is_some());
    let pair = bytes("grains", SHORTEST - 1, 300);
    assert!(ms_ssim(&pair.reference, &pair.test).is_none());
}

/// What is no number stands for black, in every metric.
#[test]
fn what_is_no_number_is_black() {
    let sound = light("mild", 24, 24);
    for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let (mut strange, mut black) = (sound.reference.clone(), sound.reference.clone());
        for i in [0, 77, 300, 575] {
            strange.pixels[i] = [odd; 3];
            black.pixels[i] = [0.0; 3];
        }
        assert_eq!(Exposures::of(&strange), Exposures::of(&black));
        let exposures = Exposures::of(&black);
        let hdr = |a, b| flip::hdr(a, b, DEFAULT_PPD, exposures).unwrap();
        assert_eq!(hdr(&strange, &sound.test), hdr(&black, &sound.test));
        assert_eq!(hdr(&sound.test, &strange), hdr(&sound.test, &black));
        let ldr = |a, b| flip::ldr(a, b, DEFAULT_PPD).unwrap();
        assert_eq!(ldr(&strange, &sound.test), ldr(&black, &sound.test));
        assert!(ssim(&strange, &sound.test) == ssim(&black, &sound.test));
    }
}

/// The tone curve would square 1e30 to infinity and its quotient would be no number.
#[test]
fn light_beyond_the_curve_is_white() {
    let (bright, brighter) = (Picture::filled(9, 9, 1e10), Picture::filled(9, 9, 1e30));
    assert_eq!(
        flip::hdr(&bright, &brighter, DEFAULT_PPD, ONE)
            .unwrap()
            .mean(),
        0.0
    );
    let (below, black) = (Picture::filled(9, 9, -50.0), Picture::filled(9, 9, 0.0));
    assert_eq!(
        flip::hdr(&below, &black, DEFAULT_PPD, ONE).unwrap().mean(),
        0.0
    );
}

#[test]
fn any_reference_has_exposures_that_can_be_used() {
    let black = Picture::filled(4, 4, 0.0);
    let alone = Exposures::of(&black);
    assert_eq!((alone.start, alone.count), (alone.stop, 1));
    assert_eq!(Exposures::of(&Picture::filled(4, 4, f32::NAN)), alone);
    let mut wide = Picture::filled(3, 1, 1e-6);
    wide.pixels[0] = [3.4e38; 3];
    for reference in [&black, &wide] {
        let exposures = Exposures::of(reference);
        assert!(
            (1..=MAX_EXPOSURES).contains(&exposures.count),
            "{exposures:?}"
        );
        let test = Picture::filled(reference.width, reference.height, 0.5);
        let map = flip::hdr(reference, &test, DEFAULT_PPD, exposures).unwrap();
        assert!(map.values.iter().all(|value| (0.0..=1.0).contains(value)));
        assert!(map.mean() > 0.0);
    }
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let (a, b) = (Picture::filled(4, 4, 0.5), Picture::filled(4, 5, 0.5));
    let usage = |result: lampray::Result<_>| matches!(result, Err(Error::Usage(_)));
    assert!(usage(flip::ldr(&a, &b, DEFAULT_PPD)));
    for ppd in [f32::NAN, -1.0, 0.0, 1.9, 301.0, f32::INFINITY] {
        assert!(usage(flip::ldr(&a, &a, ppd)), "{ppd}");
    }
    for ppd in [*PPD.start(), *PPD.end()] {
        assert!(flip::ldr(&a, &a, ppd).is_ok(), "{ppd}");
    }
    let range = |start, stop, count| Exposures { start, stop, count };
    for exposures in [
        range(1.0, 0.0, 2),
        range(0.0, f32::NAN, 2),
        range(0.0, 1.0, 0),
        range(0.0, 1.0, 129),
    ] {
        assert!(
            usage(flip::hdr(&a, &a, DEFAULT_PPD, exposures)),
            "{exposures:?}"
        );
    }
}

/// A range that a program stored is the range that it gives again.
#[test]
fn a_single_exposure_is_the_first() {
    let pair = light("mild", 20, 20);
    let hdr = |stop, count| {
        let exposures = Exposures {
            start: -1.0,
            stop,
            count,
        };
        flip::hdr(&pair.reference, &pair.test, DEFAULT_PPD, exposures).unwrap()
    };
    assert_eq!(hdr(4.0, 1), hdr(-1.0, 2));
    assert_ne!(hdr(4.0, 1), hdr(4.0, 2));
}
