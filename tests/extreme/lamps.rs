//! A hundred thousand lamps, each of which every hit asks for its light.

use super::program::{Case, devices, mean, scene, within};
use crate::support::stream::Stream;
use std::fmt::Write;

const LAMPS: usize = 100_000;

/// Lamps on a dome of radius 10 over a grey floor, and what they make of it at the dome's centre: each sends
/// albedo L (r / d)^2 times the cosine of its angle.
fn dome() -> (Case, f64) {
    let mut text = scene(
        [0.0, 2.0, 0.0],
        "[materials.lamp]\nemission = [250, 250, 250]\nalbedo = [0, 0, 0]
[[boxes]]\nmin = [-20, -1, -20]\nmax = [20, 0, 20]\nmaterial = \"grey\"\n",
    );
    let mut stream = Stream::new(7);
    let mut sum = 0.0;
    for _ in 0..LAMPS {
        let [x, y, z] = stream.direction();
        let (height, radius) = (y.abs().max(0.05), 0.002);
        let far = 10.0 / (x * x + height * height + z * z).sqrt();
        sum += 0.5 * 250.0 * (radius / 10.0_f64).powi(2) * height * far / 10.0;
        let place = [x * far, height * far, z * far];
        writeln!(
            text,
            "[[spheres]]\ncenter = {place:?}\nradius = {radius}\nmaterial = \"lamp\""
        )
        .unwrap();
    }
    (Case::new(&text), sum)
}

#[test]
fn all_of_them_light_a_point() {
    let (case, expected) = dome();
    let looks = [
        "--set",
        "camera.look_at=[0,0,0]",
        "--set",
        "camera.up=[0,0,1]",
    ];
    let one = [
        "--set",
        "camera.fov=0.1",
        "--width",
        "1",
        "--height",
        "1",
        "--spp",
        "1",
        "--max-bounces",
        "1",
    ];
    let options = [&looks[..], &one].concat();
    for device in devices("a hundred thousand lamps") {
        match case.try_render(device, &options) {
            Ok(picture) => {
                let found = mean(&picture);
                // A few of them stand before others.
                assert!(
                    within(found, 0.995 * expected, 1.001 * expected),
                    "{device}: {found:?} and not {expected}"
                );
                assert!(picture.record.rays > LAMPS as u64, "{device}");
            }
            Err(ended) => {
                assert!(device != "cpu" && ended.code == 69, "{device}: {ended:?}");
                assert!(
                    ended.said.contains("a smaller scene"),
                    "{device}: {ended:?}"
                );
            }
        }
    }
}

/// It would take days; it listens all the same.
#[cfg(unix)]
#[test]
fn a_hopeless_render_can_be_stopped() {
    let (case, _) = dome();
    let size = ["--width", "4096", "--height", "4096", "--spp", "1000"];
    let render = ["render", "s.toml", "--device", "cpu", "-o", "a.exr"];
    let mut child = case.start(&[&render, &size[..]].concat());
    std::thread::sleep(std::time::Duration::from_secs(3));
    let id = child.id().to_string();
    let kill = std::process::Command::new("kill")
        .args(["-INT", &id])
        .status();
    assert!(kill.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let left = std::fs::read_dir(case.path("")).unwrap().count();
    assert!(left <= 2, "{left} files: no temporary is left");
}
