//! Rough mirrors, glass and the lens: their cases, and the same in f64 from their definitions.

use crate::cases::{Case, UNIT, case, eight, material_of, scatter_of, xy, xyz};
use crate::inputs::*;
use crate::on_both;
use crate::support::strategy;
use crate::support::stream::Stream;
use glam::{DVec3, Vec2};
use lampray::cpu::glass::fresnel;
use lampray::cpu::{camera, scatter};
use lampray::knobs::{Choice, Scatter};
use lampray::pack::{Camera, ProbeInput, Strategy};
use lampray::shader::Probe;
use std::f64::consts::PI;

fn gloss() -> Strategy {
    Strategy {
        rough_surfaces: true,
        glass_surfaces: true,
        ..strategy()
    }
}

pub fn all() -> [Case; 5] {
    [
        sample_rough(),
        evaluate_rough(),
        sample_glass(),
        fresnel_case(),
        lens(),
    ]
}

const ALPHAS: [f32; 6] = [1e-3, 0.03, 0.1, 0.3, 0.6, 1.0];

fn rough_input(place: usize, stream: &mut Stream) -> ProbeInput {
    let (normal, incoming) = arrival(place / 6, stream);
    ProbeInput {
        a: four(normal, ALPHAS[place % 6]),
        b: four(incoming, 0.0),
        c: [
            unit(place / 6, 0, stream),
            unit(place / 6, 1, stream),
            0.0,
            0.0,
        ],
        d: [Scatter::Rough.index() as f32, 0.0, 0.0, 0.0],
    }
}

fn wide(v: [f32; 4]) -> DVec3 {
    DVec3::new(v[0].into(), v[1].into(), v[2].into())
}

/// Length of the arriving direction with the part along the surface shortened to alpha of itself: by so
/// much rounding grows where it is made of unit length again.
fn stretched(input: &ProbeInput) -> f64 {
    let (normal, incoming) = (wide(input.a), wide(input.b));
    let (alpha, up) = (f64::from(input.a[3]), normal.dot(incoming));
    (alpha * (incoming - up * normal).length()).hypot(up)
}

fn sample_rough() -> Case {
    let twin = |input: &ProbeInput| {
        let drawn = scatter_of(&gloss(), &material_of(input), input);
        eight(&[
            &drawn.direction.to_array(),
            &[drawn.density],
            &drawn.weight.to_array(),
        ])
    };
    // A facet's tilt is alpha times what a unit vector gives, over that vector's height.
    let tolerance = |input: &ProbeInput, wanted: &[f32; 8]| {
        let grown = 16.0 * UNIT / stretched(input);
        let density = grown * f64::from(wanted[3]) * (1.0 + 1.0 / f64::from(input.a[3]));
        [grown, grown, grown, density, grown, grown, grown, 0.0]
    };
    let made = case(
        "sample_rough",
        Probe::SampleScatter,
        many(31, rough_input),
        Box::new(twin),
        Box::new(tolerance),
    );
    Case {
        strategy: gloss(),
        strays: 40,
        ..made
    }
}

/// One in two directions is drawn, the others are any.
fn evaluate_input(place: usize, stream: &mut Stream) -> ProbeInput {
    let made = rough_input(place, stream);
    let drawn = scatter_of(&gloss(), &material_of(&made), &made).direction;
    let any = direction(place / 12, stream);
    let outgoing = if place.is_multiple_of(2) {
        drawn.to_array()
    } else {
        any
    };
    ProbeInput {
        c: four(outgoing, 0.0),
        ..made
    }
}

/// How far the density's relative rounding goes: the half vector is a sum of two unit vectors, and how
/// far it leans counts in units of alpha.
fn lean_error(input: &ProbeInput) -> f64 {
    let half = wide(input.c) - wide(input.b);
    let alpha = f64::from(input.a[3]);
    let up = wide(input.a).dot(half).abs();
    let across = (half - wide(input.a).dot(half) * wide(input.a)).length();
    1.0 + 8.0 / (alpha * up).hypot(across).max(1e-9)
}

