//! A closed white box, in which a path never ends by itself.

use super::program::{Case, devices, mean, scene};

/// Each of n bounces and the first sight adds the walls' own light: (n + 1) e, with sums that are exact in f32
/// for e = 2^-20.
fn room(bounces: u32) -> Case {
    Case::new(&scene(
        [0.0; 3],
        &format!(
            "[render]\nmax_bounces = {bounces}\n[interruption]\nrule = \"none\"
[materials.glow]\nalbedo = [1, 1, 1]\nemission = [{e:?}, {e:?}, {e:?}]
[[boxes]]\nmin = [-1, -1, -2]\nmax = [1, 1, 2]\nmaterial = \"glow\"\n",
            e = E
        ),
    ))
}

const E: f64 = 1.0 / 1_048_576.0;
const ONE: [&str; 6] = ["--width", "1", "--height", "1", "--spp", "1"];

#[test]
fn a_million_bounces_add_up() {
    let case = room(1_000_000);
    for device in devices("a million bounces in a closed box") {
        match case.try_render(device, &ONE) {
            Ok(picture) => {
                assert_eq!(mean(&picture), [1_000_001.0 * E; 3], "{device}");
                assert_eq!(picture.record.rays, 1_000_001, "{device}");
            }
            Err(ended) => {
                assert!(device != "cpu" && ended.code == 69, "{device}: {ended:?}");
                assert!(
                    ended.said.contains("render.max_bounces"),
                    "{device}: {ended:?}"
                );
            }
        }
    }
}

/// The same within what every device does.
#[test]
fn ten_thousand_bounces_add_up_everywhere() {
    for device in devices("ten thousand bounces in a closed box") {
        for bounces in [1, 10_000] {
            let picture = room(bounces).render(device, &ONE);
            assert_eq!(mean(&picture), [f64::from(bounces + 1) * E; 3], "{device}");
        }
    }
}

#[test]
fn one_bounce_more_is_refused() {
    let ended = room(1_000_001).run(&["check", "s.toml"]);
    assert_eq!(ended.code, 65);
    let said = ended.said + &ended.printed;
    assert!(said.contains("0 to 1000000"), "{said}");
}
