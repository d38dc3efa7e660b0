//! Interrupted paths in a closed diffuse enclosure that shines evenly, found by hits alone.
//!
//! A path that makes K reflections has X = e (1 + w + ... + w^K), with w = rho / t where survivors
//! are compensated and w = rho where they are not (literal). K is geometric, P(K >= k) = t^k, up
//! to a limit N. With Arvo and Kirk ("Particle transport and image synthesis", 1990) for the weight, without
//! a limit:
//! - compensated: mean e / (1 - rho), variance e^2 rho^2 (1 - t) / ((1 - rho)^2 (t - rho^2)),
//!   which has no bound for t <= rho^2;
//! - literal: mean e / (1 - rho t); with a limit e (1 - (rho t)^(N + 1)) / (1 - rho t);
//! - both: 1 / (1 - t) rays, with a limit (1 - t^(N + 1)) / (1 - t).

use super::spread::{Law, check, reject};
use crate::support::bench::benches;
use crate::support::gate::{Case, Form, MOST_ERRORS};
use lampray::film::Film;

pub const EMISSION: [f64; 3] = [0.7, 1.0, 2.3];
/// Reflections after which no sum here changes any more.
const ENDLESS: u32 = 600;

const SPHERE: &str = "spheres = [{ center = [0.1, 0.2, 0.3], radius = 1.7, material = \"wall\" }]";
const TURNED_BOX: &str = "boxes = [{ min = [-1.0, -0.7, -1.3], max = [1.2, 0.9, 1.1], rotation = [20.0, -35.0, 50.0], material = \"wall\" }]";

/// An enclosure and how its paths are interrupted.
#[derive(Clone, Copy, Debug)]
pub struct Walls {
    pub shape: &'static str,
    pub albedo: [f64; 3],
    pub survival: f64,
    /// The rule by which paths survive with the probability `survival`.
    pub rule: &'static str,
    pub literal: bool,
    pub max_bounces: u32,
}

pub const PLAIN: Walls = Walls {
    shape: SPHERE,
    albedo: [0.75, 0.5, 0.3],
    survival: 0.75,
    rule: "survival",
    literal: false,
    max_bounces: ENDLESS,
};

impl Walls {
    /// P(K = k).
    fn chance(self, k: u32) -> f64 {
        let reached = self.survival.powi(k as i32);
        if k < self.max_bounces {
            reached * (1.0 - self.survival)
        } else {
            reached
        }
    }

    pub fn law(self, channel: usize) -> Law {
        let survivor = if self.literal { 1.0 } else { self.survival };
        let weight = self.albedo[channel] / survivor;
        let moment = |power: i32| {
            let (mut sum, mut radiance, mut carried) = (0.0, 0.0, 1.0);
            for k in 0..=self.max_bounces {
                radiance += carried;
                carried *= weight;
                sum += self.chance(k) * f64::powi(radiance, power);
            }
            sum
        };
        Law::from_moments(moment).scaled(EMISSION[channel])
    }

    pub fn laws(self) -> [Law; 3] {
        [0, 1, 2].map(|channel| self.law(channel))
    }

    /// Rays of a path, K + 1: mean and variance.
    fn rays(self) -> (f64, f64) {
        let moment = |power: i32| -> f64 {
            let rays = |k: u32| self.chance(k) * f64::from(k + 1).powi(power);
            (0..=self.max_bounces).map(rays).sum()
        };
        (moment(1), moment(2) - moment(1).powi(2))
    }