fn evaluate_rough() -> Case {
    let twin = |input: &ProbeInput| {
        let (material, [normal, incoming, outgoing]) =
            (material_of(input), [input.a, input.b, input.c].map(xyz));
        let value = scatter::evaluate_scatter(&gloss(), &material, normal, incoming, outgoing);
        let density = scatter::scatter_density(&gloss(), &material, normal, incoming, outgoing);
        eight(&[&value.to_array(), &[density]])
    };
    let tolerance = |input: &ProbeInput, wanted: &[f32; 8]| {
        let up = wide(input.a).dot(wide(input.c)).abs().max(1e-6);
        let density = 8.0 * UNIT * lean_error(input) * f64::from(wanted[3]);
        let value = density * (1.0 + 1.0 / up);
        [value, value, value, density, 0.0, 0.0, 0.0, 0.0].map(|one| one + 1e-30)
    };
    let made = case(
        "evaluate_rough",
        Probe::EvaluateScatter,
        many(32, evaluate_input),
        Box::new(twin),
        Box::new(tolerance),
    );
    Case {
        strategy: gloss(),
        strays: 40,
        ..made
    }
}

const INDICES: [f32; 4] = [1.0, 1.33, 1.5, 4.0];

fn glass_input(place: usize, stream: &mut Stream) -> ProbeInput {
    let (normal, incoming) = arrival(place / 8, stream);
    ProbeInput {
        a: four(normal, INDICES[place % 4]),
        b: four(incoming, f32::from(u8::from(place / 4 % 2 == 1))),
        c: [unit(place / 8, 0, stream), 0.5, 0.0, 0.0],
        d: [Scatter::Glass.index() as f32, 0.0, 0.0, 0.0],
    }
}

fn sample_glass() -> Case {
    let twin = |input: &ProbeInput| {
        let drawn = scatter_of(&gloss(), &material_of(input), input);
        eight(&[
            &drawn.direction.to_array(),
            &[drawn.density],
            &drawn.weight.to_array(),
        ])
    };
    // The refracted cosine is a root: near the critical angle it has half the digits.
    let tolerance = |input: &ProbeInput, wanted: &[f32; 8]| {
        let up = f64::from(xyz(input.a).dot(glam::Vec3::new(wanted[0], wanted[1], wanted[2])));
        let index = f64::from(input.a[3]);
        let direction = 16.0 * UNIT * index * index / up.abs().max(1e-4);
        [direction, direction, direction, 0.0, 0.0, 0.0, 0.0, 0.0]
    };
    let made = case(
        "sample_glass",
        Probe::SampleScatter,
        many(33, glass_input),
        Box::new(twin),
        Box::new(tolerance),
    );
    Case {
        strategy: gloss(),
        strays: 8,
        ..made
    }
}

fn fresnel_case() -> Case {
    let input = |place: usize, stream: &mut Stream| {
        let index = edged(place / 8, &[1.0, 1.5, 4.0], stream, 1.0, 4.0);
        let ratio = if place.is_multiple_of(2) {
            index
        } else {
            1.0 / index
        };
        let cosine = edged(place, &[0.0, 1.0, 1e-4], stream, 0.0, 1.0);
        ProbeInput {
            a: [cosine, ratio, 0.0, 0.0],
            ..ProbeInput::default()
        }
    };
    let twin = |input: &ProbeInput| {
        let parts = fresnel(input.a[0], input.a[1]);
        eight(&[&[parts.reflectance, parts.cosine]])
    };
    let tolerance = |input: &ProbeInput, wanted: &[f32; 8]| {
        let [cosine, ratio] = [input.a[0], input.a[1]].map(f64::from);
        let root = 8.0 * UNIT * (1.0 + ratio * ratio) / f64::from(wanted[1]).max(1e-4);
        let steep = 1.0 / (cosine + ratio * f64::from(wanted[1])).max(1e-3);
        [
            8.0 * (root + UNIT) * steep,
            root,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
        ]
    };
    let made = case(
        "fresnel",
        Probe::Fresnel,
        many(34, input),
        Box::new(twin),
        Box::new(tolerance),
    );
    Case { strays: 8, ..made }
}

