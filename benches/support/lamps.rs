//! A room with as many small lamps in its air as wanted: together they always have the same surface.

use glam::DVec3;
use lampray::scene::{Assignment, Scene, Sphere};

/// A room, and two kinds of lamps, one sixteen times as bright. The camera looks down at the floor from under
/// the lamps: it sees none of them, whose own picture would drown the noise of their light.
const ROOM: &str = r#"version = 1
camera = { position = [0.0, 0.08, 0.95], look_at = [0.0, 0.0, 0.2], fov = 6.0 }
image = { width = 8, height = 8 }
render = { max_bounces = 1 }

[materials]
white = { albedo = [0.75, 0.75, 0.73] }
red = { albedo = [0.7, 0.12, 0.08] }
green = { albedo = [0.16, 0.56, 0.18] }
dim = { albedo = [0.0, 0.0, 0.0], emission = [4.0, 3.0, 2.0] }
bright = { albedo = [0.0, 0.0, 0.0], emission = [48.0, 48.0, 48.0] }

[[boxes]]
min = [-1.1, -0.1, -1.1]
max = [1.1, 0.0, 1.0]
material = "white"
[[boxes]]
min = [-1.1, 2.0, -1.1]
max = [1.1, 2.1, 1.0]
material = "white"
[[boxes]]
min = [-1.1, 0.0, -1.1]
max = [1.1, 2.0, -1.0]
material = "white"
[[boxes]]
min = [-1.1, 0.0, -1.0]
max = [-1.0, 2.0, 1.0]
material = "red"
[[boxes]]
min = [1.0, 0.0, -1.0]
max = [1.1, 2.0, 1.0]
material = "green"
"#;

/// Radius of a lamp that is alone.
const RADIUS: f64 = 0.1;

/// SplitMix64 (Steele, Lea and Flood 2014), even in [0, 1).
fn unit(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// The room with `count` lamps, evenly in its air; one in eight is bright. They are put into the scene past
/// its text, which may not be as long as a hundred thousand of them would be.
pub fn room(count: usize, sets: &[String]) -> Scene {
    let sets: Vec<_> = sets.iter().map(|set| Assignment::parse(set)).collect();
    let sets = sets.into_iter().collect::<Result<Vec<_>, _>>();
    let mut scene = Scene::parse("lamps.toml", ROOM, &sets.unwrap()).unwrap();
    let material = |name: &str| {
        scene
            .materials
            .iter()
            .position(|one| one.name == name)
            .unwrap()
    };
    let kinds = ["dim", "bright"].map(material);
    let radius = RADIUS / (count as f64).sqrt();
    let mut state = 0x6c61_6d70;
    for number in 0..count {
        let [x, y, z] = std::array::from_fn(|_| unit(&mut state));
        scene.spheres.push(Sphere {
            center: DVec3::new(1.7 * x - 0.85, 1.6 * y + 0.25, 1.7 * z - 0.85),
            radius,
            material: kinds[usize::from(number % 8 == 0)],
        });
    }
    scene
}
