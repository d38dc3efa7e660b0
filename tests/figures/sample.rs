//! Five made-up figures with numbers such as the runs give, for looking at and for tests.

use super::sample_pictures::{balls, noisy_room};
use lampray::figures::*;
use lampray::report::data::Interval;
use std::f64::consts::TAU;

const KINDS: [&str; 2] = ["as published", "corrected"];
const SAMPLERS: [&str; 3] = ["even angles", "cone", "area"];

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

fn interval(value: f64, share: f64) -> Interval {
    Interval {
        value,
        low: value * (1.0 - share),
        high: value * (1.0 + share),
    }
}

fn scale(label: &str, logarithmic: bool) -> Scale {
    Scale {
        label: label.into(),
        logarithmic,
        ..Scale::default()
    }
}

fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|&word| word.into()).collect()
}

fn figure(number: u32, title: &str, holds: Holds, verdict: &str) -> Figure {
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

fn seven() -> Figure {
    let row = |kind: usize, lamp: usize| PictureRow {
        label: format!("{}, {} lamp", KINDS[kind], ["small", "large"][lamp]),
        cells: (0..3)
            .map(|sampler| {
                let bias = if kind == 0 {
                    [1.45, 1.1, 0.8][sampler]
                } else {
                    1.0
                };
                let noise = [0.7, 0.12, 0.4][sampler] * if lamp == 0 { 1.0 } else { 0.6 };
                noisy_room(
                    128,
                    0.1 + 0.25 * lamp as f64,
                    bias,
                    noise,
                    &format!("bias {:+.1} %", 100.0 * (bias - 1.0)),
                )
            })
            .collect(),
    };
    let series = |kind: usize, sampler: usize| Series {
        name: format!("{}, {}", SAMPLERS[sampler], KINDS[kind]),
        look: if kind == 0 {
            Look::Measured
        } else {
            Look::Predicted
        },
        colour: sampler,
        points: (0..9)
            .map(|step| {
                let samples = 4f64.powi(step);
                let floor: f64 = [0.12, 0.02, 0.05][sampler];
                let noise = [1.1, 0.2, 0.6][sampler] / samples.sqrt();
                let y = if kind == 0 { floor.hypot(noise) } else { noise };
                Point::within(samples, interval(y, if kind == 0 { 0.08 } else { 0.0 }))
            })
            .collect(),
    };
    let lines = |title: &str| {
        Plot::Lines(Lines {
            title: title.into(),
            x: scale("samples a pixel", true),
            y: scale("root mean squared error, relative", true),
            series: (0..2)
                .flat_map(|kind| (0..3).map(move |sampler| (kind, sampler)))
                .map(|(kind, sampler)| series(kind, sampler))
                .collect(),
            marks: vec![],
        })
    };
    Figure {
        claim: "For a small lamp all samplers give the same picture; for a large one sampling the cone is the least noisy at equal samples.".into(),
        reading: "Small is a radius of 0.1, large one of 0.35, read off the paper's pictures.".into(),
        results: words(&["At 64 samples a pixel the cone's noise is 5.4 times [5.1, 5.7] lower than that of even angles.", "The published weights of even angles leave a bias of +45 % [44, 46] that no number of samples takes away."]),
        blocks: vec![
            Block::Pictures(Pictures { name: "lamps".into(), caption: "One exposure for all; 64 samples a pixel.".into(), columns: words(&SAMPLERS), rows: vec![row(0, 0), row(1, 0), row(0, 1), row(1, 1)] }),
            Block::Plots(Plots { name: "error".into(), caption: "What more samples bring: published weights end on a floor, which is their bias; corrected ones (dashed) follow the slope of −½.".into(), plots: vec![lines("Small lamp"), lines("Large lamp")] }),
            Block::Table(Table {
                caption: "Bias of the mean picture, relative to the reference, with 95 % intervals.".into(),
                head: words(&["Sampler", "Lamp", "As published", "Corrected", "Noise | one sample"]),
                rows: vec![
                    words(&["even angles", "small", "+45.1 % [44.2, 46.0]", "0.0 % [−0.2, 0.3]", "1.10"]),
                    words(&["even angles", "large", "+44.0 % [43.2, 44.9]", "0.1 % [−0.2, 0.3]", "0.71"]),
                    words(&["cone", "small", "+10.2 % [10.0, 10.3]", "0.0 % [−0.1, 0.1]", "0.20"]),
                    words(&["area", "small", "−19.8 % [−20.3, −19.4]", "0.0 % [−0.2, 0.2]", "0.62"]),
                ],
            }),
        ],
        commands: words(&["lampray sweep scenes/montelight.toml --axis light_sampler=even-angles,cone,area --axis lamp.radius=0.1,0.35 --axis preset=published,corrected --samples 64 --out fig7"]),
        ..figure(7, "Three lamp samplers, two lamps", Holds::No, "The three pictures of the small lamp are not the same: their means differ by up to 81 % [79, 83] of the reference.")
    }
}

fn eight() -> Figure {
    let series = |kind: usize| Series {
        name: KINDS[kind].into(),
        look: Look::Measured,
        colour: 1 - kind,
        points: (1..=10)
            .map(|limit| {
                let limit = f64::from(limit);
                Point::within(
                    limit,
                    interval(
                        0.8 + [1.9, 1.55][kind] * (1.0 - 0.72f64.powf(limit)) / 0.28,
                        0.03,
                    ),
                )
            })
            .collect(),
    };
    let law = Series {
        name: "linear, as claimed".into(),
        look: Look::Predicted,
        colour: 6,
        points: (1..=10)
            .map(|limit| Point::exact(f64::from(limit), 0.75 + 0.85 * f64::from(limit)))
            .collect(),
    };
    let alive = Series {
        name: "paths alive".into(),
        look: Look::Band,
        colour: 2,
        points: (0..=100)
            .map(|step| {
                let x = 1.0 + 0.09 * f64::from(step);
                Point::within(x, interval(0.72f64.powf(x - 1.0), 0.06))
            })
            .collect(),
    };
    Figure {
        claim: "Run time grows linearly with the limit of bounces.".into(),
        reading: "Run time is that of tracing alone, at 256 samples a pixel; absolute seconds on another machine say nothing, so the shape is what is compared.".into(),
        results: words(&["From limit 1 to 3 time grows by 1.2 s a bounce; from 8 to 10 by 0.1 s [0.08, 0.12]."]),
        blocks: vec![Block::Plots(Plots {
            name: "time".into(),
            caption: "Seconds against the bounce limit, means of 8 runs with 95 % intervals; and the share of paths that are still alive at a bounce, which is why the curve bends.".into(),
            plots: vec![
                Plot::Lines(Lines { title: "Run time".into(), x: scale("bounce limit", false), y: scale("seconds", false), series: vec![series(0), series(1), law], marks: vec![] }),
                Plot::Lines(Lines { title: "Paths that reach a bounce".into(), x: scale("bounce", false), y: scale("share of all paths", true), series: vec![alive], marks: vec![Mark { name: "one in ten".into(), y: 0.1 }] }),
            ],
        })],
        commands: words(&["lampray sweep scenes/cornell.toml --axis bounces=1..10 --axis seed=1..8 --samples 256 --out fig8"]),
        ..figure(8, "Run time against the bounce limit", Holds::No, "Time bends: the tenth bounce costs 0.09 [0.07, 0.11] of the second, as few paths live so long.")
    }
}

fn nine() -> Figure {
    let row = |kind: usize| PictureRow {
        label: KINDS[kind].into(),
        cells: (1..=4)
            .map(|limit| {
                let gain = 0.45 + 0.55 * (1.0 - 0.5f64.powi(limit));
                noisy_room(
                    128,
                    0.3,
                    gain * [1.2, 1.0][kind],
                    0.15,
                    &format!("{:.1} % of the light", 100.0 * gain),
                )
            })
            .collect(),
    };
    let groups = (1..=4).map(|limit| BarGroup {
        name: format!("limit {limit}"),
        bars: vec![
            Some(interval(2f64.powi(-2 * limit), 0.1)),
            (limit < 4).then(|| interval(2f64.powi(-3 * limit), 0.2)),
        ],
        predicted: vec![None, None],
    });
    Figure {
        claim: "Pictures with limits 1 to 4: after four bounces no difference is seen any more."
            .into(),
        reading: "No difference is seen where the mean FLIP to a limit of 64 is below 0.02.".into(),
        results: words(&["At limit 4 the room still lacks 3.1 % [2.9, 3.4] of its light."]),
        blocks: vec![
            Block::Pictures(Pictures {
                name: "limits".into(),
                caption: "Limits 1 to 4, one exposure.".into(),
                columns: words(&["Limit 1", "Limit 2", "Limit 3", "Limit 4"]),
                rows: vec![row(0), row(1)],
            }),
            Block::Plots(Plots {
                name: "missing".into(),
                caption: "Light that is missing, relative to a limit of 64.".into(),
                plots: vec![Plot::Bars(Bars {
                    title: "Missing light".into(),
                    y: scale("share of the converged picture's mean", true),
                    base: 0.0,
                    names: words(&KINDS),
                    colours: vec![1, 0],
                    groups: groups.collect(),
                    marks: vec![Mark {
                        name: "seen".into(),
                        y: 0.02,
                    }],
                })],
            }),
        ],
        commands: words(&["lampray sweep scenes/cornell.toml --axis bounces=1..4 --out fig9"]),
        ..figure(
            9,
            "Pictures with limits 1 to 4",
            Holds::Unknown,
            "The intervals at limit 4 hold the threshold: 0.021 [0.018, 0.024].",
        )
    }
}