    fn weight(self) -> &'static str {
        if self.literal {
            "literal"
        } else {
            "compensated"
        }
    }

    pub fn case(self) -> Case {
        let scene = format!(
            "version = 1
            camera = {{ position = [0.3, -0.1, 0.2], look_at = [1.0, 0.5, -0.4], fov = 100 }}
            image = {{ width = 32, height = 32 }}
            render = {{ max_bounces = {} }}
            background = {{ emission = [1000.0, 1000.0, 1000.0] }}
            {}
            light = {{ strategy = \"hit\" }}
            interruption = {{ rule = \"{}\", weight = \"{}\", start = 0 }}
            [materials.wall]
            albedo = {:?}
            emission = {EMISSION:?}
            survival = {}",
            self.max_bounces,
            self.shape,
            self.rule,
            self.weight(),
            self.albedo,
            self.survival
        );
        let name = format!(
            "albedo {:?}, {} {} {}, {} bounces",
            self.albedo,
            self.rule,
            self.survival,
            self.weight(),
            self.max_bounces
        );
        Case::new(name, scene, Form::Mean(self.laws().map(|law| law.mean)))
    }
}

/// Closed forms, without a limit: mean and variance for emission 1.
pub fn compensated(albedo: f64, survival: f64) -> (f64, f64) {
    let lost = 1.0 - albedo;
    let variance =
        albedo * albedo * (1.0 - survival) / (lost * lost * (survival - albedo * albedo));
    (1.0 / lost, variance)
}

#[test]
fn the_sums_are_the_closed_forms() {
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    for survival in [0.6, 0.75, 0.9] {
        let walls = Walls { survival, ..PLAIN };
        for (channel, e) in EMISSION.into_iter().enumerate() {
            let albedo = walls.albedo[channel];
            let (mean, variance) = compensated(albedo, survival);
            close(walls.law(channel).mean, e * mean);
            close(walls.law(channel).variance, e * e * variance);
            let literal = Walls {
                literal: true,
                ..walls
            };
            close(literal.law(channel).mean, e / (1.0 - albedo * survival));
            let short = Walls {
                max_bounces: 3,
                ..literal
            };
            let ratio = albedo * survival;
            close(
                short.law(channel).mean,
                e * (1.0 - ratio.powi(4)) / (1.0 - ratio),
            );
        }
        close(walls.rays().0, 1.0 / (1.0 - survival));
        let short = Walls {
            max_bounces: 3,
            ..walls
        };
        close(short.rays().0, (1.0 - survival.powi(4)) / (1.0 - survival));
    }
    // rho = t = 3/4: relative variance 3/4, and 2.29 for 4.00 when survivors are not compensated.
    close(PLAIN.law(0).relative_variance(), 0.75);
    let literal = Walls {
        literal: true,
        ..PLAIN
    };
    close(literal.law(0).mean / EMISSION[0], 16.0 / 7.0);
}

/// Rays of a path beside those that are expected, in standard errors.
fn distance_of_cost(walls: Walls, film: &Film) -> f64 {
    let (rays, variance) = walls.rays();
    let found = film.rays as f64 / film.paths as f64;
    let z = (found - rays) / (variance / film.paths as f64).sqrt();
    println!("  {found:.4} rays a path for {rays:.4}, z {z:+.2}");
    z
}

/// Compensated, by every rule that comes to one probability here; literal; and with limits.
fn measured() -> Vec<Walls> {
    let with = |albedo, survival| Walls {
        albedo,
        survival,
        ..PLAIN
    };
    let grey = |albedo| [albedo, albedo, albedo];
    let mut all = vec![
        PLAIN,
        with([0.5, 0.4, 0.3], 0.5),
        with([0.8, 0.5, 0.1], 0.9),
        with(grey(0.9), 0.95),
        Walls {
            rule: "albedo",
            ..PLAIN
        },
        Walls {
            rule: "throughput",
            ..PLAIN
        },
        Walls {
            rule: "albedo",
            ..with(grey(0.9), 0.9)
        },
    ];
    all.extend([PLAIN, with([0.9, 0.5, 0.2], 0.6)].map(|walls| Walls {
        literal: true,
        ..walls
    }));
    for (max_bounces, literal) in [(1, true), (2, false), (3, true), (7, false), (7, true)] {
        all.push(Walls {
            literal,
            max_bounces,
            ..PLAIN
        });
    }
    all
}

#[test]
fn interrupted_paths_have_the_mean_variance_and_length_that_are_computed() {
    let mut seed = 32_000;
    for bench in benches() {
        for (n, walls) in measured().into_iter().enumerate() {
            let shape = [SPHERE, TURNED_BOX][(n + bench as usize) % 2];
            let walls = Walls { shape, ..walls };
            seed += 1;
            let film = check(bench, &walls.case(), seed, walls.laws());
            let cost = distance_of_cost(walls, &film);
            assert!(cost.abs() <= MOST_ERRORS, "{walls:?}: z {cost}");
        }
    }
}

#[test]
fn the_gate_tells_interruptions_apart() {
    let mut seed = 34_000;
    for bench in benches() {
        let with = |path: &str, value: &str| PLAIN.case().set(path, value);
        let mutants = [
            with("interruption.weight", "literal"),
            with("interruption.start", "1"),
            with("interruption.rule", "none"),
            with("materials.wall.survival", "0.77"),
            with("materials.wall.albedo", "[0.74, 0.5, 0.3]"),
            with("render.max_bounces", "6"),
            with("scatter.diffuse", "uniform"),
            with("light.strategy", "sample"),
        ];
        for mutant in mutants {
            seed += 1;
            reject(bench, &mutant, seed, PLAIN.laws());
        }
        let longer = with("materials.wall.survival", "0.753").scene(seed + 1);
        let cost = distance_of_cost(PLAIN, &bench.film(&longer, 0..2000));
        assert!(
            cost > MOST_ERRORS,
            "the gate let longer paths pass: z {cost}"
        );
        seed += 1;
    }
}
