//! One figure: what the paper says, what was measured, and how to measure it again.

use super::head::{badge, command};
use super::{anchor, blocks};
use crate::error::Result;
use crate::figures::escape::markup;
use crate::figures::{Figure, names};

pub(super) fn section(figure: &Figure) -> Result<String> {
    let anchor = anchor(figure);
    let mut shown = String::new();
    for block in &figure.blocks {
        shown.push_str(&blocks::block(block)?);
    }
    Ok(format!(
        "<section class=\"figure\" id=\"{anchor}\" aria-labelledby=\"{anchor}-title\">\n\
         <p class=\"number\">Figure {} {}</p>\n\
         <h2 id=\"{anchor}-title\">{}</h2>\n\
         <p class=\"verdict\">{}</p>\n{}{shown}{}{}</section>\n",
        figure.number,
        badge(figure.verdict.holds),
        markup(&figure.title),
        markup(&figure.verdict.text),
        claim(figure),
        results(figure),
        again(figure)
    ))
}

fn claim(figure: &Figure) -> String {
    let part = |name: &str, text: &str| {
        if text.trim().is_empty() {
            return String::new();
        }
        format!("<div><dt>{name}</dt><dd>{}</dd></div>\n", markup(text))
    };
    let parts = [
        part("What the paper shows", &figure.claim),
        part("How we read it", &figure.reading),
    ];
    format!("<dl class=\"claim\">\n{}</dl>\n", parts.concat())
}

fn results(figure: &Figure) -> String {
    if figure.results.is_empty() {
        return String::new();
    }
    let items: String = figure
        .results
        .iter()
        .map(|result| format!("<li>{}</li>\n", markup(result)))
        .collect();
    format!("<h3>What was measured</h3>\n<ul class=\"results\">\n{items}</ul>\n")
}

/// Commands and data.
fn again(figure: &Figure) -> String {
    let mut again = String::new();
    if !figure.commands.is_empty() {
        again.push_str("<h3>Make it again</h3>\n");
        again.push_str(&command(&figure.commands.join("\n")));
    }
    if !figure.sweeps.is_empty() {
        let link = |path: &String| {
            let path = markup(path);
            let name = path
                .trim_start_matches("data/")
                .trim_end_matches("/report.html");
            format!("<a href=\"{path}\">{name}</a>")
        };
        let links: Vec<String> = figure.sweeps.iter().map(link).collect();
        again.push_str(&format!(
            "<p class=\"data\">Sweeps: {}</p>\n",
            links.join(", ")
        ));
    }
    if !figure.data.is_empty() {
        let links: Vec<String> = figure
            .data
            .iter()
            .map(|file| {
                let name = markup(&names::of_data(file));
                format!("<a href=\"{name}\">{name}</a>")
            })
            .collect();
        again.push_str(&format!(
            "<p class=\"data\">Data: {}</p>\n",
            links.join(", ")
        ));
    }
    again
}
