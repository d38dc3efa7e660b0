//! What made the figures: nothing in it depends on the day.

use super::{Data, Effort, NUMBERS};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::Path;

/// The run of `lampray figures` that a page shows.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct About {
    /// Version of lampray.
    pub version: String,
    /// Name of the device that traced; of several where figures have different ones.
    pub device: String,
    /// The command lines that make everything again.
    pub command: String,
    /// Tracing time of all runs.
    pub seconds: f64,
    /// How much was spent: quick or full, or both where figures have different ones.
    pub effort: String,
}

impl About {
    /// Of what was rendered into a folder.
    pub fn new(data: &Data, folder: &Path) -> Self {
        let made = data.made.0.values();
        let devices: BTreeSet<&str> = made.clone().map(|of| of.device.name.as_str()).collect();
        let devices: Vec<&str> = devices.into_iter().collect();
        let with = |effort: Effort| {
            let mine = data
                .made
                .0
                .iter()
                .filter(move |(_, of)| of.effort == effort);
            mine.map(|(number, _)| number.to_string())
                .collect::<Vec<_>>()
        };
        let efforts = [Effort::Full, Effort::Quick].map(|effort| (effort, with(effort)));
        let there = efforts.iter().filter(|(_, numbers)| !numbers.is_empty());
        let command = |(effort, numbers): &(Effort, Vec<String>)| {
            let quick = if *effort == Effort::Quick {
                " --quick"
            } else {
                ""
            };
            let only = match numbers.len() == NUMBERS.len() {
                true => String::new(),
                false => format!(" --only {}", numbers.join(",")),
            };
            format!("lampray figures{quick}{only} -o {}", folder.display())
        };
        let commands: Vec<String> = there.clone().map(command).collect();
        let efforts: Vec<&str> = there.map(|(effort, _)| effort.name()).collect();
        Self {
            version: env!("CARGO_PKG_VERSION").into(),
            device: devices.join(", "),
            command: commands.join("\n"),
            seconds: data.seconds(),
            effort: efforts.join(" and "),
        }
    }
}
