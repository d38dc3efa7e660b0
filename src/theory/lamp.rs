//! A spherical lamp straight above a matt face, radius over distance q: what the literal weight makes of
//! its light, and how much one sample with the true density varies.

use super::quadrature::integrate;
use std::f64::consts::{PI, TAU};

/// How points of the lamp are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// `uniform-angles` with the pole along the line to the lamp.
    PoleToward,
    /// `uniform-angles` with the pole across it.
    PoleSideways,
    /// `inverse-cosine` and `gaussian`.
    Area,
    /// The visible cone by solid angle.
    Cone,
}

/// The base code's weight: solid angle of a cone that a sphere of radius `s` fills at a distance, none
/// where that is nearer than `s`.
fn solid_angle(s: f64, distance: f64) -> f64 {
    TAU * (1.0 - (1.0 - (s / distance).powi(2)).max(0.0).sqrt())
}

/// Cosine at the face times weight for the lamp's point at height `mu`, the cosine between
/// its normal and the way from face to lamp. The lamp's centre is at distance 1, straight above.
fn weighted(q: f64, s: f64, mu: f64) -> f64 {
    let distance = (1.0 + 2.0 * q * mu + q * q).sqrt();
    (1.0 + q * mu) / distance * solid_angle(s, distance)
}

/// The same for a direction of the cone, at cosine `c` from its axis: it meets the near side.
fn weighted_direction(q: f64, s: f64, c: f64) -> f64 {
    let half_chord = (q * q - (1.0 - c * c)).max(0.0).sqrt();
    c * solid_angle(s, c - half_chord)
}

/// Expected direct light under the literal weight with radius `s`, over the truth pi q^2.
pub fn literal_ratio(law: Law, q: f64, s: f64) -> f64 {
    let mean = match law {
        Law::Cone => {
            let edge = (1.0 - q * q).sqrt();
            // c = edge + x^2 smooths the root at the cone's rim.
            let widest = (1.0 - edge).sqrt();
            let rim = |x: f64| 2.0 * x * weighted_direction(q, s, edge + x * x);
            integrate(0.0, widest, 400, rim) / (1.0 - edge)
        }
        _ => expectation(law, |mu, _| weighted(q, s, mu)),
    };
    mean / (PI * q * q)
}

/// Variance over squared mean of one sample X = cos_x cos_y+ / (pi d^2 p), p the density by area of the
/// law; in the cone X is the cosine at the face.
pub fn relative_variance(law: Law, q: f64) -> f64 {
    let moment = |k: i32| match law {
        Law::Cone => {
            let edge = (1.0 - q * q).sqrt();
            integrate(edge, 1.0, 20, |c| c.powi(k)) / (1.0 - edge)
        }
        _ => expectation(law, |mu, inverse| (geometry(q, mu) * inverse).powi(k)),
    };
    let mean = moment(1);
    moment(2) / (mean * mean) - 1.0
}

/// cos_x cos_y+ / d^2 of the lamp's point at height `mu`.
fn geometry(q: f64, mu: f64) -> f64 {
    let squared = 1.0 + 2.0 * q * mu + q * q;
    let cos_y = (-(mu + q)).max(0.0) / squared.sqrt();
    (1.0 + q * mu) / squared.sqrt() * cos_y / squared
}

/// Expectation of `f` of a drawn point's height and of one over its density by area on the unit sphere.
fn expectation(law: Law, f: impl Fn(f64, f64) -> f64) -> f64 {
    match law {
        Law::PoleToward => {
            let at = |phi: f64| f(phi.cos(), TAU * PI * phi.sin());
            integrate(0.0, PI, 400, at) / PI
        }
        // mu = sin(phi) cos(theta), phi and theta even.
        Law::PoleSideways => {
            let ring = |phi: f64| {
                let at = |theta: f64| f(phi.sin() * theta.cos(), TAU * PI * phi.sin());
                integrate(0.0, PI, 100, at) / PI
            };
            integrate(0.0, PI, 100, ring) / PI
        }
        Law::Area | Law::Cone => 0.5 * integrate(-1.0, 1.0, 400, |mu| f(mu, 4.0 * PI)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_lamps_have_the_closed_forms() {
        let known = [
            (Law::PoleToward, PI * PI / 4.0 - 1.0),
            (Law::Area, 5.0 / 3.0),
            (Law::PoleSideways, 3.0 * PI * PI / 8.0 - 1.0),
        ];
        for (law, variance) in known {
            let found = relative_variance(law, 1e-5);
            assert!((found - variance).abs() < 1e-3, "{law:?}: {found}");
            assert!((literal_ratio(law, 1e-3, 1e-3) - 1.0).abs() < 1e-4);
        }
        assert!(relative_variance(Law::Cone, 0.01) < 1e-8);
    }

    #[test]
    fn near_lamps_have_the_known_figures() {
        // To the digits that are known.
        let known = [
            (0.17, [1.80, 2.54, 4.10], 0.006),
            (8.5 / 24.0, [2.30, 4.26, 6.83], 0.006),
            (0.5, [2.93, 7.00, 11.2], 0.055),
        ];
        for (q, figures, digit) in known {
            let laws = [Law::PoleToward, Law::Area, Law::PoleSideways];
            for (law, figure) in laws.into_iter().zip(figures) {
                let found = relative_variance(law, q);
                assert!((found - figure).abs() < digit, "{law:?} at {q}: {found}");
            }
        }
    }
}
