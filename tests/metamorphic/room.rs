//! A scene as data that can be changed, with everything in it that a scene can have: mirror, lobe and
//! diffuse surfaces, turned boxes, one of them shining, two lamps, and a sky. No two surfaces touch, so
//! that no ray meets two of them at one distance.

use crate::support::bench::Bench;
use crate::support::gate::{Case, Form};
use lampray::film::Film;
use lampray::scene::{Assignment, Scene};
use std::fmt::Write as _;

pub type Triple = [f64; 3];

#[derive(Clone, Debug)]
pub struct Material {
    pub name: &'static str,
    pub scatter: &'static str,
    pub albedo: Triple,
    pub emission: Triple,
}

#[derive(Clone, Debug)]
pub struct Sphere {
    pub center: Triple,
    pub radius: f64,
    pub material: &'static str,
}

#[derive(Clone, Debug)]
pub struct Cuboid {
    pub min: Triple,
    pub max: Triple,
    pub rotation: Triple,
    pub material: &'static str,
}

#[derive(Clone, Debug)]
pub struct Room {
    pub eye: Triple,
    pub target: Triple,
    pub sky: Triple,
    pub materials: Vec<Material>,
    pub spheres: Vec<Sphere>,
    pub boxes: Vec<Cuboid>,
}

fn material(
    name: &'static str,
    scatter: &'static str,
    albedo: Triple,
    emission: Triple,
) -> Material {
    Material {
        name,
        scatter,
        albedo,
        emission,
    }
}

fn sphere(center: Triple, radius: f64, material: &'static str) -> Sphere {
    Sphere {
        center,
        radius,
        material,
    }
}

fn cuboid(min: Triple, max: Triple, rotation: Triple, material: &'static str) -> Cuboid {
    Cuboid {
        min,
        max,
        rotation,
        material,
    }
}

/// Names of the lamps' materials.
pub const LAMPS: [&str; 2] = ["small", "large"];

impl Room {
    pub fn new() -> Self {
        let dark = [0.0; 3];
        Self {
            eye: [0.4, 1.3, 4.2],
            target: [0.0, 0.6, 0.0],
            sky: [0.25, 0.35, 0.5],
            materials: vec![
                material("floor", "diffuse", [0.7, 0.6, 0.5], dark),
                material("mirror", "mirror", [0.9, 0.85, 0.8], dark),
                material("satin", "directional", [0.8, 0.5, 0.7], dark),
                material("glow", "diffuse", [0.5, 0.45, 0.4], [0.6, 0.3, 0.1]),
                material(LAMPS[0], "diffuse", dark, [2.8, 3.2, 3.6]),
                material(LAMPS[1], "diffuse", [0.6, 0.4, 0.2], [1.5, 1.2, 0.9]),
            ],
            spheres: vec![
                sphere([-0.5, 0.52, 0.3], 0.5, "mirror"),
                sphere([0.5, 0.42, 0.9], 0.4, "satin"),
                sphere([0.3, 2.1, 0.5], 0.35, LAMPS[0]),
                sphere([0.4, 0.63, -1.2], 0.6, LAMPS[1]),
            ],
            boxes: vec![
                cuboid([-3.0, -0.3, -3.0], [3.0, 0.0, 3.0], dark, "floor"),
                cuboid(
                    [-1.6, 0.02, -1.4],
                    [-0.9, 1.1, -0.7],
                    [0.0, 30.0, 0.0],
                    "glow",
                ),
                cuboid(
                    [0.9, 0.1, -0.4],
                    [1.5, 0.7, 0.2],
                    [20.0, 40.0, 10.0],
                    "satin",
                ),
            ],
        }
    }

    /// Nothing but the two lamps shines.
    pub fn with_lamps_alone(mut self) -> Self {
        self.sky = [0.0; 3];
        self.material("glow").emission = [0.0; 3];
        self
    }

    pub fn material(&mut self, name: &str) -> &mut Material {
        let mut all = self.materials.iter_mut();
        all.find(|material| material.name == name).unwrap()
    }

    /// Does the same to everything that shines.
    pub fn shining(mut self, change: impl Fn(Triple) -> Triple) -> Self {
        self.sky = change(self.sky);
        for material in &mut self.materials {
            material.emission = change(material.emission);
        }
        self
    }

    pub fn text(&self) -> String {
        let mut text = format!(
            "version = 1
            camera = {{ position = {:?}, look_at = {:?}, fov = 48 }}
            image = {{ width = 32, height = 32 }}
            render = {{ max_bounces = 4 }}
            background = {{ emission = {:?} }}\n",
            self.eye, self.target, self.sky
        );
        // Writing into a string cannot fail.
        for m in &self.materials {
            let _ = writeln!(
                text,
                "[materials.{}]\nscatter = {:?}\nspread = 0.35\nsurvival = 0.8\nalbedo = {:?}\nemission = {:?}",
                m.name, m.scatter, m.albedo, m.emission
            );
        }
        for s in &self.spheres {
            let _ = writeln!(
                text,
                "[[spheres]]\ncenter = {:?}\nradius = {:?}\nmaterial = {:?}",
                s.center, s.radius, s.material
            );
        }
        for b in &self.boxes {
            let _ = writeln!(
                text,
                "[[boxes]]\nmin = {:?}\nmax = {:?}\nrotation = {:?}\nmaterial = {:?}",
                b.min, b.max, b.rotation, b.material
            );
        }
        text
    }

    pub fn scene(&self, sets: &[&str]) -> Scene {
        let sets: Vec<_> = sets
            .iter()
            .map(|set| Assignment::parse(set).unwrap())
            .collect();
        Scene::parse("room", &self.text(), &sets).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Forty samples of every pixel: two whole runs, that are summed apart, and a part of one.
    pub fn film(&self, bench: Bench, sets: &[&str]) -> Film {
        bench.film(&self.scene(sets), 3..43)
    }

    /// The room under the gate of means.
    pub fn case(&self, name: &str, sets: &[&str], form: Form) -> Case {
        let case = Case::new(name, self.text(), form).within(WIDTH);
        let split = |set: &&str| {
            set.split_once('=')
                .map(|(a, b)| (a.to_string(), b.to_string()))
        };
        let pairs = sets.iter().filter_map(split);
        pairs.fold(case, |case, (path, value)| case.set(&path, value))
    }
}

/// Settings that between them run through every sampler, strategy and rule.
pub const SETTINGS: [&[&str]; 6] = [
    &["render.preset=reference", "interruption.start=1"],
    &["render.preset=corrected", "light.sampler=gaussian"],
    &[
        "light.strategy=hit",
        "interruption.rule=albedo",
        "interruption.start=1",
    ],
    &[
        "light.strategy=sample",
        "light.sampler=uniform-angles",
        "scatter.diffuse=uniform",
    ],
    &[
        "light.sampler=inverse-cosine",
        "image.filter=tent",
        "interruption.order=before-direct",
    ],
    &["render.preset=paper", "light.pole=receiver"],
];

/// Four standard errors are at most this share of a mean.
const WIDTH: f64 = 0.012;
/// Relative standard error of a mean that another is compared with.
pub const TRUTH: f64 = 0.001;
