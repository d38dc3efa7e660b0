//! From linear radiance to the 8-bit values of a PNG.

use super::Record;
use crate::knobs::{Choice, Encoding};
use serde_json::Value;

/// An exposure and an encoding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// Stops.
    pub exposure: f64,
    pub encoding: Encoding,
}

impl Curve {
    /// As the knobs `image.exposure` and `image.encoding` of a record say.
    pub fn of(record: &Record) -> Curve {
        let exposure = record.knobs.get("image.exposure").and_then(Value::as_f64);
        let encoding = record.knobs.get("image.encoding").and_then(Value::as_str);
        Curve {
            exposure: exposure.unwrap_or(0.0),
            encoding: encoding
                .and_then(Encoding::from_name)
                .unwrap_or(Encoding::Srgb),
        }
    }

    /// What radiance is multiplied by.
    pub fn gain(&self) -> f64 {
        self.exposure.exp2()
    }

    /// The 8-bit value of a radiance that the gain has been applied to. NaN and anything below
    /// zero are black, anything above one is white.
    pub fn encode(&self, exposed: f64) -> u8 {
        // NaN is not above zero either.
        let linear = if exposed > 0.0 { exposed.min(1.0) } else { 0.0 };
        match self.encoding {
            // Nearest: the cast rounds down.
            Encoding::Srgb => (255.0 * srgb(linear) + 0.5) as u8,
            Encoding::Gamma22 => (255.0 * libm::pow(linear, 1.0 / 2.2)) as u8,
        }
    }
}

/// The opto-electronic curve of IEC 61966-2-1, 0..1 to 0..1.
pub(super) fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    }
}
