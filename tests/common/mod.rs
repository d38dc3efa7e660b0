//! What tests that render share: devices, measurements, and the gates they must pass.

mod bench;
mod gate;
mod quadrature;

pub use bench::{Bench, benches};
pub use gate::{Case, Family, Form, measure_mean};
pub use quadrature::{erf, integrate};
