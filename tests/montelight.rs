//! The preset `montelight` against the base code's rules, written down here once more, in f64.
//!
//! Both sides take their random numbers from the same addresses, so that single paths can be
//! compared; the geometry, the light sample, its weight, the tests and the film are this file's own.

use glam::DVec3;
use lampray::cpu::random::{random_key, random_unit};
use lampray::cpu::trace::Tracer;
use lampray::pack::{Job, Packed, Rect, words};
use lampray::scene::Scene;
use rayon::prelude::*;
use std::f64::consts::PI;

const SIDE: u32 = 256;
const EYE: DVec3 = DVec3::new(50.0, 52.0, 295.6);
/// The camera's rays start so many lengths of their direction before the eye.
const START: f64 = 140.0;
/// Vertical extent of the image plane at distance 1.
const EXTENT: f64 = 0.5135;
/// A hit is further than this.
const NEAREST: f64 = 0.0005;
const LAST_HIT: u32 = 20;

#[derive(Clone, Copy)]
enum Form {
    Sphere(DVec3, f64),
    /// The plane where this coordinate has this value.
    Plane(usize, f64),
}

#[derive(Clone, Copy)]
struct Thing {
    form: Form,
    colour: DVec3,
    emission: f64,
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Walls {
    /// Spheres of radius 100,000, as in the base code.
    Spheres,
    /// The inner faces of the scene file's boxes.
    Planes,
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Room {
    Simple,
    Complex,
}

/// What the base code does; a test changes one rule at a time to see that it matters.
#[derive(Clone, Copy)]
struct Rules {
    test_before_light: bool,
    weight_radius: f64,
    clamp: bool,
    corner_filter: bool,
    /// The lamp counts as seen when any point of it is met, not only the drawn one.
    object_seen: bool,
    emission_at_camera_only: bool,
    first_test: u32,
}

const BASE: Rules = Rules {
    test_before_light: true,
    weight_radius: 1.5,
    clamp: true,
    corner_filter: true,
    object_seen: true,
    emission_at_camera_only: true,
    first_test: 5,
};

fn things(room: Room, walls: Walls) -> Vec<Thing> {
    let grey = DVec3::splat(0.75);
    let (red, blue) = (DVec3::new(0.75, 0.25, 0.25), DVec3::new(0.25, 0.25, 0.75));
    let faces = [
        (0, 1.0, 1.0, red),
        (0, 99.0, -1.0, blue),
        (2, 0.0, 1.0, grey),
        (1, 0.0, 1.0, grey),
        (1, 81.6, -1.0, grey),
    ];
    let mut list: Vec<Thing> = faces
        .map(|(axis, at, inwards, colour)| wall(walls, axis, at, inwards, colour))
        .to_vec();
    if walls == Walls::Planes {
        list.push(wall(walls, 2, 3200.0, -1.0, DVec3::ZERO));
    }
    let sphere = |x, y, z, radius, colour: f64, emission| Thing {
        form: Form::Sphere(DVec3::new(x, y, z), radius),
        colour: DVec3::splat(colour),
        emission,
    };
    list.extend(match room {
        Room::Simple => vec![
            sphere(27.0, 16.5, 47.0, 16.5, 0.799, 0.0),
            sphere(73.0, 16.5, 78.0, 16.5, 0.799, 0.0),
            sphere(50.0, 65.1, 81.6, 8.5, 0.0, 400.0),
        ],
        Room::Complex => vec![
            sphere(20.0, 16.5, 40.0, 16.5, 0.799, 0.0),
            sphere(50.0, 16.5, 80.0, 16.5, 0.799, 0.0),
            sphere(75.0, 16.5, 120.0, 16.5, 0.799, 0.0),
            sphere(50.0, 65.1, 40.0, 1.5, 0.0, 400.0),
            sphere(50.0, 65.1, 120.0, 1.5, 0.0, 400.0),
        ],
    });
    list
}

/// A wall whose inner side looks along `inwards` of an axis; a sphere touches that plane at the
/// height of the room's middle (and, but for the back wall, at a depth of 81.6).
fn wall(walls: Walls, axis: usize, at: f64, inwards: f64, colour: DVec3) -> Thing {
    let mut center = DVec3::new(50.0, 40.8, 81.6);
    center[axis] = at + inwards * 1e5;
    Thing {
        form: match walls {
            Walls::Spheres => Form::Sphere(center, 1e5),
            Walls::Planes => Form::Plane(axis, at),
        },
        colour,
        emission: 0.0,
    }
}

fn distance(form: Form, origin: DVec3, direction: DVec3) -> Option<f64> {
    let far_enough = |t: &f64| *t > NEAREST;
    match form {
        Form::Plane(axis, at) => {
            Some((at - origin[axis]) / direction[axis]).filter(|t| t.is_finite() && far_enough(t))
        }
        Form::Sphere(center, radius) => {
            let apart = center - origin;
            let middle = apart.dot(direction);
            let root = (middle * middle - apart.length_squared() + radius * radius).sqrt();
            [middle - root, middle + root].into_iter().find(far_enough)
        }
    }
}

fn nearest(things: &[Thing], origin: DVec3, direction: DVec3) -> Option<(usize, f64)> {
    let met = |(index, thing): (usize, &Thing)| {
        distance(thing.form, origin, direction).map(|t| (index, t))
    };
    let by_distance = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
    things
        .iter()
        .enumerate()
        .filter_map(met)
        .min_by(by_distance)
}

/// Turned against the ray.
fn normal(form: Form, point: DVec3, direction: DVec3) -> DVec3 {
    let out = match form {
        Form::Sphere(center, radius) => (point - center) / radius,
        Form::Plane(axis, _) => DVec3::AXES[axis],
    };
    if out.dot(direction) < 0.0 { out } else { -out }
}

/// Density 1 - |x| on [-1, 1].
fn tent(u: f64) -> f64 {
    if u < 0.5 {
        (2.0 * u).sqrt() - 1.0
    } else {
        1.0 - (2.0 - 2.0 * u).sqrt()
    }
}

/// A point of the unit circle. The base code's angle is 2 pi u; half a turn more is as even.
fn circle(u: f64) -> (f64, f64) {
    let (sine, cosine) = (2.0 * PI * (u - 0.5)).sin_cos();
    (cosine, sine)
}

/// What one lamp sends to a point by the base code's estimate.
fn light(
    rules: &Rules,
    things: &[Thing],
    lamp: usize,
    point: DVec3,
    normal: DVec3,
    u: [f64; 4],
) -> f64 {
    let Form::Sphere(center, radius) = things[lamp].form else {
        return 0.0;
    };
    let (sine, cosine) = (PI * u[1]).sin_cos();
    let (x, y) = circle(u[0]);
    let apart = center + radius * DVec3::new(sine * x, sine * y, cosine) - point;
    let direction = apart.normalize();
    let up = normal.dot(direction);
    let seen = nearest(things, point, direction).is_some_and(|(met, t)| {
        met == lamp && (rules.object_seen || (t - apart.length()).abs() < 1e-6 * t)
    });
    if !seen || up <= 0.0 {
        return 0.0;
    }
    let ratio = rules.weight_radius * rules.weight_radius / apart.length_squared();
    let solid_angle = 2.0 * PI * (1.0 - (1.0 - ratio).max(0.0).sqrt());
    things[lamp].emission * up * solid_angle / PI
}

/// One hit of a path.
#[derive(Clone, Copy, Debug)]
struct Step {
    thing: usize,
    point: DVec3,
    normal: DVec3,
    /// Sum of the lamps' light, before the surface's colour.
    direct: f64,
    /// The factor of whatever this hit gives, its own colour left out.
    throughput: DVec3,
    /// What it adds to the path's value.
    value: DVec3,
}

fn numbers(key: [u32; 4], vertex: u32, slot: u32) -> [f64; 4] {
    random_unit(key, vertex, slot).map(f64::from)
}

/// Origin and direction of the camera's ray; rows are counted from the bottom.
fn camera_ray(rules: &Rules, pixel: [u32; 2], u: [f64; 4]) -> (DVec3, DVec3) {
    let forward = DVec3::new(0.0, -0.042612, -1.0).normalize();
    let right = DVec3::new(EXTENT, 0.0, 0.0);
    let up = EXTENT * right.cross(forward).normalize();
    let shift = if rules.corner_filter { 0.0 } else { 0.5 };
    let x = f64::from(pixel[0]) + shift + tent(u[0]);
    let y = f64::from(SIDE - 1 - pixel[1]) + shift + tent(u[1]);
    let side = f64::from(SIDE);
    let toward = right * (x / side - 0.5) + up * (y / side - 0.5) + forward;
    (EYE + START * toward, toward.normalize())
}

/// The hits of one path up to the one that ends it.
fn follow(rules: &Rules, things: &[Thing], seed: u64, pixel: [u32; 2], sample: u64) -> Vec<Step> {
    let key = random_key(words(seed), pixel, words(sample));
    let (mut origin, mut direction) = camera_ray(rules, pixel, numbers(key, 0, 0));
    let mut throughput = DVec3::ONE;
    let mut steps = Vec::new();
    for k in 0..=LAST_HIT {
        let Some((thing, t)) = nearest(things, origin, direction) else {
            break;
        };
        let Thing {
            form,
            colour,
            emission,
        } = things[thing];
        let u = numbers(key, k + 1, 0);
        let ends = k >= rules.first_test && u[2] >= colour.max_element();
        if ends && rules.test_before_light {
            break;
        }
        let point = origin + t * direction;
        let normal = normal(form, point, direction);
        let lamps = (0..things.len()).filter(|index| things[*index].emission > 0.0);
        let direct = lamps
            .zip(1..)
            .map(|(lamp, slot)| {
                light(
                    rules,
                    things,
                    lamp,
                    point,
                    normal,
                    numbers(key, k + 1, slot),
                )
            })
            .sum();
        let shines = k == 0 || !rules.emission_at_camera_only;
        let emitted = DVec3::splat(if shines { emission } else { 0.0 });
        let value = throughput * (emitted + colour * direct);
        steps.push(Step {
            thing,
            point,
            normal,
            direct,
            throughput,
            value,
        });
        if ends {
            break;
        }
        throughput *= colour;
        let (x, y) = circle(u[1]);
        let lifted = 2.0 * (u[0] * (1.0 - u[0])).sqrt();
        let ball = DVec3::new(lifted * x, lifted * y, 1.0 - 2.0 * u[0]);
        (origin, direction) = (point, (normal + ball).normalize());
    }
    steps
}

fn value(rules: &Rules, things: &[Thing], seed: u64, pixel: [u32; 2], sample: u64) -> DVec3 {
    let sum: DVec3 = follow(rules, things, seed, pixel, sample)
        .iter()
        .map(|step| step.value)
        .sum();
    if rules.clamp {
        sum.min(DVec3::ONE)
    } else {
        sum
    }
}

fn packed(room: Room) -> Packed {
    let name = match room {
        Room::Simple => "scenes/montelight-simple.toml",
        Room::Complex => "scenes/montelight-complex.toml",
    };
    let text = std::fs::read_to_string(name).unwrap();
    Packed::new(&Scene::parse(name, &text, &[]).unwrap())
}

fn job(packed: &Packed) -> Job {
    let whole = Rect {
        x0: 0,
        y0: 0,
        x1: SIDE,
        y1: SIDE,
    };
    packed.job(whole, 0, 1)
}

/// What lampray makes of a path; as it does before averaging, the clamp comes last.
fn rendered(packed: &Packed, job: &Job, pixel: [u32; 2], sample: u64) -> DVec3 {
    let bodies = lampray::cpu::four::Bodies::new(packed);
    let (radiance, _) = Tracer::new(packed, &bodies, job).sample(pixel, sample);
    radiance
        .as_dvec3()
        .min(DVec3::splat(f64::from(packed.clamp)))
}

#[derive(Debug)]
struct Comparison {
    /// Share of the paths that agree to 1e-3.
    agree: f64,
    /// Mean of each side over all paths.
    ours: f64,
    base: f64,
}

impl Comparison {
    fn holds(&self) -> bool {
        self.agree >= 0.98 && (self.ours / self.base - 1.0).abs() < 0.005
    }
}

/// Compares the paths of `samples` samples of every seventh pixel both ways; not of the uppermost
/// row, whose rays start above the ceiling, at a height that depends on the walls' form.
fn compare(room: Room, rules: &Rules, samples: u64) -> Comparison {
    let packed = packed(room);
    let job = job(&packed);
    let things = things(room, Walls::Planes);
    let pixels = (3..SIDE)
        .step_by(7)
        .flat_map(|y| (0..SIDE).step_by(7).map(move |x| [x, y]));
    let paths: Vec<_> = pixels
        .flat_map(|pixel| (0..samples).map(move |s| (pixel, s)))
        .collect();
    let pairs: Vec<_> = paths
        .into_par_iter()
        .map(|(pixel, sample)| {
            let ours = rendered(&packed, &job, pixel, sample);
            (ours, value(rules, &things, packed.seed, pixel, sample))
        })
        .collect();
    let close = |(ours, base): &&(DVec3, DVec3)| {
        (*ours - *base).abs().max_element() <= 1e-3 * base.max_element().max(1e-6)
    };
    let count = pairs.len() as f64;
    Comparison {
        agree: pairs.iter().filter(close).count() as f64 / count,
        ours: pairs
            .iter()
            .map(|(ours, _)| ours.element_sum())
            .sum::<f64>()
            / count
            / 3.0,
        base: pairs
            .iter()
            .map(|(_, base)| base.element_sum())
            .sum::<f64>()
            / count
            / 3.0,
    }
}

/// The light at the first hit by its formulas: the drawn point, its cone, its cosine.
fn assert_first_light(packed: &Packed, pixel: [u32; 2], sample: u64, first: &Step) {
    let key = random_key(words(packed.seed), pixel, words(sample));
    let u = numbers(key, 1, 1);
    let (polar, around) = (PI * u[1], 2.0 * PI * (u[0] - 0.5));
    let drawn = DVec3::new(
        50.0 + 8.5 * polar.sin() * around.cos(),
        65.1 + 8.5 * polar.sin() * around.sin(),
        81.6 + 8.5 * polar.cos(),
    );
    let far = drawn.distance(first.point);
    let cosine = drawn.z / far;
    let cone = 2.0 * PI * (1.0 - (1.0 - 1.5 * 1.5 / (far * far)).sqrt());
    assert!((first.direct - 400.0 * cosine * cone / PI).abs() < 1e-12);
}

/// One path step by step: where it goes, what each hit adds, and why it ends. lampray's own steps
/// show in what one more allowed bounce adds.
#[test]
fn one_path_by_hand() {
    const PIXEL: [u32; 2] = [180, 120];
    const SAMPLE: u64 = 8;
    // Back wall, ceiling, floor, ceiling, floor, left wall, ceiling; where; its normal; the lamp's light.
    #[rustfmt::skip]
    let expected = [
        (2, [81.215933, 43.279308, 0.0], DVec3::Z, 0.086681561),
        (4, [69.095700, 81.6, 68.018027], DVec3::NEG_Y, 1.160033088),
        (3, [67.255965, 0.0, 133.945760], DVec3::Y, 0.078279355),
        (4, [90.131417, 81.6, 169.253514], DVec3::NEG_Y, 0.014411013),
        (3, [51.133259, 0.0, 97.994925], DVec3::Y, 0.195405399),
        (0, [1.0, 43.937730, 102.070972], DVec3::X, 0.307686313),
        (4, [26.887059, 81.6, 99.222109], DVec3::NEG_Y, 0.335426697),
    ];
    let packed = packed(Room::Simple);
    let things = things(Room::Simple, Walls::Planes);
    let steps = follow(&BASE, &things, packed.seed, PIXEL, SAMPLE);
    assert_eq!(steps.len(), expected.len());
    let mut shorter = job(&packed);
    let mut sum = DVec3::ZERO;
    let mut throughput = DVec3::ONE;
    for ((step, (thing, point, normal, direct)), bounces) in steps.iter().zip(expected).zip(1..) {
        assert_eq!((step.thing, step.normal), (thing, normal));
        let at = format!("{step:?}");
        assert!((step.point - DVec3::from(point)).length() < 1e-5, "{at}");
        assert!((step.direct - direct).abs() < 1e-8, "{at}");
        assert_eq!(step.throughput, throughput, "{at}");
        throughput *= things[thing].colour;
        sum += step.value;
        shorter.max_bounces = bounces;
        let bodies = lampray::cpu::four::Bodies::new(&packed);
        let (ours, _) = Tracer::new(&packed, &bodies, &shorter).sample(PIXEL, SAMPLE);
        assert!(
            (ours.as_dvec3() - sum).abs().max_element() < 1e-4 * sum.max_element(),
            "{at}: {ours}"
        );
    }
    assert_first_light(&packed, PIXEL, SAMPLE, &steps[0]);
    let key = random_key(words(packed.seed), PIXEL, words(SAMPLE));
    // Hits 5 and 6 pass the test against the largest colour, 0.75; hit 7 does not, and its light is lost.
    let tests = [5, 6, 7].map(|k| numbers(key, k + 1, 0)[2] < 0.75);
    assert_eq!(tests, [true, true, false]);
    let whole = rendered(&packed, &job(&packed), PIXEL, SAMPLE);
    assert!((whole - sum).abs().max_element() < 1e-4 * sum.max_element());
}

/// A path of 32-bit floats parts from its 64-bit twin where it grazes an edge: a shadow ray the
/// limb of a ball or of the lamp, a bounce the corner of two walls. That is rare, and as often up as
/// down.
#[test]
fn paths_give_the_base_codes_numbers() {
    for room in [Room::Simple, Room::Complex] {
        let result = compare(room, &BASE, 4);
        println!("{room:?}: {result:?}");
        assert!(result.holds(), "{room:?}: {result:?}");
    }
}

#[test]
fn each_rule_matters() {
    let mutants = [
        (
            "the test stands after direct light",
            Rules {
                test_before_light: false,
                ..BASE
            },
        ),
        (
            "the cone is the lamp's own",
            Rules {
                weight_radius: 8.5,
                ..BASE
            },
        ),
        (
            "no clamp",
            Rules {
                clamp: false,
                ..BASE
            },
        ),
        (
            "the filter stands on the pixel's middle",
            Rules {
                corner_filter: false,
                ..BASE
            },
        ),
        (
            "the drawn point must be seen",
            Rules {
                object_seen: false,
                ..BASE
            },
        ),
        (
            "lamps shine at every hit",
            Rules {
                emission_at_camera_only: false,
                ..BASE
            },
        ),
        (
            "the test begins a hit later",
            Rules {
                first_test: 6,
                ..BASE
            },
        ),
    ];
    for (name, rules) in mutants {
        let result = compare(Room::Simple, &rules, 1);
        println!("{name}: {result:?}");
        assert!(!result.holds(), "{name}: {result:?}");
    }
}

/// Sums of one channel over the paths of a block of pixels: of the base code's values, of the
/// differences to them, and of the squared differences.
#[derive(Clone, Copy, Default)]
struct Block {
    base: DVec3,
    apart: DVec3,
    squares: DVec3,
}

const BLOCK: u32 = 16;

/// The base code with its walls as spheres against lampray with boxes, the same random numbers on
/// both sides: how far the means of blocks of 16 x 16 pixels are apart, and the standard error of that.
fn block(room: Room, corner: [u32; 2], samples: u64) -> Block {
    let packed = packed(room);
    let job = job(&packed);
    let things = things(room, Walls::Spheres);
    let mut sums = Block::default();
    for pixel in 0..BLOCK * BLOCK {
        let pixel = [corner[0] + pixel % BLOCK, corner[1] + pixel / BLOCK];
        for sample in 0..samples {
            let base = value(&BASE, &things, packed.seed, pixel, sample);
            let apart = rendered(&packed, &job, pixel, sample) - base;
            sums.base += base;
            sums.apart += apart;
            sums.squares += apart * apart;
        }
    }
    sums
}

/// Relative distance of each block's channels and its standard error.
fn blocks_apart(room: Room, samples: u64) -> Vec<(f64, f64)> {
    let corners: Vec<_> = (0..SIDE)
        .step_by(BLOCK as usize)
        .flat_map(|y| (0..SIDE).step_by(BLOCK as usize).map(move |x| [x, y]))
        .collect();
    let count = f64::from(BLOCK * BLOCK) * samples as f64;
    let blocks = corners
        .into_par_iter()
        .map(|corner| block(room, corner, samples));
    let channels = |block: Block| {
        let mean = block.apart / count;
        let spread = (block.squares / count - mean * mean) / count;
        let base = block.base / count;
        [0, 1, 2].map(|c| (mean[c] / base[c], spread[c].max(0.0).sqrt() / base[c]))
    };
    blocks.flat_map_iter(channels).collect()
}

/// At the ends of the room boxes and spheres differ by some hundredths of a unit.
#[test]
fn boxes_stand_for_the_base_codes_wall_spheres() {
    let samples = std::env::var("MONTELIGHT_SAMPLES").map_or(4, |text| text.parse().unwrap());
    for room in [Room::Simple, Room::Complex] {
        let apart = blocks_apart(room, samples);
        let count = apart.len() as f64;
        let mean = apart.iter().map(|(apart, _)| apart).sum::<f64>() / count;
        let error = (apart.iter().map(|(_, error)| error * error).sum::<f64>()).sqrt() / count;
        let largest = apart
            .iter()
            .map(|(apart, _)| apart.abs())
            .fold(0.0, f64::max);
        let surely = |(apart, error): &(f64, f64)| apart.abs() - 4.5 * error;
        let beyond = apart.iter().map(surely).fold(0.0, f64::max);
        println!(
            "{room:?}, {samples} samples: mean {:.4} % +- {:.4} %, largest {:.3} %, surely {:.3} %, typical error {:.3} %",
            100.0 * mean,
            100.0 * error,
            100.0 * largest,
            100.0 * beyond,
            100.0 * error * count.sqrt()
        );
        assert!(
            beyond < 0.005,
            "{room:?}: a block is {beyond} beyond its noise"
        );
        assert!(
            mean.abs() < 0.001 + 4.5 * error,
            "{room:?}: all blocks are {mean} apart"
        );
    }
}
