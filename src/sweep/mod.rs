//! A grid of renders in one process: every combination of some knobs' values, written down run by run.
//!
//! ```text
//! --set PATH=VALUES ─Axis→ Grid ─Plan→ runs, each with an id ─Sweep→ images/ID.exr, runs.jsonl ─┬→ table.csv
//!                                                                                                     └analysis→ report.html
//! ```
//!
//! A run's id is a hash of all that decides its pixels, so that a run that is in the ledger as
//! finished never has to be made again: a sweep that was stopped goes on where it was.

mod axis;
mod grid;
mod ledger;
mod plan;
mod report;
mod run;
mod table;

pub use axis::{Axis, MOST_RUNS};
pub use grid::{Grid, Point};
pub use ledger::{Entry, Ledger, Status};
pub use plan::{Base, Plan, Planned};
pub use report::{About, report_data};
pub use run::{Progress, Rules, Summary, Sweep};
pub use table::table;
