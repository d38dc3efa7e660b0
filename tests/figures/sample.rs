//! Five made-up figures with numbers such as the runs give, for looking at and for tests.

use super::sample_pictures::balls;
use super::sample_runs::{eight, nine, seven};
use lampray::figures::*;
use lampray::report::data::Interval;
use std::f64::consts::TAU;

pub const KINDS: [&str; 2] = ["as published", "corrected"];
pub const SAMPLERS: [&str; 3] = ["even angles", "cone", "area"];

pub fn about() -> About {
    About {
        version: "0.1.0".into(),
        device: "NVIDIA H200 (Vulkan, 570.86)".into(),
        command: "lampray figures --out claims --full".into(),
        seconds: 1394.2,
        effort: "full".into(),
    }
}

pub fn figures() -> Vec<Figure> {
    vec![five(), six(), seven(), eight(), nine()]
}

/// A number in 0..1 that looks like chance.
pub fn chance(index: u64) -> f64 {
    let mut bits = index
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(0x1234_5678_9abc_def1);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ (bits >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

pub fn interval(value: f64, share: f64) -> Interval {
    Interval {
        value,
        low: value * (1.0 - share),
        high: value * (1.0 + share),
    }
}

pub fn scale(label: &str, logarithmic: bool) -> Scale {
    Scale {
        label: label.into(),
        logarithmic,
        ..Scale::default()
    }
}

pub fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|&word| word.into()).collect()
}

pub fn figure(number: u32, title: &str, holds: Holds, verdict: &str) -> Figure {
    Figure {
        number,
        title: title.into(),
        claim: String::new(),
        reading: String::new(),
        verdict: Verdict {
            holds,
            text: verdict.into(),
        },
        results: Vec::new(),
        blocks: Vec::new(),
        sweeps: Vec::new(),
        commands: Vec::new(),
        data: vec![DataFile {
            name: format!("fig{number}.csv"),
            csv: "kind,sampler,value,low,high\nas published,cone,1.0,0.9,1.1\n".into(),
        }],
    }
}

fn five() -> Figure {
    let row = |label: &str, gain: f64| PictureRow {
        label: label.into(),
        cells: (0..3)
            .map(|kind| balls(kind, 128, 12 + kind as u64, gain, "1024 samples a pixel"))
            .collect(),
    };
    let pictures = Pictures {
        name: "balls".into(),
        caption: "Three balls under one lamp, one exposure for all.".into(),
        columns: words(&["Diffuse", "Directional, exponent 50", "Mirror"]),
        rows: vec![row(KINDS[0], 1.35), row(KINDS[1], 1.0)],
    };
    let bars = Bars {
        title: "Energy that leaves a ball in a white furnace".into(),
        y: Scale {
            low: Some(0.0),
            ..scale("share of what falls in", false)
        },
        base: 0.0,
        names: words(&KINDS),
        colours: vec![1, 0],
        groups: [
            ("diffuse", 1.318, 1.0),
            ("directional, exponent 50", 1.052, 0.981),
            ("mirror", 1.0, 1.0),
        ]
        .map(|(name, published, corrected)| BarGroup {
            name: name.into(),
            bars: vec![
                Some(interval(published, 0.012)),
                Some(interval(corrected, 0.004)),
            ],
            predicted: vec![(name == "diffuse").then_some(4.0 / 3.0), Some(corrected)],
        })
        .into(),
        marks: vec![Mark {
            name: "no energy lost or made".into(),
            y: 1.0,
        }],
    };
    Figure {
        claim: "Three balls differ in nothing but their scattering: the diffuse one is evenly lit, the directional one shows a wide highlight, and the mirror shows the room. The paper shows them as evidence that one sampler serves all three.".into(),
        reading: "The room, the lamp and the camera are those of the paper's table 1 as far as it gives them; the exponent of the directional ball is not given, and we take 50.".into(),
        results: words(&[
            "The published weight for a diffuse bounce makes 31.8 % [30.2, 33.4] more light than falls in; theory says one third more.",
            "The mirror is exact in both: no weight enters.",
            "With corrected weights no ball loses or makes energy beyond 0.4 %.",
        ]),
        blocks: vec![Block::Pictures(pictures), Block::Plots(Plots {
            name: "energy".into(),
            caption: "A ball that scatters all light must return as much as falls in: above one it makes light. Bars show means of 16 runs with 95 % intervals.".into(),
            plots: vec![Plot::Bars(bars)],
        })],
        commands: words(&["lampray sweep scenes/three-balls.toml --axis preset=published,corrected --axis seed=1..16 --samples 1024 --out fig5"]),
        ..figure(5, "Three kinds of ball", Holds::Partly, "The three looks come out as shown, but the published diffuse ball is 31.8 % [30.2, 33.4] too bright.")
    }
}

