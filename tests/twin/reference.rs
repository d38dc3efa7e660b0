//! The same functions in f64, from their definitions.

use crate::cases::{self, UNIT};
use crate::on_both;
use glam::DVec3;
use lampray::pack::ProbeInput;
use std::f64::consts::{PI, TAU};

fn wide(v: [f32; 4]) -> DVec3 {
    DVec3::new(v[0].into(), v[1].into(), v[2].into())
}

/// A ray and a sphere, exactly.
pub struct Sphere {
    pub radius: f64,
    /// From the ray's origin to the centre.
    pub distance: f64,
    /// From the ray's line to the centre, less the radius.
    pub miss: f64,
    /// 0 for a ray that misses.
    pub half_chord: f64,
    /// Along the ray, to the point nearest to the centre.
    pub middle: f64,
}

pub fn sphere(input: &ProbeInput) -> Sphere {
    let (center, origin, direction) = (wide(input.a), wide(input.b), wide(input.c).normalize());
    let radius = f64::from(input.a[3]);
    let to_center = center - origin;
    let middle = to_center.dot(direction);
    let offset = (to_center - middle * direction).length();
    Sphere {
        radius,
        distance: to_center.length(),
        miss: offset - radius,
        half_chord: ((radius - offset) * (radius + offset)).max(0.0).sqrt(),
        middle,
    }
}

#[test]
fn sine_and_cosine_are_right() {
    let case = cases::sincos_turn();
    on_both(&case, "sine and cosine", |device, outputs| {
        for (input, got) in case.inputs.iter().zip(outputs) {
            let (sine, cosine) = (TAU * f64::from(input.a[0])).sin_cos();
            let error = (f64::from(got[0]) - sine)
                .abs()
                .max((f64::from(got[1]) - cosine).abs());
            assert!(error < 5e-7, "{device}: {input:?}: {error:e}");
            let small = sine.abs() < 0.5 && input.a[0].abs() < 0.2;
            let relative = ((f64::from(got[0]) - sine) / sine).abs();
            assert!(
                !small || sine == 0.0 || relative < 5e-7,
                "{device}: {input:?}: {relative:e}"
            );
            let (sine, cosine) = (TAU * (f64::from(input.a[1]) - 0.5)).sin_cos();
            let error = (f64::from(got[3]) - sine)
                .abs()
                .max((f64::from(got[2]) - cosine).abs());
            assert!(error < 5e-7, "{device}: {input:?}: {error:e}");
        }
    });
}

#[test]
fn angles_and_the_inverse_error_function_are_right() {
    let case = cases::angle_of_chord_case();
    on_both(&case, "angles and inverse_erf", |device, outputs| {
        let (mut worst_angle, mut worst_erf) = (0f64, 0f64);
        for (input, got) in case.inputs.iter().zip(outputs) {
            let chord = f64::from(input.a[0]);
            let angle = 2.0 * (0.5 * chord).asin();
            if chord > 0.0 {
                worst_angle = worst_angle.max((f64::from(got[0]) / angle - 1.0).abs());
            }
            let (x, y) = (f64::from(input.a[1]), f64::from(got[1]));
            if x > 0.0 {
                // How far y is from where erf is x, to first order; 1 - x is exact in f64.
                let apart = libm::erfc(y) - (1.0 - x);
                let off = apart * 0.5 * PI.sqrt() * (y * y).exp();
                let off = if x < 0.5 {
                    (x - libm::erf(y)) * 0.5 * PI.sqrt() * (y * y).exp()
                } else {
                    off
                };
                worst_erf = worst_erf.max((off / y).abs());
            }
        }
        println!("{device}: angle_of_chord {worst_angle:.2e}, inverse_erf {worst_erf:.2e}");
        assert!(worst_angle < 3e-7, "{device}: angle {worst_angle:e}");
        assert!(worst_erf < 2e-6, "{device}: inverse_erf {worst_erf:e}");
    });
}

#[test]
fn spheres_are_met_where_they_are() {
    let case = cases::sphere();
    on_both(&case, "intersect_sphere", |device, outputs| {
        let mut met = 0;
        for (input, got) in case.inputs.iter().zip(outputs) {
            let exact = sphere(input);
            let rounding = UNIT * (exact.distance + exact.radius);
            if exact.miss.abs() > 4.0 * rounding {
                assert_eq!(got[2] == 1.0, exact.miss < 0.0, "{device}: {input:?}");
            }
            if exact.miss > -4.0 * rounding {
                continue;
            }
            met += 1;
            // The direction itself is rounded to f32: middle and half chord with it.
            let bound = 6.0 * cases::sphere_error(input).0;
            let (near, far) = (
                exact.middle - exact.half_chord,
                exact.middle + exact.half_chord,
            );
            let error = (f64::from(got[0]) - near)
                .abs()
                .max((f64::from(got[1]) - far).abs());
            assert!(
                error <= bound,
                "{device}: {input:?} {got:?}: {error:e} over {bound:e}"
            );
        }
        assert!(met > 1000, "{met}");
    });
}

#[test]
fn boxes_are_met_where_they_are() {
    let case = cases::cuboid();
    on_both(&case, "intersect_box", |device, outputs| {
        let mut compared = [0, 0];
        for (input, got) in case.inputs.iter().zip(outputs) {
            let (half, origin) = (wide(input.a), wide(input.b));
            let rate = wide(input.c).recip();
            let (one, two) = ((-half - origin) * rate, (half - origin) * rate);
            let (near, far) = (one.min(two).max_element(), one.max(two).min_element());
            let size = near.abs().max(far.abs()).max(half.length());
            let (clear, error) = (32.0 * UNIT * size, 16.0 * UNIT * size);
            if !near.is_finite()
                || !far.is_finite()
                || (far - near).abs() < clear
                || far.abs() < clear
            {
                continue;
            }
            let met = near < far && far > 0.0;
            assert_eq!(got[2] == 1.0, met, "{device}: {input:?}: {near} {far}");
            compared[usize::from(met)] += 1;
            if met {
                let off = (f64::from(got[0]) - near)
                    .abs()
                    .max((f64::from(got[1]) - far).abs());
                assert!(off <= error, "{device}: {input:?}: {off:e} over {error:e}");
            }
        }
        assert!(compared.iter().all(|&count| count > 500), "{compared:?}");
    });
}
