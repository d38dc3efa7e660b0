//! Boxes along the axes that hold bodies: rounded outwards, so that they never lose any of one.

use glam::{DVec3, Vec3};

/// A box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub lower: Vec3,
    pub upper: Vec3,
}

impl Bounds {
    /// Holds nothing.
    pub const EMPTY: Self = Self {
        lower: Vec3::INFINITY,
        upper: Vec3::NEG_INFINITY,
    };

    /// Around a centre, `reach` to either side of it.
    pub fn around(center: Vec3, reach: DVec3) -> Self {
        let center = center.as_dvec3();
        let (lower, upper) = (center - reach, center + reach);
        Self {
            lower: Vec3::from_array(lower.to_array().map(down)),
            upper: Vec3::from_array(upper.to_array().map(up)),
        }
    }

    /// The least that holds both.
    #[inline]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            lower: self.lower.min(other.lower),
            upper: self.upper.max(other.upper),
        }
    }

    /// The least that holds this and a point.
    #[inline]
    pub fn with_point(&self, point: Vec3) -> Self {
        Self {
            lower: self.lower.min(point),
            upper: self.upper.max(point),
        }
    }

    /// Twice the centre: halving it would only cost time.
    #[inline]
    pub fn twice_center(&self) -> Vec3 {
        self.lower + self.upper
    }

    pub fn sides(&self) -> Vec3 {
        self.upper - self.lower
    }

    /// Half of the surface.
    #[inline]
    pub fn half_area(&self) -> f32 {
        let Vec3 { x, y, z } = self.sides();
        x * y + y * z + z * x
    }
}

/// The largest f32 that is not above a number.
fn down(x: f64) -> f32 {
    let single = x as f32;
    match f64::from(single) > x {
        true => single.next_down(),
        false => single,
    }
}

fn up(x: f64) -> f32 {
    -down(-x)
}
