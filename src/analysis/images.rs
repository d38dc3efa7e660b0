//! Pictures as the report takes them.

use crate::film::Picture;
use crate::report::data::ImageData;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use half::f16;

/// What an image shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Radiance,
    /// Signed.
    Bias,
    /// Of one sample, from 0 on.
    Deviation,
}

impl Kind {
    pub fn name(self) -> &'static str {
        match self {
            Kind::Radiance => "radiance",
            Kind::Bias => "bias",
            Kind::Deviation => "deviation",
        }
    }
}

/// Half floats keep about three digits; what they cannot hold becomes the largest that they can.
pub fn image(name: &str, kind: Kind, size: [u32; 2], pixels: &[[f32; 3]]) -> ImageData {
    let most = f16::MAX.to_f32();
    let half = |value: &f32| f16::from_f32(value.clamp(-most, most)).to_le_bytes();
    let bytes: Vec<u8> = pixels.as_flattened().iter().flat_map(half).collect();
    ImageData {
        name: name.into(),
        width: size[0],
        height: size[1],
        kind: kind.name().into(),
        half: STANDARD.encode(bytes),
    }
}

/// A picture's mean radiance.
pub fn picture_image(name: &str, picture: &Picture) -> ImageData {
    let size = [picture.width, picture.height];
    image(name, Kind::Radiance, size, &picture.mean)
}
