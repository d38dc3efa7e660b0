//! Lamps over the middle of a floor, of which none stands before another.

use glam::DVec3;
use std::f64::consts::PI;
use std::fmt::Write as _;

/// A lamp as it is seen from the middle of the floor.
#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    /// Unit vector, y up.
    pub direction: DVec3,
    pub distance: f64,
    /// Half the angle under which it is seen, radians.
    pub half: f64,
    pub emission: [f64; 3],
}

impl Lamp {
    /// What a floor of albedo 1 makes of it: its form factor times its radiance.
    pub fn light(&self) -> [f64; 3] {
        let factor = self.half.sin().powi(2) * self.direction.y.max(0.0);
        self.emission.map(|radiance| factor * radiance)
    }
}

/// `count` directions over the cap down to the cosine `lowest` (a Fibonacci lattice), and half the angle
/// that any two of them are at least apart.
pub fn lattice(count: usize, lowest: f64) -> (Vec<DVec3>, f64) {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let direction = |index: usize| {
        let cosine = 1.0 - (1.0 - lowest) * (index as f64 + 0.5) / count as f64;
        let (sine, turn) = ((1.0 - cosine * cosine).sqrt(), golden * index as f64);
        DVec3::new(sine * turn.cos(), cosine, sine * turn.sin())
    };
    let all: Vec<_> = (0..count).map(direction).collect();
    let pairs = (0..count).flat_map(|one| (0..one).map(move |other| (one, other)));
    let apart = pairs.map(|(one, other)| all[one].angle_between(all[other]));
    let half = 0.5 * apart.fold(PI, f64::min);
    (all, half)
}

/// The middle of the floor, seen along it by every pixel, with these lamps over it.
pub fn scene(lamps: &[Lamp], albedo: f64, side: u32) -> String {
    let mut text = format!(
        "version = 1
        camera = {{ position = [0.3, 0.012, 0.0], look_at = [0, 0, 0], fov = 0.01 }}
        image = {{ width = {side}, height = {side} }}
        render = {{ max_bounces = 1 }}
        [materials]
        floor = {{ albedo = [{albedo}, {albedo}, {albedo}] }}
        [[boxes]]
        min = [-3.0, -0.5, -3.0]
        max = [3.0, 0.0, 3.0]
        material = \"floor\"\n"
    );
    for (number, lamp) in lamps.iter().enumerate() {
        let (center, radius) = (
            lamp.distance * lamp.direction,
            lamp.distance * lamp.half.sin(),
        );
        // Writing into a string cannot fail.
        let _ = write!(
            text,
            "[materials.lamp{number}]\nalbedo = [0, 0, 0]\nemission = {:?}\n[[spheres]]\ncenter = {center}\nradius = {radius:?}\nmaterial = \"lamp{number}\"\n",
            lamp.emission
        );
    }
    text
}