/// Points by a lamp sampler: crowded at the poles, in a cap, or even.
fn cloud(kind: usize, many: usize) -> Vec<[f64; 3]> {
    (0..many as u64)
        .map(|index| {
            let (u, v) = (
                chance(index * 2 + kind as u64 * 77_777),
                chance(index * 2 + 1 + kind as u64 * 77_777),
            );
            let z = match kind {
                0 => (u * std::f64::consts::PI).cos(),
                1 => 1.0 - u,
                _ => 1.0 - 2.0 * u,
            };
            let ring = (1.0 - z * z).max(0.0).sqrt();
            [ring * (TAU * v).cos(), ring * (TAU * v).sin(), z]
        })
        .collect()
}

fn six() -> Figure {
    let hues = [Hue::Red, Hue::Green, Hue::Blue];
    let spheres = SAMPLERS
        .iter()
        .zip(hues)
        .enumerate()
        .map(|(kind, (name, colour))| {
            Plot::Sphere(Sphere {
                title: (*name).into(),
                note: format!(
                    "{} of 800 points within 30° of a pole; an even sampler puts 107 there",
                    [267, 107, 108][kind]
                ),
                colour,
                points: cloud(kind, 800),
            })
        });
    let shares = SAMPLERS.iter().enumerate().map(|(kind, name)| BarGroup {
        name: (*name).into(),
        bars: vec![Some(interval([0.3334, 0.1341, 0.1339][kind], 0.02))],
        predicted: vec![Some([1.0 / 3.0, 0.13397, 0.13397][kind])],
    });
    let shares = Bars {
        title: "Share of points within 30° of a pole".into(),
        y: Scale {
            low: Some(0.0),
            ..scale("share of all points", false)
        },
        base: 0.0,
        names: words(&["share"]),
        colours: vec![0],
        groups: shares.collect(),
        marks: vec![Mark {
            name: "even".into(),
            y: 0.13397,
        }],
    };
    let density = |kind: usize| Series {
        name: SAMPLERS[kind].into(),
        look: Look::Measured,
        colour: kind,
        points: (0..12)
            .map(|bin| {
                let angle = 7.5 + 15.0 * f64::from(bin);
                let value = match kind {
                    0 => 0.64 / f64::to_radians(angle).sin(),
                    1 if angle < 90.0 => 2.0 + 0.04 * (chance(bin as u64) - 0.5),
                    1 => 0.0,
                    _ => 1.0 + 0.08 * (chance(100 + bin as u64) - 0.5),
                };
                Point {
                    x: angle,
                    y: value,
                    low: value * 0.94,
                    high: value * 1.06,
                }
            })
            .collect(),
    };
    let lines = Lines {
        title: "Points per solid angle, relative to an even spread".into(),
        x: Scale {
            low: Some(0.0),
            high: Some(180.0),
            ..scale("angle from the pole, degrees", false)
        },
        y: scale("density", false),
        series: (0..3).map(density).collect(),
        marks: vec![Mark {
            name: "even".into(),
            y: 1.0,
        }],
    };
    Figure {
        claim: "800 directions to a lamp by each of three samplers, drawn in red, green and blue on a sphere: the first crowds at the poles, the others are even over what they cover.".into(),
        reading: "The sphere of the paper's drawing is the unit sphere about the shaded point; its pole is towards the lamp.".into(),
        results: words(&["Even angles put 33.3 % [32.7, 34.0] of all points within 30° of a pole; an even spread puts 13.4 % there.", "The other two are even to within what 800 points can tell (p = 0.62 and 0.41)."]),
        blocks: vec![
            Block::Plots(Plots { name: "points".into(), caption: "800 points by each sampler, the pole towards the lamp. The strong circles are 30° from the poles; points behind are pale.".into(), plots: spheres.collect() }),
            Block::Plots(Plots { name: "density".into(), caption: "Where the points are: one million for the density, with 95 % intervals.".into(), plots: vec![Plot::Bars(shares), Plot::Lines(lines)] }),
        ],
        commands: words(&["lampray points --sampler even-angles --count 800 --out fig6-red.png", "lampray points --sampler cone --count 800 --out fig6-green.png"]),
        ..figure(6, "800 points by three samplers", Holds::Yes, "All three clouds look as drawn: 33.3 % [32.7, 34.0] of the first one's points are within 30° of a pole, against 13.4 % of an even spread.")
    }
}
