//! Tables, for HTML and for Markdown.

use crate::figures::Table;
use crate::figures::escape::{markdown, markup};

/// Letters that may stand behind a number and leave it one: exponents and units.
const UNIT: usize = 3;

/// Whether every cell of a column is a number, with an interval or a unit perhaps, or is empty.
pub(super) fn is_numeric(table: &Table, column: usize) -> bool {
    let mut cells = table
        .rows
        .iter()
        .filter_map(|row| row.get(column))
        .peekable();
    cells.peek().is_some() && cells.all(|cell| is_number(cell))
}

fn is_number(cell: &str) -> bool {
    let cell = cell.trim();
    if cell.is_empty() || ["–", "—", "-"].contains(&cell) {
        return true;
    }
    let number = cell.trim_start_matches(['+', '-', '−', '±', '<', '>', '≤', '≥', '≈', ' ']);
    number.starts_with(|letter: char| letter.is_ascii_digit())
        && number
            .chars()
            .filter(|letter| letter.is_alphabetic())
            .count()
            <= UNIT
}

/// As many columns as the longest row has.
fn columns(table: &Table) -> usize {
    let longest = table.rows.iter().map(Vec::len).max().unwrap_or(0);
    longest.max(table.head.len())
}

pub(super) fn html(table: &Table) -> String {
    let columns = columns(table);
    let numeric: Vec<&str> = (0..columns)
        .map(|column| {
            if is_numeric(table, column) {
                " class=\"numeric\""
            } else {
                ""
            }
        })
        .collect();
    let cell = |row: &[String], column: usize| markup(row.get(column).map_or("", |cell| cell));
    let head: String = (0..columns)
        .map(|column| {
            format!(
                "<th scope=\"col\"{}>{}</th>",
                numeric[column],
                cell(&table.head, column)
            )
        })
        .collect();
    let mut rows = String::new();
    for row in &table.rows {
        let cells = (0..columns).map(|column| {
            let text = cell(row, column);
            if column == 0 {
                format!("<th scope=\"row\"{}>{text}</th>", numeric[column])
            } else {
                format!("<td{}>{text}</td>", numeric[column])
            }
        });
        rows.push_str(&format!("<tr>{}</tr>\n", cells.collect::<String>()));
    }
    let caption = markup(&table.caption);
    format!(
        "<figure class=\"table\">\n<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"{caption}\"><table>\n\
         <thead><tr>{head}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n\
         <figcaption>{caption}</figcaption>\n</figure>\n"
    )
}

pub(super) fn in_markdown(table: &Table) -> String {
    let columns = columns(table);
    let row = |cells: &[String]| {
        let cells = (0..columns).map(|column| markdown(cells.get(column).map_or("", |cell| cell)));
        format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "))
    };
    let rule = (0..columns).map(|column| {
        if is_numeric(table, column) {
            "---:"
        } else {
            "---"
        }
    });
    let rule = format!("| {} |\n", rule.collect::<Vec<_>>().join(" | "));
    let rows: String = table.rows.iter().map(|cells| row(cells)).collect();
    [row(&table.head), rule, rows].concat()
}
