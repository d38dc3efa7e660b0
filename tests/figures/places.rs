//! Where values are drawn: coordinates are read back and held against the numbers of the axes.

use super::document::*;
use lampray::figures::*;
use lampray::report::data::Interval;
use roxmltree::Document;

/// Numbers on the axis, with their places: along x where `upright` is false.
fn numbers(document: &Document, upright: bool) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    for node in document
        .descendants()
        .filter(|node| node.has_tag_name("text"))
    {
        let on_axis = match upright {
            true => node.attribute("text-anchor") == Some("end"),
            false => node.attribute("text-anchor") == Some("middle"),
        };
        let mut parts = node
            .descendants()
            .filter(|each| each.is_text())
            .filter_map(|each| each.text());
        let words: String = parts
            .next()
            .unwrap_or("")
            .replace('−', "-")
            .replace('\u{202f}', "");
        let power: Option<i32> = parts
            .next()
            .map(|power| power.replace('−', "-").parse().unwrap());
        let mantissa = words
            .strip_suffix("×10")
            .or_else(|| power.and(words.strip_suffix("10")));
        let number = match (mantissa, power) {
            (Some(""), Some(power)) => Some(10f64.powi(power)),
            (Some(mantissa), Some(power)) => mantissa
                .parse()
                .ok()
                .map(|value: f64| value * 10f64.powi(power)),
            _ => words.parse().ok(),
        };
        if let Some(number) = number.filter(|_| on_axis) {
            let place = if upright {
                value(&node, "y") - 4.0
            } else {
                value(&node, "x")
            };
            found.push((number, place));
        }
    }
    found
}

/// The value at a place, by the first and the last number of an axis.
fn read(numbers: &[(f64, f64)], place: f64, logarithmic: bool) -> f64 {
    let of = |value: f64| if logarithmic { value.ln() } else { value };
    let ((a, from), (b, to)) = (numbers[0], numbers[numbers.len() - 1]);
    let read = of(a) + (place - from) / (to - from) * (of(b) - of(a));
    if logarithmic { read.exp() } else { read }
}

fn held(x_log: bool, y_log: bool, points: &[Point]) {
    let plot = lines(
        scale("x", x_log, None, None),
        scale("y", y_log, None, None),
        vec![series("", Look::Measured, points)],
    );
    let text = sound(&Plot::Lines(plot));
    let document = Document::parse(&text).unwrap();
    let (across, up) = (numbers(&document, false), numbers(&document, true));
    assert!(
        across.len() >= 2 && up.len() >= 2,
        "{across:?} {up:?}\n{text}"
    );
    let dots = of_class(&document, "dot");
    assert_eq!(dots.len(), points.len());
    for (dot, point) in dots.iter().zip(points) {
        let x = read(&across, value(dot, "cx"), x_log);
        let y = read(&up, value(dot, "cy"), y_log);
        let near = |seen: f64, wanted: f64, log: bool, numbers: &[(f64, f64)]| {
            let span = (numbers[numbers.len() - 1].0 - numbers[0].0).abs();
            if log {
                (seen / wanted - 1.0).abs() < 0.01
            } else {
                (seen - wanted).abs() < 1e-3 * span
            }
        };
        assert!(
            near(x, point.x, x_log, &across) && near(y, point.y, y_log, &up),
            "{point:?} is at {x} {y}"
        );
    }
}

#[test]
fn dots_are_where_their_values_are() {
    let at = |x, y| Point::exact(x, y);
    held(false, false, &[at(1.0, 2.0), at(4.0, 3.5), at(10.0, 7.25)]);
    held(false, false, &[at(-3.0, -2e6), at(4.0, 3e6)]);
    held(
        true,
        true,
        &[at(1.0, 0.1), at(64.0, 0.01), at(4096.0, 0.0003)],
    );
    held(true, true, &[at(2.0, 3.0), at(5.0, 4.0)]);
    held(false, true, &[at(1.0, 1e-12), at(2.0, 1e9)]);
    held(true, false, &[at(1e-30, 0.001), at(1e30, 0.002)]);
}

#[test]
fn error_bars_end_where_intervals_end() {
    let points = [
        Point {
            x: 1.0,
            y: 2.0,
            low: 1.0,
            high: 4.0,
        },
        Point::exact(2.0, 0.0),
    ];
    let plot = lines(
        scale("", false, None, None),
        scale("", false, None, None),
        vec![series("", Look::Measured, &points)],
    );
    let text = sound(&Plot::Lines(plot));
    let document = Document::parse(&text).unwrap();
    let up = numbers(&document, true);
    let bar = of_class(&document, "error")[0]
        .attribute("d")
        .unwrap()
        .to_string();
    let (start, end) = bar.split_once('V').unwrap();
    let start: f64 = start.split(' ').nth(1).unwrap().parse().unwrap();
    assert!((read(&up, start, false) - 1.0).abs() < 0.01);
    assert!((read(&up, end.parse().unwrap(), false) - 4.0).abs() < 0.01);
}

