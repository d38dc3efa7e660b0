//! A box that shines over a floor, found by shadow rays or left to scattered rays: with the same
//! expectation, under every strategy and by every kernel.
//!
//! Light reflected is rho Le F, F the form factor. Straight below the middle of a face with half sizes
//! a, b at height h, and A = a / h, B = b / h,
//! F = (2 / pi) [A / sqrt(1 + A^2) atan(B / sqrt(1 + A^2)) + B / sqrt(1 + B^2) atan(A / sqrt(1 + B^2))].
//! In general a box is its visible faces, each cut at the horizon, and of a polygon
//! F = |sum over edges of angle * (edge normal . n)| / (2 pi) (Lambert 1760, "Photometria").

use super::cross::{check_all, covering};
use super::lamp::turn;
use crate::support::bench::benches;
use crate::support::gate::{Case, Family, Form};
use crate::support::quadrature::integrate;
use glam::DVec3;
use std::f64::consts::PI;

/// Form factor of a face straight above.
fn above(a: f64, b: f64) -> f64 {
    let half = |a: f64, b: f64| {
        let root = (1.0 + a * a).sqrt();
        a / root * (b / root).atan()
    };
    2.0 / PI * (half(a, b) + half(b, a))
}

/// The part of a polygon above the floor.
fn clipped(polygon: &[DVec3]) -> Vec<DVec3> {
    let mut kept = Vec::new();
    for (i, &p) in polygon.iter().enumerate() {
        let next = polygon[(i + 1) % polygon.len()];
        if p.y >= 0.0 {
            kept.push(p);
        }
        if (p.y >= 0.0) != (next.y >= 0.0) {
            kept.push(p.lerp(next, p.y / (p.y - next.y)));
        }
    }
    kept
}

/// Lambert's sum for a polygon above the floor, seen from the origin.
fn polygon_factor(polygon: &[DVec3]) -> f64 {
    let edge = |i: usize| {
        let (p, next) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let across = p.cross(next);
        p.angle_between(next) * across.y / across.length().max(1e-300)
    };
    (0..polygon.len()).map(edge).sum::<f64>().abs() / (2.0 * PI)
}

/// A box over the floor y = 0, and where the floor is looked at.
#[derive(Clone, Copy, Debug)]
struct Panel {
    center: DVec3,
    half: DVec3,
    degrees: DVec3,
    spot: DVec3,
}

impl Panel {
    /// The faces whose outer side the spot sees, about the spot.
    fn faces(self) -> Vec<[DVec3; 4]> {
        let axes = turn(self.degrees);
        let mut faces = Vec::new();
        for axis in 0..3 {
            let [out, along, up] =
                [axis, (axis + 1) % 3, (axis + 2) % 3].map(|axis| axes.col(axis) * self.half[axis]);
            for side in [-1.0, 1.0] {
                let middle = self.center - self.spot + side * out;
                if middle.dot(side * out) < 0.0 {
                    let corner = |s: f64, t: f64| middle + s * along + t * up;
                    let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
                    faces.push(corners.map(|(s, t)| corner(s, t)));
                }
            }
        }
        faces
    }

    fn factor(self) -> f64 {
        let faces = self.faces().into_iter();
        faces.map(|face| polygon_factor(&clipped(&face))).sum()
    }

    /// The same by quadrature: cos cos' / (pi d^2) over each face, nothing from below the floor.
    fn integrated(self) -> f64 {
        let face = |[a, b, c, d]: [DVec3; 4]| {
            let area = (b - a).cross(d - a);
            let point = |u: f64, v: f64| a.lerp(b, u).lerp(d.lerp(c, u), v);
            integrate(0.0, 1.0, 60, |u| {
                integrate(0.0, 1.0, 60, |v| {
                    let to = point(u, v);
                    to.y.max(0.0) * to.dot(area).abs() / (PI * to.length_squared().powi(2))
                })
            })
        };
        self.faces().into_iter().map(face).sum()
    }

    fn case(self) -> Case {
        let eye = self.spot + DVec3::new(-0.16, 0.1, 0.12);
        let scene = format!(
            "version = 1
            camera = {{ position = {eye}, look_at = {}, fov = 0.02 }}
            image = {{ width = 32, height = 32 }}
            render = {{ max_bounces = 1 }}
            [[boxes]]
            min = [-3.0, -0.5, -3.0]
            max = [3.0, 0.0, 3.0]
            material = \"floor\"
            [[boxes]]
            min = {}
            max = {}
            rotation = {}
            material = \"panel\"
            [materials.floor]
            albedo = {ALBEDO:?}
            survival = 0.85
            [materials.panel]
            albedo = [0.3, 0.3, 0.3]
            emission = {EMISSION:?}",
            self.spot,
            self.center - self.half,
            self.center + self.half,
            self.degrees
        );
        let factor = self.factor();
        let truth = [0, 1, 2].map(|channel| ALBEDO[channel] * EMISSION[channel] * factor);
        Case::new(format!("{self:?}"), scene, Form::Mean(truth))
    }
}

const ALBEDO: [f64; 3] = [0.8, 0.35, 0.6];
const EMISSION: [f64; 3] = [1.5, 4.0, 0.7];

const fn panel(center: [f64; 3], half: [f64; 3], degrees: [f64; 3], spot: [f64; 2]) -> Panel {
    Panel {
        center: DVec3::from_array(center),
        half: DVec3::from_array(half),
        degrees: DVec3::from_array(degrees),
        spot: DVec3::new(spot[0], 0.0, spot[1]),
    }
}