fn camera_of(input: &ProbeInput) -> Camera {
    Camera {
        forward: xyz(input.a).to_array(),
        aperture: input.a[3],
        right: xyz(input.b).to_array(),
        focus: input.b[3],
        down: xyz(input.c).to_array(),
        pixel: [0.125; 2],
        ..Camera::default()
    }
}

fn lens_input(place: usize, stream: &mut Stream) -> ProbeInput {
    let forward = direction(place, stream);
    let view = DVec3::from_array(forward.map(f64::from));
    let (x, y) = view.any_orthonormal_pair();
    let aperture = stream.scale(1e-3, 1e2);
    ProbeInput {
        a: four(forward, aperture as f32),
        b: four(
            (0.7 * x).as_vec3().to_array(),
            (aperture * stream.scale(0.1, 1e4)) as f32,
        ),
        c: four((0.5 * y).as_vec3().to_array(), 0.0),
        d: [
            unit(place, 0, stream),
            unit(place, 1, stream),
            stream.between(0.0, 16.0) as f32,
            stream.between(0.0, 16.0) as f32,
        ],
    }
}

fn lens() -> Case {
    let twin = |input: &ProbeInput| {
        let camera = camera_of(input);
        let lens = camera::sample_lens(&camera, xy(input.d));
        let film = Vec2::new(input.d[2], input.d[3]);
        let direction = camera::lens_direction(&camera, film, lens);
        eight(&[&lens.to_array(), &[0.0], &direction.to_array()])
    };
    let tolerance = |input: &ProbeInput, _: &[f32; 8]| {
        let (aperture, focus) = (f64::from(input.a[3]), f64::from(input.b[3]));
        let (lens, angle) = (
            16.0 * UNIT * aperture,
            32.0 * UNIT * (1.0 + aperture / focus),
        );
        [lens, lens, lens, 0.0, angle, angle, angle, 0.0]
    };
    case(
        "lens",
        Probe::Lens,
        many(35, lens_input),
        Box::new(twin),
        Box::new(tolerance),
    )
}

/// Scattering function of a rough mirror of albedo 1 from its parts: D G2 / (4 i.z o.z), with Smith's
/// Lambda of both directions; and the density of its draws, from the area of the cap and the Jacobians of
/// what is done to a point of it.
struct Facets {
    alpha: f64,
}

impl Facets {
    fn lambda(&self, v: DVec3) -> f64 {
        let slope = self.alpha * v.truncate().length() / v.z;
        0.5 * ((1.0 + slope * slope).sqrt() - 1.0)
    }

    fn scattering(&self, i: DVec3, o: DVec3) -> f64 {
        let m = (i + o).normalize();
        let squared = self.alpha * self.alpha;
        let tangent = m.truncate().length_squared() / (m.z * m.z);
        let normals = 1.0 / (PI * squared * m.z.powi(4) * (1.0 + tangent / squared).powi(2));
        normals / (1.0 + self.lambda(i) + self.lambda(o)) / (4.0 * i.z * o.z)
    }

    fn density(&self, i: DVec3, o: DVec3) -> f64 {
        let a = self.alpha;
        let m = (i + o).normalize();
        let shortened = DVec3::new(a * i.x, a * i.y, i.z).normalize();
        let normal = DVec3::new(m.x / a, m.y / a, m.z).normalize();
        let reach = (1.0 + i.truncate().length()).powi(2);
        let bound = (1.0 - a * a) * reach / (reach + a * a * i.z * i.z) * shortened.z;
        let height = (2.0 * shortened.dot(normal) * normal - shortened).z;
        let stretch = DVec3::new(a * normal.x, a * normal.y, normal.z).length();
        let cap = 1.0 / (2.0 * PI * (1.0 + bound));
        if height < -bound {
            return 0.0;
        }
        cap * shortened.dot(normal) * stretch.powi(3) / (a * a * i.dot(m))
    }
}

