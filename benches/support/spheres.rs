//! A room full of small spheres: a scene of any size that costs a path about the same everywhere.

use glam::DVec3;
use lampray::scene::{Assignment, Scene, Sphere};

/// A room open towards the camera, with a lamp.
const ROOM: &str = r#"version = 1
camera = { position = [0.0, 1.0, 3.6], look_at = [0.0, 1.0, 0.0], fov = 42.0 }
background = { emission = [0.2, 0.25, 0.3] }

[materials]
white = { albedo = [0.75, 0.75, 0.73] }
red = { albedo = [0.7, 0.12, 0.08] }
green = { albedo = [0.16, 0.56, 0.18] }
lamp = { albedo = [0.0, 0.0, 0.0], emission = [14.0, 13.0, 11.0] }

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
[[spheres]]
center = [0.0, 1.7, 0.0]
radius = 0.15
material = "lamp"
"#;

/// SplitMix64 (Steele, Lea and Flood 2014), even in [0, 1).
fn unit(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// The room with `count` spheres. Their radii shrink with the cube root of the count, so that
/// together they always fill the same share of the room. They are put into the scene past its text,
/// which may not be as long as a million of them would be.
pub fn room(count: usize, sets: &[String]) -> Scene {
    let sets: Vec<_> = sets.iter().map(|set| Assignment::parse(set)).collect();
    let sets = sets.into_iter().collect::<Result<Vec<_>, _>>();
    let mut scene = Scene::parse("room.toml", ROOM, &sets.unwrap()).unwrap();
    let spacing = 2.0 / (count as f64).cbrt();
    let mut state = count as u64;
    for _ in 0..count {
        let [x, y, z, size] = std::array::from_fn(|_| unit(&mut state));
        scene.spheres.push(Sphere {
            center: DVec3::new(1.9 * x - 0.95, 1.9 * y + 0.05, 1.9 * z - 0.95),
            radius: spacing * (0.15 + 0.15 * size),
            material: (3.0 * unit(&mut state)) as usize,
        });
    }
    scene
}
