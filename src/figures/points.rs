//! Figure 6: points of the three cases on a sphere.

use super::build::chance;
use super::data::{CASES, Data};
use super::figure::*;
use crate::error::Result;
use crate::theory::{
    chi_square_above, distance_of_sorted, kolmogorov_above, polar_share, polar_share_even,
    z_distribution,
};
use std::f64::consts::PI;
use std::fmt::Write as _;

/// What a test has to be below to count.
const LEVEL: f64 = 0.01;
/// Rings of equal height, and cells of each: equal areas.
const RINGS: usize = 6;
const SECTORS: usize = 8;

/// What is tested of a case's points.
struct Tested {
    /// Share within 30 degrees of a pole.
    polar: f64,
    /// Largest distance of the heights' distribution from an even one, and its chance under it.
    distance: f64,
    distance_p: f64,
    /// Pearson's statistic over cells of equal area, and its chance where points are even by area.
    square: f64,
    square_p: f64,
}

impl Tested {
    fn new(points: &[[f64; 3]]) -> Self {
        let count = points.len() as f64;
        let polar = points
            .iter()
            .filter(|point| point[2].abs() >= 0.75f64.sqrt())
            .count();
        let distance = distance(points, |z| 0.5 + 0.5 * z);
        let square = square(points);
        Self {
            polar: polar as f64 / count,
            distance,
            distance_p: kolmogorov_above(distance * count.sqrt()),
            square,
            square_p: chi_square_above(square, (RINGS * SECTORS - 1) as f64),
        }
    }

    fn is_even(&self) -> bool {
        // Two tests of each case.
        self.distance_p > 0.5 * LEVEL && self.square_p > 0.5 * LEVEL
    }
}

fn heights(points: &[[f64; 3]]) -> Vec<f64> {
    let mut heights: Vec<f64> = points.iter().map(|point| point[2]).collect();
    heights.sort_by(f64::total_cmp);
    heights
}

/// Kolmogorov's distance of the heights from a distribution.
fn distance(points: &[[f64; 3]], distribution: impl Fn(f64) -> f64) -> f64 {
    let heights = heights(points);
    let count = heights.len() as f64;
    let apart = |(index, z): (usize, &f64)| {
        let expected = distribution(*z);
        let (below, above) = (index as f64 / count, (index as f64 + 1.0) / count);
        (expected - below).abs().max((above - expected).abs())
    };
    heights.iter().enumerate().map(apart).fold(0.0, f64::max)
}

/// Pearson's statistic over cells of equal area.
fn square(points: &[[f64; 3]]) -> f64 {
    let mut counts = [0.0; RINGS * SECTORS];
    for [x, y, z] in points {
        let ring = (0.5 * (z + 1.0) * RINGS as f64) as usize;
        let sector = ((y.atan2(*x) / PI + 1.0) * 0.5 * SECTORS as f64) as usize;
        counts[ring.min(RINGS - 1) * SECTORS + sector.min(SECTORS - 1)] += 1.0;
    }
    let expected = points.len() as f64 / counts.len() as f64;
    counts
        .iter()
        .map(|count| (count - expected) * (count - expected) / expected)
        .sum()
}

/// # Errors
/// None; the signature is that of the other figures.
pub fn figure(data: &Data) -> Result<Figure> {
    let tested: Vec<_> = data
        .points
        .iter()
        .map(|points| Tested::new(points))
        .collect();
    let [second, third] = [1, 2].map(|case| heights(&data.points[case]));
    let apart = distance_of_sorted(&second, &third);
    let apart_p = kolmogorov_above(apart * (0.5 * second.len() as f64).sqrt());
    Ok(Figure {
        number: 6,
        title: "Points on a spherical lamp".into(),
        claim: format!(
            "{} points of each case: those of case 1 crowd at the poles, those of cases 2 and 3 are even over the sphere.",
            second.len()
        ),
        reading: "The points are drawn by the functions that the renderer draws its shadow rays with. Case 1 takes both \
                  angles even, case 2 the polar angle as acos(1 - 2u), case 3 three normal numbers scaled to length 1. \
                  This figure has no correction: a density that is not even is no fault as long as it is divided by."
            .into(),
        verdict: verdict(&tested, apart_p),
        results: results(&tested, apart, apart_p),
        blocks: vec![Block::Plots(spheres(data, &tested)), Block::Table(table(&tested))],
        commands: commands(&second),
        sweeps: data.pages(6),
        data: vec![csv(data)],
    })
}

