//! What the program does when something goes wrong: each row says what was done, the exit code, and all that
//! must be left. `cargo test --release --test faults -- --nocapture` prints the rows as tables.

#![cfg(target_os = "linux")]

mod support;

mod faults {
    mod devices;
    mod files;
    mod full;
    mod memory;
    mod resume;
    mod stage;
    mod stops;
    mod streams;
    mod table;
}
