//! Draws as a plot: two views of the unit sphere, one with the z axis upright and one along it.

use super::Cloud;
use crate::error::{Error, Result};
use crate::wording::counted;
use glam::{DVec2, DVec3};
use image::{ImageFormat, Rgb, RgbImage, imageops};
use std::fmt::Write as _;
use std::io::Cursor;

/// Side of a view and height of the line of text under it, in pixels.
const SIDE: f64 = 420.0;
const FOOT: f64 = 56.0;
/// Radius of the unit sphere on the page.
const RADIUS: f64 = 180.0;
const PAPER: [u8; 3] = [255, 255, 255];
const OUTLINE: [u8; 3] = [150, 158, 168];
const AXIS: [u8; 3] = [70, 78, 90];
/// Draws that count and draws that do not, on the near and on the far side of the sphere.
const COLOURS: [[[u8; 3]; 2]; 2] = [
    [[228, 132, 40], [246, 216, 182]],
    [[28, 98, 190], [176, 204, 236]],
];

/// Where one looks from: the sphere's x to the right and its y up on the page, z towards the eye.
struct View {
    middle: DVec2,
    right: DVec3,
    up: DVec3,
    label: &'static str,
}

/// A point on the page.
struct Dot {
    at: DVec2,
    far: bool,
    useful: bool,
}

/// The z axis upright, seen from a little above so that its upper end shows; and along the z axis.
fn views() -> [View; 2] {
    let (sine, cosine) = 24f64.to_radians().sin_cos();
    let tilted = View {
        middle: DVec2::new(0.5 * SIDE, 0.5 * SIDE),
        right: DVec3::X,
        up: DVec3::new(0.0, sine, cosine),
        label: "z axis upright",
    };
    let along = View {
        middle: DVec2::new(1.5 * SIDE, 0.5 * SIDE),
        right: DVec3::X,
        up: DVec3::Y,
        label: "along the z axis",
    };
    [tilted, along]
}

impl View {
    fn project(&self, point: DVec3) -> (DVec2, f64) {
        let toward = self.right.cross(self.up);
        let flat = DVec2::new(point.dot(self.right), -point.dot(self.up));
        (self.middle + RADIUS * flat, point.dot(toward))
    }

    /// The draws on the page, the far ones first.
    fn dots(&self, cloud: &Cloud) -> Vec<Dot> {
        let place = |draw: &crate::pack::Draw| {
            let (at, depth) = self.project(DVec3::from_array(draw.point.map(f64::from)));
            Dot {
                at,
                far: depth < 0.0,
                useful: draw.useful == 1,
            }
        };
        let mut dots: Vec<_> = cloud.draws.iter().map(place).collect();
        dots.sort_by_key(|dot| !dot.far);
        dots
    }

    /// The ends of the z axis, a little beyond the sphere.
    fn axis(&self) -> [DVec2; 2] {
        [
            self.project(DVec3::Z * -1.1).0,
            self.project(DVec3::Z * 1.1).0,
        ]
    }
}

/// Many draws get small dots.
fn dot_radius(cloud: &Cloud) -> f64 {
    (60.0 / (cloud.draws.len() as f64).sqrt()).clamp(0.6, 2.4)
}

fn colour(dot: &Dot) -> [u8; 3] {
    COLOURS[usize::from(dot.useful)][usize::from(dot.far)]
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The plot as SVG, with its title and a legend.
pub fn svg(cloud: &Cloud) -> String {
    let (width, height) = (2.0 * SIDE, SIDE + FOOT);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        hex(PAPER)
    );
    for view in views() {
        svg_view(&mut text, &view, cloud);
    }
    let title = cloud.title.replace('&', "&amp;").replace('<', "&lt;");
    // Writing into a string cannot fail.
    let _ = writeln!(
        text,
        "<text x=\"20\" y=\"{}\" font-weight=\"bold\">{title}</text>\n<text x=\"20\" y=\"{}\" fill=\"{}\">{}; blue: {}; pale: far side; {}</text>\n</svg>",
        SIDE + 18.0,
        SIDE + 40.0,
        hex(AXIS),
        counted(cloud.draws.len() as u64, "draw"),
        cloud.share(),
        cloud.rest("°")
    );
    text
}

fn svg_view(text: &mut String, view: &View, cloud: &Cloud) {
    let (middle, [low, high]) = (view.middle, view.axis());
    let _ = writeln!(
        text,
        "<circle cx=\"{}\" cy=\"{}\" r=\"{RADIUS}\" fill=\"none\" stroke=\"{}\"/>\n<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{}\" stroke-dasharray=\"4 3\"/>",
        middle.x,
        middle.y,
        hex(OUTLINE),
        low.x,
        low.y,
        high.x,
        high.y,
        hex(AXIS)
    );
    let radius = dot_radius(cloud);
    for dot in view.dots(cloud) {
        let fill = hex(colour(&dot));
        let _ = writeln!(
            text,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius:.2}\" fill=\"{fill}\"/>",
            dot.at.x, dot.at.y
        );
    }
    let _ = writeln!(
        text,
        "<text x=\"{}\" y=\"16\" text-anchor=\"middle\" fill=\"{}\">{}</text>",
        middle.x,
        hex(AXIS),
        view.label
    );
}

/// Lines are drawn this much larger and scaled down, which smooths them.
const FINE: u32 = 3;

/// The plot as PNG, without words.
///
/// # Errors
/// [`Error::Internal`] where the encoder refuses, which it never should.
pub fn png(cloud: &Cloud) -> Result<Vec<u8>> {
    let (width, height) = (2 * SIDE as u32, SIDE as u32);
    let mut fine = RgbImage::from_pixel(width * FINE, height * FINE, Rgb(PAPER));
    for view in views() {
        draw_circle(&mut fine, view.middle);
        let [low, high] = view.axis();
        for step in 0..=2000 {
            let at = low.lerp(high, f64::from(step) / 2000.0);
            draw_disc(&mut fine, at, 0.6, AXIS);
        }
        for dot in view.dots(cloud) {
            draw_disc(&mut fine, dot.at, dot_radius(cloud), colour(&dot));
        }
    }
    let small = imageops::resize(&fine, width, height, imageops::FilterType::Triangle);
    let mut bytes = Cursor::new(Vec::new());
    let written = small.write_to(&mut bytes, ImageFormat::Png);
    written.map_err(|error| Error::Internal(error.to_string()))?;
    Ok(bytes.into_inner())
}

fn draw_circle(image: &mut RgbImage, middle: DVec2) {
    for step in 0..4000 {
        let angle = f64::from(step) / 4000.0 * std::f64::consts::TAU;
        draw_disc(
            image,
            middle + RADIUS * DVec2::from_angle(angle),
            0.6,
            OUTLINE,
        );
    }
}

fn draw_disc(image: &mut RgbImage, at: DVec2, radius: f64, colour: [u8; 3]) {
    let (at, radius) = (at * f64::from(FINE), radius * f64::from(FINE));
    let range = |middle: f64, size: u32| {
        let low = (middle - radius).floor().max(0.0) as u32;
        low..((middle + radius).ceil().max(0.0) as u32 + 1).min(size)
    };
    for y in range(at.y, image.height()) {
        for x in range(at.x, image.width()) {
            let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            if pixel.distance(at) <= radius {
                image.put_pixel(x, y, Rgb(colour));
            }
        }
    }
}
