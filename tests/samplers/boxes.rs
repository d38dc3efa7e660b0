//! Boxes that shine: the places of their faces that are drawn, by solid angle, and the densities that are stated.
//!
//! Cells are rectangles of a face, whose solid angle is a sum of four arc tangents, one for each corner. A face below
//! 0.003 sr is drawn evenly by area. The draws are the renderer's own, through the probe kernel on the GPU.

use super::LEVEL;
use crate::support;
use crate::support::bench::{Bench, benches};
use crate::support::chance::{fit, sidak};
use glam::{DVec3, Vec3, Vec4};
use lampray::cpu::maths::{Basis, basis_around};
use lampray::cpu::random::{random_key, random_unit};
use lampray::cpu::rectangle::{box_inverse_density, sample_box};
use lampray::pack::{Cuboid, ProbeInput, ProbeOutput, words};
use lampray::shader::Probe;
use std::f64::consts::PI;

const DRAWS: usize = 400_000;
/// Cells along each side of a face.
const SIDE: usize = 12;

/// A box around the origin, and a receiver in the box's own axes.
#[derive(Clone, Copy, Debug)]
struct Place {
    half: DVec3,
    from: DVec3,
}

const fn place(half: [f64; 3], from: [f64; 3]) -> Place {
    Place {
        half: DVec3::from_array(half),
        from: DVec3::from_array(from),
    }
}

/// One face, two and three of them; from the side; all but on a face; small; thin; and from inside.
const PLACES: [Place; 10] = [
    place([0.5, 0.3, 0.8], [0.1, -0.9, 0.2]),
    place([0.5, 0.3, 0.8], [1.4, 0.9, 0.2]),
    place([0.5, 0.3, 0.8], [-1.1, 0.8, 1.9]),
    place([0.5, 0.3, 0.8], [0.2, 0.31, -0.3]),
    place([0.5, 0.3, 0.8], [3.0, 0.32, 0.0]),
    place([0.1, 0.2, 0.15], [-8.0, 5.0, 6.0]),
    place([2.0, 0.02, 0.02], [0.3, 0.5, 0.4]),
    place([0.5, 0.3, 0.8], [0.0, 0.0, 0.0]),
    place([0.5, 0.3, 0.8], [0.4, -0.2, 0.7]),
    place([0.5, 0.3, 0.8], [-0.3, 0.299, 0.1]),
];

fn axes() -> Basis {
    basis_around(Vec3::new(0.3, -0.5, 0.8).normalize())
}

impl Place {
    fn inside(self) -> bool {
        self.from.abs().cmplt(self.half).all()
    }

    /// As the probe kernel has it.
    fn shape(self) -> Cuboid {
        let axes = axes();
        Cuboid {
            half_size: self.half.as_vec3().to_array(),
            axis_x: axes.x.to_array(),
            axis_y: axes.y.to_array(),
            axis_z: axes.z.to_array(),
            ..Cuboid::default()
        }
    }

    /// The receiver in the scene's axes.
    fn origin(self) -> Vec3 {
        let (axes, from) = (axes(), self.from.as_vec3());
        from.x * axes.x + from.y * axes.y + from.z * axes.z
    }

