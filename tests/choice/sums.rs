//! The probabilities themselves, by the twin's functions.

use crate::support::stream::Stream;
use glam::{DVec3, Vec3};
use lampray::cpu::choice::{choice_probability, choose_lamp};
use lampray::cpu::random::random_key;
use lampray::knobs::LightChoice;
use lampray::pack::Packed;
use lampray::scene::{Assignment, Scene, Sphere};

const EMPTY: &str = "version = 1
camera = { position = [0, 0, 0], look_at = [0, 0, -1] }
[materials]
dim = { emission = [0.1, 0.2, 0.3] }
bright = { emission = [50, 20, 10] }
";

pub const CHOSEN: [LightChoice; 3] = [LightChoice::Uniform, LightChoice::Power, LightChoice::Tree];

/// A scene of nothing but lamps: centres, radii, and which of two materials.
pub fn packed(choice: LightChoice, text: &str, lamps: &[(DVec3, f64, usize)]) -> Packed {
    let set = Assignment::parse(&format!("light.choice={choice}")).unwrap();
    let mut scene = Scene::parse("lamps", text, &[set]).unwrap_or_else(|error| panic!("{error}"));
    let sphere = |&(center, radius, material): &(DVec3, f64, usize)| Sphere {
        center,
        radius,
        material,
    };
    scene.spheres = lamps.iter().map(sphere).collect();
    Packed::new(&scene)
}

/// Lamps of many sizes, in three swarms.
fn swarms(count: usize) -> Vec<(DVec3, f64, usize)> {
    let mut stream = Stream::new(81);
    (0..count)
        .map(|number| {
            let middle =
                DVec3::from_array([[0.0; 3], [4.0, 1.0, 0.0], [-3.0, 0.0, 50.0]][number % 3]);
            let away = stream.scale(0.01, 2.0);
            let center = middle + away * DVec3::from_array(stream.direction());
            (center, stream.scale(1e-4, 0.1), number % 2)
        })
        .collect()
}

/// Points and normals: in the swarms, on a lamp, inside one, far from all of them.
fn receivers(lamps: &[(DVec3, f64, usize)]) -> Vec<(Vec3, Vec3)> {
    let mut stream = Stream::new(82);
    let mut all = Vec::new();
    for number in 0..24 {
        let normal = DVec3::from_array(stream.direction());
        let (center, radius, _) = lamps[number % lamps.len()];
        let away = DVec3::from_array(stream.direction());
        let point = match number % 4 {
            0 => stream.between(0.0, 3.0) * away,
            1 => center + radius * normal,
            2 => center + 0.7 * radius * away,
            _ => stream.scale(10.0, 1e6) * away,
        };
        all.push((point.as_vec3(), normal.as_vec3()));
    }
    all
}

fn probabilities(scene: &Packed, (point, normal): (Vec3, Vec3)) -> Vec<f32> {
    let lamps = 0..scene.lamps.len() as u32;
    let of = |lamp| choice_probability(scene, lamp, point, normal);
    lamps.map(of).collect()
}

/// Every lamp has a chance, and all chances together are 1: to the rounding of 32 products and their sum.
pub fn check_sums(scene: &Packed, receivers: &[(Vec3, Vec3)], what: &str) {
    for &receiver in receivers {
        let all = probabilities(scene, receiver);
        let sum: f64 = all.iter().map(|p| f64::from(*p)).sum();
        assert!((sum - 1.0).abs() < 4e-6, "{what}: {sum} at {receiver:?}");
        let some = all.iter().all(|p| *p > 0.0 && *p <= 1.0);
        assert!(some, "{what}: {all:?} at {receiver:?}");
    }
}

#[test]
fn probabilities_add_up_to_one() {
    for count in [1, 2, 3, 5, 64, 1000] {
        let lamps = swarms(count);
        for choice in CHOSEN {
            let scene = packed(choice, EMPTY, &lamps);
            check_sums(
                &scene,
                &receivers(&lamps),
                &format!("{count} lamps by {choice}"),
            );
        }
    }
}

/// What a draw says of its lamp is what is said of that lamp by itself, to the last bit.
#[test]
fn a_drawn_lamp_has_its_own_probability() {
    let lamps = swarms(1000);
    for choice in CHOSEN {
        let scene = packed(choice, EMPTY, &lamps);
        for (number, (point, normal)) in receivers(&lamps).into_iter().enumerate() {
            for sample in 0..200 {
                let key = random_key([5, 0], [number as u32, 0], [sample, 0]);
                let chosen = choose_lamp(&scene, key, 1, point, normal);
                let stated = choice_probability(&scene, chosen.lamp, point, normal);
                assert_eq!(
                    chosen.inverse_probability,
                    1.0 / stated,
                    "{choice} {chosen:?}"
                );
            }
        }
    }
}