const FLAT: [f64; 3] = [0.0; 3];

/// Straight above the spot, the lower face at 0.9, 0.4 and 1.1.
const ABOVE: [Panel; 3] = [
    panel([0.2, 1.2, -0.1], [0.7, 0.3, 0.4], FLAT, [0.2, -0.1]),
    panel([0.0, 0.5, 0.0], [0.5, 0.1, 0.5], FLAT, [0.0, 0.0]),
    panel([-0.4, 1.6, 0.3], [0.9, 0.5, 1.5], FLAT, [-0.4, 0.3]),
];

/// Beside the spot, turned, standing in the floor, and both.
const ANYWHERE: [Panel; 4] = [
    panel([0.6, 0.7, -0.5], [0.5, 0.5, 0.4], FLAT, [0.0, 0.1]),
    panel(
        [0.3, 0.9, -0.2],
        [0.6, 0.3, 0.5],
        [20.0, 30.0, -40.0],
        [0.0, 0.0],
    ),
    panel([0.7, 0.3, -0.5], [0.5, 0.5, 0.6], FLAT, [0.0, 0.2]),
    panel(
        [0.6, 0.25, -0.6],
        [0.5, 0.5, 0.5],
        [20.0, 10.0, -15.0],
        [0.0, 0.0],
    ),
];

#[test]
fn the_form_factors_are_known() {
    assert!((above(0.7 / 0.9, 0.4 / 0.9) - 0.291_64).abs() < 5e-6);
    for panel in ABOVE {
        let height = panel.center.y - panel.half.y;
        let closed = above(panel.half.x / height, panel.half.z / height);
        assert!((panel.factor() - closed).abs() < 1e-12, "{panel:?}");
        assert_eq!(panel.faces().len(), 1);
    }
    for (panel, faces) in ANYWHERE.into_iter().zip([3, 2, 2, 2]) {
        let (sum, integral) = (panel.factor(), panel.integrated());
        println!(
            "{panel:?}: form factor {sum:.5}, {} faces",
            panel.faces().len()
        );
        assert!((sum - integral).abs() < 1e-5, "{sum} {integral}");
        assert_eq!(panel.faces().len(), faces, "{panel:?}");
    }
}

#[test]
fn every_knob_gives_the_form_factor_of_a_box() {
    let mut family = Family::new("shining box", 22_000);
    for bench in benches() {
        for panels in [&ABOVE[..], &ANYWHERE] {
            check_all(&mut family, bench, &covering(bench), |choice| {
                choice.pick(panels).case()
            });
        }
    }
    family.finish();
}

/// Small and far, where points are drawn by area; long and thin; all but touching the floor.
const HARD: [Panel; 4] = [
    panel([0.3, 9.0, 0.2], [0.2, 0.1, 0.15], FLAT, [0.0, 0.1]),
    panel(
        [0.1, 1.0, 0.0],
        [1.8, 0.02, 0.02],
        [0.0, 30.0, 0.0],
        [0.3, 0.1],
    ),
    panel([0.9, 0.501, 0.0], [0.5, 0.5, 0.4], FLAT, [0.2, 0.1]),
    panel([0.0, 0.07, 0.0], [1.5, 0.05, 1.2], FLAT, [0.9, 0.4]),
];

#[test]
fn hard_boxes_have_their_form_factors() {
    let mut family = Family::new("shining box, hard", 24_000);
    for bench in benches() {
        for panel in HARD {
            for strategy in ["sample", "mis"] {
                let mut case = panel.case().set("light.boxes", "sample");
                if panel.center.y < 0.1 {
                    // Below the panel.
                    case = case.set("camera.position", "[0.89, 0.015, 0.38]");
                }
                family.check(bench, &case.set("light.strategy", strategy));
            }
        }
    }
    family.finish();
}

#[test]
fn every_kernel_samples_boxes() {
    let mut family = Family::new("shining box, kernels", 25_000);
    for bench in benches() {
        for kernel in ["general", "baked", "bvh"] {
            for panel in [ABOVE[0], ANYWHERE[1], ANYWHERE[3]] {
                for strategy in ["sample", "mis"] {
                    let case = panel.case().set("light.boxes", "sample");
                    let case = case.set("render.kernel", kernel);
                    family.check(bench, &case.set("light.strategy", strategy));
                }
            }
        }
    }
    family.finish();
}

#[test]
fn the_gate_rejects_small_faults() {
    let mut family = Family::new("shining box, mutants", 23_000);
    for bench in benches() {
        let case = ABOVE[0].case();
        let with = |path: &str, value: &str| case.clone().set(path, value);
        let mutants = [
            with("boxes.1.min", "[-0.514, 0.9, -0.508]"),
            with("boxes.1.min", "[-0.5, 0.91, -0.5]"),
            with("materials.panel.emission", "[1.515, 4.04, 0.707]"),
            with("render.max_bounces", "0"),
            with("light.strategy", "sample").set("light.direct", "lambert"),
            ANYWHERE[1].case().set("boxes.1.rotation", "[20, 30, -45]"),
            ANYWHERE[1].case().set("boxes.1.rotation", "[0, 0, 0]"),
            ANYWHERE[2].case().set("boxes.1.max", "[1.2, 0.77, 0.1]"),
        ];
        for mutant in mutants {
            family.reject(bench, &mutant);
        }
    }
}
