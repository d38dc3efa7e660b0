//! Every function that the probe kernel runs: inputs, twin, tolerance.

use crate::inputs::*;
use crate::support::strategy;
use glam::{Vec2, Vec3, Vec4};
use lampray::cpu::r#box::box_world;
use lampray::cpu::r#box::{box_face, intersect_box, safe_inverse};
use lampray::cpu::interruption::{survival_probability, survival_weight};
use lampray::cpu::light::{LampHit, light_inverse_density, power_heuristic, sample_light};
use lampray::cpu::light_tree::{LightPair, WHOLE_SHARE, first_share};
use lampray::cpu::maths::*;
use lampray::cpu::random::{random_bits, random_key, random_unit};
use lampray::cpu::ray::{Crossing, Ray};
use lampray::cpu::rectangle::{box_inverse_density, sample_box};
use lampray::cpu::sphere::intersect_sphere;
use lampray::cpu::{camera, scatter};
use lampray::knobs::*;
use lampray::pack::{Cuboid, Lamp, Material, ProbeInput, Strategy};
use lampray::shader::Probe;
use std::f64::consts::PI;

pub struct Case {
    pub name: String,
    pub probe: Probe,
    pub strategy: Strategy,
    pub inputs: Vec<ProbeInput>,
    pub twin: Twin,
    /// The tolerance of each lane for an input and what the twin makes of it; 0 asks for equality.
    pub tolerance: Tolerance,
    /// Inputs that may miss the tolerance: those that stand so close to a branch that one device
    /// takes one side and the other the other.
    pub strays: usize,
}

type Twin = Box<dyn Fn(&ProbeInput) -> [f32; 8]>;
type Tolerance = Box<dyn Fn(&ProbeInput, &[f32; 8]) -> [f64; 8]>;

/// f32's rounding unit.
pub const UNIT: f64 = 1.0 / 16_777_216.0;

/// Every case, strategies unrolled.
pub fn all() -> Vec<Case> {
    let single = [
        random_bits_case(),
        random_unit_case(),
        sincos_turn(),
        unit_sphere_case(),
        angle_of_chord_case(),
        basis_around_case(),
        sphere(),
        cuboid(),
        face(),
        finite(),
        first_share_case(),
    ];
    let films = Filter::ALL.iter().map(|&filter| film(filter));
    let scatters = scatter_strategies();
    let scatters = scatters.flat_map(|s| [sample_scatter_case(s), evaluate_scatter_case(s)]);
    let lights = light_strategies();
    let lights = lights.flat_map(|s| [sample_light_case(s), light_density_case(s)]);
    let boxes = [sample_box_case(), box_density_case()];
    let survivals = survival_strategies().map(survival);
    let many = films
        .chain(scatters)
        .chain(lights)
        .chain(boxes)
        .chain(survivals);
    single
        .into_iter()
        .chain(many)
        .chain(crate::gloss::all())
        .chain(crate::sequence::cases())
        .chain(crate::efficiency::cases())
        .collect()
}

pub fn xyz(v: [f32; 4]) -> Vec3 {
    Vec3::new(v[0], v[1], v[2])
}

pub fn xy(v: [f32; 4]) -> Vec2 {
    Vec2::new(v[0], v[1])
}

/// Up to eight numbers, the rest zero.
pub fn eight(parts: &[&[f32]]) -> [f32; 8] {
    let mut all = parts.iter().flat_map(|part| part.iter().copied());
    std::array::from_fn(|_| all.next().unwrap_or(0.0))
}

/// The same multiple of the rounding unit in every lane, whatever the input.
pub fn absolute(units: f64) -> Tolerance {
    Box::new(move |_, _| [units * UNIT; 8])
}

pub fn case(
    name: &str,
    probe: Probe,
    inputs: Vec<ProbeInput>,
    twin: Twin,
    tolerance: Tolerance,
) -> Case {
    Case {
        name: name.into(),
        probe,
        strategy: strategy(),
        inputs,
        twin,
        tolerance,
        strays: 0,
    }
}

pub fn words_input(_: usize, stream: &mut crate::support::stream::Stream) -> ProbeInput {
    let mut any = || f32::from_bits(stream.bits() as u32);
    ProbeInput {
        a: [any(), any(), f32::from_bits(17), f32::from_bits(40_000)],
        b: [any(), any(), f32::from_bits(3), f32::from_bits(2)],
        ..ProbeInput::default()
    }
}

pub fn key_of(input: &ProbeInput) -> [u32; 4] {
    let ([a, b, c, d], [e, f, _, _]) = (input.a.map(f32::to_bits), input.b.map(f32::to_bits));
    random_key([a, b], [c, d], [e, f])
}

