//! Faults that tests ask for: a device that is lost in the middle of a render, as happens when a driver is
//! reset or a node's GPU falls off its bus.

use crate::error::{Error, Result};
use crate::knobs::short;
use std::env;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Names the blocks after which devices are destroyed: `5` the first device that the program opens, after
/// five blocks of a scene; `5,0` the second one too, at once.
pub const LOSE_DEVICE: &str = "LAMPRAY_TEST_LOSE_DEVICE";

/// How many devices this program has opened.
static OPENED: AtomicUsize = AtomicUsize::new(0);

/// When a device is to be lost.
#[derive(Debug)]
pub struct Fault {
    after: Option<u64>,
    blocks: u64,
}

impl Fault {
    /// What the environment says of the next device that is opened.
    ///
    /// # Errors
    /// [`Error::Usage`] for what are no numbers: a test that loses nothing would pass.
    pub fn of_this_device() -> Result<Self> {
        let number = OPENED.fetch_add(1, Ordering::SeqCst);
        let text = env::var_os(LOSE_DEVICE).unwrap_or_default();
        let after = blocks(&text.to_string_lossy())?;
        Ok(Self {
            after: after.get(number).copied(),
            blocks: 0,
        })
    }

    /// Another scene is loaded: its blocks are counted anew.
    pub fn begin(&mut self) {
        self.blocks = 0;
    }

    /// Whether the device is to be lost now; asked before each block.
    pub fn strikes(&mut self) -> bool {
        let now = self.after == Some(self.blocks);
        self.blocks += 1;
        now
    }
}

/// After how many blocks each device in turn is to be lost; nothing says none.
fn blocks(text: &str) -> Result<Vec<u64>> {
    if text.is_empty() {
        return Ok(Vec::new());
    }
    let numbers = text.split(',').map(|number| number.trim().parse().ok());
    numbers.collect::<Option<_>>().ok_or_else(|| {
        Error::Usage(format!(
            "{LOSE_DEVICE}={}: give numbers of blocks, one for each device that is to be lost in turn, such as 5 or 5,0; or unset it",
            short(text)
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nonsense_is_refused() {
        assert!(blocks("").unwrap().is_empty());
        assert_eq!(blocks("5, 0").unwrap(), [5, 0]);
        for nonsense in ["five", "5,", "-1", "0.5", "5;0", " "] {
            assert!(
                matches!(blocks(nonsense), Err(Error::Usage(_))),
                "{nonsense}"
            );
        }
    }
}
