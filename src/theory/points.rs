//! Points on a sphere by the paper's three cases (section 2.2): where along the pole they are.
//!
//! Case 1 takes both angles even, so that z has the arcsine's density 1 / (pi sqrt(1 - z^2)); cases 2 and 3 are
//! even by area, and z is even (Archimedes).

use std::f64::consts::PI;

/// Share of case 1's points with a height of at most `z`.
pub fn z_distribution(z: f64) -> f64 {
    0.5 + z.clamp(-1.0, 1.0).asin() / PI
}

/// Share of case 1's points within so many degrees of one of the two poles.
pub fn polar_share(degrees: f64) -> f64 {
    degrees / 90.0
}

/// The same for points that are even by area.
pub fn polar_share_even(degrees: f64) -> f64 {
    1.0 - degrees.to_radians().cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_third_against_a_seventh() {
        assert!((polar_share(30.0) - 0.3333).abs() < 1e-4);
        assert!((polar_share_even(30.0) - 0.1340).abs() < 1e-4);
        // The two distributions are furthest apart where the densities cross: at sqrt(1 - 4 / pi^2).
        let z = (1.0 - 4.0 / (PI * PI)).sqrt();
        let apart = (0.5 + 0.5 * z) - z_distribution(z);
        assert!((apart - 0.1053).abs() < 1e-4 && (z - 0.771).abs() < 1e-3);
    }
}
