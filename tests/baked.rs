//! The kernel that is printed for a scene: it finds what the general one finds, bit for bit; and when it
//! is taken.

mod support;

mod baked {
    mod choice;
    mod pictures;
    mod printed;
}

#[path = "bvh/crowds.rs"]
#[allow(dead_code, reason = "the tree's tests use all of it")]
mod crowds;
