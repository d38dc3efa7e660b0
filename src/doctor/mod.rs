//! Known-answer checks of a device: canaries, each a short computation whose answer is known, that are
//! asked before a device is trusted with a picture.
//!
//! A driver that computes wrongly gives a wrong picture without a word. [`examine`] asks every canary of
//! a device; [`trust`] does so once for each driver and program, and keeps the verdict in the
//! [`crate::cache`]'s folder. Only a device that passed is kept there: one that failed is examined again.
//!
//! `LAMPRAY_TEST_FAIL_CANARY=NAME` wipes what the device answers to one canary before it is judged, so
//! that tests see what a device that fails leads to. Such a verdict is neither kept nor taken from there.

mod ask;
mod canaries;
mod floats;
mod loops;
mod memory;
mod numbers;
mod picture;
mod report;
mod trust;

pub use canaries::NAMES;
pub use report::table;
pub use trust::{record, trust};

use crate::device::{Device, DeviceInfo, Limits};
use crate::error::{Error, Result};
use ask::Ask;
use canaries::{CANARIES, Canary};
use serde::Serialize;

/// Names a canary that is to fail, for tests.
const FAIL_VARIABLE: &str = "LAMPRAY_TEST_FAIL_CANARY";

/// What one canary found.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    pub name: &'static str,
    pub ok: bool,
    /// False where the canary says nothing of such a device; it is `ok` then.
    pub applies: bool,
    pub expected: String,
    pub found: String,
}

/// What all canaries found of a device.
#[derive(Clone, Debug, Serialize)]
pub struct Examination {
    pub device: DeviceInfo,
    /// None for the CPU twin.
    pub limits: Option<Limits>,
    pub canaries: Vec<Finding>,
    pub ok: bool,
}

impl Examination {
    /// The first canary that failed.
    pub fn failure(&self) -> Option<&Finding> {
        self.canaries.iter().find(|finding| !finding.ok)
    }

    /// An error that names the first canary that failed.
    ///
    /// # Errors
    /// [`Error::Device`] where one did.
    pub fn verdict(&self) -> Result<()> {
        let Some(Finding {
            name,
            expected,
            found,
            ..
        }) = self.failure()
        else {
            return Ok(());
        };
        Err(Error::Device(format!(
            "the device {} fails the canary {name} (found: {found}; expected: {expected}) and would give wrong pictures: `lampray doctor` tells more",
            self.device.name
        )))
    }

    /// The examination as one JSON object.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

/// Asks every canary of a device. Takes the place of the scene that is loaded.
///
/// # Errors
/// [`Error::Usage`] where `LAMPRAY_TEST_FAIL_CANARY` names no canary, [`Error::Internal`]. A device that
/// is lost on the way, or refuses, fails its canaries.
pub fn examine(device: &mut dyn Device) -> Result<Examination> {
    let wiped = wiped_canary()?;
    let info = device.info().clone();
    let mut ask = Ask::new(device)?;
    let limits = ask.limits;
    let canaries: Vec<_> = CANARIES
        .iter()
        .map(|canary| finding(canary, &mut ask, wiped == Some(canary.name)))
        .collect();
    Ok(Examination {
        device: info,
        limits,
        ok: canaries.iter().all(|finding| finding.ok),
        canaries,
    })
}

fn finding(canary: &Canary, ask: &mut Ask, wiped: bool) -> Finding {
    let (applies, verdict) = match (canary.ask)(ask) {
        Ok(Some(mut words)) => {
            if wiped {
                words.fill(0);
            }
            (true, (canary.judge)(&words, ask.limits))
        }
        Ok(None) => (false, Ok("not applicable".into())),
        Err(error) => (true, Err(error.to_string())),
    };
    Finding {
        name: canary.name,
        ok: verdict.is_ok(),
        applies,
        expected: canary.expected.into(),
        found: verdict.unwrap_or_else(|found| found),
    }
}

/// The canary that the environment wants to fail.
fn wiped_canary() -> Result<Option<&'static str>> {
    let Some(wanted) = std::env::var_os(FAIL_VARIABLE).filter(|name| !name.is_empty()) else {
        return Ok(None);
    };
    let known = NAMES.iter().find(|name| wanted == **name);
    known.copied().map(Some).ok_or_else(|| {
        let wanted = wanted.to_string_lossy();
        Error::Usage(format!(
            "{FAIL_VARIABLE}={wanted}: there is no such canary; there are {}",
            NAMES.join(", ")
        ))
    })
}