/// A group of the tree, read again from what the device gets.
#[derive(Clone, Copy, Debug)]
struct Group {
    center: DVec3,
    radius: f64,
    power: f64,
}

fn group(ball: [u32; 4], power: u32) -> Group {
    let [x, y, z, radius] = ball.map(|word| f64::from(f32::from_bits(word)));
    Group {
        center: DVec3::new(x, y, z),
        radius,
        power: f64::from(f32::from_bits(power)),
    }
}

/// Power times the cosine of the least angle between the normal and the group's cone, over the squared
/// distance: with the angles themselves, unlike the renderer.
fn importance(group: &Group, (point, normal): (DVec3, DVec3)) -> f64 {
    let to_center = group.center - point;
    let distance = to_center.length().max(group.radius);
    let angle = (to_center.dot(normal) / distance).clamp(-1.0, 1.0).acos();
    let cone = (group.radius / distance).clamp(0.0, 1.0).asin();
    let cosine = (angle - cone).max(0.0).cos().max(1.0 / 64.0);
    group.power * cosine / (distance * distance)
}

/// Probabilities of all lamps, from the pair `place` down.
fn walk(scene: &Packed, place: usize, p: f64, at: (DVec3, DVec3), all: &mut [f64]) {
    let [a, b, last] = [0, 1, 2].map(|part| scene.choice.entries[3 * place + part]);
    let groups = [group(a, last[0]), group(b, last[1])];
    let [first, second] = groups.map(|group| importance(&group, at));
    let least = 1.0 / 4096.0;
    let share = (first / (first + second)).clamp(least, 1.0 - least);
    for (link, share) in [(last[2], share), (last[3], 1.0 - share)] {
        match link >> 31 {
            0 => walk(scene, link as usize, p * share, at, all),
            _ => all[(link & 0x7fff_ffff) as usize] = p * share,
        }
    }
}

/// By the definition in f64, with angles. Rounding moves cosines near the rim of a cone most; the root of
/// f32's unit, 2.4e-4, at each of a few pairs is what it may be there.
#[test]
fn tree_probabilities_are_the_definitions() {
    let lamps = swarms(1000);
    let scene = packed(LightChoice::Tree, EMPTY, &lamps);
    for receiver in receivers(&lamps) {
        let mut wanted = vec![0.0; lamps.len()];
        let at = (receiver.0.as_dvec3(), receiver.1.as_dvec3());
        walk(&scene, 0, 1.0, at, &mut wanted);
        for (lamp, found) in probabilities(&scene, receiver).into_iter().enumerate() {
            let ratio = f64::from(found) / wanted[lamp];
            assert!(
                (ratio - 1.0).abs() < 2e-3,
                "lamp {lamp} at {receiver:?}: {ratio}"
            );
        }
    }
}

/// Each group's sphere holds its lamps, and a group's power is what they send out.
#[test]
fn groups_hold_their_lamps() {
    let lamps = swarms(1000);
    let scene = packed(LightChoice::Tree, EMPTY, &lamps);
    let power = |lamp: usize| lamps[lamp].1.powi(2) * [0.3, 50.0][lamps[lamp].2];
    fn below(scene: &Packed, link: u32) -> Vec<usize> {
        if link >> 31 == 1 {
            return vec![(link & 0x7fff_ffff) as usize];
        }
        let [.., first, second] = scene.choice.entries[3 * link as usize + 2];
        [below(scene, first), below(scene, second)].concat()
    }
    for place in 0..lamps.len() - 1 {
        let [a, b, last] = [0, 1, 2].map(|part| scene.choice.entries[3 * place + part]);
        let groups = [group(a, last[0]), group(b, last[1])];
        let sides = [below(&scene, last[2]), below(&scene, last[3])];
        for (group, lamps_below) in groups.iter().zip(&sides) {
            for lamp in lamps_below {
                let (center, radius, _) = lamps[*lamp];
                let reach = center.distance(group.center) + radius;
                assert!(
                    reach <= group.radius * (1.0 + 1e-5) + 1e-5,
                    "lamp {lamp} of pair {place}"
                );
            }
        }
        let sums = sides.map(|side| side.into_iter().map(power).sum::<f64>());
        let ratio = groups[0].power / groups[1].power * sums[1] / sums[0];
        assert!((ratio - 1.0).abs() < 1e-5, "pair {place}: {ratio}");
    }
}