    /// Solid angle of a part of a face, 0 where it is not seen; bounds along the face's two axes, -1 to 1.
    fn angle(self, face: usize, low: [f64; 2], high: [f64; 2]) -> f64 {
        let (axis, side) = (face / 2, if face % 2 == 1 { 1.0 } else { -1.0 });
        let [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
        let height = side * self.from[axis] - self.half[axis];
        let height = if self.inside() { -height } else { height };
        if height <= 0.0 {
            return 0.0;
        }
        let along = |x: f64, axis: usize| x * self.half[axis] - self.from[axis];
        let corner =
            |x: f64, y: f64| (x * y).atan2(height * (x * x + y * y + height * height).sqrt());
        let [x, y] = [
            [along(low[0], b), along(high[0], b)],
            [along(low[1], c), along(high[1], c)],
        ];
        corner(x[1], y[1]) - corner(x[0], y[1]) - corner(x[1], y[0]) + corner(x[0], y[0])
    }

    fn face(self, face: usize) -> f64 {
        self.angle(face, [-1.0; 2], [1.0; 2])
    }

    fn total(self) -> f64 {
        (0..6).map(|face| self.face(face)).sum()
    }

    /// Share of the draws that each cell should have.
    fn shares(self, law: impl Fn(f64) -> f64) -> Vec<f64> {
        let total = self.total();
        let edge = |cell: usize| 2.0 * cell as f64 / SIDE as f64 - 1.0;
        let share = |number: usize| {
            let (face, cell) = (number / (SIDE * SIDE), number % (SIDE * SIDE));
            let (i, j) = (cell / SIDE, cell % SIDE);
            let whole = self.face(face);
            match law(whole) < 0.0 {
                true => whole / total / (SIDE * SIDE) as f64,
                false => self.angle(face, [edge(i), edge(j)], [edge(i + 1), edge(j + 1)]) / total,
            }
        };
        (0..6 * SIDE * SIDE).map(share).collect()
    }
}

fn input(place: Place, u: [f32; 4]) -> ProbeInput {
    let (half, origin) = (place.half.as_vec3(), place.origin());
    ProbeInput {
        a: half.extend(0.0).to_array(),
        b: origin.extend(0.0).to_array(),
        c: u,
        d: [f32::from(u8::from(place.inside())), 0.0, 0.0, 0.0],
    }
}

fn probed(probe: Probe, inputs: &[ProbeInput]) -> Vec<ProbeOutput> {
    let mut gpu = support::gpu("boxes").expect("only benches that are there");
    gpu.probe(&support::strategy(), probe, inputs).unwrap()
}

/// Direction, distance and inverse density of each draw.
fn draws(bench: Bench, place: Place, seed: u32) -> Vec<(Vec4, f32)> {
    let numbers =
        (0..DRAWS as u64).map(|n| random_unit(random_key([seed, 3], [0, 0], words(n)), 1, 1));
    if bench == Bench::Twin {
        let one = |u| {
            let drawn = sample_box(
                &place.shape(),
                place.origin(),
                place.inside(),
                Vec4::from_array(u),
            );
            (
                drawn.direction.extend(drawn.distance),
                drawn.inverse_density,
            )
        };
        return numbers.map(one).collect();
    }
    let inputs: Vec<_> = numbers.map(|u| input(place, u)).collect();
    let outputs = probed(Probe::SampleBox, &inputs);
    outputs
        .iter()
        .map(|out| (Vec4::from_array(out.a), out.b[0]))
        .collect()
}

/// The cell of a drawn point.
fn cell(place: Place, drawn: Vec4) -> usize {
    let (direction, axes) = (drawn.truncate(), axes());
    let local = Vec3::new(
        direction.dot(axes.x),
        direction.dot(axes.y),
        direction.dot(axes.z),
    );
    let at = (place.from + f64::from(drawn.w) * local.as_dvec3()) / place.half;
    let axis = (0..3)
        .max_by(|&a, &b| at[a].abs().total_cmp(&at[b].abs()))
        .unwrap();
    assert!((at[axis].abs() - 1.0).abs() < 1e-2, "{place:?}: {at}");
    let face = 2 * axis + usize::from(at[axis] > 0.0);
    let along = |x: f64| (((x + 1.0) * 0.5 * SIDE as f64).max(0.0) as usize).min(SIDE - 1);
    let (b, c) = (at[(axis + 1) % 3], at[(axis + 2) % 3]);
    (face * SIDE + along(b)) * SIDE + along(c)
}

/// Below zero for a face that is drawn by area.
fn law(angle: f64) -> f64 {
    angle - 3e-3
}

#[test]
fn faces_are_drawn_by_their_solid_angle() {
    let level = sidak(LEVEL, PLACES.len());
    for bench in benches() {
        for (number, place) in PLACES.into_iter().enumerate() {
            let mut counts = vec![0.0; 6 * SIDE * SIDE];
            let drawn = draws(bench, place, number as u32);
            for (at, _) in &drawn {
                counts[cell(place, *at)] += 1.0;
            }
            let expected = |of: Place, law: fn(f64) -> f64| {
                let shares = of.shares(law);
                shares.iter().map(|p| p * DRAWS as f64).collect::<Vec<_>>()
            };
            let right = fit(&counts, &expected(place, law));
            println!("{bench:?} {place:?}: p {:.4}", right.p);
            assert!(right.p >= level, "{bench:?} {place:?}: {right:?}");
            // A receiver a little aside that sees the same faces.
            let moved = match place.inside() {
                true => 0.9 * place.from + 0.1 * place.half,
                false => place.from * DVec3::new(1.0, 1.1, 1.0) + 0.05 * place.half,
            };
            let aside = Place {
                from: moved,
                ..place
            };
            let wrong = fit(&counts, &expected(aside, law));
            assert!(
                wrong.p < level,
                "{bench:?} {place:?}: the wrong law passes: {wrong:?}"
            );
        }
    }
}

/// Inverse densities of the middles of all cells of a face, by the function that a hit of the box asks.
fn stated(bench: Bench, place: Place, face: usize) -> Vec<f64> {
    let (axis, side) = (face / 2, if face % 2 == 1 { 1.0 } else { -1.0 });
    let middle = |cell: usize| 2.0 * (cell as f64 + 0.5) / FINE as f64 - 1.0;
    let point = |number: usize| {
        let mut at = DVec3::ZERO;
        at[axis] = side;
        at[(axis + 1) % 3] = middle(number / FINE);
        at[(axis + 2) % 3] = middle(number % FINE);
        (at * place.half).as_vec3()
    };
    let points = (0..FINE * FINE).map(point);
    if bench == Bench::Twin {
        let basis = axes();
        let world = |v: Vec3| v.x * basis.x + v.y * basis.y + v.z * basis.z;
        let outward = world(side as f32 * [Vec3::X, Vec3::Y, Vec3::Z][axis]);
        let one = |at: Vec3| {
            let to = world(at) - place.origin();
            box_inverse_density(&place.shape(), place.origin(), place.inside(), to, outward).into()
        };
        return points.map(one).collect();
    }
    let one = |at: Vec3| {
        let mut made = input(place, at.extend(0.0).to_array());
        made.d[1] = face as f32;
        made
    };
    let outputs = probed(Probe::BoxDensity, &points.map(one).collect::<Vec<_>>());
    outputs.iter().map(|out| f64::from(out.a[0])).collect()
}

/// Midpoints along each side of a face.
const FINE: usize = 40;

#[test]
fn densities_of_boxes_integrate_to_one() {
    for bench in benches() {
        for place in PLACES {
            let edge = |cell: usize| 2.0 * cell as f64 / FINE as f64 - 1.0;
            let mut mass = 0.0;
            for face in (0..6).filter(|&face| place.face(face) > 0.0) {
                for (number, inverse) in stated(bench, place, face).into_iter().enumerate() {
                    let (i, j) = (number / FINE, number % FINE);
                    let angle = place.angle(face, [edge(i), edge(j)], [edge(i + 1), edge(j + 1)]);
                    mass += angle / inverse;
                }
            }
            println!("{bench:?} {place:?}: {mass:.6}");
            assert!((mass - 1.0).abs() < 1e-3, "{bench:?} {place:?}: {mass}");
        }
    }
}

/// A draw states the density that a hit of the same place is given: one over all the angles, or by area.
#[test]
fn draws_of_boxes_state_their_density() {
    for bench in benches() {
        for (number, place) in PLACES.into_iter().enumerate() {
            let total = place.total();
            for (at, inverse) in draws(bench, place, number as u32).into_iter().take(20_000) {
                let face = cell(place, at) / (SIDE * SIDE);
                let whole = place.face(face);
                let wanted = if law(whole) < 0.0 {
                    let axis = face / 2;
                    let area = 4.0 * place.half[(axis + 1) % 3] * place.half[(axis + 2) % 3];
                    let height = place.half[axis] - place.from[axis].abs();
                    area * height.abs() / f64::from(at.w).powi(3) * total / whole
                } else {
                    total
                };
                let off = (f64::from(inverse) / wanted - 1.0).abs();
                assert!(off < 1e-3, "{bench:?} {place:?}: {inverse} for {wanted}");
            }
        }
    }
    assert!((PLACES[7].total() - 4.0 * PI).abs() < 1e-12);
}
