//! Whether a device may be trusted with pictures: examined once for each driver and program.

use super::{Examination, examine, wiped_canary};
use crate::cache::{Folder, Kind};
use crate::device::{Device, DeviceInfo};
use crate::error::Result;
use crate::shader::library_hash;
use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};
use std::time::UNIX_EPOCH;

/// Verdicts in the cache's folder.
const KIND: Kind = Kind {
    name: "doctor",
    most: 64,
};

/// What a file of a device that passed holds.
const PASSED: &[u8] = b"passed";

/// Devices that passed in this process.
static TRUSTED: Mutex<Option<HashSet<String>>> = Mutex::new(None);

/// Examines a device, unless this program has found it well before.
///
/// # Errors
/// [`crate::Error::Device`] naming the first canary that failed; as [`examine`].
pub fn trust(device: &mut dyn Device) -> Result<()> {
    let forced = wiped_canary()?.is_some();
    let key = key(device.info());
    let folder = Folder::of_user();
    if !forced && (is_trusted(&key) || was_trusted(folder.as_ref(), &key)) {
        return Ok(());
    }
    examine(device)?.verdict()?;
    if !forced {
        remember(folder.as_ref(), &key);
    }
    Ok(())
}

/// Keeps what an examination found, or forgets what an earlier one did.
pub fn record(examination: &Examination) {
    if wiped_canary().is_ok_and(|wiped| wiped.is_none()) {
        settle(Folder::of_user().as_ref(), examination);
    }
}

fn settle(folder: Option<&Folder>, examination: &Examination) {
    let key = key(&examination.device);
    match (examination.ok, folder) {
        (true, _) => remember(folder, &key),
        (false, Some(folder)) => folder.remove(KIND, &key),
        (false, None) => {}
    }
}

fn is_trusted(key: &str) -> bool {
    let trusted = TRUSTED.lock().unwrap_or_else(PoisonError::into_inner);
    trusted.as_ref().is_some_and(|keys| keys.contains(key))
}

/// Whether an earlier process found it well.
fn was_trusted(folder: Option<&Folder>, key: &str) -> bool {
    let kept = folder.and_then(|folder| folder.read(KIND, key));
    let passed = kept.is_some_and(|kept| kept == PASSED);
    if passed {
        hold(key);
    }
    passed
}

fn hold(key: &str) {
    let mut trusted = TRUSTED.lock().unwrap_or_else(PoisonError::into_inner);
    trusted
        .get_or_insert_with(HashSet::new)
        .insert(key.to_string());
}

fn remember(folder: Option<&Folder>, key: &str) {
    hold(key);
    if let Some(folder) = folder {
        // Where nothing can be kept the next process examines it again.
        folder.write(KIND, key, PASSED);
    }
}

/// Everything that a verdict may depend on: the device with its driver, the shaders, the program.
fn key(info: &DeviceInfo) -> String {
    let DeviceInfo {
        kind: _,
        name,
        driver,
        backend,
        pci,
    } = info;
    let version = env!("CARGO_PKG_VERSION");
    [
        name,
        driver,
        backend,
        pci,
        version,
        &library_hash(),
        &program(),
    ]
    .join("\n")
}

/// Size and age of the running program's file: another build has others.
fn program() -> String {
    let file = std::env::current_exe().and_then(std::fs::metadata);
    let Ok(file) = file else {
        return String::new();
    };
    let age = file.modified().ok();
    let age = age.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    format!("{} {:?}", file.len(), age)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::{Cpu, info};

    #[test]
    fn a_verdict_is_of_one_driver_on_one_device() {
        let info = info();
        let own = key(&info);
        assert_eq!(own, key(&info));
        for other in [
            DeviceInfo {
                driver: "another".into(),
                ..info.clone()
            },
            DeviceInfo {
                name: "another".into(),
                ..info.clone()
            },
            DeviceInfo {
                pci: "0000:65:00.0".into(),
                ..info.clone()
            },
        ] {
            assert_ne!(own, key(&other));
        }
        assert!(!program().is_empty());
    }

    #[test]
    fn only_a_whole_verdict_counts() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::at(place.path());
        assert!(!was_trusted(Some(&folder), "a"));
        assert!(folder.write(KIND, "a", b"failed"));
        assert!(!was_trusted(Some(&folder), "a"));
        remember(Some(&folder), "a");
        assert!(was_trusted(Some(&folder), "a") && is_trusted("a"));
        assert!(!was_trusted(Some(&folder), "b") && !is_trusted("b"));
        // Without a folder this process remembers all the same.
        remember(None, "c");
        assert!(is_trusted("c") && !was_trusted(None, "c"));
    }

    #[test]
    fn an_examination_gives_and_takes_trust() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::at(place.path());
        let mut examination = examine(&mut Cpu::new()).unwrap();
        examination.device.name = "a device of this test".into();
        let key = key(&examination.device);
        settle(Some(&folder), &examination);
        assert!(was_trusted(Some(&folder), &key));
        examination.ok = false;
        settle(Some(&folder), &examination);
        assert!(!was_trusted(Some(&folder), &key));
    }

    #[test]
    fn the_twin_is_well() {
        trust(&mut Cpu::new()).unwrap();
    }
}
