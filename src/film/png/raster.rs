//! Any program's PNG, for comparing.

use super::head::{Colour, Head, Meaning};
use super::image::Image;
use super::pixels::{Values, decode};
use crate::error::{Error, Result};
use crate::film::input::Input;
use crate::film::{Curve, Pixels, Raster, Record, Transfer, bytes, limits, text};
use crate::knobs::Encoding;
use crate::panics::catch;
use png::DecodingError;
use std::io::ErrorKind;
use std::path::Path;

/// What a gamma chunk of every second program holds, 1 / 2.2: it means sRGB.
const NEARLY_SRGB: u32 = 45455;

/// A file that has been read up to its pixels.
#[derive(Debug)]
pub(in crate::film) struct PngFile {
    input: Input,
    head: Head,
}

impl PngFile {
    /// The signature has been read already.
    pub(in crate::film) fn open(path: &Path, mut input: Input) -> Result<PngFile> {
        let head = Head::read(path, &mut input.reader)?;
        limits::refuse_bomb(path, input.size, head.decoded_bytes(), head.raster_bytes())?;
        Ok(PngFile { input, head })
    }

    pub(in crate::film) fn size(&self) -> [u32; 2] {
        [self.head.width, self.head.height]
    }

    pub(in crate::film) fn read(self, path: &Path) -> Result<Raster> {
        let PngFile {
            mut input,
            mut head,
        } = self;
        let mut image = Image::new(&mut input.reader, &head);
        let pixels = match catch(|| decode(&mut image, &head)) {
            Ok(Ok(pixels)) => pixels,
            Ok(Err(error)) => return Err(failed(path, error)),
            Err(_) => return Err(bytes::data(path, "broken pixels: they cannot be decoded")),
        };
        let Some(next) = image.next else {
            return Err(bytes::data(path, "broken pixels: they do not end"));
        };
        head.texts.read_rest(path, &mut input.reader, next)?;

        let mut left_aside = left_aside(&head);
        let record = match head.texts.record.as_deref() {
            None => None,
            Some(json) => {
                let record = text::parse_record(path, Some(json))?;
                text::of_size(record, head.width, head.height, &mut left_aside)
            }
        };
        let transfer = transfer(record.as_ref(), &head.meaning);
        Ok(Raster {
            width: head.width,
            height: head.height,
            origin: [0, 0],
            pixels: match pixels {
                Values::Bytes(pixels) => Pixels::Bytes(pixels, transfer),
                Values::Words(pixels) => Pixels::Words(pixels, transfer),
            },
            noise: None,
            record,
            format: format(&head),
            left_aside,
        })
    }
}

fn failed(path: &Path, error: DecodingError) -> Error {
    match error {
        DecodingError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
            bytes::data(path, "the file ends too early")
        }
        DecodingError::IoError(source) => Error::Input {
            path: path.into(),
            source,
        },
        error => bytes::data(path, format!("broken pixels: {error}")),
    }
}

/// A record that came through a program that cut the picture is left aside, as it says nothing of
/// this one's encoding either.
fn transfer(record: Option<&Record>, meaning: &Meaning) -> Transfer {
    match (
        record.map(|record| Curve::of(record).encoding),
        meaning.gamma,
    ) {
        (Some(Encoding::Gamma22), _) => Transfer::Power(2.2),
        (Some(Encoding::Srgb), _) => Transfer::Srgb,
        (None, Some(gamma)) if !meaning.srgb && gamma != NEARLY_SRGB && gamma > 0 => {
            Transfer::Power(100_000.0 / f64::from(gamma))
        }
        _ => Transfer::Srgb,
    }
}

fn format(head: &Head) -> String {
    let kind = match head.colour {
        Colour::Grey | Colour::GreyAlpha => ", grey",
        Colour::Palette => ", palette",
        Colour::Rgb | Colour::Rgba => "",
    };
    let plural = if head.depth == 1 { "" } else { "s" };
    format!("PNG, {} bit{plural}{kind}", head.depth)
}

fn left_aside(head: &Head) -> Vec<String> {
    let alpha = matches!(head.colour, Colour::GreyAlpha | Colour::Rgba) || head.transparent;
    let notes = [
        (alpha, "alpha"),
        (head.meaning.profile, "colour profile"),
        (head.animated, "animation after the first frame"),
    ];
    let true_notes = notes.into_iter().filter(|(is_so, _)| *is_so);
    true_notes.map(|(_, note)| note.into()).collect()
}