/// Integers, exact. Words that are NaNs as floats may change on the way, so that the bits are kept
/// to those that are numbers; tests of the generator itself look at all of them.
fn random_bits_case() -> Case {
    let twin = |input: &ProbeInput| {
        let key = key_of(input);
        let bits = random_bits(key, 3, 2);
        eight(&[&bits.map(f32::from_bits), &key.map(f32::from_bits)])
    };
    let inputs = many(1, words_input);
    case(
        "random_bits",
        Probe::RandomBits,
        inputs,
        Box::new(twin),
        absolute(0.0),
    )
}

fn random_unit_case() -> Case {
    let twin = |input: &ProbeInput| eight(&[&random_unit(key_of(input), 3, 2)]);
    let inputs = many(2, words_input);
    case(
        "random_unit",
        Probe::RandomUnit,
        inputs,
        Box::new(twin),
        absolute(0.0),
    )
}

pub fn sincos_turn() -> Case {
    let edges = [0.0, -0.0, 0.5, -0.5, 0.25, -0.25, 1e-7, -1e-7, 0.125, 1e-20];
    let inputs = many(3, |place, stream| {
        let x = edged(place, &edges, stream, -0.5, 0.5);
        let u = unit(place, 0, stream);
        ProbeInput {
            a: [x, u, 0.0, 0.0],
            ..ProbeInput::default()
        }
    });
    let twin = |input: &ProbeInput| {
        let (turn, circle) = (
            lampray::cpu::maths::sincos_turn(input.a[0]),
            unit_circle(input.a[1]),
        );
        eight(&[&turn.to_array(), &circle.to_array()])
    };
    // Sums and products alone: rounded alike everywhere but for fused multiply-and-add.
    case(
        "sincos_turn",
        Probe::SincosTurn,
        inputs,
        Box::new(twin),
        absolute(8.0),
    )
}

fn unit_sphere_case() -> Case {
    let inputs = many(4, |place, stream| ProbeInput {
        a: [unit(place, 0, stream), unit(place, 1, stream), 0.0, 0.0],
        ..ProbeInput::default()
    });
    let twin = |input: &ProbeInput| eight(&[&unit_sphere(xy(input.a)).to_array()]);
    case(
        "unit_sphere",
        Probe::UnitSphere,
        inputs,
        Box::new(twin),
        absolute(8.0),
    )
}

pub fn angle_of_chord_case() -> Case {
    let edges = [0.0, 1e-20, 1e-6, 1.0, 2f32.sqrt(), 1.421_267];
    let inputs = many(5, |place, stream| {
        let chord = edged(place, &edges, stream, 0.0, 1.42);
        let x = match place % 3 {
            0 => unit(place, 0, stream),
            1 => 1.0 - stream.scale(6e-8, 1.0) as f32,
            _ => stream.scale(1e-12, 1.0) as f32 * LAST,
        };
        ProbeInput {
            a: [chord, x.clamp(0.0, LAST), 0.0, 0.0],
            ..ProbeInput::default()
        }
    });
    let twin = |input: &ProbeInput| [angle_of_chord(input.a[0]), inverse_erf(input.a[1])];
    let tolerance = |input: &ProbeInput, wanted: &[f32; 8]| {
        // The logarithm of a number near 1 has an absolute error, and w is made of it.
        let x = f64::from(input.a[1]);
        let log_error = 2.0 / (-((1.0 - x) * (1.0 + x)).ln()).max(0.5);
        let angle = 8.0 * f64::from(wanted[0]);
        let erf = 8.0 * f64::from(wanted[1]) * (1.0 + log_error);
        [angle, erf, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0].map(|units| units * UNIT)
    };
    let twin = move |input: &ProbeInput| eight(&[&twin(input)]);
    let (probe, tolerance) = (Probe::AngleOfChord, Box::new(tolerance));
    case(
        "angle_of_chord, inverse_erf",
        probe,
        inputs,
        Box::new(twin),
        tolerance,
    )
}

fn basis_around_case() -> Case {
    let inputs = many(6, |place, stream| ProbeInput {
        a: four(direction(place, stream), 0.0),
        ..ProbeInput::default()
    });
    let twin = |input: &ProbeInput| {
        let basis = basis_around(xyz(input.a));
        eight(&[&basis.x.to_array(), &[0.0], &basis.y.to_array()])
    };
    case(
        "basis_around",
        Probe::BasisAround,
        inputs,
        Box::new(twin),
        absolute(8.0),
    )
}

