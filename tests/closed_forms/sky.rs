//! Lone bodies under an even sky, what a camera sees directly, and an empty scene.

use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};
use crate::support::quadrature::{erf, integrate};
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

const SKY: [f32; 3] = [0.9, 1.3, 0.1];
const ALBEDO: [f32; 3] = [0.83, 0.4, 0.17];

const SPHERE: &str = "spheres = [{ center = [0.3, 0.2, -4.0], radius = 1.5, material = \"body\" }]";
const TURNED_BOX: &str = "boxes = [{ min = [-1.7, -1.8, -6.0], max = [2.3, 2.2, -2.0], rotation = [30.0, 20.0, -50.0], material = \"body\" }]";

/// A camera that sees nothing but the body in the middle of the picture.
fn view(shape: &str, scatter: &str, form: Form) -> Case {
    let scene = format!(
        "version = 1
        camera = {{ position = [0.3, 0.2, 0.0], look_at = [0.3, 0.2, -4.0], fov = 25 }}
        image = {{ width = 32, height = 32 }}
        background = {{ emission = {SKY:?} }}
        {shape}
        [materials.body]
        scatter = \"{scatter}\"
        albedo = {ALBEDO:?}
        survival = 0.9"
    );
    Case::new(format!("{scatter} {shape}"), scene, form)
}

/// One reflection of the sky, in the arithmetic of a device.
fn reflected() -> [f32; 3] {
    [0, 1, 2].map(|channel| ALBEDO[channel] * SKY[channel])
}

#[test]
fn a_convex_body_reflects_its_albedo_exactly() {
    let mut family = Family::new("convex bodies, exact", 12_000);
    for bench in benches() {
        for shape in [SPHERE, TURNED_BOX] {
            for scatter in ["diffuse", "mirror"] {
                for (max_bounces, strategy) in [(1, "sample"), (8, "mis"), (2, "hit")] {
                    let case = view(shape, scatter, Form::Bits(reflected()))
                        .set("render.max_bounces", max_bounces)
                        .set("light.strategy", strategy)
                        .set("interruption.rule", "none");
                    family.check(bench, &case);
                }
                let dark = view(shape, scatter, Form::Bits([0.0; 3]));
                family.check(bench, &dark.set("render.max_bounces", 0));
            }
        }
    }
    family.finish();
}

#[test]
fn a_convex_body_reflects_its_albedo_on_average() {
    let mut family = Family::new("convex bodies, noisy", 13_000);
    let truth = Form::Mean(reflected().map(f64::from));
    for bench in benches() {
        for shape in [SPHERE, TURNED_BOX] {
            let case = view(shape, "diffuse", truth);
            family.check(bench, &case.clone().set("scatter.diffuse", "uniform"));
            let interrupted = case.set("interruption.start", 0);
            for rule in ["survival", "albedo", "throughput"] {
                family.check(bench, &interrupted.clone().set("interruption.rule", rule));
            }
        }
    }
    family.finish();
}

/// Share of the half-normal lobe that falls below the surface, for a mirror direction at `away` from
/// the normal: of the ring at angle t, acos(cot t cot away) / pi. A clamp piles the law's tail up
/// on the ring at a right angle, half of which is below; truncation leaves it out.
fn below(spread: f64, away: f64, clamp: bool) -> f64 {
    let inside = erf(FRAC_PI_2 / (SQRT_2 * spread));
    let law = |t: f64| (2.0 / PI).sqrt() / spread * (-0.5 * (t / spread).powi(2)).exp();
    // t = start + x^2 smooths the root at the angle that touches the horizon.
    let start = FRAC_PI_2 - away;
    let ring = |x: f64| {
        let t = start + x * x;
        let share = (1.0 / (t.tan() * away.tan())).clamp(-1.0, 1.0).acos() / PI;
        2.0 * x * law(t) * share
    };
    let mass = integrate(0.0, away.sqrt(), 200, ring);
    if clamp {
        mass + 0.5 * (1.0 - inside)
    } else {
        mass / inside
    }
}

#[test]
fn the_lobe_s_share_below_is_known() {
    let known = [
        (0.1, 85.0, 0.098),
        (0.2, 75.0, 0.041),
        (0.3, 60.0, 0.016),
        (0.5, 45.0, 0.028),
        (1.0, 30.0, 0.062),
        (1.0, 85.0, 0.403),
    ];
    for (spread, degrees, share) in known {
        let found = below(spread, f64::to_radians(degrees), false);
        assert!(
            (found - share).abs() < 0.0006,
            "{spread} {degrees}: {found}"
        );
    }
}

/// A directional face seen at one angle from its normal: a pinhole so narrow that there is no other.
fn lobe(shape: &str, spread: f64, degrees: f64, bound: &str) -> Case {
    let away = degrees.to_radians();
    let (x, y) = (3.0 * away.sin(), 3.0 * away.cos());
    let share = 1.0 - below(spread, away, bound == "clamp");
    let truth = reflected().map(|value| f64::from(value) * share);
    let scene = format!(
        "version = 1
        camera = {{ position = [{x}, {y}, 0.0], look_at = [0.0, 0.0, 0.0], up = [0.0, 0.0, 1.0], fov = 0.02 }}
        image = {{ width = 32, height = 32 }}
        background = {{ emission = {SKY:?} }}
        {shape}
        [materials.body]
        scatter = \"directional\"
        spread = {spread}
        albedo = {ALBEDO:?}"
    );
    Case::new(
        format!("lobe at {degrees} degrees"),
        scene,
        Form::Mean(truth),
    )
    .set("scatter.bound", bound)
}

