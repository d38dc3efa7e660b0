//! `--calibrate`: limits that are measured.

use super::{Command, Output, SAME, print, print_json, remark};
use crate::calibrate;
use crate::compare::{Metric, Wishes};
use crate::error::{Error, Result};
use std::path::Path;

impl Command {
    /// Renders, compares and proposes; returns the exit code.
    pub(super) fn calibrate(&self, scene: &Path, wishes: &Wishes, output: Output) -> Result<u8> {
        if !(1e-6..=0.5).contains(&self.false_alarms) {
            return Err(Error::Usage(format!(
                "--false-alarms {:e}: must be from 1e-6 to 0.5",
                self.false_alarms
            )));
        }
        if !wishes.gates.is_empty() {
            return Err(Error::Usage(
                "--calibrate proposes limits: give --metric without --max or --min".into(),
            ));
        }
        let metrics = if wishes.metrics.is_empty() {
            vec![Metric::Rmse, Metric::Flip]
        } else {
            wishes.metrics.clone()
        };
        let scene = self.knobs.load(scene)?;
        let plan = calibrate::Plan {
            scene: &scene,
            metrics,
            viewing: wishes.viewing,
            seeds: self.seeds,
            false_alarms: self.false_alarms,
            reference: self.reference.as_deref(),
        };
        let devices = self.device.open_all()?;
        let mut say = |text: &str| remark(text, output);
        let found = calibrate::calibrate(&plan, devices, &mut say)?;
        if output.json {
            print_json(&found)?;
        } else {
            print(&found.to_string())?;
        }
        Ok(SAME)
    }
}
