//! The one table of knobs, the presets, and the typed values made of them.

mod choice;
mod find;
mod kind;
mod pages;
pub mod randomisation;
mod read;
mod schema;
mod settings;
mod table;

pub(crate) use choice::choice;
pub use choice::*;
pub use find::{REPEATED, Target, find, in_section, nearest, sections, short, unknown};
pub use kind::{Kind, LARGEST, Range, SMALLEST, Value, shown};
pub use pages::{knob_json, markdown, page, table};
pub use read::{Refusal, a};
pub use schema::schema;
pub use settings::*;
pub use table::{Given, KNOBS, Knob};
