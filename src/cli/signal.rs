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

/// Asks for the picture so far; the signal that tells programs that their terminal has gone.
#[cfg(unix)]
const HANG_UP: Option<i32> = Some(signal_hook::consts::SIGHUP);
#[cfg(not(unix))]
const HANG_UP: Option<i32> = None;

/// Lets a file that may grow no further be an error of writing, which is said and leaves the old file, instead of
/// the end of the program, which the system makes of it.
pub(crate) fn survive_file_limits() {
    #[cfg(unix)]
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
}

/// Watches for signals from now on.
pub(crate) struct Watch {
    flags: Vec<(i32, Arc<AtomicBool>)>,
    hung_up: Arc<AtomicBool>,
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
            hung_up: Arc::default(),
        }
    }

    /// As [`Watch::new`], for work that can show what is done and go on when it is hung up on.
    pub(crate) fn of_render() -> Self {
        let watch = Self::new();
        if let Some(signal) = HANG_UP {
            let _ = signal_hook::flag::register(signal, watch.hung_up.clone());
        }
        watch
    }

    /// Whether somebody has asked for the picture so far since this was last asked.
    pub(crate) fn hung_up(&self) -> bool {
        self.hung_up.swap(false, Ordering::SeqCst)
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
