//! How fast a device traces, by scene and primitive count: rays and paths a second, what compiling
//! costs, what is spent beside tracing, memory.
//!
//! ```text
//! Order (subjects × devices × presets × kernels) ─run→ measurements ─Report→ text, JSON ─Against→ ratios to an earlier run
//! ```
//!
//! Machines are shared and clocks move, so what counts is ratios inside one run. Of one scene the
//! values of the axes are measured in turns, A B C then C B A, the first turn is thrown away (it
//! finds how much work takes the time that was asked for), and a ratio is the median of the turns' own ratios.
//! Each measurement opens its device anew, so that compiling is measured each time.

mod against;
mod device;
mod effort;
mod machine;
mod measure;
mod order;
mod report;
mod room;
mod run;
mod spread;
mod subject;
mod table;

pub use against::{Against, Comparison};
pub use device::{Bench, benches};
pub use effort::Effort;
pub use machine::Machine;
pub use measure::{Measured, measure};
pub use order::{Axis, Cell, Order, kernels, presets, turn};
pub use report::{Ratio, Report, Row, Status};
pub use room::{ROOM_BODIES, room, room_text};
pub use run::{Step, run};
pub use spread::{Spread, ratios};
pub use subject::Subject;
pub use table::table;
