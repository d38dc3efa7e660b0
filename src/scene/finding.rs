//! What is wrong or suspect in a scene, with its place, and how it is shown.

use codespan_reporting::diagnostic::{Diagnostic, Label, Severity};
use codespan_reporting::files::{Error as FilesError, Files};
use codespan_reporting::term::{Config, emit_into_string};
use std::fmt;
use std::ops::Range;

/// One error or warning.
#[derive(Clone, Debug)]
pub struct Finding {
    /// Line and column in the scene file, both from 1, the column in characters.
    pub place: Option<(usize, usize)>,
    /// The argument of the command line that is at fault, as it was typed.
    pub flag: Option<String>,
    pub message: String,
    /// The remedy or the nearest valid name.
    pub note: Option<String>,
    /// All of it as text, with the line of the file and a caret.
    pub text: String,
}

impl Finding {
    /// As `--json` has it.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::json!({
            "line": self.place.map(|(line, _)| line),
            "column": self.place.map(|(_, column)| column),
            "flag": self.flag,
            "message": self.message,
            "note": self.note,
        })
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// How a finding is shown.
pub(crate) fn render(
    severity: Severity,
    snippet: Option<&Snippet>,
    message: &str,
    note: Option<&str>,
) -> String {
    let diagnostic = Diagnostic::new(severity)
        .with_message(message)
        .with_notes(note.map(String::from).into_iter().collect());
    let plain = || {
        let note = note.map_or(String::new(), |note| format!("\n  = {note}"));
        format!("{}: {message}{note}\n", word(severity))
    };
    let Some(snippet) = snippet else {
        return plain();
    };
    let diagnostic = diagnostic.with_labels(vec![Label::primary((), snippet.marked.clone())]);
    emit_into_string(&Config::default(), snippet, &diagnostic).unwrap_or_else(|_| plain())
}

fn word(severity: Severity) -> &'static str {
    match severity {
        Severity::Warning => "warning",
        _ => "error",
    }
}

/// The part of one line that a finding shows. A line may be as long as the file, so that only a
/// window around the marked text is kept; and it may hold control characters, which must not reach
/// a terminal.
pub(crate) struct Snippet {
    name: String,
    line: usize,
    column: usize,
    /// Characters of the line before the window.
    skipped: usize,
    window: String,
    /// The marked bytes of the window.
    marked: Range<usize>,
}

/// Bytes of a line that are shown before and after the start of the marked text.
const BEFORE: usize = 100;
const AFTER: usize = 160;

impl Snippet {
    pub(crate) fn new(name: &str, text: &str, span: Range<usize>) -> Self {
        let start = floor(text, span.start);
        let begin = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let rest = &text[begin..];
        let line_end = begin + rest.find('\n').unwrap_or(rest.len());
        let from = floor(text, start.saturating_sub(BEFORE).max(begin));
        let to = floor(text, (start + AFTER).min(line_end)).max(start);
        let end = floor(text, span.end).clamp(start, to);
        let skipped = text[begin..from].chars().count();
        let lead = printable(&text[from..start]);
        let marked = printable(&text[start..end]);
        let tail = printable(text[end..to].trim_end_matches('\r'));
        Self {
            // A name may come out of an image.
            name: printable(name),
            line: text.as_bytes()[..begin]
                .iter()
                .filter(|byte| **byte == b'\n')
                .count()
                + 1,
            column: skipped + text[from..start].chars().count() + 1,
            skipped,
            marked: lead.len()..lead.len() + marked.len(),
            window: lead + &marked + &tail,
        }
    }

    /// Line and column of the marked text, both from 1.
    pub(crate) fn place(&self) -> (usize, usize) {
        (self.line, self.column)
    }
}

/// The nearest character boundary at or before a byte.
fn floor(text: &str, byte: usize) -> usize {
    let byte = byte.min(text.len());
    (0..=byte)
        .rev()
        .find(|at| text.is_char_boundary(*at))
        .unwrap_or(0)
}

pub(super) fn printable(text: &str) -> String {
    let clean = |c: char| match c {
        '\t' => c,
        c if c.is_control() => '\u{fffd}',
        c => c,
    };
    text.chars().map(clean).collect()
}

impl<'a> Files<'a> for Snippet {
    type FileId = ();
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, (): ()) -> Result<&'a str, FilesError> {
        Ok(&self.name)
    }

    fn source(&'a self, (): ()) -> Result<&'a str, FilesError> {
        Ok(&self.window)
    }

    fn line_index(&'a self, (): (), _byte: usize) -> Result<usize, FilesError> {
        Ok(0)
    }

    fn line_number(&'a self, (): (), _line: usize) -> Result<usize, FilesError> {
        Ok(self.line)
    }

    fn column_number(&'a self, (): (), _line: usize, byte: usize) -> Result<usize, FilesError> {
        let before = self.window.get(..byte).unwrap_or(&self.window);
        Ok(self.skipped + before.chars().count() + 1)
    }

    fn line_range(&'a self, (): (), line: usize) -> Result<Range<usize>, FilesError> {
        if line == 0 {
            return Ok(0..self.window.len());
        }
        Err(FilesError::LineTooLarge {
            given: line,
            max: 0,
        })
    }
}
