//! SVG documents, read back: their elements, their texts and where these are.

use lampray::figures::plot::{svg, text_width};
use lampray::figures::{Lines, Look, Plot, Point, Scale, Series};
use roxmltree::{Document, Node};

/// A text with the box that it fills.
#[derive(Clone, Debug)]
pub struct Placed {
    pub words: String,
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
}

impl Placed {
    fn meets(&self, other: &Placed) -> bool {
        let across = self.right.min(other.right) - self.left.max(other.left);
        let down = self.bottom.min(other.bottom) - self.top.max(other.top);
        across > 0.0 && down > 0.0
    }
}

pub fn value(node: &Node, name: &str) -> f64 {
    let text = node.attribute(name).unwrap_or_else(|| panic!("no {name}"));
    text.parse().unwrap_or_else(|_| panic!("{name} is {text}"))
}

/// Elements that have a class among theirs.
pub fn of_class<'a>(document: &'a Document<'a>, class: &str) -> Vec<Node<'a, 'a>> {
    let has = |node: &Node| {
        node.attribute("class")
            .is_some_and(|all| all.split(' ').any(|each| each == class))
    };
    document.descendants().filter(has).collect()
}

pub fn texts(document: &Document) -> Vec<Placed> {
    let texts = document
        .descendants()
        .filter(|node| node.has_tag_name("text"));
    texts.map(|node| placed(&node)).collect()
}

fn placed(node: &Node) -> Placed {
    let inner = node
        .descendants()
        .filter(Node::is_text)
        .filter_map(|each| each.text());
    let words: String = inner.collect();
    let (x, y, size) = (value(node, "x"), value(node, "y"), value(node, "font-size"));
    let width = text_width(
        &words,
        size,
        node.attribute("class")
            .is_some_and(|all| all.contains("title")),
    );
    let left = match node.attribute("text-anchor") {
        Some("middle") => x - width / 2.0,
        Some("end") => x - width,
        _ => x,
    };
    Placed {
        words,
        left,
        right: left + width,
        top: y - 0.72 * size,
        bottom: y + 0.2 * size,
    }
}

/// Draws a plot, and holds it to what every plot must keep; returns the document.
pub fn sound(plot: &Plot) -> String {
    let text = svg(plot);
    assert_eq!(text, svg(plot), "the same plot makes the same bytes");
    let document = Document::parse(&text).unwrap_or_else(|fault| panic!("{fault}\n{text}"));
    let root = document.root_element();
    assert_eq!(root.attribute("role"), Some("img"));
    assert_eq!(
        root.children()
            .filter(|node| node.has_tag_name("title"))
            .count(),
        1
    );
    assert_eq!(
        root.children()
            .filter(|node| node.has_tag_name("desc"))
            .count(),
        1
    );
    assert!(
        document
            .descendants()
            .all(|node| node.attribute("id").is_none()),
        "names could meet"
    );
    for mark in ["NaN", "inf\"", "infinity", "url(", "href", "<script"] {
        let body = &text[text.find("</style>").expect("a style")..];
        assert!(!body.contains(mark), "{mark} in {body}");
    }
    keeps_texts_apart(&document);
    text
}

fn keeps_texts_apart(document: &Document) {
    let texts = texts(document);
    for (index, text) in texts.iter().enumerate() {
        for other in &texts[index + 1..] {
            assert!(
                !text.meets(other),
                "{} lies on {}: {text:?} {other:?}",
                text.words,
                other.words
            );
        }
    }
    let view = document
        .root_element()
        .attribute("viewBox")
        .expect("a view box");
    let view: Vec<f64> = view.split(' ').map(|side| side.parse().unwrap()).collect();
    for text in &texts {
        let inside = text.left >= view[0] && text.right <= view[0] + view[2];
        assert!(
            inside && text.top >= view[1] && text.bottom <= view[1] + view[3],
            "{text:?} leaves {view:?}"
        );
    }
}

pub fn scale(label: &str, logarithmic: bool, low: Option<f64>, high: Option<f64>) -> Scale {
    Scale {
        label: label.into(),
        logarithmic,
        low,
        high,
    }
}

pub fn series(name: &str, look: Look, points: &[Point]) -> Series {
    Series {
        name: name.into(),
        look,
        colour: 0,
        points: points.to_vec(),
    }
}

pub fn lines(x: Scale, y: Scale, series: Vec<Series>) -> Lines {
    Lines {
        title: "A title".into(),
        x,
        y,
        series,
        marks: Vec::new(),
    }
}
