//! Plots as SVG documents that stand by themselves, without names that could meet on a page.
//!
//! ```text
//! axis (values to places) ─→ ticks ─→ frame (grid, axes) ─┬→ lines (trace: one series) ─┐
//! measure (widths of text) ─→ legend, labels (names) ─────┼→ bars ──────────────────────┼→ svg
//!                                                         └→ sphere ────────────────────┘
//! ```

mod axis;
mod bars;
mod canvas;
mod frame;
mod labels;
mod legend;
mod lines;
mod measure;
mod sphere;
mod style;
mod ticks;
mod trace;

pub use measure::text_width;

use crate::figures::Plot;
use crate::figures::escape::markup;
use canvas::{Canvas, number};

/// Paper around a document that stands by itself.
const MARGIN: f64 = 16.0;

/// What a plot is made of once it is drawn.
struct Drawn {
    body: String,
    width: f64,
    height: f64,
}

impl Drawn {
    fn new(canvas: Canvas, width: f64, height: f64) -> Self {
        Self {
            body: canvas.into_body(),
            width,
            height: height.ceil(),
        }
    }
}

/// A whole SVG document: it stands by itself, on paper of its own, light or dark as the reader's
/// system is, and works inside a page any number of times.
pub fn svg(plot: &Plot) -> String {
    let drawn = draw(plot);
    let [width, height] = [drawn.width, drawn.height].map(|side| number(side + 2.0 * MARGIN));
    let margin = number(-MARGIN);
    let paper = format!(
        "<style>\n{}</style>\n<rect class=\"paper\" x=\"{margin}\" y=\"{margin}\" width=\"{width}\" height=\"{height}\"/>\n",
        style::alone()
    );
    let view = format!("{margin} {margin} {width} {height}");
    element(plot, &view, [&width, &height], &paper, &drawn.body)
}

/// The same without paper and rules, for a page that has [`page_style`] in its head; and its width.
pub(super) fn inline(plot: &Plot) -> (String, f64) {
    let drawn = draw(plot);
    let [width, height] = [drawn.width, drawn.height].map(number);
    let view = format!("0 0 {width} {height}");
    let svg = element(plot, &view, [&width, &height], "", &drawn.body);
    (svg, drawn.width)
}

/// The rules for every plot of a page.
pub(super) fn page_style() -> String {
    style::in_page()
}

fn draw(plot: &Plot) -> Drawn {
    match plot {
        Plot::Lines(lines) => lines::draw(lines),
        Plot::Bars(bars) => bars::draw(bars),
        Plot::Sphere(sphere) => sphere::draw(sphere),
    }
}

fn element(plot: &Plot, view: &str, [width, height]: [&str; 2], paper: &str, body: &str) -> String {
    let (title, description) = words(plot);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"{}\" role=\"img\" viewBox=\"{view}\" width=\"{width}\" height=\"{height}\">\n\
         <title>{}</title>\n<desc>{}</desc>\n{paper}{body}</svg>\n",
        style::CLASS,
        markup(title),
        markup(&description)
    )
}

/// For those who do not see the plot.
fn words(plot: &Plot) -> (&str, String) {
    match plot {
        Plot::Lines(lines) => {
            let names: Vec<&str> = lines
                .series
                .iter()
                .map(|series| series.name.as_str())
                .collect();
            let axes = format!("{} against {}", lines.y.label, lines.x.label);
            (
                &lines.title,
                format!("{axes}. Lines: {}.", names.join("; ")),
            )
        }
        Plot::Bars(bars) => {
            let groups: Vec<&str> = bars
                .groups
                .iter()
                .map(|group| group.name.as_str())
                .collect();
            let axes = format!("{} of {}", bars.y.label, groups.join("; "));
            (
                &bars.title,
                format!("{axes}. Bars: {}.", bars.names.join("; ")),
            )
        }
        Plot::Sphere(sphere) => {
            let many = sphere.points.len();
            let text = format!(
                "{many} points on a sphere whose pole is upright. {}",
                sphere.note
            );
            (&sphere.title, text)
        }
    }
}
