//! What a long command shows while it works.

use super::{Output, note};
use indicatif::{ProgressBar, ProgressStyle};
use std::cell::RefCell;
use std::time::Duration;

/// Steps of a bar that shows shares.
const STEPS: u64 = 1000;

/// indicatif's bar in one of our layouts; it shows nothing where there is no terminal.
pub(crate) fn bar(output: Output, layout: &str) -> ProgressBar {
    if output.quiet {
        return ProgressBar::hidden();
    }
    let style =
        ProgressStyle::with_template(layout).unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::no_length().with_style(style);
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// A bar with words on a terminal; elsewhere a line whenever something else is in hand.
pub(crate) struct Bar {
    bar: ProgressBar,
    plain: bool,
    /// What the last line was about.
    said: RefCell<String>,
}

impl Bar {
    pub(crate) fn new(output: Output) -> Self {
        let bar = bar(output, "{bar:24} {percent:>3}% {prefix} {wide_msg}");
        bar.set_length(STEPS);
        Self {
            plain: bar.is_hidden() && !output.quiet,
            bar,
            said: RefCell::new(String::new()),
        }
    }

    /// Shows how much is done, 0 to 1, what is in hand, and the time left.
    pub(crate) fn show(&self, share: f64, words: String, left: Option<String>) {
        let left = left.map(|left| format!("about {left} left"));
        if self.plain && *self.said.borrow() != words {
            match left {
                Some(left) => note(&format!("{words}, {left}")),
                None => note(&words),
            }
            self.said.replace(words);
        } else {
            self.bar.set_position((share * STEPS as f64) as u64);
            self.bar.set_prefix(left.unwrap_or_default());
            self.bar.set_message(words);
        }
    }

    /// Takes the bar away.
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}
