//! Points on the unit sphere: a ball of glass, seen from a little above its equator.

use super::Drawn;
use super::canvas::{Anchor, Canvas, LINE, TEXT, TITLE, Text, number, polyline};
use super::measure::wrap;
use crate::figures::{Hue, Sphere};
use glam::DVec3;
use std::f64::consts::PI;
use std::fmt::Write as _;

const WIDTH: f64 = 312.0;
const RADIUS: f64 = 128.0;
/// How far above the equator the eye is, in degrees.
const ELEVATION: f64 = 24.0;
/// Where the pole's axis ends, in radii.
const AXIS_END: f64 = 1.2;
/// Between two circles of the graticule, in degrees.
const EVERY: usize = 30;

/// The ball on the page.
struct View {
    middle: [f64; 2],
    up: DVec3,
    toward: DVec3,
}

impl View {
    fn new(middle: [f64; 2]) -> Self {
        let (sine, cosine) = ELEVATION.to_radians().sin_cos();
        Self {
            middle,
            up: DVec3::new(0.0, sine, cosine),
            toward: DVec3::new(0.0, -cosine, sine),
        }
    }

    fn at(&self, point: DVec3) -> [f64; 2] {
        let [x, y] = self.middle;
        [x + RADIUS * point.x, y - RADIUS * point.dot(self.up)]
    }

    fn depth(&self, point: DVec3) -> f64 {
        point.dot(self.toward)
    }

    /// The part of a closed line that is on the near or on the far side.
    fn half(&self, circle: &[DVec3], near: bool) -> String {
        let mut pieces: Vec<Vec<[f64; 2]>> = vec![Vec::new()];
        for &point in circle {
            let seen = (self.depth(point) >= 0.0) == near;
            match pieces.last_mut() {
                Some(piece) if seen => piece.push(self.at(point)),
                Some(piece) if !piece.is_empty() => pieces.push(Vec::new()),
                _ => {}
            }
        }
        pieces.retain(|piece| piece.len() > 1);
        polyline(&pieces)
    }
}

pub(super) fn draw(plot: &Sphere) -> Drawn {
    let mut canvas = Canvas::default();
    let middle_x = WIDTH / 2.0;
    let title = lines(&mut canvas, &plot.title, "ink title", TITLE, 0.0);
    let top = title + 10.0 + RADIUS * (AXIS_END * ELEVATION.to_radians().cos() - 1.0) + 14.0;
    let view = View::new([middle_x, top + RADIUS]);
    draw_ball(&mut canvas, &view);
    draw_half(&mut canvas, &view, plot, false);
    draw_axis(&mut canvas, &view);
    draw_half(&mut canvas, &view, plot, true);
    canvas.circle("outline", view.middle, RADIUS);
    let bottom = top + 2.0 * RADIUS + RADIUS * (AXIS_END * ELEVATION.to_radians().cos() - 1.0);
    let height = lines(&mut canvas, &plot.note, "muted", TEXT, bottom + 10.0);
    Drawn::new(canvas, WIDTH, height + 3.0)
}

/// Centred lines of text; returns their lower end.
fn lines(canvas: &mut Canvas, words: &str, class: &str, size: f64, top: f64) -> f64 {
    let mut y = top;
    if !words.trim().is_empty() {
        for line in wrap(words, size, size == TITLE, WIDTH) {
            y += LINE + 2.0;
            let at = [WIDTH / 2.0, y - 4.0];
            let text = Text::new(class, at, Anchor::Middle, &line);
            canvas.text(&Text { size, ..text });
        }
    }
    y
}

/// Light from the upper left, as discs of shade that leave it out; gradients would need names,
/// which must not meet on a page of many plots.
fn draw_ball(canvas: &mut Canvas, view: &View) {
    const DISCS: usize = 14;
    canvas.circle("ball", view.middle, RADIUS);
    let [x, y] = view.middle;
    for disc in 0..DISCS {
        let share = disc as f64 / DISCS as f64;
        // Each disc of light touches the rim at the lower right least.
        let radius = RADIUS * (1.0 - share);
        let shift = 0.3 * (RADIUS - radius);
        canvas.circle("light", [x - shift, y - shift], radius);
    }
}

