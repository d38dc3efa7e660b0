//! Faults that tests ask for: a device that is lost in the middle of a render, as happens when a driver is
//! reset or a node's GPU falls off its bus.

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
    pub fn of_this_device() -> Self {
        let number = OPENED.fetch_add(1, Ordering::SeqCst);
        let text = env::var(LOSE_DEVICE).unwrap_or_default();
        Self {
            after: text
                .split(',')
                .nth(number)
                .and_then(|blocks| blocks.trim().parse().ok()),
            blocks: 0,
        }
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
