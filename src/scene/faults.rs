//! All that is wrong with a scene, gathered before anything is said.

use super::assign::Assignment;
use super::finding::{Finding, Snippet, printable, render};
use crate::error::Error;
use codespan_reporting::diagnostic::Severity;
use std::ops::Range;

/// Where a value comes from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Origin {
    /// Nobody said it: a default or a preset that nobody named.
    Default,
    /// The bytes of the scene's text.
    File(Range<usize>),
    /// The assignment with this number.
    Flag(usize),
}

/// How many faults are shown, and how many are kept to choose the first of the file from.
const SHOWN: usize = 50;
const KEPT: usize = 1000;

/// The faults found so far.
pub(crate) struct Faults<'a> {
    name: &'a str,
    text: &'a str,
    assignments: &'a [Assignment],
    kept: Vec<Fault>,
    total: usize,
}

struct Fault {
    origin: Origin,
    /// Whether it is the text itself that is no TOML; what follows it on the line means nothing.
    syntax: bool,
    message: String,
    note: Option<String>,
}

impl<'a> Faults<'a> {
    pub(crate) fn new(name: &'a str, text: &'a str, assignments: &'a [Assignment]) -> Self {
        let (kept, total) = (Vec::new(), 0);
        Self {
            name,
            text,
            assignments,
            kept,
            total,
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.total == 0
    }

    /// Adds a fault; its words are made only if there is room for it, so that a file of a million
    /// faults costs no more than one of a thousand.
    pub(crate) fn add(&mut self, origin: Origin, words: impl FnOnce() -> (String, Option<String>)) {
        self.total += 1;
        if self.kept.len() < KEPT {
            let (message, note) = words();
            let syntax = false;
            self.kept.push(Fault {
                origin,
                syntax,
                message,
                note,
            });
        }
    }

    /// Adds a place where the text is no TOML.
    pub(crate) fn add_syntax(&mut self, span: Range<usize>, message: String) {
        self.add(Origin::File(span), || (message, None));
        if let Some(fault) = self.kept.get_mut(self.total - 1) {
            fault.syntax = true;
        }
    }

    /// The findings in the order of the file, those of the command line last.
    pub(crate) fn finish(mut self) -> Mistakes {
        self.drop_echoes();
        let flag = |fault: &Fault| matches!(fault.origin, Origin::Flag(_));
        let usage = self.total == self.kept.len() && self.kept.iter().all(flag);
        let shown = self.kept.iter().take(SHOWN);
        let findings: Vec<_> = shown.map(|fault| self.show(fault)).collect();
        Mistakes {
            page: if usage {
                lines(&findings)
            } else {
                page(&findings, self.total, self.name)
            },
            total: self.total,
            usage,
            findings,
        }
    }

    /// Sorts by place, and keeps of each line with a syntax error nothing but the first such error:
    /// the rest are its echoes.
    fn drop_echoes(&mut self) {
        self.kept.sort_by_key(|fault| match &fault.origin {
            Origin::File(span) => (0, span.start, !fault.syntax),
            Origin::Default => (1, 0, false),
            Origin::Flag(number) => (2, *number, false),
        });
        let newlines: Vec<usize> = if self.kept.iter().any(|fault| fault.syntax) {
            self.text.match_indices('\n').map(|(at, _)| at).collect()
        } else {
            return;
        };
        let line = |fault: &Fault| match &fault.origin {
            Origin::File(span) => Some(newlines.partition_point(|at| *at < span.start)),
            _ => None,
        };
        let mut broken: Vec<_> = self
            .kept
            .iter()
            .filter(|f| f.syntax)
            .filter_map(line)
            .collect();
        broken.dedup();
        let before = self.kept.len();
        let mut said = None;
        self.kept.retain(|fault| {
            let Some(line) = line(fault).filter(|line| broken.binary_search(line).is_ok()) else {
                return true;
            };
            let first = fault.syntax && said != Some(line);
            if first {
                said = Some(line);
            }
            first
        });
        self.total -= before - self.kept.len();
    }

    fn show(&self, fault: &Fault) -> Finding {
        let (message, note) = (fault.message.clone(), fault.note.clone());
        let (place, flag, text) = match &fault.origin {
            Origin::Flag(number) => {
                let flag = self.assignments.get(*number).map(|a| a.flag.clone());
                let lead = flag.as_deref().unwrap_or_default();
                let tail = note
                    .as_ref()
                    .map_or(String::new(), |note| format!("; {note}"));
                (
                    None,
                    flag.clone(),
                    format!("error: {lead}: {message}{tail}\n"),
                )
            }
            Origin::File(_) | Origin::Default => {
                let span = match &fault.origin {
                    Origin::File(span) => span.clone(),
                    _ => 0..0,
                };
                let snippet = Snippet::new(self.name, self.text, span);
                let text = render(Severity::Error, Some(&snippet), &message, note.as_deref());
                (Some(snippet.place()), None, text)
            }
        };
        Finding {
            place,
            flag,
            message,
            note,
            text,
        }
    }
}

/// Mistakes of the command line, one a line.
fn lines(findings: &[Finding]) -> String {
    let line = |finding: &Finding| finding.text.trim_end().replacen("error: ", "", 1);
    findings.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// Mistakes of the file, each with its line, and how many there are.
fn page(findings: &[Finding], total: usize, name: &str) -> String {
    let mut page = String::new();
    for finding in findings {
        page += finding.text.trim_end();
        page += "\n\n";
    }
    if total > findings.len() {
        page += &format!("... and {} more\n\n", total - findings.len());
    }
    let errors = if total == 1 { "error" } else { "errors" };
    page + &format!("{total} {errors} in {}", printable(name))
}

/// Why there is no scene.
#[derive(Debug)]
pub struct Mistakes {
    /// The first of them, in the order of the file.
    pub findings: Vec<Finding>,
    /// How many there are.
    pub total: usize,
    /// All of it as text.
    pub page: String,
    /// Whether the command line alone is at fault.
    pub usage: bool,
}

impl From<Mistakes> for Error {
    fn from(mistakes: Mistakes) -> Self {
        if mistakes.usage {
            Self::Knob(mistakes.page)
        } else {
            Self::Scene(mistakes.page)
        }
    }
}
