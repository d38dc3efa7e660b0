//! Two pictures side by side: metrics, gates, and a verdict that needs no threshold.
//!
//! ```text
//! files ─RasterFile→ Pair ─Study→ figures, maps ─┬→ gates ──┐
//!                     └─ Sides ─→ verdict ───────┴──────────┴→ Comparison → text, JSON, exit code
//! ```
//!
//! This room reads files and never renders.

mod comparison;
pub mod flip;
mod gate;
mod lines;
mod map;
mod metric;
mod pair;
mod palette;
mod records;
pub mod similarity;
mod study;
mod survey;
pub mod verdict;

pub use comparison::{Comparison, Described, NoVerdict, Wishes, compare, sides};
pub use gate::{Allowed, Gate, Judgement, Step};
pub use lines::{Lines, Map};
pub use map::{Chart, MapKind, chart, prepare as prepare_map, write as write_map};
pub use metric::{Figure, Metric};
pub(crate) use pair::part;
pub use pair::{Display, Linear, Pair};
pub use palette::Palette;
pub use records::{Kinship, KnobDifference, kinship};
pub use study::{Study, Viewing};
pub use survey::{NEAR_BLACK, NonFinite, Survey, TileError, survey};
