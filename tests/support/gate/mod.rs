//! The gates: what a render must pass to agree with a closed form. Tests and their mutants use the
//! same ones.

mod case;
mod family;
mod judge;

pub use case::{Case, Form, measure_mean};
pub use family::Family;

/// Standard errors that a mean, or a sum of many z brought back to one, may lie from the truth.
pub const MOST_ERRORS: f64 = 4.0;
/// Two-sided p of that for one comparison: erfc(4 / sqrt 2).
pub const LEVEL: f64 = 6.334e-5;
/// Relative error of 32-bit arithmetic along a path, where noise is smaller than that.
pub const ARITHMETIC: f64 = 1e-5;
/// Relative standard error that a comparison may have.
const MOST_RELATIVE_ERROR: f64 = 0.002;
