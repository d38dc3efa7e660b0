//! Panics of other people's code, caught where they are called so that they become errors.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread;

thread_local! {
    /// Whether a panic of this thread would be caught and read as an error.
    static CATCHING: Cell<bool> = const { Cell::new(false) };
}

/// Whether this thread is in a call whose panic is caught: nobody need be told of it.
pub(crate) fn catching() -> bool {
    CATCHING.get()
}

/// Runs a call that may panic and that leaves nothing behind that is used after a panic.
pub(crate) fn catch<T>(call: impl FnOnce() -> T) -> thread::Result<T> {
    let outer = CATCHING.replace(true);
    let outcome = catch_unwind(AssertUnwindSafe(call));
    CATCHING.set(outer);
    outcome
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_known_to_be_caught() {
        assert!(!catching());
        let outcome = catch(|| {
            assert!(catch(catching).is_ok_and(|inside| inside));
            assert!(catching());
            panic!("on purpose");
        });
        assert!(outcome.is_err_and(|cause: Box<_>| cause.is::<&str>()));
        assert!(!catching());
    }
}
