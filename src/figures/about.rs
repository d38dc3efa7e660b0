//! What made the figures: nothing in it depends on the day.

use serde::{Deserialize, Serialize};

/// The run of `lampray figures` that a page shows.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct About {
    /// Version of lampray.
    pub version: String,
    /// Name of the device that traced.
    pub device: String,
    /// The command line that makes everything again.
    pub command: String,
    /// Wall clock of the whole run.
    pub seconds: f64,
    /// How much was spent: quick or full.
    pub effort: String,
}
