//! Seeds, samples and pixels whose numbers do not fit 32 bits, up to the ends of 64.

use super::program::{Case, devices, exists, mean, scene, within};
use lampray::film::read_exr;

/// Half of the picture is a wall of 0.5, the other half sky of 1, with noise by the wall's three bounces.
fn wall() -> Case {
    Case::new(&scene(
        [0.0; 3],
        "[background]\nemission = [1, 1, 1]
[[boxes]]\nmin = [-50, -50, -3]\nmax = [0, 50, -2]\nmaterial = \"grey\"
[[boxes]]\nmin = [-50, -50, -3]\nmax = [50, -1, 3]\nmaterial = \"grey\"\n",
    ))
}

const SMALL: [&str; 4] = ["--width", "16", "--height", "16"];
/// What the wall's mean is, whatever the numbers: from 4096 samples a pixel.
const BAND: [f64; 2] = [0.60, 0.70];

#[test]
fn the_first_and_the_last_seed_draw_their_own_pictures() {
    let case = wall();
    for device in devices("the first and the last seed") {
        let of = |seed: &str| {
            let more = [&SMALL[..], &["--spp", "64", "--seed", seed]].concat();
            let picture = case.render(device, &more);
            assert_eq!(picture.record.seed.to_string(), seed);
            let found = mean(&picture);
            assert!(
                within(found, BAND[0], BAND[1]),
                "{device}, {seed}: {found:?}"
            );
            let again = case.run(&["rerun", "a.exr", "-q", "-o", "b.exr", "--device", device]);
            assert_eq!(again.code, 0, "{again:?}");
            assert_eq!(read_exr(case.path("b.exr")).unwrap().mean, picture.mean);
            picture.mean
        };
        let all = ["0", "1", "4294967296", "18446744073709551615"].map(of);
        for (number, one) in all.iter().enumerate() {
            assert!(
                !all[..number].contains(one),
                "{device}: two seeds draw the same"
            );
        }
    }
    assert_eq!(
        case.run(&["check", "s.toml", "--seed", "18446744073709551616"])
            .code,
        2
    );
}

/// The last samples that there are, in one piece and in two.
#[test]
fn samples_near_2_to_the_63() {
    let case = wall();
    for device in devices("samples near 2^63") {
        let of = |first: u64, end: u64, file: &str| {
            let range = format!("{first}..{end}");
            let more = [&SMALL[..], &["--sample-range", &range]].concat();
            let picture = case.render(device, &more);
            assert_eq!(picture.record.sample_range, [first, end]);
            std::fs::rename(case.path("a.exr"), case.path(file)).unwrap();
            picture
        };
        let last = 1 << 63;
        let whole = of(last - 64, last, "whole.exr");
        let found = mean(&whole);
        assert!(within(found, BAND[0], BAND[1]), "{device}: {found:?}");
        of(last - 64, last - 32, "one.exr");
        of(last - 32, last, "two.exr");
        let merged = case.run(&["merge", "two.exr", "one.exr", "-q", "-o", "sum.exr"]);
        assert_eq!(merged.code, 0, "{merged:?}");
        let sum = read_exr(case.path("sum.exr")).unwrap();
        assert_eq!(sum.record.sample_range, [last - 64, last]);
        let pairs = sum
            .mean
            .as_flattened()
            .iter()
            .zip(whole.mean.as_flattened());
        assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-5), "{device}");
        let first = of(0, 64, "first.exr");
        assert!(
            first.mean != whole.mean,
            "{device}: other samples draw other numbers"
        );
    }
    for range in [
        "9223372036854775807..9223372036854775809",
        "18446744073709551615..18446744073709551616",
        "5..5",
    ] {
        let ended = case.run(&["render", "s.toml", "--sample-range", range]);
        assert_eq!(ended.code, 2, "{ended:?}");
        assert!(ended.said.contains("up to 2^63"), "{ended:?}");
    }
}

/// 2^28 pixels of 2^31 - 1 samples: the last pixels, of which each sample counts as in a picture of its own.
#[test]
fn more_samples_than_32_bits_count() {
    let case = wall();
    for device in devices("the corner of the largest picture") {
        let corner = |width: &str, height: &str, crop: &str| {
            let more = [
                "--width",
                width,
                "--height",
                height,
                "--crop",
                crop,
                "--samples",
                "2147483647",
            ];
            case.render(
                device,
                &[&more[..], &["--sample-range", "2147483631..2147483647"]].concat(),
            )
        };
        let picture = corner("32768", "8192", "32764,8188,32768,8192");
        assert_eq!(picture.record.crop, Some([32764, 8188, 32768, 8192]));
        assert_eq!(picture.record.paths, 16 * 16);
        let found = mean(&picture);
        assert!(within(found, 0.3, 1.0), "{device}: {found:?}");
        let next = corner("32768", "8192", "32760,8184,32768,8192");
        assert_eq!(
            next.mean[4 * 8 + 4],
            picture.mean[0],
            "{device}: a pixel is itself in every crop"
        );
    }
}

/// All samples that there are of four pixels are more than 64 bits count; what is done of them is saved.
#[cfg(unix)]
#[test]
fn all_samples_of_all_pixels_can_be_begun() {
    let case = wall();
    let more = [
        "--width",
        "2",
        "--height",
        "2",
        "--sample-range",
        "0..9223372036854775808",
    ];
    let render = ["render", "s.toml", "--device", "cpu", "-q", "-o", "a.exr"];
    let mut child = case.start(&[&render, &more[..]].concat());
    std::thread::sleep(std::time::Duration::from_millis(1500));
    let id = child.id().to_string();
    let kill = std::process::Command::new("kill")
        .args(["-TERM", &id])
        .status();
    assert!(kill.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(143));
    assert!(exists(&case.path("a.exr")));
    let picture = read_exr(case.path("a.exr")).unwrap();
    assert!(!picture.record.complete && picture.record.samples > 16);
    assert!(within(mean(&picture), 0.3, 1.0));
}
