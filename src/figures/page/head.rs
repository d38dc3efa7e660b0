//! What stands before the figures: the header, and the claims in one table.

use super::{TITLE, WHAT, anchor};
use crate::figures::escape::markup;
use crate::figures::{About, Figure, Holds};
use std::fmt::Write as _;

pub(super) fn header(about: &About) -> String {
    let mut facts = vec![format!("lampray {}", about.version), about.device.clone()];
    if !about.effort.is_empty() {
        facts.push(format!("{} effort", about.effort));
    }
    if let Some(time) = duration(about.seconds) {
        facts.push(time);
    }
    let facts: String = facts
        .iter()
        .filter(|fact| !fact.trim().is_empty())
        .map(|fact| format!("<span>{}</span>", markup(fact)))
        .collect();
    format!(
        "<header class=\"wide\">\n<div class=\"kicker\">{facts}</div>\n<h1>{}</h1>\n\
         <p id=\"question\">{}</p>\n{}</header>\n",
        markup(TITLE),
        markup(WHAT),
        command(&about.command)
    )
}

/// Wall clock as one says it; none where it was not taken.
pub(super) fn duration(seconds: f64) -> Option<String> {
    if !(seconds.is_finite() && seconds > 0.0) {
        return None;
    }
    let whole = seconds.round() as u64;
    Some(match whole {
        0..60 => format!("{seconds:.1} s"),
        60..3600 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
    })
}

/// A command that can be copied: the script adds the button.
pub(super) fn command(command: &str) -> String {
    if command.trim().is_empty() {
        return String::new();
    }
    let code = markup(command);
    format!(
        "<div class=\"command\"><pre tabindex=\"0\" aria-label=\"Command\"><code>{code}</code></pre></div>\n"
    )
}

pub(super) fn links(figures: &[Figure]) -> String {
    let mut links = String::from("      <a href=\"#claims\">Claims</a>\n");
    for figure in figures {
        // Writing to a string cannot fail.
        let _ = writeln!(
            links,
            "      <a href=\"#{}\" title=\"{}\">Figure {}</a>",
            anchor(figure),
            markup(&figure.title),
            figure.number
        );
    }
    links
}

pub(super) fn badge(holds: Holds) -> String {
    let class = match holds {
        Holds::Yes => "good",
        Holds::Partly => "part",
        Holds::No => "bad",
        Holds::Unknown => "open",
    };
    format!("<span class=\"badge {class}\">{}</span>", holds.words())
}

/// Every claim in a row, linked to its figure.
pub(super) fn claims(figures: &[Figure]) -> String {
    let mut rows = String::new();
    for figure in figures {
        // Writing to a string cannot fail.
        let _ = writeln!(
            rows,
            "<tr><th scope=\"row\"><a href=\"#{}\">Figure&nbsp;{}</a></th><td class=\"claim-title\">{}</td><td class=\"claim-badge\">{}</td><td class=\"words\">{}</td></tr>",
            anchor(figure),
            figure.number,
            markup(&figure.title),
            badge(figure.verdict.holds),
            markup(&figure.verdict.text)
        );
    }
    if rows.is_empty() {
        rows.push_str("<tr><td class=\"none\" colspan=\"4\">No figure was made.</td></tr>\n");
    }
    format!(
        "<section id=\"claims\" aria-labelledby=\"claims-title\">\n\
         <h2 id=\"claims-title\">What is left of each claim</h2>\n\
         <table class=\"claims\">\n<thead><tr><th scope=\"col\">Figure</th><th scope=\"col\">Subject</th><th scope=\"col\">The claim</th><th scope=\"col\">What was measured</th></tr></thead>\n\
         <tbody>\n{rows}</tbody>\n</table>\n</section>\n"
    )
}
