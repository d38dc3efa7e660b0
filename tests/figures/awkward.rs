//! Plots of what nobody would plot: they stay whole, and no text lies on another.

use super::document::*;
use super::sample;
use lampray::figures::*;
use lampray::report::data::Interval;
use roxmltree::Document;

const HOSTILE: &str = "</title><script>alert('1')</script> & \"<b>\" ]]> \u{0} \u{1b}";
const LONG: &str = "a name so long that it never fits beside a line, nor in one row of a legend, however wide the plot may be drawn";

fn free() -> Scale {
    scale("y", false, None, None)
}

fn logarithmic() -> Scale {
    scale("y", true, None, None)
}

fn dots(document: &str) -> usize {
    of_class(&Document::parse(document).unwrap(), "dot").len()
}

#[test]
fn sample_plots_are_sound() {
    let figures = sample::figures();
    let blocks = figures.iter().flat_map(|figure| &figure.blocks);
    let plots = blocks.filter_map(|block| match block {
        Block::Plots(plots) => Some(&plots.plots),
        _ => None,
    });
    assert!(plots.flatten().map(sound).count() > 5);
}

#[test]
fn empty_plots_are_plots() {
    for y in [free(), logarithmic()] {
        sound(&Plot::Lines(lines(y.clone(), y.clone(), Vec::new())));
        sound(&Plot::Lines(lines(
            y.clone(),
            y.clone(),
            vec![series("none", Look::Band, &[])],
        )));
        let bars = Bars {
            title: String::new(),
            y,
            base: 0.0,
            names: vec![],
            colours: vec![],
            groups: vec![],
            marks: vec![],
        };
        sound(&Plot::Bars(bars));
    }
    for points in [vec![], vec![[f64::NAN; 3], [0.0, f64::INFINITY, 0.0]]] {
        sound(&Plot::Sphere(Sphere {
            title: String::new(),
            note: String::new(),
            colour: Hue::Red,
            points,
        }));
    }
}

#[test]
fn what_has_no_place_is_left_out() {
    let at = Point::exact;
    let bad = [
        at(1.0, 1.0),
        at(f64::NAN, 1.0),
        at(2.0, f64::INFINITY),
        at(3.0, -1.0),
        at(4.0, 0.0),
        at(5.0, 2.0),
    ];
    let drawn = |y: Scale| {
        dots(&sound(&Plot::Lines(lines(
            free(),
            y,
            vec![series("", Look::Measured, &bad)],
        ))))
    };
    assert_eq!(drawn(free()), 4);
    assert_eq!(drawn(logarithmic()), 2);
}

#[test]
fn every_range_can_be_drawn() {
    let at = Point::exact;
    let cases: [&[Point]; 6] = [
        &[at(1.0, 5.0)],
        &[at(1.0, 0.0), at(2.0, 0.0)],
        &[at(1.0, 7.0), at(1.0, 7.0), at(1.0, 7.0)],
        &[at(-1e300, -1e300), at(1e300, 1e300)],
        &[at(1.0, 1e-300), at(2.0, 1e300)],
        &[at(1.0, 1.0), at(2.0, 1.0 + 1e-15)],
    ];
    for points in cases {
        for (x, y) in [(free(), free()), (logarithmic(), logarithmic())] {
            for look in [Look::Measured, Look::Band, Look::Predicted] {
                sound(&Plot::Lines(lines(
                    x.clone(),
                    y.clone(),
                    vec![series("name", look, points)],
                )));
            }
        }
    }
}

#[test]
fn intervals_that_reach_below_nought_end_at_a_logarithmic_frame() {
    let points = [
        Point {
            x: 1.0,
            y: 1.0,
            low: -3.0,
            high: f64::INFINITY,
        },
        Point::exact(2.0, 2.0),
    ];
    for look in [Look::Measured, Look::Band] {
        sound(&Plot::Lines(lines(
            free(),
            logarithmic(),
            vec![series("s", look, &points)],
        )));
    }
}

