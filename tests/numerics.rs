//! What rounding must not do: surfaces that shadow or light themselves, closed boxes that leak,
//! distances that lose their digits, and samples that are not numbers.

mod support;

use glam::{DMat3, DVec3, Vec3};
use lampray::cpu::Cpu;
use lampray::cpu::ray::{Ray, offset_origin};
use lampray::cpu::scene::{nearest_hit, surface_at};
use lampray::cpu::sphere::intersect_sphere;
use lampray::device::Device;
use lampray::pack::{Cuboid, Packed, Rect, Sphere, Tally};
use lampray::scene::Scene;
use support::stream::Stream;

const HEAD: &str = r#"
version = 1
[camera]
position = [0.0, 0.0, 0.0]
look_at = [0.3, -0.2, -1.0]
fov = 120.0
[image]
width = 16
height = 16
[render]
samples = 16
max_bounces = 20
[interruption]
rule = "none"
[materials.white]
albedo = [1.0, 1.0, 1.0]
[materials.lamp]
albedo = [0.0, 0.0, 0.0]
emission = [1e6, 1e6, 1e6]
"#;

fn packed(text: &str) -> Packed {
    let scene = Scene::parse("test.toml", &(HEAD.to_string() + text), &[]);
    Packed::new(&scene.unwrap_or_else(|e| panic!("{e}")))
}

/// A scene of one body, to be put in by hand.
fn empty() -> Packed {
    packed("[background]\nemission = [1.0, 1.0, 1.0]\n")
}

fn one_sphere(center: DVec3, radius: f64) -> Packed {
    let mut scene = empty();
    scene.spheres = vec![Sphere {
        center: center.as_vec3().to_array(),
        radius: radius as f32,
        ..Sphere::default()
    }];
    scene.strategy.sphere_count = 1;
    scene
}

fn one_box(center: DVec3, half: DVec3, axes: DMat3) -> Packed {
    let mut scene = empty();
    scene.boxes = vec![Cuboid {
        center: center.as_vec3().to_array(),
        half_size: half.as_vec3().to_array(),
        id: 1,
        axis_x: axes.x_axis.as_vec3().to_array(),
        axis_y: axes.y_axis.as_vec3().to_array(),
        axis_z: axes.z_axis.as_vec3().to_array(),
        ..Cuboid::default()
    }];
    scene.strategy.rotated_box_count = 1;
    scene
}

fn vector(stream: &mut Stream) -> DVec3 {
    DVec3::from_array(stream.direction())
}

/// A body of some size and how far it reaches, at up to 1e4 times its size from the eye.
fn body(stream: &mut Stream, number: usize) -> (Packed, DVec3, f64) {
    let size = stream.scale(1e-4, 1e4);
    let center = vector(stream) * size * stream.scale(1e-2, 1e4);
    if number.is_multiple_of(2) {
        return (one_sphere(center, size), center, size);
    }
    let half = DVec3::new(
        size,
        size * stream.unit().max(0.05),
        size * stream.unit().max(0.05),
    );
    let (z, turn) = (vector(stream), stream.between(0.0, std::f64::consts::TAU));
    let (x, y) = z.any_orthonormal_pair();
    let (sine, cosine) = turn.sin_cos();
    let axes = DMat3::from_cols(cosine * x + sine * y, cosine * y - sine * x, z);
    (one_box(center, half, axes), center, half.min_element())
}

fn ray(from: DVec3, to: DVec3) -> Ray {
    let origin = from.as_vec3();
    Ray {
        origin,
        direction: (to - origin.as_dvec3()).normalize().as_vec3(),
        source: 0,
        inside: false,
    }
}

/// What became of rays that leave a surface they hit.
#[derive(Debug, Default)]
struct Outcome {
    rays: usize,
    /// Left on the outside and met the body again.
    self_hits: usize,
    /// Left on the inside and got out.
    leaks: usize,
    /// Left on the inside and met a place that is not on the body.
    strays: usize,
}

/// How far a point is from a body's surface, exactly.
fn off_surface(scene: &Packed, point: DVec3) -> f64 {
    if let Some(sphere) = scene.spheres.first() {
        let center = Vec3::from(sphere.center).as_dvec3();
        return (point.distance(center) - f64::from(sphere.radius)).abs();
    }
    let shape = &scene.boxes[0];
    let [x, y, z] = [shape.axis_x, shape.axis_y, shape.axis_z].map(|v| Vec3::from(v).as_dvec3());
    let from = point - Vec3::from(shape.center).as_dvec3();
    let local = DVec3::new(x.dot(from), y.dot(from), z.dot(from));
    let past = local.abs() - Vec3::from(shape.half_size).as_dvec3();
    past.max_element().abs()
}

