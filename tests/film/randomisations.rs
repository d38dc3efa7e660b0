//! Films whose samples are independent randomisation by randomisation only.

use super::sample::{Folder, film, record, write};
use lampray::device::Block;
use lampray::film::{Checkpoint, ErrorEstimate, Film, Picture, merge};
use lampray::pack::{Rect, Tally};
use std::ops::Range;

const LENGTH: u64 = 32;

fn region() -> Rect {
    Rect {
        x0: 2,
        y0: 1,
        x1: 7,
        y1: 4,
    }
}

/// The radiance of every run of 16 samples of every pixel: some number that no rule makes round.
fn tally(pixel: usize, run: u64) -> Tally {
    let value = |channel: u64| {
        let x = 0.37 * pixel as f64 + 1.71 * run as f64 + 0.53 * channel as f64;
        (1.5 + x.sin() + 0.3 * (7.3 * x).sin()) as f32
    };
    Tally {
        mean: [value(0), value(1), value(2)],
        rays: 16,
        squares: [0.25; 3],
        non_finite: 0,
    }
}

/// A film of whole runs, and a short one at the end where the samples say so.
fn of_samples(samples: Range<u64>, shared: bool) -> Film {
    let mut film = Film::of_randomisations(region(), LENGTH, shared);
    for first in samples.clone().step_by(16) {
        let count = (samples.end - first).min(16) as u32;
        for pixel in 0..region().area() {
            film.add(pixel, first, count, &tally(pixel, first / 16));
        }
    }
    film
}

fn picture_of(film: &Film, samples: Range<u64>) -> Picture {
    let mut record = super::sample::record(samples);
    record.knobs["render.samples"] = 4096.into();
    film.picture(record, None, None)
}

/// Variance by the definition: over the means of the randomisations, each with its samples as its weight.
fn by_hand(pixel: usize, samples: u64, channel: usize) -> f64 {
    let sets: Vec<(f64, f64)> = (0..samples.div_ceil(LENGTH))
        .map(|set| {
            let (first, end) = (set * LENGTH, ((set + 1) * LENGTH).min(samples));
            let runs = (first..end).step_by(16).map(|first| {
                let count = (end - first).min(16) as f64;
                (
                    count,
                    count * f64::from(tally(pixel, first / 16).mean[channel]),
                )
            });
            let (count, sum) = runs.fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
            (count, sum / count)
        })
        .collect();
    let mean = sets.iter().map(|(n, m)| n * m).sum::<f64>() / samples as f64;
    let spread: f64 = sets.iter().map(|(n, m)| n * (m - mean).powi(2)).sum();
    spread / (sets.len() - 1) as f64
}

#[test]
fn the_variance_is_that_of_the_means_of_randomisations() {
    for samples in [64, 80, 96, 250, 256, 1024] {
        let film = of_samples(0..samples, false);
        assert_eq!(film.error_estimate(), ErrorEstimate::Randomisations);
        for pixel in 0..region().area() {
            assert_eq!(film.estimates(pixel), samples.div_ceil(LENGTH));
            for channel in 0..3 {
                let (found, wanted) = (
                    film.variance(pixel)[channel],
                    by_hand(pixel, samples, channel),
                );
                assert!(
                    (found - wanted).abs() < 1e-9 * wanted,
                    "{samples}: {found} {wanted}"
                );
            }
        }
    }
    // The formula for independent samples says something else: this could tell.
    let mut plain = Film::new(region());
    (0..8).for_each(|run| plain.add(0, 16 * run, 16, &tally(0, run)));
    let wanted = by_hand(0, 128, 0);
    assert!((plain.variance(0)[0] - wanted).abs() > 0.1 * wanted);
}

#[test]
fn one_randomisation_tells_nothing() {
    let film = of_samples(0..32, false);
    assert_eq!(film.variance(3), [0.0; 3]);
    assert_eq!(film.relative_error().picture, f64::INFINITY);
    for shared in [false, true] {
        let of =
            |samples: u64| of_samples(0..samples, shared).picture(record(0..samples), None, None);
        assert_eq!(of(32).record.standard_error, None);
        assert!(of(64).record.standard_error.is_some());
    }
    assert!(
        of_samples(0..64, false)
            .relative_error()
            .picture
            .is_finite()
    );
}

/// Where pixels share point sets, the error of the mean picture is the spread of its means by randomisation.
#[test]
fn the_error_of_a_picture_with_shared_sets_is_that_of_its_means() {
    for samples in [64u64, 250, 256] {
        let film = of_samples(0..samples, true);
        let pixels = region().area();
        let means: Vec<(f64, f64)> = (0..samples.div_ceil(LENGTH))
            .map(|set| {
                let (first, end) = (set * LENGTH, ((set + 1) * LENGTH).min(samples));
                let all = (0..pixels).flat_map(|pixel| {
                    (first..end).step_by(16).map(move |first| {
                        let count = (end - first).min(16) as f64;
                        count * f64::from(tally(pixel, first / 16).mean[0])
                    })
                });
                let count = (end - first) as f64;
                (count, all.sum::<f64>() / (pixels as f64 * count))
            })
            .collect();
        let mean = means.iter().map(|(n, m)| n * m).sum::<f64>() / samples as f64;
        let spread: f64 = means.iter().map(|(n, m)| n * (m - mean).powi(2)).sum();
        let error = (spread / (means.len() - 1) as f64 / samples as f64).sqrt();
        let found = film.standard_error()[0];
        assert!(
            (found - error).abs() < 1e-9 * error,
            "{samples}: {found} {error}"
        );
        // That of pixels that were independent is another.
        let alone = of_samples(0..samples, false).standard_error()[0];
        assert!((alone - error).abs() > 0.05 * error);
        let record = picture_of(&film, 0..samples).record;
        assert_eq!(record.randomisation_means.len(), means.len());
        assert_eq!(record.randomisation, Some(LENGTH));
    }
}

