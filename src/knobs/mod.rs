//! The one table of knobs, the presets, and the typed values made of them.

mod choice;
mod settings;

pub(crate) use choice::choice;
pub use choice::*;
pub use settings::*;