fn commands(points: &[f64]) -> Vec<String> {
    let command = |case: &str| {
        format!(
            "lampray points light --set light.sampler={case} -n {} -o fig6-{case}.csv",
            points.len()
        )
    };
    CASES.map(command).to_vec()
}

fn spheres(data: &Data, tested: &[Tested]) -> Plots {
    let hues = [Hue::Red, Hue::Green, Hue::Blue];
    let sphere = |case: usize| {
        Plot::Sphere(Sphere {
            title: format!("Case {}: {}", case + 1, CASES[case]),
            note: format!(
                "{:.1} % within 30° of the poles",
                100.0 * tested[case].polar
            ),
            colour: hues[case],
            points: data.points[case].clone(),
        })
    };
    Plots {
        name: "points".into(),
        caption: "The paper's colours; the pole is upright, the circles are 30 degrees from it."
            .into(),
        plots: (0..3).map(sphere).collect(),
    }
}

fn table(tested: &[Tested]) -> Table {
    let row = |(case, one): (usize, &Tested)| {
        let expected = match case {
            0 => polar_share(30.0),
            _ => polar_share_even(30.0),
        };
        vec![
            format!("{}, {}", case + 1, CASES[case]),
            format!("{:.1} %", 100.0 * one.polar),
            format!("{:.1} %", 100.0 * expected),
            format!("{:.4}", one.distance),
            chance(one.distance_p),
            format!("{:.1}", one.square),
            chance(one.square_p),
        ]
    };
    let head = [
        "case",
        "within 30° of a pole",
        "expected",
        "KS distance from even",
        "p",
        "chi-square of 48 equal areas",
        "p",
    ];
    Table {
        caption: "Tests of evenness over the sphere; p is the chance of such a value if points were even.".into(),
        head: head.map(String::from).to_vec(),
        rows: tested.iter().enumerate().map(row).collect(),
    }
}

fn verdict(tested: &[Tested], apart_p: f64) -> Verdict {
    let crowds = !tested[0].is_even();
    let even = tested[1].is_even() && tested[2].is_even() && apart_p > LEVEL;
    let holds = match (crowds, even) {
        (true, true) => Holds::Yes,
        (false, _) => Holds::No,
        _ => Holds::Partly,
    };
    let told = match even {
        true => "and no test tells them from even points or from each other",
        false => "but a test tells them from even points or from each other",
    };
    Verdict {
        holds,
        text: format!(
            "{:.1} % of case 1's points are within 30 degrees of a pole, where an even sphere has {:.1} %; cases 2 and 3 have \
             {:.1} and {:.1} %, {told}.",
            100.0 * tested[0].polar,
            100.0 * polar_share_even(30.0),
            100.0 * tested[1].polar,
            100.0 * tested[2].polar,
        ),
    }
}

fn results(tested: &[Tested], apart: f64, apart_p: f64) -> Vec<String> {
    let crossing = (1.0 - 4.0 / (PI * PI)).sqrt();
    let furthest = 0.5 + 0.5 * crossing - z_distribution(crossing);
    vec![
        format!(
            "Case 1's heights are {:.4} from even at most (expected {furthest:.4}, at a height of {crossing:.3} of the radius); the \
             chance of that is {}.",
            tested[0].distance,
            chance(tested[0].distance_p)
        ),
        format!(
            "Case 2 against case 3: {apart:.4} apart at most, which has a chance of {} if they are one distribution; each serves as \
             the other's control in what follows.",
            chance(apart_p)
        ),
    ]
}

fn csv(data: &Data) -> DataFile {
    let mut csv = String::from("case,x,y,z\n");
    for (case, points) in CASES.iter().zip(&data.points) {
        for [x, y, z] in points {
            // Writing into a string cannot fail.
            let _ = writeln!(csv, "{case},{x},{y},{z}");
        }
    }
    DataFile {
        name: "fig6-points.csv".into(),
        csv,
    }
}
