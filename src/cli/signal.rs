//! SIGINT and SIGTERM: the first finishes the dispatch in hand and saves what is done, the second
//! ends the program at once. Files are never half-written: they are renamed into place when whole.

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};

/// The signal that asked to stop, 0 for none.
static RECEIVED: AtomicI32 = AtomicI32::new(0);

#[cfg(unix)]
const SIGNALS: [i32; 2] = [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM];
#[cfg(not(unix))]
const SIGNALS: [i32; 1] = [signal_hook::consts::SIGINT];

/// Watches for signals from now on.
pub(crate) struct Watch {
    flags: Vec<(i32, Arc<AtomicBool>)>,
}

impl Watch {
    pub(crate) fn new() -> Self {
        let flags = SIGNALS.map(|signal| {
            let flag = Arc::new(AtomicBool::new(false));
            // Registered first, so that it sees the flag that an earlier signal set. A system that
            // refuses to watch leaves the signal as it was, which stops the program.
            let _ = signal_hook::flag::register_conditional_shutdown(
                signal,
                128 + signal,
                flag.clone(),
            );
            let _ = signal_hook::flag::register(signal, flag.clone());
            (signal, flag)
        });
        Self {
            flags: flags.to_vec(),
        }
    }

    /// Whether somebody has asked to stop.
    pub(crate) fn stopped(&self) -> bool {
        let asked = self
            .flags
            .iter()
            .find(|(_, flag)| flag.load(Ordering::SeqCst));
        if let Some((signal, _)) = asked {
            RECEIVED.store(*signal, Ordering::SeqCst);
        }
        asked.is_some()
    }
}

/// Success, or 128 + the signal that ended the work early.
pub(crate) fn exit_code() -> ExitCode {
    match RECEIVED.load(Ordering::SeqCst) {
        0 => ExitCode::SUCCESS,
        signal => ExitCode::from(128 + signal as u8),
    }
}
