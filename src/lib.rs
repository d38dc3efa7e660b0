//! A headless path tracer for studying how light is sampled.

#![forbid(unsafe_code)]

pub mod cli;
pub mod cpu;
pub mod device;
pub mod error;
pub mod film;
pub mod gpu;
pub mod knobs;
pub mod pack;
pub mod place;
pub mod points;
pub mod render;
pub mod scene;
pub mod shader;

pub use error::{Error, Result};