#[test]
fn bars_begin_at_their_base() {
    let bar = |value| {
        Some(Interval {
            value,
            low: value,
            high: value,
        })
    };
    let plot = Bars {
        title: String::new(),
        y: scale("", false, Some(0.0), Some(2.0)),
        base: 1.0,
        names: vec!["a".into(), "b".into()],
        colours: vec![0, 1],
        groups: vec![BarGroup {
            name: "group".into(),
            bars: vec![bar(1.5), bar(0.5)],
            predicted: vec![Some(1.25), None],
        }],
        marks: Vec::new(),
    };
    let text = sound(&Plot::Bars(plot));
    let document = Document::parse(&text).unwrap();
    let up = numbers(&document, true);
    let ends = |node: &roxmltree::Node| {
        let top = value(node, "y");
        [top, top + value(node, "height")]
            .map(|place| (read(&up, place, false) * 100.0).round() / 100.0)
    };
    let bars: Vec<[f64; 2]> = of_class(&document, "amount").iter().map(ends).collect();
    assert_eq!(bars, [[1.5, 1.0], [1.0, 0.5]]);
    let expected = of_class(&document, "expected");
    let tick = expected.last().unwrap();
    assert!((read(&up, value(tick, "y1"), false) - 1.25).abs() < 0.01);
}

/// Numbers on an axis that has these ends.
fn numbered(low: f64, high: f64, logarithmic: bool) -> Vec<f64> {
    let plot = lines(
        scale("", false, None, None),
        scale("", logarithmic, Some(low), Some(high)),
        Vec::new(),
    );
    let text = sound(&Plot::Lines(plot));
    let document = Document::parse(&text).unwrap();
    numbers(&document, true)
        .into_iter()
        .map(|(value, _)| value)
        .collect()
}

#[test]
fn numbers_on_axes_are_round() {
    assert_eq!(numbered(0.0, 1.0, false), [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]);
    assert_eq!(numbered(-1.0, 1.0, false), [-1.0, -0.5, 0.0, 0.5, 1.0]);
    assert_eq!(numbered(3.0, 17.0, false), [5.0, 10.0, 15.0]);
    assert_eq!(
        numbered(0.0, 40_000.0, false),
        [0.0, 10_000.0, 20_000.0, 30_000.0, 40_000.0]
    );
    assert_eq!(numbered(1.0, 1e4, true), [1.0, 10.0, 100.0, 1e3, 1e4]);
    assert_eq!(numbered(0.5, 30.0, true), [0.5, 1.0, 2.0, 5.0, 10.0, 20.0]);
    assert_eq!(numbered(1e-12, 1e12, true).len(), 5);
    let narrow = numbered(1.02, 1.09, true);
    assert!(
        narrow.len() >= 3 && narrow.iter().all(|value| (1.02..=1.09).contains(value)),
        "{narrow:?}"
    );
}

#[test]
fn points_of_a_sphere_are_where_they_are() {
    let plot = Sphere {
        title: "t".into(),
        note: String::new(),
        colour: Hue::Green,
        points: vec![
            [0.0, -1.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
        ],
    };
    let text = sound(&Plot::Sphere(plot));
    let document = Document::parse(&text).unwrap();
    let ball = of_class(&document, "ball")[0];
    let [x, y, radius] = ["cx", "cy", "r"].map(|name| value(&ball, name));
    let places = |class: &str| -> Vec<[f64; 2]> {
        let paths = of_class(&document, class);
        let data = paths.iter().filter_map(|path| path.attribute("d"));
        data.flat_map(|data| data.split("h0"))
            .filter_map(|dot| dot.strip_prefix('M')?.split_once(' '))
            .map(|(left, top)| [left, top].map(|side| side.parse::<f64>().unwrap()))
            .map(|[left, top]| [(left - x) / radius, (y - top) / radius])
            .collect()
    };
    let (sine, cosine) = 24f64.to_radians().sin_cos();
    let near = |places: &[[f64; 2]], wanted: [f64; 2]| {
        let close = |place: &[f64; 2]| (place[0] - wanted[0]).hypot(place[1] - wanted[1]) < 1e-3;
        assert!(
            places.iter().any(close),
            "{wanted:?} is not among {places:?}"
        );
    };
    near(&places("front"), [0.0, -sine]);
    near(&places("front"), [0.0, cosine]);
    near(&places("middle"), [1.0, 0.0]);
    near(&places("back"), [0.0, sine]);
}
