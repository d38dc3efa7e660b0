//! Every sampler's draws against its density, through the calls that `lampray points` makes, on the
//! CPU twin and on the first Vulkan device.
//!
//! Densities are written here from their definitions in f64; the renderer's own are compared with
//! them draw by draw, and integrated. Seeds are fixed; the level is 0.01 for all chi-square tests of
//! a device and a file together (Sidak). Each test is also shown to refuse what is wrong by little.

mod support;

/// Chance that any of a device's tests refuses perfect samplers.
const LEVEL: f64 = 0.01;
/// Draws of each chi-square test.
const DRAWS: usize = 1_000_000;

mod samplers {
    use super::{DRAWS, LEVEL};

    mod boxes;
    mod cells;
    mod chi_square;
    mod film;
    mod light;
    mod mass;
    mod poles;
    mod rough;
    mod sampling;
    mod scatter;
    mod sequence;
}
