//! The one table of knobs, the presets, and the typed values made of them.

mod choice;
mod settings;

pub use choice::*;
pub use settings::*;