/// Both have a normal along y at the origin.
const BALL: &str = "spheres = [{ center = [0.0, -2.0, 0.0], radius = 2.0, material = \"body\" }]";
const FACE: &str =
    "boxes = [{ min = [-1.0, -0.4, -1.0], max = [1.0, 0.0, 1.0], material = \"body\" }]";

#[test]
fn a_directional_body_loses_what_falls_below_it() {
    let mut family = Family::new("directional bodies", 14_000);
    let angles = [20.0, 45.0, 60.0, 75.0, 85.0];
    for bench in benches() {
        for (s, spread) in [0.1, 0.3, 0.6, 1.0, 3.0].into_iter().enumerate() {
            for (a, degrees) in angles.into_iter().enumerate() {
                let even = (s + a + bench as usize).is_multiple_of(2);
                let shape = if even { BALL } else { FACE };
                let bound = ["truncate", "clamp"][(s + a / 2) % 2];
                family.check(bench, &lobe(shape, spread, degrees, bound));
            }
        }
    }
    family.finish();
}

/// A black ball over a wide floor takes (R / d)^2 h / d of the sky, d^2 = h^2 + x^2.
fn shaded(height: f64, radius: f64, x: f64) -> Case {
    let scene = format!(
        "version = 1
        camera = {{ position = [{}, 0.5, 0.0], look_at = [{x}, 0.0, 0.0], fov = 0.02 }}
        image = {{ width = 32, height = 32 }}
        background = {{ emission = {SKY:?} }}
        spheres = [{{ center = [0.0, {height}, 0.0], radius = {radius}, material = \"black\" }}]
        boxes = [{{ min = [-50.0, -1.0, -50.0], max = [50.0, 0.0, 50.0], material = \"floor\" }}]
        [materials.black]
        albedo = [0.0, 0.0, 0.0]
        [materials.floor]
        albedo = {ALBEDO:?}",
        x + 1.5
    );
    let d = height.hypot(x);
    let open = 1.0 - (radius / d).powi(2) * height / d;
    let truth = reflected().map(|value| f64::from(value) * open);
    Case::new(
        format!("shade at {x} of a ball at {height}"),
        scene,
        Form::Mean(truth),
    )
}

#[test]
fn a_ball_takes_its_share_of_the_sky() {
    let mut family = Family::new("shade", 15_000);
    for bench in benches() {
        for (height, radius, x) in [
            (1.0, 1.0, 0.5),
            (1.0, 0.8, 1.5),
            (2.0, 1.0, 0.0),
            (1.2, 1.2, 3.0),
        ] {
            let case = shaded(height, radius, x);
            family.check(bench, &case.clone().set("scatter.diffuse", "cosine"));
            family.check(bench, &case.set("scatter.diffuse", "uniform"));
        }
    }
    family.finish();
}

/// A number with all its bits, in every preset: what is seen directly is not touched.
#[test]
fn emission_and_background_are_seen_bit_for_bit() {
    let shapes = [
        (
            "a lamp",
            "spheres = [{ center = [0.0, 0.0, -3.0], radius = 2.0, material = \"lamp\" }]",
        ),
        (
            "inside a lamp",
            "spheres = [{ center = [0.0, 0.0, -3.0], radius = 7.0, material = \"lamp\" }]",
        ),
        (
            "a box",
            "boxes = [{ min = [-2.0, -2.0, -6.0], max = [2.0, 2.0, -3.0], rotation = [10.0, 20.0, 30.0], material = \"lamp\" }]",
        ),
        ("nothing", ""),
    ];
    let mut family = Family::new("seen directly", 16_000);
    for bench in benches() {
        for (name, shape) in shapes {
            for preset in ["montelight", "paper", "corrected", "reference"] {
                let scene = format!(
                    "version = 1
                    camera = {{ position = [0.0, 0.0, 0.0], look_at = [0.0, 0.0, -1.0], fov = 30 }}
                    image = {{ width = 32, height = 32 }}
                    background = {{ emission = {} }}
                    {shape}
                    [materials.lamp]
                    albedo = [0.0, 0.0, 0.0]
                    emission = [0.1, 0.3333333, 0.987654]",
                    if shape.is_empty() {
                        "[0.1, 0.3333333, 0.987654]"
                    } else {
                        "[5.0, 6.0, 7.0]"
                    }
                );
                let form = Form::Bits([0.1, 0.333_333_3, 0.987_654]);
                let case = Case::new(name, scene, form).set("render.preset", preset);
                family.check(bench, &case);
            }
        }
    }
    family.finish();
}

#[test]
fn the_gates_reject_small_faults() {
    let mut family = Family::new("sky, mutants", 17_000);
    for bench in benches() {
        for shape in [SPHERE, TURNED_BOX] {
            let exact = view(shape, "mirror", Form::Bits(reflected()));
            family.reject(
                bench,
                &exact.set("materials.body.albedo", "[0.83, 0.4, 0.1700001]"),
            );
            let noisy = view(shape, "diffuse", Form::Mean(reflected().map(f64::from)));
            let noisy = noisy.set("scatter.diffuse", "uniform");
            family.reject(
                bench,
                &noisy.set("materials.body.albedo", "[0.83, 0.404, 0.17]"),
            );
        }
        let lobe = lobe(FACE, 0.6, 75.0, "truncate");
        family.reject(bench, &lobe.clone().set("materials.body.spread", 0.63));
        family.reject(
            bench,
            &lobe
                .clone()
                .set("scatter.bound", "clamp")
                .set("materials.body.spread", 1.0),
        );
        family.reject(bench, &lobe.set("camera.position", "[2.92, 0.7, 0.0]"));
        let shaded = shaded(1.0, 0.8, 1.0);
        family.reject(bench, &shaded.clone().set("spheres.0.radius", 0.82));
        family.reject(bench, &shaded.set("spheres.0.center", "[0.03, 1.0, 0.0]"));
    }
}
