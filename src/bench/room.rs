//! A room like the Cornell box with as many small spheres in it as wanted: the same spheres for the
//! same number, on every machine.

use crate::error::{Error, Result};
use crate::scene::{Assignment, MOST_BYTES, MOST_PRIMITIVES, Scene, Sphere};
use glam::DVec3;
use std::fmt::Write as _;

/// The lamp and the five walls, which stand in every room.
pub const ROOM_BODIES: usize = 6;

/// The room without its small spheres.
const EMPTY: &str = r#"version = 1

[camera]
position = [0.0, 1.0, 3.6]
look_at = [0.0, 0.995, 0.0]
fov = 42.0

[image]
width = 256
height = 256

[render]
samples = 64
max_bounces = 8

[background]
emission = [0.22, 0.25, 0.30]

[materials.white]
albedo = [0.76, 0.75, 0.73]

[materials.red]
albedo = [0.70, 0.12, 0.08]

[materials.green]
albedo = [0.16, 0.56, 0.18]

[materials.blue]
albedo = [0.20, 0.32, 0.66]

[materials.mirror]
scatter = "mirror"
albedo = [0.92, 0.93, 0.94]

[materials.lamp]
albedo = [0.0, 0.0, 0.0]
emission = [14.2, 13.3, 11.4]

[[boxes]]
min = [-1.0, -0.1, -1.0]
max = [1.0, 0.0, 1.0]
material = "white"

[[boxes]]
min = [-1.0, 2.0, -1.0]
max = [1.0, 2.1, 1.0]
material = "white"

[[boxes]]
min = [-1.0, 0.0, -1.1]
max = [1.0, 2.0, -1.0]
material = "white"

[[boxes]]
min = [-1.1, -0.1, -1.1]
max = [-1.0, 2.1, 1.0]
material = "red"

[[boxes]]
min = [1.0, -0.1, -1.1]
max = [1.1, 2.1, 1.0]
material = "green"

[[spheres]]
center = [0.0, 1.6, -0.1]
radius = 0.18
material = "lamp"
"#;

/// What the small spheres are made of, in turns: one in eight is a mirror.
const MATERIALS: [&str; 8] = [
    "white", "red", "blue", "white", "green", "mirror", "white", "blue",
];
/// The largest sphere of a room of one: they fill about 2 % of any room.
const LARGEST: f64 = 0.4;
const LAMP: (DVec3, f64) = (DVec3::new(0.0, 1.6, -0.1), 0.18);

/// The room of so many spheres. Above 16 MiB of text no file could hold it, so the scene's source is the
/// empty room: it is there to be traced, not to be told apart by its record.
///
/// # Errors
/// [`Error::Usage`] for more primitives than a scene may have; faults of the assignments.
pub fn room(spheres: usize, assignments: &[Assignment]) -> Result<Scene> {
    let most = MOST_PRIMITIVES - ROOM_BODIES;
    if spheres > most {
        return Err(Error::Usage(format!(
            "a room of {spheres} spheres: a scene has at most {most} beside its lamp and walls"
        )));
    }
    let mut scene = Scene::parse(&format!("room-{spheres}"), EMPTY, assignments)?;
    let material = |name: &str| {
        let mut materials = scene.materials.iter();
        materials.position(|material| material.name == name)
    };
    let numbers = MATERIALS.map(|name| material(name).unwrap_or(0));
    scene
        .spheres
        .extend(small(spheres).enumerate().map(|(index, ball)| Sphere {
            center: ball.0,
            radius: ball.1,
            material: numbers[index % numbers.len()],
        }));
    Ok(scene)
}