/// Follows one ray to a body, and from there onwards on the same side.
fn follow(scene: &Packed, first: &Ray, stream: &mut Stream, rounding: f64, outcome: &mut Outcome) {
    let hit = nearest_hit(scene, first);
    if hit.body == 0 {
        return;
    }
    let surface = surface_at(scene, hit, first);
    let normal = surface.normal.as_dvec3();
    let any = vector(stream);
    let out = if any.dot(normal) < 0.0 { -any } else { any };
    let next = Ray {
        origin: offset_origin(surface.point, surface.normal),
        direction: out.as_vec3(),
        source: surface.body,
        inside: surface.inside,
    };
    let again = nearest_hit(scene, &next);
    outcome.rays += 1;
    match (surface.inside, again.body) {
        (false, 0) => {}
        (false, _) => outcome.self_hits += 1,
        (true, 0) => outcome.leaks += 1,
        (true, _) => {
            let point = surface_at(scene, again, &next).point.as_dvec3();
            outcome.strays += usize::from(off_surface(scene, point) > rounding);
        }
    }
}

fn outcome() -> Outcome {
    let mut stream = Stream::new(31);
    let mut outcome = Outcome::default();
    for number in 0..1000 {
        let (scene, center, reach) = body(&mut stream, number);
        // A few units in the last place of the coordinates, once for each of the sums.
        let rounding = 1e-6 * (center.length() + 10.0 * reach);
        for place in 0..400 {
            let inner = center + vector(&mut stream) * reach * 0.9 * stream.unit();
            let from = match place % 2 {
                0 => center + vector(&mut stream) * reach * stream.scale(30.0, 1e3),
                _ => center + vector(&mut stream) * reach * 0.5,
            };
            follow(
                &scene,
                &ray(from, inner),
                &mut stream,
                rounding,
                &mut outcome,
            );
        }
    }
    outcome
}

#[test]
fn no_surface_meets_itself() {
    let outcome = outcome();
    println!("{outcome:?}");
    assert!(outcome.rays > 300_000, "{outcome:?}");
    assert_eq!(
        (outcome.self_hits, outcome.leaks, outcome.strays),
        (0, 0, 0),
        "{outcome:?}"
    );
}

#[test]
fn without_its_source_a_ray_does_meet_its_surface() {
    // The gate above can fail: rays that forget where they start meet it at once, now and then.
    let mut stream = Stream::new(32);
    let (mut met, mut rays) = (0, 0);
    for number in 0..100 {
        let (scene, center, reach) = body(&mut stream, number);
        for _ in 0..400 {
            let first = ray(center + vector(&mut stream) * reach * 100.0, center);
            let hit = nearest_hit(&scene, &first);
            if hit.body == 0 {
                continue;
            }
            let surface = surface_at(&scene, hit, &first);
            let any = vector(&mut stream).as_vec3();
            let direction = if any.dot(surface.normal) < 0.0 {
                -any
            } else {
                any
            };
            let next = Ray {
                origin: surface.point,
                direction,
                source: 0,
                inside: false,
            };
            rays += 1;
            met += usize::from(nearest_hit(&scene, &next).body != 0);
        }
    }
    assert!(met * 100 > rays, "{met} of {rays}");
}

/// The four walls, floor and ceiling of a room of half size 1 around the origin, moved and scaled.
/// `overlap` is how far the slabs reach past each other's edges.
fn room(scale: f64, middle: DVec3, turn: f64, overlap: f64) -> String {
    let mut text = String::new();
    let angle = turn.to_radians();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let mut center = DVec3::ZERO;
            center[axis] = side * 1.1;
            let mut half = DVec3::splat(1.0 + overlap);
            half[axis] = 0.1;
            // A slab turns about its own middle, so that its middle turns about the room's.
            let turned = DMat3::from_rotation_y(angle) * center;
            let (low, high) = (
                (turned - half) * scale + middle,
                (turned + half) * scale + middle,
            );
            text += &format!(
                "[[boxes]]\nmin = {:?}\nmax = {:?}\nrotation = [0.0, {turn:?}, 0.0]\nmaterial = \"white\"\n",
                low.to_array(),
                high.to_array()
            );
        }
    }
    text
}

