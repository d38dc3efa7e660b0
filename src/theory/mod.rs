//! What should come out: closed forms and quadratures of the paper's samplers and weights, in f64.
//!
//! No rendering is in here. The tests hold the renderer against these numbers, and the figures draw them
//! beside what was measured.

mod chance;
mod interruption;
mod lamp;
mod penumbra;
mod points;
mod quadrature;

pub use chance::{chi_square_above, distance_of_sorted, kolmogorov_above};
pub use interruption::{energy_share, hits};
pub use lamp::{Law, literal_ratio, relative_variance};
pub use penumbra::{Drawn, share};
pub use points::{polar_share, polar_share_even, z_distribution};
pub use quadrature::integrate;
