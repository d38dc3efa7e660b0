//! The made-up figures of lamps, time and limits.

use super::sample::{KINDS, SAMPLERS, figure, interval, scale, words};
use super::sample_pictures::noisy_room;
use lampray::figures::*;

pub fn seven() -> Figure {
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

pub fn eight() -> Figure {
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

pub fn nine() -> Figure {
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