const LAMP_OUTSIDE: &str =
    "[[spheres]]\ncenter = [0.0, 3e4, 0.0]\nradius = 1e4\nmaterial = \"lamp\"\n";
const SKY: &str = "[background]\nemission = [1e6, 1e6, 1e6]\n";

/// Closed spaces around the camera, bright outside and black within.
fn closed() -> Vec<(String, Packed)> {
    let mut all = Vec::new();
    for scale in [1e-3, 1.0, 1e3] {
        for middle in [DVec3::ZERO, DVec3::new(0.4, -0.5, 0.6) * scale] {
            for (turn, overlap) in [(0.0, 0.2), (0.0, 0.1), (30.0, 0.2)] {
                let name = format!("room {scale} {middle} {turn} {overlap}");
                all.push((
                    name,
                    SKY.to_string() + &room(scale, middle, turn, overlap) + LAMP_OUTSIDE,
                ));
            }
            for turn in [0.0, 33.0] {
                let (low, high) = (middle - DVec3::ONE * scale, middle + DVec3::ONE * scale);
                let text = format!(
                    "[[boxes]]\nmin = {:?}\nmax = {:?}\nrotation = [0.0, {turn:?}, 0.0]\nmaterial = \"white\"\n",
                    low.to_array(),
                    high.to_array()
                );
                all.push((
                    format!("box {scale} {middle} {turn}"),
                    SKY.to_string() + &text + LAMP_OUTSIDE,
                ));
            }
            let text = format!(
                "[[spheres]]\ncenter = {:?}\nradius = {:?}\nmaterial = \"white\"\n",
                middle.to_array(),
                1.8 * scale
            );
            all.push((
                format!("sphere {scale} {middle}"),
                SKY.to_string() + &text + LAMP_OUTSIDE,
            ));
        }
    }
    all.into_iter()
        .map(|(name, text)| (name, packed(&text)))
        .collect()
}

const IMAGE: Rect = Rect {
    x0: 0,
    y0: 0,
    x1: 16,
    y1: 16,
};

fn trace(device: &mut dyn Device, scene: &Packed) -> Vec<Tally> {
    device.load(scene).unwrap();
    device.trace(IMAGE, 0, 16).unwrap()
}

fn nothing_leaks(device: &mut dyn Device) {
    for (name, scene) in closed() {
        let tallies = trace(device, &scene);
        let lit = tallies
            .iter()
            .filter(|tally| tally.mean != [0.0; 3])
            .count();
        let rays: u32 = tallies.iter().map(|tally| tally.rays).sum();
        assert_eq!(lit, 0, "{name}: pixels with light from outside");
        assert!(
            rays > 16 * 16 * 16 * 20,
            "{name}: paths end early, after {rays} rays"
        );
    }
}

#[test]
fn closed_spaces_are_dark() {
    nothing_leaks(&mut Cpu::new());
    if let Some(mut gpu) = support::gpu("light that leaks into closed spaces") {
        nothing_leaks(&mut *gpu);
    }
}

#[test]
fn a_gap_is_seen() {
    // Slabs that stop short of each other's edges by a thousandth let light in.
    let text = SKY.to_string() + &room(1.0, DVec3::ZERO, 0.0, -0.001) + LAMP_OUTSIDE;
    let lit = trace(&mut Cpu::new(), &packed(&text));
    assert!(lit.iter().any(|tally| tally.mean != [0.0; 3]));
}

/// Worst error of the near distance of rays aimed within 0.95 radii, in radii, by distance.
fn accuracy(distance: f64) -> (f64, usize) {
    let mut stream = Stream::new(33);
    let (mut worst, mut missed) = (0f64, 0);
    for _ in 0..20_000 {
        let (from, rim) = (vector(&mut stream) * distance, vector(&mut stream));
        let across = rim - from.normalize() * rim.dot(from.normalize());
        let ray = ray(from, across.normalize() * 0.95 * stream.unit().sqrt());
        let crossing = intersect_sphere(Vec3::ZERO, 1.0, &ray);
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3().normalize());
        let along = -origin.dot(direction);
        let off = (origin + along * direction).length_squared();
        missed += usize::from(!crossing.met);
        if crossing.met && off < 0.99 {
            let near = along - (1.0 - off).sqrt();
            worst = worst.max((f64::from(crossing.near) - near).abs());
        }
    }
    (worst, missed)
}

