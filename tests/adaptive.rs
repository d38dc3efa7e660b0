//! Samples where the error is: without bias, with errors that are as stated, the same bytes however the work is
//! split, and whatever the picture is like.

mod support;

mod adaptive {
    mod bytes;
    mod extreme;
    mod files;
    mod stopped;
    mod unbiased;
}

#[path = "checkpoint/room.rs"]
#[allow(dead_code, reason = "made for the tests of checkpoints")]
mod room;
