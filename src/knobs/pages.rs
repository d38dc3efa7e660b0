//! The table of knobs for people: aligned text, one knob in full, JSON, and the README's tables.

use super::choice::{Choice, Preset};
use super::kind::{Kind, Value};
use super::table::{KNOBS, Knob};
use serde_json::json;
use std::fmt::Write;

/// Widths of the columns before the meaning, which gets what is left of the line.
const WIDTHS: [usize; 4] = [20, 18, 11, 14];
const HEADS: [&str; 5] = ["PATH", "VALUES", "UNIT", "DEFAULT", "MEANING"];

/// The knobs as an aligned table; cells wrap at words so that no line is wider than `width`.
pub fn table(knobs: &[&Knob], width: usize) -> String {
    let used: usize = WIDTHS.iter().map(|column| column + 2).sum();
    let widths = [
        WIDTHS[0],
        WIDTHS[1],
        WIDTHS[2],
        WIDTHS[3],
        width.saturating_sub(used).max(24),
    ];
    let mut page = row(&HEADS.map(String::from), &widths);
    let mut section = "";
    for knob in knobs {
        if knob.section() != section {
            section = knob.section();
            page.push('\n');
        }
        page += &row(&cells(knob), &widths);
    }
    page
}

fn cells(knob: &Knob) -> [String; 5] {
    [
        knob.path.into(),
        unbroken(&values(knob)),
        knob.unit.into(),
        default(knob),
        knob.meaning.into(),
    ]
}

/// A space at which lines do not break.
const HARD_SPACE: char = '\u{a0}';

/// Keeps what stands between commas on one line: `> 0 and < 180`, `three numbers`.
fn unbroken(values: &str) -> String {
    let hard = values.replace(' ', "\u{a0}");
    hard.replace(",\u{a0}", ", ")
}

/// Type and range in a few words.
fn values(knob: &Knob) -> String {
    let range = knob.kind.range();
    match knob.kind {
        Kind::Integer { .. } | Kind::Number(_) | Kind::Triple(_) => {
            format!("{}, {}", knob.kind.type_name(), range)
        }
        Kind::OptionalNumber(_) => format!("number, {range}"),
        Kind::Choice(_) | Kind::Pole | Kind::Material => range,
    }
}

fn default(knob: &Knob) -> String {
    knob.default()
        .map_or("required".into(), |value| value.to_string())
}

/// One row, as many lines as its tallest cell needs.
fn row(cells: &[String; 5], widths: &[usize; 5]) -> String {
    let columns: Vec<_> = cells
        .iter()
        .zip(widths)
        .map(|(cell, width)| wrap(cell, *width))
        .collect();
    let height = columns.iter().map(Vec::len).max().unwrap_or(0);
    let mut lines = String::new();
    for number in 0..height {
        let mut line = String::new();
        for (column, width) in columns.iter().zip(widths) {
            let cell = column.get(number).map_or("", String::as_str);
            let _ = write!(line, "{cell:width$}  ");
        }
        lines += line.trim_end();
        lines.push('\n');
    }
    lines
}

/// Breaks text between words; a word that is too long keeps a line to itself.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    for line in &mut lines {
        *line = line.replace(HARD_SPACE, " ");
    }
    lines
}

/// Everything about one knob.
pub fn page(knob: &Knob) -> String {
    let mut page = format!("{}\n  {}\n\n", knob.path, knob.meaning);
    let mut line = |name: &str, text: &str| {
        let _ = writeln!(page, "  {name:9}{text}");
    };
    line("type", knob.kind.type_name());
    let name = match knob.kind {
        Kind::Choice(_) => "values",
        _ => "range",
    };
    line(name, &knob.kind.range());
    if !knob.unit.is_empty() {
        line("unit", knob.unit);
    }
    line("default", &default(knob));
    if knob.in_presets() {
        for (number, preset) in Preset::ALL.iter().enumerate() {
            let name = if number == 0 { "presets" } else { "" };
            line(
                name,
                &format!("{:11} {}", preset.name(), preset_value(knob, *preset)),
            );
        }
    }
    let example = example(knob);
    let (header, value) = (header(knob), example.to_toml());
    line(
        "scene",
        &format!("{header}\n           {} = {value}", knob.key()),
    );
    let path = knob.path.replace('*', instance(knob.section()));
    line("once", &format!("--set {path}={}", quoted(&example)));
    page
}

/// A material's name or a shape's number that may stand for `*`.
fn instance(section: &str) -> &'static str {
    if section == "materials" { "white" } else { "0" }
}

/// The header that the knob's key stands under in a scene file.
fn header(knob: &Knob) -> String {
    match knob.section() {
        "materials" => "[materials.white]".into(),
        shapes @ ("spheres" | "boxes") => format!("[[{shapes}]]"),
        section => format!("[{section}]"),
    }
}

/// A value that shows how the knob is written.
fn example(knob: &Knob) -> Value {
    match (knob.default(), &knob.kind) {
        (Some(value), _) => value.clone(),
        (None, Kind::Triple(_)) => Value::Triple([0.0, 1.0, 0.0]),
        (None, Kind::Material) => Value::Text("white".into()),
        (None, _) => Value::Number(0.5),
    }
}

/// A value as a shell takes it.
fn quoted(value: &Value) -> String {
    match value {
        Value::Triple(_) => format!("'{value}'"),
        other => other.to_string(),
    }
}

fn preset_value(knob: &Knob, preset: Preset) -> String {
    knob.value(preset).map_or(String::new(), Value::to_string)
}

/// One knob as JSON.
pub fn knob_json(knob: &Knob) -> serde_json::Value {
    let mut entry = json!({
        "path": knob.path,
        "type": knob.kind.type_name(),
        "range": knob.kind.range(),
        "unit": knob.unit,
        "required": knob.default().is_none(),
        "default": knob.default().map(Value::to_json),
        "meaning": knob.meaning,
    });
    match &knob.kind {
        Kind::Choice(names) => entry["values"] = json!(names),
        Kind::Integer { least, most } => {
            entry["least"] = json!(least);
            entry["most"] = json!(most);
        }
        Kind::Number(range) | Kind::OptionalNumber(range) | Kind::Triple(range) => {
            entry["least"] = json!(range.least);
            entry["most"] = json!(range.most);
            entry["ends_excluded"] = json!(range.open);
        }
        Kind::Pole | Kind::Material => {}
    }
    if knob.in_presets() {
        let value = |preset: &Preset| {
            let value = knob.value(*preset).map(Value::to_json);
            (preset.name().to_string(), json!(value))
        };
        entry["presets"] = Preset::ALL.iter().map(value).collect();
    }
    entry
}

/// The README's two tables: every knob, and the presets.
pub fn markdown() -> String {
    let mut page =
        String::from("| knob | values | unit | default | meaning |\n|---|---|---|---|---|\n");
    for knob in KNOBS {
        let (path, values, default) = (knob.path, values(knob), default(knob));
        let (unit, meaning) = (knob.unit, knob.meaning);
        let _ = writeln!(
            page,
            "| `{path}` | {values} | {unit} | {default} | {meaning} |"
        );
    }
    page += "\n| knob |";
    for preset in Preset::ALL {
        let _ = write!(page, " {preset} |");
    }
    page += "\n|---|---|---|---|---|\n";
    for knob in KNOBS.iter().filter(|knob| knob.in_presets()) {
        let _ = write!(page, "| `{}` |", knob.path);
        for preset in Preset::ALL {
            let _ = write!(page, " {} |", preset_value(knob, *preset));
        }
        page.push('\n');
    }
    page
}