#[test]
fn spheres_far_away_are_still_met() {
    // By rounding alone the distance is off by about distance / 2^24; the bounds are about twice
    // what was seen. The textbook's b^2 - 4ac is off by half a radius at 1e3.
    for (distance, bound) in [
        (2.0, 2e-6),
        (10.0, 5e-6),
        (1e2, 5e-5),
        (1e3, 5e-4),
        (1e4, 5e-3),
        (1e5, 6e-2),
    ] {
        let (worst, missed) = accuracy(distance);
        println!("distance {distance:e}: worst {worst:.1e} radii, {missed} missed");
        assert!(
            worst < bound && missed == 0,
            "{distance:e}: {worst:e}, {missed} missed"
        );
    }
}

const PAIR: &str = "[background]\nemission = [1e12, 1e12, 1e12]\n\
    [[spheres]]\ncenter = [0.3, -0.2, -3.0]\nradius = 1.0\nmaterial = \"white\"\n\
    [[spheres]]\ncenter = [0.0, 2.5, -3.0]\nradius = 0.5\nmaterial = \"lamp\"\n";

#[test]
fn the_brightest_legal_scene_stays_finite() {
    let check = |device: &mut dyn Device| {
        let text = PAIR.to_string();
        let mut scene = packed(&text);
        // The largest emission that a scene may ask for.
        scene
            .materials
            .iter_mut()
            .filter(|m| m.emission[0] > 0.0)
            .for_each(|m| m.emission = [1e12; 3]);
        scene
            .lamps
            .iter_mut()
            .for_each(|lamp| lamp.emission = [1e12; 3]);
        for tally in trace(device, &scene) {
            assert!(
                tally
                    .mean
                    .iter()
                    .chain(&tally.squares)
                    .all(|x| x.is_finite()),
                "{tally:?}"
            );
            assert_eq!(tally.non_finite, 0);
        }
    };
    check(&mut Cpu::new());
    if let Some(mut gpu) = support::gpu("the brightest scene") {
        check(&mut *gpu);
    }
}

/// Samples that are not numbers: how many of each pixel's 16, and the first one's place.
fn faults(device: &mut dyn Device, emission: f32) -> Vec<u32> {
    let mut scene = packed(PAIR);
    // No scene file can ask for this, so it is put in behind the parser's back.
    scene.background = [emission, 1.0, 1.0];
    let tallies = trace(device, &scene);
    for (pixel, tally) in tallies.iter().enumerate() {
        assert!(
            tally.mean.iter().all(|x| x.is_finite()),
            "{pixel}: {tally:?}"
        );
        let (count, first) = (tally.non_finite & 0xffff, tally.non_finite >> 16);
        assert!(count <= 16 && first < 16);
        if pixel.is_multiple_of(37) {
            let (x0, y0) = (pixel as u32 % 16, pixel as u32 / 16);
            let (x1, y1) = (x0 + 1, y0 + 1);
            let at = Rect { x0, y0, x1, y1 };
            let single = |sample| device.trace(at, sample, 1).unwrap()[0].non_finite;
            let each: Vec<_> = (0..16).map(single).collect();
            assert_eq!(count, each.iter().sum::<u32>(), "{pixel}");
            let found = each.iter().position(|fault| *fault == 1).unwrap_or(0);
            assert_eq!(first as usize, found, "{pixel}");
        }
    }
    tallies.iter().map(|tally| tally.non_finite).collect()
}

#[test]
fn samples_that_are_not_numbers_are_counted_and_black() {
    for emission in [f32::INFINITY, f32::NAN, -f32::INFINITY] {
        let ours = faults(&mut Cpu::new(), emission);
        let total: u32 = ours.iter().map(|fault| fault & 0xffff).sum();
        assert!(total > 500, "{emission}: {total}");
        assert!(faults(&mut Cpu::new(), 1.0).iter().all(|fault| *fault == 0));
        if let Some(mut gpu) = support::gpu("samples that are not numbers") {
            let theirs = faults(&mut *gpu, emission);
            let differing = ours.iter().zip(&theirs).filter(|(a, b)| a != b).count();
            assert!(
                differing * 100 <= ours.len(),
                "{emission}: {differing} pixels count otherwise"
            );
        }
    }
}