fn film(filter: Filter) -> Case {
    let inputs = many(7, |place, stream| {
        let edge = [0.0, 32_767.0][place % 2];
        let pixel = [0; 2].map(|_| edged(place, &[edge; 4], stream, 0.0, 32_767.0).floor());
        let u = [unit(place, 0, stream), unit(place, 1, stream)];
        ProbeInput {
            a: [pixel[0], pixel[1], 0.0, 0.0],
            b: [u[0], u[1], 0.0, 0.0],
            ..ProbeInput::default()
        }
    });
    let twin = move |input: &ProbeInput| {
        let pixel = [input.a[0] as u32, input.a[1] as u32];
        eight(&[&camera::sample_film(filter, pixel, xy(input.b)).to_array()])
    };
    // One rounding of a number as large as the image, and a square root's.
    let tolerance =
        |_: &ProbeInput, wanted: &[f32; 8]| wanted.map(|x| 2.0 * UNIT * (1.0 + f64::from(x.abs())));
    let name = format!("sample_film {filter}");
    let made = case(
        &name,
        Probe::SampleFilm,
        inputs,
        Box::new(twin),
        Box::new(tolerance),
    );
    Case {
        strategy: Strategy {
            filter,
            ..strategy()
        },
        ..made
    }
}

fn crossing_lanes(crossing: Crossing) -> [f32; 8] {
    let met = f32::from(u8::from(crossing.met));
    if crossing.met {
        eight(&[&[crossing.near, crossing.far, met]])
    } else {
        eight(&[&[0.0, 0.0, met]])
    }
}

fn ray_of(input: &ProbeInput) -> Ray {
    Ray {
        origin: xyz(input.b),
        direction: xyz(input.c),
        source: 0,
        inside: false,
    }
}

/// Rounding of the vector between centre and ray grows with the distance, and of the half chord
/// with radius over half chord, too.
pub fn sphere_error(input: &ProbeInput) -> (f64, f64) {
    let exact = crate::reference::sphere(input);
    let growth = 1.0 + exact.radius / exact.half_chord.max(1e-4 * exact.radius);
    (
        UNIT * (exact.distance + exact.radius) * growth,
        exact.half_chord / exact.radius,
    )
}

