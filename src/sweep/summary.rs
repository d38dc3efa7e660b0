//! What is asked of a sweep about failures, and how it ended.

use std::time::Duration;

/// What is done about runs that fail.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rules {
    /// Stop at the first.
    pub fail_fast: bool,
    /// Try each so many times more; references, too.
    pub retries: u32,
    /// Give a run up after so long; a reference has its time.
    pub timeout: Option<Duration>,
}

/// How a sweep ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Runs made now, runs that were there already, and runs that failed.
    pub made: usize,
    pub skipped: usize,
    pub failed: usize,
    /// Whether it was stopped before its end.
    pub stopped: bool,
}

impl Summary {
    /// Runs that are behind it, however they ended.
    pub(super) fn count(&self) -> usize {
        self.made + self.skipped + self.failed
    }
}

/// What became of the references.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReferenceSummary {
    pub made: usize,
    /// Those that were there already.
    pub found: usize,
    /// Name and reason of each that could not be made.
    pub failed: Vec<(String, String)>,
    pub stopped: bool,
}
