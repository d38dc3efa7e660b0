//! Glass: a clear body under an even sky cannot be seen; a slab passes and reflects what the sum over its
//! inner reflections says; and in an enclosure that shines evenly every surface looks the same.

use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};

const SKY: [f64; 3] = [0.9, 1.3, 0.1];

const BALL: &str = "spheres = [{ center = [0.1, 0.2, -4.0], radius = 1.3, material = \"glass\" }]";
const TURNED_BOX: &str = "boxes = [{ min = [-0.8, -0.8, -5.0], max = [1.1, 0.9, -3.4], rotation = [30.0, 20.0, -50.0], material = \"glass\" }]";
/// A core about the same middle: a ray leaves at the angle at which it came, by no total reflection.
const NESTED: &str = "spheres = [
    { center = [0.1, 0.2, -4.0], radius = 1.3, material = \"glass\" },
    { center = [0.1, 0.2, -4.0], radius = 0.7, material = \"core\" }]";

/// Paths are long enough to leave: a ray that stays in a ball of glass does so at the grazing angles of
/// very few.
fn clear(bodies: &str, index: f64, eye: &str) -> Case {
    let scene = format!(
        "version = 1
        camera = {{ position = {eye}, look_at = [0.1, 0.2, -4.4], fov = 50 }}
        image = {{ width = 32, height = 32 }}
        render = {{ max_bounces = 400 }}
        background = {{ emission = {SKY:?} }}
        {bodies}
        [materials.glass]
        scatter = \"glass\"
        index = {index}
        albedo = [1.0, 1.0, 1.0]
        [materials.core]
        scatter = \"glass\"
        index = 1.9
        albedo = [1.0, 1.0, 1.0]"
    );
    Case::new(
        format!("clear glass {index} {bodies}"),
        scene,
        Form::Constant(SKY),
    )
    .set("interruption.rule", "none")
}

const OUTSIDE: &str = "[0.3, 0.4, 0.0]";
const INSIDE: &str = "[0.2, 0.3, -3.6]";

#[test]
fn a_clear_body_under_an_even_sky_cannot_be_seen() {
    let mut family = Family::new("clear bodies", 63_000);
    for bench in benches() {
        for bodies in [BALL, TURNED_BOX, NESTED] {
            for (index, strategy) in [(1.0, "mis"), (1.33, "hit"), (1.5, "mis"), (2.4, "sample")] {
                let case = clear(bodies, index, OUTSIDE).set("light.strategy", strategy);
                family.check(bench, &case.set("camera.aperture", 0.2));
            }
        }
        // From inside it is radiance over the index squared that is seen.
        for bodies in [BALL, NESTED] {
            family.check(bench, &clear(bodies, 1.5, INSIDE));
        }
    }
    family.finish();
}

/// A closed room whose walls shine: after enough reflections e / (1 - rho), clear glass in it or not; and
/// where glass shines and absorbs as the walls do, the sum of n + 1 terms after n reflections.
fn room(glass: &str, max_bounces: u32, form: Form) -> Case {
    let scene = format!(
        "version = 1
        camera = {{ position = [0.3, -0.1, 0.2], look_at = [1.0, 0.5, -0.4], fov = 100 }}
        image = {{ width = 32, height = 32 }}
        render = {{ max_bounces = {max_bounces} }}
        background = {{ emission = [1000.0, 1000.0, 1000.0] }}
        boxes = [
            {{ min = [-1.0, -0.7, -1.3], max = [1.2, 0.9, 1.1], material = \"wall\" }},
            {{ min = [-0.9, -0.6, -0.9], max = [-0.5, 0.1, -0.4], rotation = [0.0, 25.0, 10.0], material = \"glass\" }}]
        spheres = [
            {{ center = [0.7, 0.3, -0.4], radius = 0.3, material = \"glass\" }},
            {{ center = [0.1, -0.3, 0.7], radius = 0.35, material = \"glass\" }}]
        [materials.wall]
        albedo = [0.3, 0.2, 0.1]
        emission = {SKY:?}
        [materials.glass]
        scatter = \"glass\"
        {glass}"
    );
    Case::new(format!("room, {max_bounces} bounces, {glass}"), scene, form)
        .set("light.strategy", "hit")
        .set("interruption.rule", "none")
}

const RHO: [f64; 3] = [0.3, 0.2, 0.1];

fn partial(max_bounces: u32) -> [f64; 3] {
    let sum = |rho: f64| (0..max_bounces).fold(1.0, |sum, _| 1.0 + rho * sum);
    [0, 1, 2].map(|channel| SKY[channel] * sum(RHO[channel]))
}

#[test]
fn a_closed_room_with_glass_keeps_its_closed_form() {
    let mut family = Family::new("rooms with glass", 64_000);
    let shining = format!("albedo = {RHO:?}\nemission = {SKY:?}");
    for bench in benches() {
        // Clear glass that is entered at a grazing angle keeps a few rays for too long.
        let clear = "albedo = [1.0, 1.0, 1.0]";
        family.check(bench, &room(clear, 400, Form::Mean(partial(400))));
        for max_bounces in [0, 1, 2, 5, 40] {
            let truth = Form::Constant(partial(max_bounces));
            family.check(bench, &room(&shining, max_bounces, truth));
        }
    }
    family.finish();
}

/// Share that one face reflects, from the angles of both sides (Fresnel's sines and tangents).
fn reflectance(away: f64, index: f64) -> f64 {
    let beyond = (away.sin() / index).asin();
    let (difference, sum) = (away - beyond, away + beyond);
    let across = (difference.sin() / sum.sin()).powi(2);
    let along = (difference.tan() / sum.tan()).powi(2);
    0.5 * (across + along)
}

/// A slab before a wall that shines, seen at an angle from its normal. Of the light 1 - R enters and R
/// stays at each inner reflection; each event keeps the albedo A: with q = A R,
/// A^2 (1 - R)^2 / (1 - q^2) goes through, and q + A q (1 - R)^2 A / (1 - q^2) back.
fn slab(degrees: f64, index: f64, albedo: f64) -> Case {
    let away = degrees.to_radians();
    let r = reflectance(away, index);
    let q = albedo * r;
    let inner = (albedo * (1.0 - r)).powi(2) / (1.0 - q * q);
    let wall = [0.2, 0.7, 2.0];
    let truth = [0, 1, 2].map(|c| wall[c] * inner + SKY[c] * (q + q * inner));
    let scene = format!(
        "version = 1
        camera = {{ position = [{x}, {y}, 0.0], look_at = [0.0, 0.0, 0.0], up = [0.0, 0.0, 1.0], fov = 0.02 }}
        image = {{ width = 32, height = 32 }}
        render = {{ max_bounces = 64 }}
        background = {{ emission = {SKY:?} }}
        boxes = [
            {{ min = [-60.0, -1.0, -60.0], max = [60.0, 0.0, 60.0], material = \"glass\" }},
            {{ min = [-400.0, -3.0, -400.0], max = [400.0, -2.0, 400.0], material = \"wall\" }}]
        [materials.glass]
        scatter = \"glass\"
        index = {index}
        albedo = [{albedo}, {albedo}, {albedo}]
        [materials.wall]
        albedo = [0.0, 0.0, 0.0]
        emission = {wall:?}",
        x = 3.0 * away.sin(),
        y = 3.0 * away.cos(),
    );
    Case::new(
        format!("slab {index} {albedo} at {degrees} degrees"),
        scene,
        Form::Mean(truth),
    )
}

#[test]
fn a_slab_passes_and_reflects_by_the_sum_of_its_reflections() {
    let mut family = Family::new("slabs", 65_000);
    for bench in benches() {
        for (index, albedo) in [(1.5, 1.0), (1.33, 0.9), (2.4, 0.8)] {
            for degrees in [0.5, 40.0, 57.0, 75.0] {
                family.check(bench, &slab(degrees, index, albedo));
            }
        }
    }
    family.finish();
}

#[test]
fn the_gates_reject_small_faults() {
    let mut family = Family::new("glass, mutants", 66_000);
    for bench in benches() {
        let ball = clear(BALL, 1.5, OUTSIDE);
        family.reject(
            bench,
            &ball.clone().set("materials.glass.albedo", "[1, 1, 0.9999]"),
        );
        family.reject(bench, &ball.set("render.max_bounces", 3));
        let slab = slab(57.0, 1.5, 1.0);
        family.reject(bench, &slab.clone().set("materials.glass.index", 1.53));
        family.reject(
            bench,
            &slab
                .clone()
                .set("materials.glass.albedo", "[0.995, 0.995, 0.995]"),
        );
        family.reject(bench, &slab.set("render.max_bounces", 1));
    }
}