/// Into the frame of a normal, of unit length again.
fn local(normal: DVec3, v: DVec3) -> DVec3 {
    let (x, y) = normal.normalize().any_orthonormal_pair();
    DVec3::new(v.dot(x), v.dot(y), v.dot(normal.normalize())).normalize()
}

#[test]
fn facets_scatter_and_are_drawn_as_they_are_defined() {
    let case = evaluate_rough();
    on_both(&case, "rough mirrors", |device, outputs| {
        let (mut checked, mut below) = (0, 0);
        for (input, got) in case.inputs.iter().zip(outputs) {
            let facets = Facets {
                alpha: input.a[3].into(),
            };
            let i = local(wide(input.a), -wide(input.b));
            let o = local(wide(input.a), wide(input.c));
            // What f32 tells of the half vector, in units of alpha.
            let rounding = 64.0 * UNIT * lean_error(input) + 1e-5;
            if i.z < 0.01 || o.z.abs() < 0.01 || rounding > 0.01 {
                continue;
            }
            let density = facets.density(i, o);
            let near =
                |found: f32, wanted: f64| (f64::from(found) - wanted).abs() <= rounding * wanted;
            let rim = density > 0.0 && got[3] == 0.0 || density == 0.0 && got[3] > 0.0;
            if o.z < 0.0 {
                below += 1;
                // Rounding may put a direction on the other side of the cap's rim, but not far over it.
                let beside =
                    |share: f64| facets.density(i, (o + share * DVec3::Z).normalize()) > 0.0;
                assert!(
                    near(got[3], density) || rim && beside(1e-3) != beside(-1e-3),
                    "{device}: {input:?} {got:?} {density}"
                );
                assert_eq!(got[..3], [0.0; 3], "{device}: {input:?}");
                continue;
            }
            checked += 1;
            let value = facets.scattering(i, o) * o.z;
            assert!(
                near(got[3], density),
                "{device}: {input:?}: {} is not {density}",
                got[3]
            );
            assert!(
                near(got[2], value),
                "{device}: {input:?}: {} is not {value}",
                got[2]
            );
        }
        println!("{device}: {checked} directions above, {below} below");
        assert!(
            checked > 2000 && below > 500,
            "{device}: {checked}, {below}"
        );
    });
}

#[test]
fn facets_send_as_much_one_way_as_the_other() {
    let there = evaluate_rough();
    let turned = |input: &ProbeInput| {
        let [back, out] = [input.b, input.c].map(|v| four([-v[0], -v[1], -v[2]], 0.0));
        ProbeInput {
            b: out,
            c: back,
            ..*input
        }
    };
    let back = Case {
        inputs: there.inputs.iter().map(turned).collect(),
        ..evaluate_rough()
    };
    let both = std::cell::RefCell::new(Vec::<Vec<[f32; 8]>>::new());
    for case in [&there, &back] {
        on_both(case, "reciprocity", |_, outputs| {
            both.borrow_mut().push(outputs.to_vec())
        });
    }
    let all = both.into_inner();
    let devices = all.len() / 2;
    for device in 0..devices {
        let (forth, back) = (&all[device], &all[device + devices]);
        let mut checked = 0;
        for (number, input) in there.inputs.iter().enumerate() {
            let up = -wide(input.a).dot(wide(input.b));
            let out = wide(input.a).dot(wide(input.c));
            let rounding = 32.0 * UNIT * lean_error(input) + 1e-5;
            if up < 0.01 || out < 0.01 || rounding > 0.01 {
                continue;
            }
            let (one, other) = (
                f64::from(forth[number][2]) / out,
                f64::from(back[number][2]) / up,
            );
            assert!(
                (one / other - 1.0).abs() < rounding,
                "{device} {input:?}: {one} and {other}"
            );
            checked += 1;
        }
        assert!(checked > 2000, "{checked}");
    }
}

