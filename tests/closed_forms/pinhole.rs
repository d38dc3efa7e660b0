//! The picture of a sphere that shines, wherever it stands in the picture.
//!
//! At an angle omega from the axis, with half angle sigma (sin sigma = R / d), a sphere is an ellipse
//! in the image plane at distance 1: with c = cos^2 omega - sin^2 sigma its middle is at
//! sin omega cos omega / c, its semi-axes are sin sigma cos sigma / c along the way from the axis
//! and sin sigma / sqrt c across; on the axis a disc of radius tan sigma. A unit of
//! the image plane is (H / 2) / tan(fov / 2) pixels, in both directions.

use super::cross::{check_all, covering};
use crate::support::bench::{Bench, benches};
use crate::support::chance::chi_square_above;
use crate::support::gate::{Case, Family, Form, LEVEL};
use crate::support::quadrature::integrate;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

const EMISSION: [f64; 3] = [2.0, 0.5, 1.0];
const DISTANCE: f64 = 5.0;

/// Angles in degrees: half angle, angle from the axis, direction of that (from the right,
/// counterclockwise), and the vertical field of view.
#[derive(Clone, Copy, Debug)]
struct View {
    half: f64,
    away: f64,
    around: f64,
    fov: f64,
    size: [u32; 2],
}

const VIEWS: [View; 5] = [
    view(12.0, 0.0, 0.0, 40.0, [160, 160]),
    view(13.0, 0.0, 0.0, 40.0, [200, 100]),
    view(14.0, 25.0, 30.0, 80.0, [200, 160]),
    view(13.0, 28.0, -100.0, 90.0, [90, 200]),
    view(12.0, 46.0, 150.0, 100.0, [300, 150]),
];

const fn view(half: f64, away: f64, around: f64, fov: f64, size: [u32; 2]) -> View {
    View {
        half,
        away,
        around,
        fov,
        size,
    }
}

/// Where the sphere is seen, in pixels from the upper left corner.
#[derive(Clone, Copy, Debug)]
struct Ellipse {
    middle: DVec2,
    /// Unit vector of the first semi-axis.
    toward: DVec2,
    semi: DVec2,
}

impl Ellipse {
    fn area(&self) -> f64 {
        PI * self.semi.x * self.semi.y
    }

    /// The part of a row at height `y` that is inside, from left to right.
    fn chord(&self, y: f64) -> Option<[f64; 2]> {
        // |(p . t) / a|^2 + |(p . s) / b|^2 = 1 with p = (x, y), as a quadratic in x.
        let (t, s) = (self.toward / self.semi.x, self.toward.perp() / self.semi.y);
        let y = y - self.middle.y;
        let (a, b) = (t.x * t.x + s.x * s.x, y * (t.x * t.y + s.x * s.y));
        let c = y * y * (t.y * t.y + s.y * s.y) - 1.0;
        let root = (b * b - a * c).max(0.0).sqrt();
        let ends = [-b - root, -b + root].map(|end| self.middle.x + end / a);
        (b * b > a * c).then_some(ends)
    }

    /// Share of a pixel that is inside.
    fn share(&self, x: u32, y: u32) -> f64 {
        let (left, top) = (f64::from(x), f64::from(y));
        let width = |y: f64| {
            self.chord(y).map_or(0.0, |[from, to]| {
                (to.min(left + 1.0) - from.max(left)).max(0.0)
            })
        };
        integrate(top, top + 1.0, 40, width)
    }
}

impl View {
    fn ellipse(self) -> Ellipse {
        let [width, height] = self.size.map(f64::from);
        let unit = 0.5 * height / (0.5 * self.fov).to_radians().tan();
        let (sine, cosine) = self.half.to_radians().sin_cos();
        let (away_sine, away_cosine) = self.away.to_radians().sin_cos();
        let c = away_cosine * away_cosine - sine * sine;
        // Rows count downwards.
        let toward = DVec2::from_angle(-self.around.to_radians());
        let away = unit * away_sine * away_cosine / c;
        Ellipse {
            middle: 0.5 * DVec2::new(width, height) + away * toward,
            toward,
            semi: unit * DVec2::new(sine * cosine / c, sine / c.sqrt()),
        }
    }

