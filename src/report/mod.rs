//! The report of a sweep.

pub mod data;