#[test]
fn fresnel_s_values_by_hand() {
    let brewster = 1.5f64.atan();
    let known = [
        // Head-on ((n - 1) / (n + 1))^2, from both sides.
        (1.0, 1.0 / 1.5, 0.04),
        (1.0, 1.5, 0.04),
        (1.0, 1.0 / 2.4, (1.4f64 / 3.4).powi(2)),
        // Brewster's angle: nothing of one polarisation, ((n^2 - 1) / (n^2 + 1))^2 of the other.
        (brewster.cos(), 1.0 / 1.5, 0.5 * (1.25f64 / 3.25).powi(2)),
        (brewster.sin(), 1.5, 0.5 * (1.25f64 / 3.25).powi(2)),
        // Grazing, and beyond the critical angle asin(1 / 1.5) = 41.8 degrees.
        (0.0, 1.0 / 1.5, 1.0),
        (42f64.to_radians().cos(), 1.5, 1.0),
        // No boundary.
        (0.3, 1.0, 0.0),
        // 60 degrees into 1.5: s -0.420204, p 0.042449.
        (
            0.5,
            1.0 / 1.5,
            0.5 * (0.420_204f64.powi(2) + 0.042_449f64.powi(2)),
        ),
    ];
    let input = |&(cosine, ratio, _): &(f64, f64, f64)| ProbeInput {
        a: [cosine as f32, ratio as f32, 0.0, 0.0],
        ..ProbeInput::default()
    };
    let case = Case {
        inputs: known.iter().map(input).collect(),
        ..fresnel_case()
    };
    on_both(&case, "Fresnel's equations", |device, outputs| {
        for ((cosine, ratio, reflectance), got) in known.iter().zip(outputs) {
            let off = (f64::from(got[0]) - reflectance).abs();
            assert!(
                off < 1e-5,
                "{device}: {cosine} {ratio}: {} is not {reflectance}",
                got[0]
            );
        }
    });
}

/// Helmholtz: a boundary reflects the same share from both sides of one ray.
#[test]
fn glass_reflects_alike_from_both_sides() {
    let there = fresnel_case();
    let crossed = |input: &ProbeInput| {
        let [cosine, ratio] = [input.a[0], input.a[1]].map(f64::from);
        let beyond = (1.0 - ratio * ratio * (1.0 - cosine * cosine))
            .max(0.0)
            .sqrt();
        ProbeInput {
            a: [beyond as f32, (1.0 / ratio) as f32, 0.0, 0.0],
            ..*input
        }
    };
    let back = Case {
        inputs: there.inputs.iter().map(crossed).collect(),
        ..fresnel_case()
    };
    let both = std::cell::RefCell::new(Vec::<Vec<[f32; 8]>>::new());
    for case in [&there, &back] {
        on_both(case, "both sides of glass", |_, outputs| {
            both.borrow_mut().push(outputs.to_vec())
        });
    }
    let all = both.into_inner();
    let devices = all.len() / 2;
    for device in 0..devices {
        let mut checked = 0;
        for (number, input) in there.inputs.iter().enumerate() {
            let (one, other) = (all[device][number], all[device + devices][number]);
            // Where both cosines have their digits.
            if one[1] > 0.02 && input.a[0] > 0.02 {
                assert!(
                    (one[0] - other[0]).abs() < 2e-4,
                    "{input:?}: {one:?} {other:?}"
                );
                checked += 1;
            }
        }
        assert!(checked > 4000, "{checked}");
    }
}