pub fn sphere() -> Case {
    let inputs = many(8, sphere_and_ray);
    let twin = |input: &ProbeInput| {
        crossing_lanes(intersect_sphere(xyz(input.a), input.a[3], &ray_of(input)))
    };
    let tolerance = |input: &ProbeInput, wanted: &[f32; 8]| {
        let reach = 4.0 * sphere_error(input).0;
        // Where nothing is met only that is asked for.
        let reach = if wanted[2] == 1.0 {
            reach
        } else {
            f64::INFINITY
        };
        [reach, reach, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    };
    let made = case(
        "intersect_sphere",
        Probe::IntersectSphere,
        inputs,
        Box::new(twin),
        Box::new(tolerance),
    );
    Case { strays: 4, ..made }
}

pub fn cuboid() -> Case {
    let inputs = many(9, box_and_ray);
    let twin = |input: &ProbeInput| {
        let inverse = safe_inverse(xyz(input.c));
        let crossing = intersect_box(xyz(input.a), xyz(input.b), inverse);
        eight(&[&[
            crossing.near,
            crossing.far,
            f32::from(u8::from(crossing.met)),
        ]])
    };
    // Slabs of a ray along an axis lie as far as 1e12 away; each is rounded in proportion.
    let tolerance = |_: &ProbeInput, wanted: &[f32; 8]| {
        let both = 8.0 * UNIT * f64::from(wanted[0].abs().max(wanted[1].abs()));
        [both, both, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    };
    let made = case(
        "intersect_box",
        Probe::IntersectBox,
        inputs,
        Box::new(twin),
        Box::new(tolerance),
    );
    Case { strays: 4, ..made }
}

fn face() -> Case {
    let inputs = many(10, |place, stream| {
        let made = box_and_ray(place, stream);
        let half = xyz(made.a);
        // On a face, on an edge, in a corner, or anywhere.
        let corner = xyz(four(direction(place, stream), 0.0)).signum() * half;
        let point = match place % 4 {
            0 => corner,
            1 => corner * Vec3::new(1.0, 1.0, stream.unit() as f32),
            2 => corner * Vec3::new(1.0, stream.unit() as f32, stream.unit() as f32),
            _ => corner * (stream.between(0.9, 1.1) as f32),
        };
        ProbeInput {
            b: four(point.to_array(), 0.0),
            ..made
        }
    });
    let twin = |input: &ProbeInput| {
        let face = box_face(xyz(input.a), xyz(input.b), xyz(input.c));
        eight(&[&face.point.to_array(), &[0.0], &face.normal.to_array()])
    };
    // Comparisons and signs alone: exact.
    case(
        "box_face",
        Probe::BoxFace,
        inputs,
        Box::new(twin),
        absolute(0.0),
    )
}

/// What the host works out for a directional material.
pub fn material(kind: Scatter, spread: f64, bound: ScatterBound) -> [f32; 4] {
    let mass = match bound {
        ScatterBound::Truncate => libm::erf(0.5 * PI / (2f64.sqrt() * spread)),
        ScatterBound::Clamp => 1.0,
    };
    let scale = (2.0 / PI).sqrt() / (spread * mass) / (2.0 * PI);
    [
        kind.index() as f32,
        spread as f32,
        mass as f32,
        scale as f32,
    ]
}

pub fn material_of(input: &ProbeInput) -> Material {
    Material {
        albedo: [0.5, 0.25, 1.0],
        scatter: input.d[0] as u32,
        emission: [0.0; 3],
        survival: 1.0,
        spread: input.d[1],
        lobe_mass: input.d[2],
        lobe_scale: input.d[3],
        shape: input.a[3],
    }
}

/// The draw that the probe kernel makes of an input.
pub fn scatter_of(of: &Strategy, material: &Material, input: &ProbeInput) -> scatter::Scattered {
    let inside = input.b[3] == 1.0;
    scatter::sample_scatter(
        of,
        material,
        xyz(input.a),
        xyz(input.b),
        inside,
        xy(input.c),
    )
}

fn scatter_strategies() -> impl Iterator<Item = Strategy> {
    let all = ScatterDiffuse::ALL.iter();
    all.flat_map(|&diffuse| ScatterBound::ALL.iter().map(move |&bound| (diffuse, bound)))
        .map(|(scatter_diffuse, scatter_bound)| Strategy {
            scatter_diffuse,
            scatter_bound,
            ..strategy()
        })
}

fn scatter_name(strategy: &Strategy) -> String {
    format!("{} {}", strategy.scatter_diffuse, strategy.scatter_bound)
}

const SPREADS: [f64; 5] = [1e-3, 0.05, 0.3, 1.0, 10.0];

fn scatter_input(
    place: usize,
    stream: &mut crate::support::stream::Stream,
    bound: ScatterBound,
) -> ProbeInput {
    let (normal, incoming) = arrival(place / 15, stream);
    ProbeInput {
        a: four(normal, 0.0),
        b: four(incoming, 0.0),
        c: [unit(place, 0, stream), unit(place, 1, stream), 0.0, 0.0],
        d: material(Scatter::ALL[place % 3], SPREADS[place / 3 % 5], bound),
    }
}

/// Relative rounding of the lobe's density at an angle: the angle is made of the difference of two
/// unit vectors, and enters squared, over the spread, into an exponential.
fn lobe_error(input: &ProbeInput, theta: f64) -> f64 {
    let spread = f64::from(input.d[1]);
    1.0 + 1.0 / theta.max(1e-6) + theta / (spread * spread) + (theta / spread).powi(2)
}

fn sample_scatter_case(of: Strategy) -> Case {
    let inputs = many(11, move |place, stream| {
        scatter_input(place, stream, of.scatter_bound)
    });
    let twin = move |input: &ProbeInput| {
        let material = material_of(input);
        let drawn = scatter_of(&of, &material, input);
        eight(&[
            &drawn.direction.to_array(),
            &[drawn.density],
            &drawn.weight.to_array(),
        ])
    };
    let tolerance = move |input: &ProbeInput, wanted: &[f32; 8]| {
        // The sum of normal and ball may be short, so that its direction has few digits.
        let up =
            f64::from(wanted[0] * input.a[0] + wanted[1] * input.a[1] + wanted[2] * input.a[2]);
        let short = if input.d[0] == 0.0 {
            1.0 / up.abs().max(1e-3)
        } else {
            1.0
        };
        let (angle, cosine) = (8.0 * UNIT * short, f64::from(wanted[3]));
        // The drawn angle's share of the lobe: by its own error, not by that of a difference.
        let mirror = scatter::mirror_direction(xyz(input.a), xyz(input.b));
        let theta = f64::from(mirror.distance(Vec3::new(wanted[0], wanted[1], wanted[2])));
        let density = match input.d[0] as u32 {
            1 => 8.0 * UNIT * cosine * lobe_error(input, theta.max(1e-3)),
            _ => angle,
        };
        [angle, angle, angle, density, angle, angle, angle, 0.0]
    };
    let name = format!("sample_scatter {}", scatter_name(&of));
    let made = case(
        &name,
        Probe::SampleScatter,
        inputs,
        Box::new(twin),
        Box::new(tolerance),
    );
    Case {
        strategy: of,
        strays: 8,
        ..made
    }
}

fn evaluate_scatter_case(of: Strategy) -> Case {
    let inputs = many(12, move |place, stream| {
        let made = scatter_input(place, stream, of.scatter_bound);
        ProbeInput {
            c: four(direction(place / 15, stream), 0.0),
            ..made
        }
    });
    let twin = move |input: &ProbeInput| {
        let (material, [normal, incoming, outgoing]) =
            (material_of(input), [input.a, input.b, input.c].map(xyz));
        let value = scatter::evaluate_scatter(&of, &material, normal, incoming, outgoing);
        let density = scatter::scatter_density(&of, &material, normal, incoming, outgoing);
        eight(&[&value.to_array(), &[density]])
    };
    let tolerance = |input: &ProbeInput, wanted: &[f32; 8]| {
        let mirror = scatter::mirror_direction(xyz(input.a), xyz(input.b));
        let theta = f64::from(mirror.distance(xyz(input.c)));
        let error = match input.d[0] as u32 {
            1 => 8.0 * f64::from(wanted[3]) * lobe_error(input, theta),
            _ => 4.0,
        };
        // Densities below the normal numbers may be flushed to zero.
        [error * UNIT + 1e-37; 8]
    };
    let name = format!("evaluate_scatter {}", scatter_name(&of));
    let made = case(
        &name,
        Probe::EvaluateScatter,
        inputs,
        Box::new(twin),
        Box::new(tolerance),
    );
    Case {
        strategy: of,
        strays: 40,
        ..made
    }
}

fn light_strategies() -> impl Iterator<Item = Strategy> {
    let samplers = LightSampler::ALL.iter();
    let weighted = samplers.flat_map(|&a| LightWeight::ALL.iter().map(move |&b| (a, b)));
    let points = weighted.flat_map(|(light_sampler, light_weight)| {
        [false, true].map(|pole_at_receiver| Strategy {
            light_sampler,
            light_weight,
            pole_at_receiver,
            ..strategy()
        })
    });
    let objects = LightSampler::ALL.iter().map(|&light_sampler| Strategy {
        light_sampler,
        light_test: LightTest::Object,
        ..strategy()
    });
    points.chain(objects)
}

fn light_name(strategy: &Strategy) -> String {
    let pole = if strategy.pole_at_receiver {
        "receiver"
    } else {
        "axis"
    };
    format!(
        "{} {} {pole} {}",
        strategy.light_sampler, strategy.light_weight, strategy.light_test
    )
}

fn lamp_of(input: &ProbeInput) -> Lamp {
    Lamp {
        center: xyz(input.a).to_array(),
        radius: input.a[3],
        emission: [1.0; 3],
        body: 1,
        weight_radius: input.b[3],
        ..Lamp::default()
    }
}

/// The lit surface's normal.
fn normal_of(input: &ProbeInput) -> Vec3 {
    unit_sphere(Vec2::new(input.d[2], input.d[3]))
}

fn pole() -> Basis {
    basis_around(Vec3::new(0.3, -0.5, 0.8).normalize())
}

/// What rounding grows with: coordinates over the distance to the point, and the largest inverse
/// density there is.
fn light_error(input: &ProbeInput, reach: f64) -> (f64, f64) {
    let [center, origin] = [input.a, input.b].map(|v| f64::from(xyz(v).length()));
    let radius = f64::from(input.a[3]);
    let size = center + origin + radius;
    (
        size / reach.max(1e-3 * radius),
        2.0 * PI * PI * (radius / reach).powi(2),
    )
}

/// How far a point by the Gaussian sampler may be off, in rounding units and lamp radii: WGSL lets
/// the logarithm of numbers from 0.5 to 2 be off by 2^-21, and the two radii are roots of it.
fn gaussian_error(input: &ProbeInput) -> f64 {
    let allowed = 2f64.powi(-21);
    let radii = [input.c[0], input.c[1]].map(|u| (-2.0 * (-f64::from(u)).ln_1p()).sqrt());
    let off = radii.map(|radius| (allowed / radius.max(1e-30)).min((2.0 * allowed).sqrt()));
    let size = radii[0].hypot(radii[1] * (f64::from(input.c[3]) * 2.0 * PI).cos());
    (off[0] + off[1]) / size.max(1e-9) / UNIT
}

/// How far the distance to a cone's point may be off: at the lamp's rim the half chord is the root
/// of a difference of nearly equal numbers.
fn cone_error(of: &Strategy, input: &ProbeInput) -> f64 {
    if of.light_sampler == LightSampler::ProjectedCap {
        return f64::from(input.a[3]) * (16.0 * UNIT).sqrt();
    }
    if of.light_sampler != LightSampler::Cone {
        return 0.0;
    }
    let (radius, left) = (f64::from(input.a[3]), 1.0 - f64::from(input.c[0]));
    radius * (16.0 * UNIT / left.sqrt()).min((16.0 * UNIT).sqrt())
}

/// What a projected direction's errors grow with, given the direction: its weight goes as one over the height above
/// the horizon, and how much of the lamp that leaves to be seen is told in lamp radii.
fn grazing(of: &Strategy, input: &ProbeInput, direction: Vec3) -> f64 {
    if of.light_sampler != LightSampler::ProjectedCap {
        return 1.0;
    }
    let up = f64::from(direction.dot(normal_of(input)));
    let away = f64::from(xyz(input.a).distance(xyz(input.b)) / input.a[3]);
    1.0 + 4.0 / up.abs().max(1e-7) + 4.0 * away
}

fn sample_light_case(of: Strategy) -> Case {
    let inputs = many(13, |place, stream| {
        let (made, _) = lamp_and_origin(place, stream);
        let c = [0, 1, 2, 3].map(|turn| unit(place, turn, stream));
        let [z, w] = [(); 2].map(|()| stream.unit() as f32);
        ProbeInput {
            c,
            d: [made.d[0], 0.0, z, w],
            ..made
        }
    });
    let twin = move |input: &ProbeInput| {
        let lamp = lamp_of(input);
        let inside = input.d[0] == 1.0;
        let light = sample_light(
            &of,
            &lamp,
            pole(),
            xyz(input.b),
            normal_of(input),
            inside,
            Vec4::from(input.c),
        );
        eight(&[
            &light.direction.to_array(),
            &[light.distance, light.weight, light.inverse_density],
        ])
    };
    let tolerance = move |input: &ProbeInput, wanted: &[f32; 8]| {
        let (mut spread, largest) = light_error(input, f64::from(wanted[3]));
        if of.light_sampler == LightSampler::Gaussian {
            spread *= 1.0 + gaussian_error(input);
        }
        let grazing = grazing(&of, input, Vec3::new(wanted[0], wanted[1], wanted[2]));
        let direction = 8.0 * UNIT * spread * grazing.min(64.0);
        // A far point's near side is a difference of two distances.
        let reach = f64::from(wanted[3]).max(1e-3 * f64::from(input.a[3]));
        let cone = cone_error(&of, input);
        let distance = 8.0 * UNIT * spread * reach + cone;
        let weight =
            (8.0 * UNIT * spread * grazing + 4.0 * cone / reach) * (largest + f64::from(wanted[4]));
        [
            direction, direction, direction, distance, weight, weight, 0.0, 0.0,
        ]
    };
    let name = format!("sample_light {}", light_name(&of));
    let made = case(
        &name,
        Probe::SampleLight,
        inputs,
        Box::new(twin),
        Box::new(tolerance),
    );
    Case {
        strategy: of,
        strays: 8,
        ..made
    }
}

fn light_density_case(of: Strategy) -> Case {
    let inputs = many(14, |place, stream| {
        let (made, inside) = lamp_and_origin(place, stream);
        let outward = four(direction(place, stream), 0.0);
        let ratio = [0.0, 1.0, 1e15, 1e30, stream.scale(1e-6, 1e6) as f32][place % 5];
        ProbeInput {
            c: outward,
            d: [
                f32::from(u8::from(inside)),
                ratio,
                unit(place, 2, stream),
                unit(place, 3, stream),
            ],
            ..made
        }
    });
    let twin = move |input: &ProbeInput| {
        let lamp = lamp_of(input);
        let to_point = Vec3::from(lamp.center) + lamp.radius * xyz(input.c) - xyz(input.b);
        let distance = to_point.length();
        let hit = LampHit {
            inside: input.d[0] == 1.0,
            direction: to_point / distance,
            distance,
            outward: xyz(input.c),
        };
        let density =
            light_inverse_density(&of, &lamp, pole(), xyz(input.b), normal_of(input), hit);
        eight(&[&[density, power_heuristic(input.d[1])]])
    };
    let tolerance = move |input: &ProbeInput, wanted: &[f32; 8]| {
        let point = xyz(input.a) + input.a[3] * xyz(input.c);
        let (spread, largest) = light_error(input, f64::from(point.distance(xyz(input.b))));
        let direction = (point - xyz(input.b)).normalize();
        let (grazing, projected) = match of.light_sampler {
            LightSampler::ProjectedCap => (grazing(&of, input, direction), f64::from(wanted[0])),
            _ => (1.0, 0.0),
        };
        [
            8.0 * UNIT * spread * grazing * (largest + projected),
            4.0 * UNIT,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
        ]
    };
    let name = format!("light_density {}", light_name(&of));
    let made = case(
        &name,
        Probe::LightDensity,
        inputs,
        Box::new(twin),
        Box::new(tolerance),
    );
    Case {
        strategy: of,
        strays: 8,
        ..made
    }
}

/// The probe's box, and whether the receiver is in it.
fn box_of(input: &ProbeInput) -> (Cuboid, bool) {
    let axes = pole();
    let shape = Cuboid {
        half_size: xyz(input.a).to_array(),
        axis_x: axes.x.to_array(),
        axis_y: axes.y.to_array(),
        axis_z: axes.z.to_array(),
        ..Cuboid::default()
    };
    (shape, input.d[0] == 1.0)
}

/// A box and a receiver, in the box's own axes: inside, near, or farther off.
fn box_and_receiver(
    place: usize,
    stream: &mut crate::support::stream::Stream,
) -> (ProbeInput, Vec3) {
    let scale = stream.scale(1e-2, 1e2);
    let half = Vec3::from([0; 3].map(|_| (scale * stream.scale(0.1, 1.0)) as f32));
    let inside = place.is_multiple_of(3);
    let reach = if inside { 0.98 } else { 6.0 };
    let mut local = Vec3::from([0; 3].map(|_| stream.between(-reach, reach) as f32));
    if !inside && local.abs().max_element() < 1.05 {
        local.x = 1.5;
    }
    let (shape, _) = box_of(&ProbeInput {
        a: half.extend(0.0).to_array(),
        ..ProbeInput::default()
    });
    let made = ProbeInput {
        a: half.extend(0.0).to_array(),
        b: box_world(&shape, local * half).extend(0.0).to_array(),
        d: [f32::from(u8::from(inside)), 0.0, 0.0, 0.0],
        ..ProbeInput::default()
    };
    (made, local * half)
}

/// Rounding of angles of a turn grows as one over the part of it that a face is, where it is not drawn by area.
fn sample_box_case() -> Case {
    let inputs = many(17, |place, stream| {
        let (made, _) = box_and_receiver(place, stream);
        ProbeInput {
            c: [0, 1, 2, 3].map(|turn| unit(place, turn, stream)),
            ..made
        }
    });
    let twin = |input: &ProbeInput| {
        let (shape, inside) = box_of(input);
        let drawn = sample_box(&shape, xyz(input.b), inside, Vec4::from(input.c));
        let lanes: [&[f32]; 2] = [
            &drawn.direction.to_array(),
            &[drawn.distance, drawn.inverse_density],
        ];
        eight(&lanes)
    };
    let tolerance = |_: &ProbeInput, wanted: &[f32; 8]| {
        let (distance, inverse) = (f64::from(wanted[3]), f64::from(wanted[4]));
        let direction = 1e-3;
        let density = 1e-5 * inverse + 2.0 * UNIT * inverse / direction;
        [
            direction,
            direction,
            direction,
            1e-2 * distance,
            density,
            0.0,
            0.0,
            0.0,
        ]
    };
    let made = case(
        "sample_box",
        Probe::SampleBox,
        inputs,
        Box::new(twin),
        Box::new(tolerance),
    );
    Case { strays: 80, ..made }
}

fn box_density_case() -> Case {
    let inputs = many(18, |place, stream| {
        let (made, local) = box_and_receiver(place, stream);
        let half = xyz(made.a);
        let mut point = Vec3::from([0; 3].map(|_| stream.between(-0.99, 0.99) as f32));
        // A face that is seen: across an axis along which the receiver is outside, or any from inside.
        let beyond = (0..3).find(|&axis| local[axis].abs() > 1.01 * half[axis]);
        let axis = beyond.unwrap_or(place % 3);
        let side = match beyond {
            Some(axis) => local[axis].signum(),
            None => [-1.0, 1.0][place / 3 % 2],
        };
        point[axis] = side;
        ProbeInput {
            c: (point * half).extend(0.0).to_array(),
            d: [
                made.d[0],
                (2 * axis + usize::from(side > 0.0)) as f32,
                0.0,
                0.0,
            ],
            ..made
        }
    });
    let twin = |input: &ProbeInput| {
        let (shape, inside) = box_of(input);
        let number = input.d[1] as usize;
        let side = if number % 2 == 1 { 1.0 } else { -1.0 };
        let outward = box_world(&shape, side * [Vec3::X, Vec3::Y, Vec3::Z][number / 2]);
        let to = box_world(&shape, xyz(input.c)) - xyz(input.b);
        eight(&[&[box_inverse_density(
            &shape,
            xyz(input.b),
            inside,
            to,
            outward,
        )]])
    };
    // A face seen from the side has a height of few digits.
    let tolerance = |_: &ProbeInput, wanted: &[f32; 8]| wanted.map(|x| 1e-4 * f64::from(x));
    let made = case(
        "box_density",
        Probe::BoxDensity,
        inputs,
        Box::new(twin),
        Box::new(tolerance),
    );
    Case { strays: 8, ..made }
}

fn survival_strategies() -> impl Iterator<Item = Strategy> {
    let rules = InterruptionRule::ALL.iter();
    rules
        .flat_map(|&rule| {
            InterruptionWeight::ALL
                .iter()
                .map(move |&weight| (rule, weight))
        })
        .map(|(interruption_rule, interruption_weight)| Strategy {
            interruption_rule,
            interruption_weight,
            ..strategy()
        })
}

fn survival(of: Strategy) -> Case {
    let inputs = many(15, |place, stream| {
        let mut any = |turn| match place % 5 {
            0 => 0.0,
            1 => 1.0,
            _ => unit(place, turn, stream) * if turn > 3 { 4.0 } else { 1.0 },
        };
        ProbeInput {
            a: [any(0), 0.0, 0.0, 0.0],
            b: [any(1), any(2), any(3), 0.0],
            c: [any(4), any(5), any(6), 0.0],
            ..ProbeInput::default()
        }
    });
    let twin = move |input: &ProbeInput| {
        let probability = survival_probability(&of, input.a[0], xyz(input.b), xyz(input.c));
        eight(&[&[probability, survival_weight(&of, probability)]])
    };
    // Comparisons, then one division: 2.5 units by WGSL's rules.
    let tolerance = |_: &ProbeInput, wanted: &[f32; 8]| wanted.map(|x| 4.0 * UNIT * f64::from(x));
    let name = format!(
        "survival {} {}",
        of.interruption_rule, of.interruption_weight
    );
    let made = case(
        &name,
        Probe::Survival,
        inputs,
        Box::new(twin),
        Box::new(tolerance),
    );
    Case {
        strategy: of,
        ..made
    }
}

/// Not-a-numbers of every kind, infinities and their neighbours.
fn finite() -> Case {
    let bits: [u32; 12] = [
        0x7f80_0000,
        0xff80_0000,
        0x7fc0_0000,
        0xffc0_0000,
        0x7f80_0001,
        0x7fff_ffff,
        0xffff_ffff,
        0x7f7f_ffff,
        0xff7f_ffff,
        0x0000_0000,
        0x8000_0000,
        0x0000_0001,
    ];
    let inputs = many(16, |place, stream| {
        let mut any = |turn: u32| match place < 12 * 12 * 12 {
            true => f32::from_bits(bits[place / 12usize.pow(turn) % 12]),
            false => f32::from_bits(stream.bits() as u32),
        };
        ProbeInput {
            a: [any(0), any(1), any(2), 0.0],
            ..ProbeInput::default()
        }
    });
    let twin = |input: &ProbeInput| eight(&[&[f32::from(u8::from(xyz(input.a).is_finite()))]]);
    case(
        "all_finite",
        Probe::Finite,
        inputs,
        Box::new(twin),
        absolute(0.0),
    )
}

/// Two groups of any size and power around a point: it is far from them, near, or inside of one.
fn first_share_case() -> Case {
    let inputs = many(17, |place, stream| {
        let mut ball = |near: bool| {
            let radius = stream.scale(1e-3, 1e2);
            let away = match near {
                true => radius * stream.between(0.0, 1.5),
                false => radius * stream.scale(1.5, 1e3),
            };
            four(stream.direction().map(|x| (away * x) as f32), radius as f32)
        };
        let (a, b) = (ball(place % 4 == 0), ball(place % 7 == 0));
        let powers = [1.0, [0.0, 1.0, stream.scale(1e-6, 1.0)][place % 3] as f32];
        ProbeInput {
            a,
            b,
            c: [0.0, 0.0, 0.0, powers[place % 2]],
            d: four(direction(place, stream), powers[1 - place % 2]),
        }
    });
    let twin = |input: &ProbeInput| {
        let pair = LightPair {
            first: Vec4::from(input.a),
            second: Vec4::from(input.b),
            power: [input.c[3], input.d[3]],
            link: [0; 2],
        };
        eight(&[&[first_share(&pair, xyz(input.c), xyz(input.d)) as f32]])
    };
    let tolerance = |input: &ProbeInput, wanted: &[f32; 8]| {
        let whole = f64::from(WHOLE_SHARE);
        let share = f64::from(wanted[0]) / whole;
        let relative = [input.a, input.b].map(|ball| nearness_error(ball, xyz(input.d)));
        let shares = share * (1.0 - share) * (relative[0] + relative[1]);
        [
            whole * (shares + 8.0 * UNIT),
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
        ]
    };
    case(
        "first_share",
        Probe::FirstShare,
        inputs,
        Box::new(twin),
        Box::new(tolerance),
    )
}

/// How far a group's cosine may be off, for its size: two roots of differences that rounding has moved by a
/// few units, each times the other angle's cosine or sine.
fn nearness_error(ball: [f32; 4], normal: Vec3) -> f64 {
    let (center, radius) = (xyz(ball).as_dvec3(), f64::from(ball[3]));
    let inverse = 1.0 / center.length().max(radius);
    let cosine = center.dot(normal.as_dvec3()) * inverse;
    let cone_sine = radius * inverse;
    let off = 16.0 * UNIT;
    let root_error = |sine: f64| {
        let square = (1.0 - sine * sine).max(0.0);
        (square + off).sqrt() - (square - off).max(0.0).sqrt()
    };
    let moved = cosine.abs() * root_error(cone_sine) + cone_sine * root_error(cosine) + off;
    let cone_cosine = (1.0 - cone_sine * cone_sine).max(0.0).sqrt();
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let highest = match cosine >= cone_cosine {
        true => 1.0,
        false => cosine * cone_cosine + sine * cone_sine,
    };
    moved / highest.max(0.015625) + 2.0 * off
}
