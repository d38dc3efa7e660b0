//! What a figure shows: pictures, plots, tables.

use super::tables;
use crate::error::Result;
use crate::figures::escape::markup;
use crate::figures::{Block, Pictures, Plots, Shown, plot, sheet};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

pub(super) fn block(block: &Block) -> Result<String> {
    match block {
        Block::Pictures(each) => pictures(each),
        Block::Plots(each) => Ok(plots(each)),
        Block::Table(each) => Ok(tables::html(each)),
    }
}

fn pictures(block: &Pictures) -> Result<String> {
    let (columns, own) = (sheet::columns(block), sheet::widest(block));
    let mut cells = String::from("<span class=\"corner\"></span>\n");
    for column in 0..columns {
        let name = block.columns.get(column).map_or("", |name| name);
        cells.push_str(&format!(
            "<span class=\"column-name\">{}</span>\n",
            markup(name)
        ));
    }
    for row in &block.rows {
        cells.push_str(&format!(
            "<span class=\"row-name\">{}</span>\n",
            markup(&row.label)
        ));
        for column in 0..columns {
            let name = block.columns.get(column).map_or("", |name| name);
            cells.push_str(&match row.cells.get(column) {
                Some(cell) => picture(cell, &row.label, name)?,
                None => "<span></span>\n".into(),
            });
        }
    }
    let caption = markup(&block.caption);
    let unnamed = if block.rows.iter().all(|row| row.label.trim().is_empty()) {
        " unnamed"
    } else {
        ""
    };
    Ok(format!(
        "<figure class=\"pictures{unnamed}\" style=\"--columns:{columns};--side:{}px;--own:{own}px\">\n\
         <div class=\"sheet\" tabindex=\"0\" role=\"group\" aria-label=\"{caption}\"><div class=\"cells\" data-columns=\"{columns}\">\n{cells}</div></div>\n\
         <figcaption>{caption}</figcaption>\n</figure>\n",
        own * sheet::enlarged(block)
    ))
}

fn picture(cell: &Shown, row: &str, column: &str) -> Result<String> {
    let data = STANDARD.encode(sheet::picture(cell)?);
    let words: Vec<&str> = [row, column]
        .into_iter()
        .filter(|name| !name.trim().is_empty())
        .collect();
    let name = markup(&words.join(", "));
    let note = markup(&cell.note);
    Ok(format!(
        "<div class=\"cell\"><img src=\"data:image/png;base64,{data}\" width=\"{}\" height=\"{}\" alt=\"{name}\">{}</div>\n",
        cell.width,
        cell.height,
        if note.is_empty() {
            note
        } else {
            format!("<small>{note}</small>")
        }
    ))
}

fn plots(block: &Plots) -> String {
    // Wider ones are moved under a narrow window rather than made small.
    const WIDE: f64 = 500.0;
    let mut plots = String::new();
    for each in &block.plots {
        let (svg, width) = plot::inline(each);
        let wide = if width > WIDE { " wide-plot" } else { "" };
        plots.push_str(&format!(
            "<div class=\"plot{wide}\" style=\"--drawn:{width:.0}px\">\n{svg}</div>\n"
        ));
    }
    format!(
        "<figure class=\"plots\">\n<div class=\"beside-plots\">\n{plots}</div>\n<figcaption>{}</figcaption>\n</figure>\n",
        markup(&block.caption)
    )
}
