use super::{Output, Result, print};
use crate::error::Error;
use crate::knobs::{
    KNOBS, Knob, find, knob_json, markdown, nearest, page, schema, sections, short, table, unknown,
};
use clap::Args;

/// List every knob: path, values, unit, default, meaning
///
/// With a PATH, the knobs below it (`light`), or one of them in full with its value in each preset
/// (`light.sampler`).
#[derive(Args)]
#[command(
    after_help = "Example:\n  lampray knobs light.sampler\n  lampray knobs --schema > scene.schema.json"
)]
pub(crate) struct Command {
    /// A knob, or the beginning of some
    path: Option<String>,
    /// Print a JSON Schema of the scene file
    #[arg(long, conflicts_with_all = ["path", "markdown"])]
    schema: bool,
    /// Print the README's tables of knobs and presets
    #[arg(long, conflicts_with = "path")]
    markdown: bool,
}

impl Command {
    pub(crate) fn run(self, output: Output) -> Result<()> {
        if self.schema {
            return print(&format!("{:#}\n", schema()));
        }
        if self.markdown {
            return print(&markdown());
        }
        let (knobs, one) = match &self.path {
            None => (KNOBS.iter().collect(), false),
            Some(path) => chosen(path)?,
        };
        let text = match (knobs.as_slice(), output.json) {
            (knobs, true) => {
                let list: Vec<_> = knobs.iter().map(|knob| knob_json(knob)).collect();
                format!("{:#}\n", serde_json::Value::from(list))
            }
            ([knob], false) if one => page(knob),
            (knobs, false) => table(knobs, width()),
        };
        print(&text)
    }
}

/// The knobs that a path names, and whether it names one in full.
fn chosen(path: &str) -> Result<(Vec<&'static Knob>, bool)> {
    if let Some(target) = find(path) {
        return Ok((vec![target.knob], true));
    }
    let path = path.trim_end_matches(['.', '*']);
    let below = |knob: &&Knob| knob.path.starts_with(path);
    let knobs: Vec<_> = KNOBS.iter().filter(below).collect();
    if knobs.is_empty() {
        let message = match nearest(path, sections()) {
            Some(near) if !path.contains('.') => {
                format!("there is no knob `{}`; did you mean `{near}`?", short(path))
            }
            _ => unknown(path),
        };
        return Err(Error::Knob(message));
    }
    Ok((knobs, false))
}

/// Columns of the terminal, where the shell tells them.
fn width() -> usize {
    let told = std::env::var("COLUMNS").ok();
    told.and_then(|columns| columns.parse::<usize>().ok())
        .map_or(100, |columns| columns.clamp(90, 160))
}