    fn case(self) -> Case {
        let eye = DVec3::new(1.0, -2.0, 0.5);
        let forward = DVec3::new(0.6, 0.3, -0.8).normalize();
        let right = forward.cross(DVec3::Y).normalize();
        let up = right.cross(forward);
        let (sine, cosine) = self.around.to_radians().sin_cos();
        let (away_sine, away_cosine) = self.away.to_radians().sin_cos();
        let aside = away_sine * (cosine * right + sine * up);
        let center = eye + DISTANCE * (away_cosine * forward + aside);
        let [width, height] = self.size;
        let scene = format!(
            "version = 1
            camera = {{ position = {eye}, look_at = {}, fov = {} }}
            image = {{ width = {width}, height = {height} }}
            render = {{ max_bounces = 2 }}
            spheres = [{{ center = {center}, radius = {}, material = \"lamp\" }}]
            [materials.lamp]
            albedo = [0.6, 0.6, 0.6]
            emission = {EMISSION:?}
            survival = 0.5",
            eye + forward,
            self.fov,
            DISTANCE * self.half.to_radians().sin()
        );
        let share = self.ellipse().area() / f64::from(width * height);
        let form = Form::Mean(EMISSION.map(|emission| emission * share));
        Case::new(format!("{self:?}"), scene, form).within(0.001)
    }
}

#[test]
fn on_the_axis_the_ellipse_is_the_disc() {
    let ellipse = VIEWS[0].ellipse();
    let (radius, distance) = (12f64.to_radians().sin(), 1.0);
    let disc = 80.0 * (radius / (distance - radius * radius).sqrt()) / 20f64.to_radians().tan();
    assert!((ellipse.semi - disc).length() < 1e-9);
    assert_eq!(ellipse.middle, DVec2::splat(80.0));
    for view in VIEWS {
        let ([width, height], ellipse) = (view.size, view.ellipse());
        let shares = (0..width * height).map(|i| ellipse.share(i % width, i / width));
        let sum: f64 = shares.sum();
        assert!((sum / ellipse.area() - 1.0).abs() < 1e-5, "{view:?}");
    }
}

#[test]
fn every_knob_gives_the_area_to_a_thousandth() {
    let mut family = Family::new("picture of a sphere", 20_000);
    for bench in benches() {
        check_all(&mut family, bench, &covering(bench), |choice| {
            choice.pick(&VIEWS).case()
        });
    }
    family.finish();
}

/// Chance of pixels as far from an ellipse's shares as a render's are: the sum of squared z over the pixels
/// that its outline crosses. Pixels off the outline must be all lamp or all black; those that it hardly
/// crosses, by counts too small for z, may be off by twenty samples. The chance is then 0.
fn chance_of_outline(bench: Bench, case: &Case, seed: u64, ellipse: Ellipse, width: u32) -> f64 {
    const SAMPLES: u64 = 256;
    let film = bench.film(&case.scene(seed), 0..SAMPLES);
    let (mut sum, mut crossed) = (0.0, 0.0);
    for pixel in 0..film.counts.len() {
        let (x, y) = (pixel as u32 % width, pixel as u32 / width);
        let (share, found) = (ellipse.share(x, y), film.mean(pixel)[2] / EMISSION[2]);
        let variance = share * (1.0 - share) / SAMPLES as f64;
        if variance * (SAMPLES * SAMPLES) as f64 >= 5.0 {
            sum += (found - share).powi(2) / variance;
            crossed += 1.0;
        } else if (found - share).abs() * SAMPLES as f64 > 20.0 {
            return 0.0;
        }
    }
    let p = chi_square_above(sum, crossed);
    println!(
        "{bench:?}, {}: chi-square {sum:.1} of {crossed} pixels, p {p:.2e}",
        case.name
    );
    p
}

#[test]
fn the_outline_is_the_ellipse() {
    for bench in benches() {
        for (n, view) in VIEWS.into_iter().enumerate() {
            let (case, seed) = (view.case(), 21_000 + 10 * bench as u64 + n as u64);
            let p = chance_of_outline(bench, &case, seed, view.ellipse(), view.size[0]);
            assert!(p >= LEVEL, "{view:?} on {bench:?}: p {p:e}");
        }
    }
}

#[test]
fn the_gates_reject_small_faults() {
    let mut family = Family::new("picture of a sphere, mutants", 21_100);
    for bench in benches() {
        for view in [VIEWS[1], VIEWS[2]] {
            let case = view.case();
            let radius = 1.002 * DISTANCE * view.half.to_radians().sin();
            family.reject(bench, &case.clone().set("spheres.0.radius", radius));
            family.reject(bench, &case.clone().set("camera.fov", view.fov * 1.002));
            family.reject(bench, &case.set("image.width", view.size[0] + 1));
        }
        // The same area in the wrong place or shape.
        let (case, truth) = (VIEWS[2].case(), VIEWS[2].ellipse());
        let disc = DVec2::splat((truth.semi.x * truth.semi.y).sqrt());
        let wrong = [
            Ellipse {
                semi: disc,
                ..truth
            },
            Ellipse {
                toward: truth.toward.perp(),
                ..truth
            },
            Ellipse {
                middle: truth.middle + DVec2::new(0.1, 0.0),
                ..truth
            },
            Ellipse {
                middle: truth.middle - DVec2::new(0.0, 0.1),
                ..truth
            },
        ];
        for ellipse in wrong {
            let p = chance_of_outline(bench, &case, 21_200, ellipse, VIEWS[2].size[0]);
            assert!(p < LEVEL, "{ellipse:?} passes on {bench:?}: p {p:e}");
        }
    }
}
