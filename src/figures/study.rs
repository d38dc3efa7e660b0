//! What has to be rendered for the figures: a few sweeps of shipped scenes, each one command.

use crate::error::Result;
use crate::scene::Assignment;
use crate::sweep::{Axis, Base, Grid};
use serde::{Deserialize, Serialize};

/// How much is spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Effort {
    /// Small pictures and few seeds: every claim is told, with wide intervals.
    Quick,
    Full,
}

impl Effort {
    pub fn name(self) -> &'static str {
        match self {
            Effort::Quick => "quick",
            Effort::Full => "full",
        }
    }

    fn of<T>(self, quick: T, full: T) -> T {
        match self {
            Effort::Quick => quick,
            Effort::Full => full,
        }
    }
}

/// One sweep.
#[derive(Clone, Debug)]
pub struct Study {
    /// Its folder.
    pub name: &'static str,
    /// The figure that it is for.
    pub figure: u32,
    /// File name and text of the scene.
    pub scene: (&'static str, &'static str),
    /// `PATH=VALUE` of what is the same in all runs.
    pub fixed: Vec<String>,
    /// `PATH=VALUES`.
    pub axes: Vec<String>,
    pub seeds: u64,
    /// Whether the runs are held against a reference.
    pub reference: bool,
}

macro_rules! scene {
    ($name:literal) => {
        (
            concat!("scenes/", $name, ".toml"),
            include_str!(concat!("../../scenes/", $name, ".toml")),
        )
    };
}

/// The paper's count of samples a pixel.
const SAMPLES: &str = "render.samples=50";
/// One filter for all rules: what is compared is how light is sampled.
const FILTER: &str = "image.filter=box";
const PRESETS: &str = "render.preset=paper,corrected";
const CASES: &str = "light.sampler=uniform-angles,inverse-cosine,gaussian";
/// Every surface of the room of the run times goes on with this probability.
pub const THRESHOLD: f64 = 0.75;

/// All sweeps of all figures.
pub fn studies(effort: Effort) -> Vec<Study> {
    [balls(effort), lamps(effort), times(effort), limits(effort)].concat()
}

/// `image.width=...` and `image.height=...`.
fn size(width: u32, height: u32) -> [String; 2] {
    [
        format!("image.width={width}"),
        format!("image.height={height}"),
    ]
}

fn fixed(size: [String; 2], more: &[&str]) -> Vec<String> {
    let more = [FILTER].iter().chain(more).map(|text| text.to_string());
    size.into_iter().chain(more).collect()
}

fn axes(texts: &[&str]) -> Vec<String> {
    texts.iter().map(|text| text.to_string()).collect()
}

/// Figure 5.
fn balls(effort: Effort) -> Vec<Study> {
    let scene = scene!("three-balls");
    let picture = effort.of(size(192, 96), size(384, 192));
    let small = effort.of(size(128, 64), size(192, 96));
    vec![
        Study {
            name: "fig5-balls",
            figure: 5,
            scene,
            fixed: fixed(picture, &[SAMPLES]),
            axes: axes(&[PRESETS]),
            seeds: effort.of(2, 8),
            reference: true,
        },
        Study {
            name: "fig5-spread",
            figure: 5,
            scene,
            fixed: fixed(small.clone(), &[SAMPLES, "render.preset=corrected"]),
            axes: axes(&["materials.satin.spread=0.0125..6.4*2"]),
            seeds: effort.of(1, 4),
            reference: false,
        },
        Study {
            name: "fig5-ends",
            figure: 5,
            scene,
            fixed: fixed(small, &["render.samples=200", "render.preset=corrected"]),
            axes: axes(&["materials.satin.scatter=mirror,diffuse"]),
            seeds: effort.of(1, 4),
            reference: false,
        },
    ]
}

/// Figure 7.
fn lamps(effort: Effort) -> Vec<Study> {
    let room = |name, scene| Study {
        name,
        figure: 7,
        scene,
        fixed: fixed(
            effort.of(size(128, 128), size(256, 256)),
            &[SAMPLES, "light.strategy=sample"],
        ),
        axes: axes(&[PRESETS, CASES]),
        seeds: effort.of(2, 6),
        reference: true,
    };
    let poles = |toward: &str, across: &str| format!("light.pole={toward},{across}");
    let alone = &[SAMPLES, "light.strategy=sample"];
    vec![
        room("fig7-small-lamp", scene!("cornell-small-lamp")),
        room("fig7-large-lamp", scene!("cornell-large-lamp")),
        Study {
            name: "fig7-one-lamp",
            figure: 7,
            scene: scene!("one-lamp"),
            fixed: fixed(effort.of(size(32, 32), size(64, 64)), alone),
            axes: axes(&[
                PRESETS,
                "spheres.0.radius=0.03,0.17,0.35,0.5",
                CASES,
                &poles("[0,1,0]", "[0,0,1]"),
            ]),
            seeds: effort.of(2, 8),
            reference: false,
        },
        Study {
            name: "fig7-penumbra",
            figure: 7,
            scene: scene!("penumbra"),
            fixed: fixed(size(128, 16), alone),
            axes: axes(&[PRESETS, CASES, &poles("[1,0,0]", "[0,0,1]")]),
            seeds: effort.of(8, 64),
            reference: false,
        },
    ]
}

