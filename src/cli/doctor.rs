use super::options::DeviceOptions;
use super::{Output, Result, note, print};
use crate::doctor::{Examination, examine, record, table};
use crate::error::Error;
use clap::Args;
use serde_json::json;

/// Check that a device computes as it should
///
/// Asks the device short questions whose answers are known (canaries): integers, random numbers, the
/// layout of structs, NaN and infinity, denormals, accesses past the end of a buffer, division and roots,
/// conversions, long loops, a long wait, and a picture of 8x8 pixels. Exits with 69 where one fails.
///
/// Every command that renders asks the same of a graphics device when a program meets a driver for the first
/// time, and keeps the verdict in $XDG_CACHE_HOME/lampray or ~/.cache/lampray (macOS: ~/Library/Caches/lampray,
/// Windows: %LOCALAPPDATA%\lampray\cache). There too lie the drivers' compiled pipelines. LAMPRAY_CACHE_DIR
/// names another folder; empty, it switches both off. The folder may be deleted at any time.
#[derive(Args)]
#[command(after_help = "Examples:
  lampray doctor                             # the device that --device auto chooses first
  lampray doctor --device cpu --json
  LAMPRAY_CACHE_DIR= lampray render s.toml   # examines the device again, keeps nothing")]
pub(crate) struct Command {
    #[command(flatten)]
    device: DeviceOptions,
}

impl Command {
    pub(crate) fn run(self, output: Output) -> Result<()> {
        let outcome = self.examine(output);
        if let (Err(error), true) = (&outcome, output.json) {
            print(&(unexamined(error) + "\n"))?;
        }
        let examination = outcome?;
        record(&examination);
        print(&match output.json {
            true => examination.to_json() + "\n",
            false => table(&examination),
        })?;
        examination.verdict()
    }

    fn examine(&self, output: Output) -> Result<Examination> {
        let mut chosen = self.device.open_unexamined()?;
        if let (Some(remark), false) = (&chosen.remark, output.quiet) {
            note(&format!("lampray: {remark}"));
        }
        examine(chosen.device.as_mut())
    }
}

/// The object of a device that could not be asked: the same keys, and why.
fn unexamined(error: &Error) -> String {
    json!({
        "device": null,
        "limits": null,
        "canaries": [],
        "ok": false,
        "error": error.to_string(),
    })
    .to_string()
}