fn draw_half(canvas: &mut Canvas, view: &View, plot: &Sphere, near: bool) {
    let side = if near { "near" } else { "far" };
    let graticule: String = graticule()
        .iter()
        .map(|circle| view.half(circle, near))
        .collect();
    canvas.path(side, &graticule);
    let caps: String = caps()
        .iter()
        .map(|circle| view.half(circle, near))
        .collect();
    canvas.path(&format!("cap-{side}"), &caps);
    draw_points(canvas, view, plot, near);
}

/// Points of one side, the farthest first; those that face the eye are the strongest.
fn draw_points(canvas: &mut Canvas, view: &View, plot: &Sphere, near: bool) {
    // Nearer than this to the rim, a point on the near side is a little weaker.
    const RIM: f64 = 0.35;
    let hue = match plot.colour {
        Hue::Red => "red",
        Hue::Green => "green",
        Hue::Blue => "blue",
    };
    let mut points: Vec<(f64, [f64; 2])> = plot
        .points
        .iter()
        .map(|&point| DVec3::from(point))
        .filter(|point| point.is_finite() && point.length() < 1.5)
        .map(|point| (view.depth(point), view.at(point)))
        .filter(|(depth, _)| (*depth >= 0.0) == near)
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let split = points.partition_point(|(depth, _)| *depth < RIM);
    let (rim, facing) = points.split_at(split);
    let classes = if near {
        ["middle", "front"]
    } else {
        ["back", "back"]
    };
    for (class, points) in classes.into_iter().zip([rim, facing]) {
        canvas.path(&format!("{class} {hue}"), &dots(points));
    }
}

/// Lines of no length with round ends: the shortest way to write many dots.
fn dots(points: &[(f64, [f64; 2])]) -> String {
    let mut data = String::new();
    for (_, [x, y]) in points {
        // Writing to a string cannot fail.
        let _ = write!(data, "M{} {}h0", number(*x), number(*y));
    }
    data
}

/// The axis through the ball: dashed inside, whole where it stands out.
fn draw_axis(canvas: &mut Canvas, view: &View) {
    let on_axis = |z: f64| view.at(DVec3::Z * z);
    // The lower end comes into sight where it passes the rim.
    let rim = -1.0 / ELEVATION.to_radians().cos();
    canvas.line("pole-inside", on_axis(1.0), on_axis(rim));
    canvas.line("pole", on_axis(rim), on_axis(-AXIS_END));
    canvas.line("pole", on_axis(1.0), on_axis(AXIS_END));
    let [x, y] = on_axis(AXIS_END);
    canvas.text(&Text::new("ink", [x + 8.0, y + 8.0], Anchor::Start, "pole"));
}

fn degrees(angle: usize) -> f64 {
    angle as f64 * PI / 180.0
}

fn on_sphere(from_pole: f64, around: f64) -> DVec3 {
    let (sine, cosine) = from_pole.sin_cos();
    DVec3::new(sine * around.cos(), sine * around.sin(), cosine)
}

fn parallel(from_pole: usize) -> Vec<DVec3> {
    // Begins behind, so that the near half is one piece.
    (0..=360)
        .step_by(3)
        .map(|around| on_sphere(degrees(from_pole), PI / 2.0 + degrees(around)))
        .collect()
}

/// The circles at 30 degrees from either pole.
fn caps() -> [Vec<DVec3>; 2] {
    [parallel(EVERY), parallel(180 - EVERY)]
}

fn graticule() -> Vec<Vec<DVec3>> {
    let parallels = (2 * EVERY..=180 - 2 * EVERY).step_by(EVERY).map(parallel);
    let meridians = (0..180).step_by(EVERY).map(|around| {
        // A meridian and the one opposite, but for the caps, where they would crowd.
        (0..=360)
            .step_by(3)
            .map(|from_pole| on_sphere(degrees(from_pole), degrees(around)))
            .collect()
    });
    parallels.chain(meridians).collect()
}