/// The room as a scene file, for `render` and for other programs.
///
/// # Errors
/// [`Error::Usage`] for a room that is too large for a scene file.
pub fn room_text(spheres: usize) -> Result<String> {
    let mut text = format!("# The room of {spheres} spheres of `lampray bench`.\n{EMPTY}");
    for (index, (center, radius)) in small(spheres).enumerate() {
        let material = MATERIALS[index % MATERIALS.len()];
        let [x, y, z] = center.to_array();
        // Writing into a string cannot fail.
        let _ = write!(
            text,
            "\n[[spheres]]\ncenter = [{x:?}, {y:?}, {z:?}]\nradius = {radius:?}\nmaterial = \"{material}\"\n"
        );
        if text.len() as u64 > MOST_BYTES {
            return Err(Error::Usage(format!(
                "a room of {spheres} spheres is more than the 16 MiB that a scene file may have"
            )));
        }
    }
    Ok(text)
}

/// Centres and radii. They lie inside the walls and clear of the lamp, so in front of no camera; they may
/// overlap each other.
fn small(count: usize) -> impl Iterator<Item = (DVec3, f64)> {
    let largest = LARGEST / (count.max(1) as f64).cbrt();
    let mut numbers = SplitMix(0x6c61_6d70_7261_7921);
    (0..count).map(move |_| {
        loop {
            let radius = short(largest * (0.6 + 0.4 * numbers.unit()));
            let place = DVec3::from_array([numbers.unit(), numbers.unit(), numbers.unit()]);
            let (low, high) = (DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 2.0, 1.0));
            let center = low + radius + (high - low - 2.0 * radius) * place;
            let center = DVec3::from_array(center.to_array().map(short));
            if center.distance(LAMP.0) > LAMP.1 + radius {
                return (center, radius);
            }
        }
    })
}

/// To a millionth, so that text is short and says exactly what is traced.
fn short(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators" (OOPSLA 2014).
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_generator_is_the_published_one() {
        let mut numbers = SplitMix(1_234_567);
        let first: Vec<u64> = (0..3).map(|_| numbers.next()).collect();
        assert_eq!(
            first,
            [
                6_457_827_717_110_365_317,
                3_203_168_211_198_807_973,
                9_817_491_932_198_370_423
            ]
        );
    }

    #[test]
    fn a_room_is_the_same_each_time_and_as_its_text_says() {
        for count in [0, 1, 8, 100, 1000] {
            let (scene, again) = (room(count, &[]).unwrap(), room(count, &[]).unwrap());
            assert_eq!(scene.spheres, again.spheres);
            assert_eq!(scene.spheres.len() + scene.boxes.len(), count + ROOM_BODIES);
            let read = Scene::parse("text", &room_text(count).unwrap(), &[]).unwrap();
            assert_eq!(read.spheres, scene.spheres, "{count}");
            assert_eq!(read.boxes, scene.boxes);
            assert_eq!(read.materials, scene.materials);
        }
    }

    #[test]
    fn spheres_stand_between_the_walls_and_clear_of_lamp_and_camera() {
        let scene = room(5000, &[]).unwrap();
        let (low, high) = (DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 2.0, 1.0));
        for ball in &scene.spheres[1..] {
            let slack = 1e-6;
            let inside = (ball.center - ball.radius).cmpge(low - slack)
                & (ball.center + ball.radius).cmple(high + slack);
            assert!(inside.all(), "{ball:?}");
            assert!(ball.center.distance(scene.camera.position) > ball.radius);
            assert!(ball.center.distance(scene.spheres[0].center) > ball.radius + 0.18);
        }
        assert_eq!(scene.lamps().count(), 1);
        assert_eq!(scene.spheres[0].center, LAMP.0);
    }

    #[test]
    fn radii_shrink_with_the_cube_root_so_that_the_filled_share_stays() {
        let filled = |count| -> f64 {
            let scene = room(count, &[]).unwrap();
            scene.spheres[1..]
                .iter()
                .map(|ball| ball.radius.powi(3))
                .sum()
        };
        let (few, many) = (filled(64), filled(8000));
        assert!((few / many - 1.0).abs() < 0.2, "{few} {many}");
    }

    #[test]
    fn rooms_that_no_scene_can_hold_are_refused() {
        assert!(room(1 << 20, &[]).is_err());
        assert!(room_text(1_000_000).is_err());
        assert!(room(1_000_000, &[]).is_ok());
    }
}
