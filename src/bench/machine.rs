//! The machine that is measured, and what a process needs of its memory.

use serde::{Deserialize, Serialize};
use std::fs;

/// Enough of a machine to know it again.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Operating system and architecture.
    pub system: String,
    /// The processor's name; empty where the system does not say.
    pub processor: String,
    pub threads: usize,
}

impl Machine {
    pub fn here() -> Self {
        let threads = std::thread::available_parallelism();
        Self {
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            processor: processor().unwrap_or_default(),
            threads: threads.map_or(1, usize::from),
        }
    }
}

/// As Linux names it.
fn processor() -> Option<String> {
    let text = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().into())
}

/// Starts a new peak of this process's memory; whether the system does that.
pub fn forget_peak() -> bool {
    // Linux: 5 resets VmHWM to what is resident now.
    fs::write("/proc/self/clear_refs", "5").is_ok()
}

/// The most memory that this process held resident since [`forget_peak`], in bytes; none outside Linux.
pub fn peak() -> Option<u64> {
    let text = fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_knows_itself() {
        let here = Machine::here();
        assert_eq!(here, Machine::here());
        assert!(here.threads >= 1 && here.system.contains(' '));
    }

    /// Held while it is asked: other tests may start a new peak at any time.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_peak_is_at_least_what_is_held() {
        const BYTES: usize = 64 << 20;
        let held = vec![1u8; BYTES];
        assert!(peak().expect("Linux tells") >= BYTES as u64);
        assert_eq!(std::hint::black_box(&held)[BYTES / 2], 1);
    }
}