/// Blocks of other rows in another order give the same film bit for bit, sums over pixels included.
#[test]
fn the_order_of_blocks_changes_no_bit() {
    let wanted = of_samples(0..96, true);
    let mut film = Film::of_randomisations(region(), LENGTH, true);
    for y in (region().y0..region().y1).rev() {
        let rect = Rect {
            y0: y,
            y1: y + 1,
            ..region()
        };
        for (first, samples) in [(0, 48), (48, 48)] {
            let block = Block {
                rect,
                first_sample: first,
                samples,
            };
            let width = region().width() as usize;
            let row = (y - region().y0) as usize * width;
            let runs = (first / 16)..((first + u64::from(samples)) / 16);
            let tallies: Vec<_> = runs
                .flat_map(|run| (row..row + width).map(move |pixel| tally(pixel, run)))
                .collect();
            film.add_block(&block, &tallies);
        }
    }
    assert_eq!(film, wanted);
}

#[test]
fn a_checkpoint_keeps_open_randomisations() {
    let folder = Folder::new();
    for (samples, shared) in [(48, false), (48, true), (64, true)] {
        let film = of_samples(0..samples, shared);
        let mut record = super::sample::record(0..samples);
        film.describe(&mut record);
        Checkpoint::save(&folder.join("c"), &record, [0, 999], &film, None).unwrap();
        assert_eq!(Checkpoint::read(&folder.join("c")).unwrap().film, film);
    }
}

fn merged(parts: &[Picture]) -> lampray::Result<Picture> {
    let folder = Folder::new();
    let names: Vec<_> = (0..parts.len())
        .map(|n| folder.join(format!("{n}.exr")))
        .collect();
    parts
        .iter()
        .zip(&names)
        .for_each(|(part, name)| write(part, name));
    merge(&names, false)
}

/// The part of a film from a later sample on, with the tallies that it has in the whole.
fn part(samples: Range<u64>, shared: bool) -> Picture {
    picture_of(&of_samples(samples.clone(), shared), samples)
}

#[test]
fn parts_make_the_whole_with_its_error() {
    for shared in [false, true] {
        let whole = part(0..256, shared);
        // One of a single randomisation, which knows no error of its own, is as good as any other.
        let sum = merged(&[
            part(96..256, shared),
            part(0..64, shared),
            part(64..96, shared),
        ])
        .unwrap();
        for (found, wanted) in sum
            .variance
            .as_flattened()
            .iter()
            .zip(whole.variance.as_flattened())
        {
            assert!((found - wanted).abs() < 1e-4 * wanted, "{found} {wanted}");
        }
        let [found, wanted] =
            [&sum, &whole].map(|picture| picture.record.standard_error.unwrap()[1]);
        assert!((found - wanted).abs() < 1e-4 * wanted, "{found} {wanted}");
        assert_eq!(
            sum.record.randomisation_means,
            whole.record.randomisation_means
        );
        // The plan says how long randomisations are: a merged picture keeps it.
        assert_eq!(sum.record.knobs["render.samples"], 4096);
        assert_eq!(sum.record.samples, 256);
    }
}

#[test]
fn parts_of_randomisations_are_refused() {
    let refusal = |parts: &[Picture]| merged(parts).unwrap_err().to_string();
    let cut = [part(0..48, false), part(64..128, false)];
    assert!(
        refusal(&cut).contains("samples 0..48 end inside a randomisation"),
        "{}",
        refusal(&cut)
    );
    let mut stopped = part(64..128, false);
    stopped.record.samples = 48;
    let text = refusal(&[part(0..64, false), stopped]);
    assert!(text.contains("some of its pixels"), "{text}");
    let mut other = part(64..128, false);
    other.record.knobs["render.samples"] = 8192.into();
    let text = refusal(&[part(0..64, false), other]);
    assert!(text.contains("render.samples"), "{text}");
    // Only the last may end inside one.
    assert!(merged(&[part(0..64, false), part(64..112, false)]).is_ok());
}

#[test]
fn a_record_says_what_its_errors_are_made_of() {
    let json = |film: &Film| {
        let mut record = super::sample::record(0..64);
        film.describe(&mut record);
        serde_json::from_str::<serde_json::Value>(&record.to_json()).unwrap()
    };
    let plain = json(&film(region(), 0..64));
    assert_eq!(plain["error_estimate"], "independent");
    assert!(plain.get("randomisation").is_none());
    let sets = json(&of_samples(0..64, false));
    assert_eq!(
        (
            sets["error_estimate"].as_str(),
            sets["randomisation"].as_u64()
        ),
        (Some("randomisations"), Some(32))
    );
}
