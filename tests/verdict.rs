//! The verdict of `lampray diff`: false alarms at the stated rate whatever the noise is like, and power.
//!
//! Seeds are fixed, so that the answer is the same every time. `LAMPRAY_FRESH_SEEDS=1` takes others,
//! under which a test of false alarms fails by chance as often as it says.

mod support;

mod verdict {
    mod alarms;
    mod pictures;
    mod power;
}
