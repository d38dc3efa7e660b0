//! `claims.md`, for readers of the repository.

use super::head::duration;
use super::tables;
use crate::figures::escape::{markdown as text, markup};
use crate::figures::{About, Block, Figure, names};
use std::fmt::Write as _;

/// `claims.md`: what the paper claims and what was measured, with links to the files beside it.
pub fn markdown(figures: &[Figure], about: &About) -> String {
    let mut page = String::from("# What the paper claims and what we measured\n\n");
    page.push_str(&format!("{}\n\n", text(super::WHAT)));
    page.push_str(&made_by(about));
    page.push_str(&claims(figures));
    for figure in figures {
        page.push_str(&section(figure));
    }
    page
}

fn made_by(about: &About) -> String {
    let mut facts = vec![format!("lampray {}", text(&about.version))];
    facts.push(text(&about.device));
    if !about.effort.is_empty() {
        facts.push(format!("{} effort", text(&about.effort)));
    }
    facts.extend(duration(about.seconds));
    facts.retain(|fact| !fact.is_empty());
    let made = format!(
        "Made by {}. Brackets are 95 % intervals.\n\n",
        facts.join(", ")
    );
    format!("{made}{}", code(std::slice::from_ref(&about.command)))
}

fn claims(figures: &[Figure]) -> String {
    let mut table =
        String::from("| Figure | Subject | The claim | What was measured |\n|---|---|---|---|\n");
    for figure in figures {
        // Writing to a string cannot fail.
        let _ = writeln!(
            table,
            "| [Figure {0}](#figure-{0}) | {1} | **{2}** | {3} |",
            figure.number,
            text(&figure.title),
            figure.verdict.holds.words(),
            text(&figure.verdict.text)
        );
    }
    format!("{table}\n")
}

fn section(figure: &Figure) -> String {
    let mut section = format!("## Figure {}\n\n", figure.number);
    section.push_str(&format!("**{}**\n\n", text(&figure.title)));
    for (name, words) in [
        ("The paper", &figure.claim),
        ("Our reading", &figure.reading),
    ] {
        if !words.trim().is_empty() {
            section.push_str(&format!("*{name}.* {}\n\n", text(words)));
        }
    }
    let verdict = &figure.verdict;
    section.push_str(&format!(
        "> **The claim {}.** {}\n\n",
        verdict.holds.words(),
        text(&verdict.text)
    ));
    for (block, files) in figure.blocks.iter().zip(names::of_blocks(figure)) {
        section.push_str(&shown(block, &files));
    }
    for result in &figure.results {
        section.push_str(&format!("- {}\n", text(result)));
    }
    if !figure.results.is_empty() {
        section.push('\n');
    }
    section.push_str(&code(&figure.commands));
    let data: Vec<String> = figure
        .data
        .iter()
        .map(|file| format!("[{0}]({0})", names::of_data(file)))
        .collect();
    if !data.is_empty() {
        section.push_str(&format!("Data: {}\n\n", data.join(", ")));
    }
    section
}

fn shown(block: &Block, files: &[String]) -> String {
    let (caption, picture) = match block {
        Block::Pictures(pictures) => (&pictures.caption, images(files, &pictures.caption)),
        Block::Plots(plots) => (&plots.caption, images(files, &plots.caption)),
        Block::Table(table) => (&table.caption, tables::in_markdown(table)),
    };
    let caption = text(caption);
    if caption.is_empty() {
        return format!("{picture}\n");
    }
    format!("{picture}\n*{caption}*\n\n")
}

/// Beside each other, where there are several.
fn images(files: &[String], caption: &str) -> String {
    let caption = markup(&caption.split_whitespace().collect::<Vec<_>>().join(" "));
    match files {
        [file] => format!("<img src=\"{file}\" alt=\"{caption}\">\n"),
        files => {
            let width = 98 / files.len().clamp(1, 3);
            let images = files
                .iter()
                .map(|file| format!("<img src=\"{file}\" alt=\"{caption}\" width=\"{width}%\">\n"));
            images.collect()
        }
    }
}

/// Lines of code in a fence that is longer than any inside them.
fn code(lines: &[String]) -> String {
    let lines: Vec<&String> = lines
        .iter()
        .filter(|line| !line.trim().is_empty())
        .collect();
    if lines.is_empty() {
        return String::new();
    }
    let longest = lines
        .iter()
        .flat_map(|line| line.split(|letter| letter != '`'))
        .map(str::len)
        .max();
    let fence = "`".repeat(longest.unwrap_or(0).max(2) + 1);
    let code: String = lines.iter().map(|line| format!("{line}\n")).collect();
    format!("{fence}sh\n{code}{fence}\n\n")
}
