//! A headless path tracer for studying how light is sampled.

#![forbid(unsafe_code)]

pub mod cli;
pub mod error;
pub mod film;
pub mod knobs;
pub mod pack;
pub mod scene;

pub use error::{Error, Result};
