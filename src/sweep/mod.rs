//! A grid of renders in one process: every combination of some knobs' values, written down run by run.
//!
//! ```text
//! --set PATH=VALUES ─Axis→ Grid ─Experiment→ runs and references, each with an id
//! Experiment ─Sweep→ images/ID.exr, runs.jsonl, reference/ID.exr ─┬→ table.csv
//!                                                                  └Answer→ analysis → report.html
//! ```
//!
//! [`Answer::read`] is the one way back from a folder, for the report and for whoever else asks; it never
//! renders. A whole sweep from code:
//!
//! ```no_run
//! use lampray::sweep::*;
//! use lampray::{Error, Result, render};
//! use std::ops::ControlFlow;
//!
//! fn whole(base: Base, grid: Grid, folder: &std::path::Path) -> Result<Answer> {
//!     let device = render::open(&"auto".parse()?, None)?.device;
//!     let experiment = Experiment::new(base, grid, device.info(), &ReferenceRule::Auto, None)?;
//!     let mut sweep = Sweep::new(&experiment, folder, Rules::default())?;
//!     let mut device = Some(device);
//!     let mut open = || device.take().ok_or(Error::Device("it was lost".into()));
//!     let mut watch = |_: Progress| ControlFlow::Continue(());
//!     sweep.go(&mut open, &mut watch)?;
//!     sweep.references(&mut open, &mut watch)?;
//!     Answer::read(folder, &experiment, &mut |_, _| {})
//! }
//! ```
//!
//! A run's id is a hash of all that decides its pixels, so that a run that is in the ledger as finished,
//! and whose picture reads back whole, never has to be made again: a sweep that was stopped goes on where it
//! was.

mod answer;
mod attempt;
mod axis;
mod entry;
mod expected;
mod experiment;
mod grid;
mod ledger;
mod plan;
mod progress;
mod report;
mod run;
mod summary;
mod table;
mod walk;
mod whole;

pub use answer::{Answer, Look};
pub use axis::{Axis, MOST_RUNS};
pub use expected::{PlannedReference, ReferenceRule};
pub use experiment::Experiment;
pub use grid::{Grid, Point};
pub use ledger::{Entry, Ledger, Status};
pub use plan::{Base, Plan, Planned};
pub use progress::{Progress, Step};
pub use report::{About, report_data};
pub use run::{Open, Sweep, Watch};
pub use summary::{ReferenceSummary, Rules, Summary};
pub use table::table;
