//! Checkpoints as files, and renders that go on: from a checkpoint, on another device, by another split.

#[path = "film/sample.rs"]
mod sample;

mod checkpoint {
    mod endure;
    mod file;
    mod resume;
    mod room;
}