#[test]
fn a_thousand_points_and_many_lines_stay_legible() {
    let points: Vec<Point> = (0..1000)
        .map(|x| Point::exact(f64::from(x), (f64::from(x) / 90.0).sin()))
        .collect();
    let text = sound(&Plot::Lines(lines(
        free(),
        free(),
        vec![series("wave", Look::Measured, &points)],
    )));
    // One more where the name stands in a legend with its key.
    assert!([1000, 1001].contains(&dots(&text)));
    for (many, name) in [
        (2, "short"),
        (5, "a line"),
        (6, LONG),
        (14, "one of very many lines"),
        (3, HOSTILE),
    ] {
        let ends = |index: usize| {
            [
                Point::exact(0.0, 0.0),
                Point::exact(1.0, 1.0 + 1e-3 * index as f64),
            ]
        };
        let all = (0..many).map(|index| Series {
            colour: index,
            ..series(&format!("{name} {index}"), Look::Measured, &ends(index))
        });
        sound(&Plot::Lines(lines(free(), free(), all.collect())));
    }
}

#[test]
fn names_of_levels_keep_apart() {
    let points: Vec<Point> = (0..50)
        .map(|x| Point::exact(f64::from(x), f64::from(x % 7)))
        .collect();
    for levels in [
        &[1.0, 1.0, 1.0][..],
        &[1.0, 1.01, 1.02, 1.03],
        &[0.0, 6.0],
        &[3.0; 12],
    ] {
        for name in ["level", LONG] {
            let marks = levels.iter().enumerate().map(|(index, &y)| Mark {
                name: format!("{name} {index}"),
                y,
            });
            let plot = lines(free(), free(), vec![series("saw", Look::Band, &points)]);
            sound(&Plot::Lines(Lines {
                marks: marks.collect(),
                ..plot
            }));
        }
    }
}

#[test]
fn long_and_hostile_words_are_words() {
    for words in [
        HOSTILE,
        LONG,
        "unbroken".repeat(40).as_str(),
        "",
        "𝓏 ünïcödé 光",
    ] {
        let plot = Lines {
            title: words.into(),
            marks: vec![Mark {
                name: words.into(),
                y: 0.5,
            }],
            ..lines(
                scale(words, false, None, None),
                scale(words, false, None, None),
                vec![series(
                    words,
                    Look::Measured,
                    &[Point::exact(0.0, 0.0), Point::exact(1.0, 1.0)],
                )],
            )
        };
        let text = sound(&Plot::Lines(plot));
        let document = Document::parse(&text).unwrap();
        assert!(
            !document
                .descendants()
                .any(|node| node.has_tag_name("script") || node.has_tag_name("b"))
        );
        sound(&Plot::Sphere(Sphere {
            title: words.into(),
            note: words.into(),
            colour: Hue::Blue,
            points: vec![[0.0, 0.0, 1.0]; 1000],
        }));
    }
}

#[test]
fn many_groups_of_bars_find_room() {
    let bar = |value: f64| {
        Some(Interval {
            value,
            low: value - 1.0,
            high: value + 1.0,
        })
    };
    for (groups, bars, name) in [
        (1, 1, "one"),
        (30, 2, "a group with a long name"),
        (3, 20, "few"),
        (12, 3, LONG),
    ] {
        for logarithmic in [false, true] {
            let plot = Bars {
                title: LONG.into(),
                y: scale("height", logarithmic, None, None),
                base: 0.0,
                names: (0..bars).map(|index| format!("bar {index}")).collect(),
                colours: (0..bars).collect(),
                groups: (0..groups)
                    .map(|group| BarGroup {
                        name: format!("{name} {group}"),
                        bars: (0..bars)
                            .map(|index| {
                                if index == 1 {
                                    None
                                } else {
                                    bar((group * index) as f64 - 2.0)
                                }
                            })
                            .collect(),
                        predicted: vec![Some(1.0), Some(f64::NAN)],
                    })
                    .collect(),
                marks: vec![Mark {
                    name: "level".into(),
                    y: 1.0,
                }],
            };
            sound(&Plot::Bars(plot));
        }
    }
}

#[test]
fn what_lies_beyond_fixed_ends_is_pointed_at() {
    let points = [
        Point::exact(0.0, 0.5),
        Point::exact(1.0, 9.0),
        Point::exact(2.0, 0.2),
    ];
    let y = scale("y", false, Some(0.0), Some(1.0));
    let text = sound(&Plot::Lines(lines(
        free(),
        y,
        vec![series("", Look::Measured, &points)],
    )));
    let document = Document::parse(&text).unwrap();
    assert_eq!(of_class(&document, "beyond").len(), 1);
    assert_eq!(of_class(&document, "dot").len(), 2);
}
