//! Which lamp a shadow ray goes to: `light.choice`, on the CPU twin and on the first Vulkan device.
//!
//! | file | what is held |
//! |---|---|
//! | `law` | a million draws by each device's own tracing kernel have the stated probabilities (chi-square) |
//! | `sums` | the probabilities of all lamps add up to 1 wherever they are asked for, and are the definition's |
//! | `closed` | the sum of lamps' form factors, by every choice |
//! | `hostile` | lamps of all sizes and powers, many, one, in one place |
//! | `bits` | kernels and splits give the same picture, bit for bit |
//!
//! Seeds are fixed; the level is 0.01 for all chi-square tests of a device together (Sidak).

mod support;

mod choice {
    mod bits;
    mod closed;
    mod dome;
    mod hostile;
    mod law;
    mod sums;
}