/// Figure 8: the repeats go outermost, so that a slow second of the machine does not fall on one limit.
fn times(effort: Effort) -> Vec<Study> {
    let picture = effort.of(size(96, 96), size(128, 128));
    let repeats = effort.of("render.seed=1..3", "render.seed=1..9");
    let axes = axes(&[PRESETS, repeats, "render.max_bounces=1..10"]);
    let materials = ["white", "red", "green", "clay", "plaster", "lamp"];
    let thresholds = materials.map(|material| format!("materials.{material}.survival={THRESHOLD}"));
    let thresholds: Vec<&str> = thresholds.iter().map(String::as_str).collect();
    let study = |name, more: &[&str]| Study {
        name,
        figure: 8,
        scene: scene!("cornell-small-lamp"),
        fixed: fixed(picture.clone(), &[&[SAMPLES], more].concat()),
        axes: axes.clone(),
        seeds: 1,
        reference: false,
    };
    vec![
        study("fig8-limit", &[]),
        study("fig8-threshold", &thresholds),
    ]
}

/// The last limit of figure 9, which stands for none: what is left after it is below 0.5 %.
pub const UNLIMITED: u32 = 64;

/// Figure 9.
fn limits(effort: Effort) -> Vec<Study> {
    let levels = format!("render.max_bounces=1,2,3,4,8,{UNLIMITED}");
    vec![
        Study {
            name: "fig9-room",
            figure: 9,
            scene: scene!("cornell"),
            // Without the daylight of the open front, which no shadow ray finds: the lamp is all light there is.
            fixed: fixed(
                effort.of(size(128, 128), size(256, 256)),
                &[SAMPLES, "background.emission=[0,0,0]"],
            ),
            axes: axes(&[PRESETS, &levels]),
            seeds: effort.of(2, 4),
            reference: false,
        },
        Study {
            name: "fig9-sphere",
            figure: 9,
            scene: scene!("integrating-sphere"),
            fixed: fixed(
                effort.of(size(48, 48), size(96, 96)),
                &[
                    SAMPLES,
                    &format!("materials.wall.survival={THRESHOLD}"),
                    // Even by area: case 1 makes some of the wall brighter than the rest.
                    "light.sampler=inverse-cosine",
                ],
            ),
            axes: axes(&[PRESETS, &levels]),
            seeds: effort.of(2, 8),
            reference: false,
        },
    ]
}

impl Study {
    /// # Errors
    /// [`crate::Error::Knob`] where the table above has a mistake; the tests read all of it.
    pub fn base(&self) -> Result<Base> {
        let (name, text) = self.scene;
        let parse = |text: &String| Assignment::parse(text);
        Ok(Base {
            name: name.into(),
            text: text.into(),
            assignments: self.fixed.iter().map(parse).collect::<Result<_>>()?,
        })
    }

    /// # Errors
    /// [`crate::Error::Usage`] where the table above has a mistake.
    pub fn grid(&self) -> Result<Grid> {
        let axes = self.axes.iter().map(|text| Axis::parse(text));
        Ok(Grid {
            axes: axes.collect::<Result<_>>()?,
            zip: false,
            seeds: self.seeds,
        })
    }

    /// The same sweep by hand.
    pub fn command(&self) -> String {
        let quoted = |text: &String| match text.contains(['[', ' ', '*']) {
            true => format!("'{text}'"),
            false => text.clone(),
        };
        let sets = self.fixed.iter().chain(&self.axes);
        let sets: Vec<String> = sets.map(|text| format!("--set {}", quoted(text))).collect();
        let seeds = match self.seeds {
            1 => String::new(),
            seeds => format!(" --seeds {seeds}"),
        };
        let reference = if self.reference {
            ""
        } else {
            " --reference none"
        };
        format!(
            "lampray sweep {} {}{seeds}{reference} -o {}",
            self.scene.0,
            sets.join(" "),
            self.name
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_study_is_a_sweep_that_can_be_planned() {
        for effort in [Effort::Quick, Effort::Full] {
            for study in studies(effort) {
                let (base, grid) = (study.base().unwrap(), study.grid().unwrap());
                let points = grid.points().unwrap();
                println!("{}: {} runs: {}", study.name, points.len(), study.command());
                for point in points {
                    base.scene(&point)
                        .unwrap_or_else(|error| panic!("{}: {error}", study.name));
                }
            }
        }
    }
}