#[test]
fn glass_refracts_by_snell_s_law_and_reflects_as_a_mirror() {
    let case = sample_glass();
    on_both(&case, "sample_glass", |device, outputs| {
        let (mut refracted, mut reflected, mut total) = (0, 0, 0);
        for (input, got) in case.inputs.iter().zip(outputs) {
            let (normal, incoming) = (wide(input.a).normalize(), wide(input.b).normalize());
            let outgoing = DVec3::new(got[0].into(), got[1].into(), got[2].into());
            let index = f64::from(input.a[3]);
            let ratio = if input.b[3] == 1.0 {
                index
            } else {
                1.0 / index
            };
            let across = |v: DVec3| v - v.dot(normal) * normal;
            assert!(
                (outgoing.length() - 1.0).abs() < 1e-5,
                "{device}: {input:?}"
            );
            let beyond = ratio * across(incoming).length();
            if outgoing.dot(normal) < -1e-3 {
                let off = (across(outgoing) - ratio * across(incoming)).length();
                assert!(off < 1e-5, "{device}: {input:?}: {got:?}");
                assert!(beyond < 1.0 + 1e-6, "{device}: {input:?}");
                refracted += 1;
            } else if outgoing.dot(normal) > 1e-3 {
                let mirror = incoming - 2.0 * normal.dot(incoming) * normal;
                assert!(
                    (outgoing - mirror).length() < 1e-5,
                    "{device}: {input:?}: {got:?}"
                );
                reflected += 1;
                total += usize::from(beyond > 1.0);
            }
            assert!(
                beyond < 1.0 + 1e-6 || outgoing.dot(normal) >= 0.0,
                "{device}: {input:?}"
            );
        }
        println!("{device}: {refracted} refracted, {reflected} reflected, {total} of them totally");
        assert!(
            refracted > 2000 && total > 500,
            "{device}: {refracted}, {total}"
        );
    });
}

/// Every ray of one place in the picture goes through one point of the plane in focus, and the lens is
/// a disc across the view.
#[test]
fn a_lens_gathers_rays_in_the_plane_in_focus() {
    let case = lens();
    on_both(&case, "the lens", |device, outputs| {
        for (input, got) in case.inputs.iter().zip(outputs) {
            let (aperture, focus) = (f64::from(input.a[3]), f64::from(input.b[3]));
            let [forward, right, down] = [input.a, input.b, input.c].map(wide);
            let at = |film: f32| f64::from(film) * 0.125 - 1.0;
            let aim = focus * (forward + at(input.d[2]) * right + at(input.d[3]) * down);
            let from = DVec3::new(got[0].into(), got[1].into(), got[2].into());
            let direction = DVec3::new(got[4].into(), got[5].into(), got[6].into());
            assert!(
                from.dot(forward).abs() < 1e-6 * aperture,
                "{device}: {input:?}"
            );
            let radius = aperture * f64::from(input.d[0]).sqrt();
            assert!(
                (from.length() - radius).abs() < 1e-6 * aperture,
                "{device}: {input:?}"
            );
            let off = (aim - from).normalize() - direction;
            assert!(
                off.length() < 1e-5 * (1.0 + aperture / focus),
                "{device}: {input:?}: {off}"
            );
        }
    });
}

#[test]
fn wrong_densities_and_wrong_laws_are_caught() {
    // The unbounded cap's density, and Smith's terms apart: both are off where the right ones are not.
    let facets = Facets { alpha: 0.5 };
    let (i, o) = (DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.8, 0.0, 0.6));
    let bounded = facets.density(i, o);
    let all = DVec3::new(0.5 * i.x, 0.5 * i.y, i.z).length();
    let m = (i + o).normalize();
    let normals = 0.25 / (PI * (0.25 * m.z * m.z + m.truncate().length_squared()).powi(2));
    let whole = normals / (2.0 * (i.z + all));
    assert!((bounded / whole - 1.0).abs() > 0.05, "{bounded} {whole}");
    let apart = 1.0 / ((1.0 + facets.lambda(i)) * (1.0 + facets.lambda(o)));
    let together = 1.0 / (1.0 + facets.lambda(i) + facets.lambda(o));
    assert!((apart / together - 1.0).abs() > 0.002, "{apart} {together}");
}
