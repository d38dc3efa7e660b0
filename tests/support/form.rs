//! Form factors in closed form.

use std::f64::consts::PI;

/// Fraction of the light that a sphere of half angle `half`, its middle at `omega` from the normal, would send if it
/// filled the half-space (Snyder, "Area light sources for real-time graphics", 1996).
pub fn form_factor(half: f64, omega: f64) -> f64 {
    let (s2, cosine) = (half.sin().powi(2), omega.cos());
    if cosine * cosine >= s2 {
        return s2 * cosine.max(0.0);
    }
    let x = (1.0 / s2 - 1.0).sqrt();
    let y = -x / omega.tan();
    let w = omega.sin() * (1.0 - y * y).sqrt();
    (s2 * (cosine * y.acos() - x * w) + (w / x).atan()) / PI
}
