//! Any program's EXR, for comparing.

use super::blocks::read_planes;
use super::channels::{SAMPLES, VARIANCE};
use super::header::Header;
use super::layers::{Choice, listed};
use super::part::{Part, compression_name};
use super::planes::Wanted;
use crate::error::Result;
use crate::film::input::Input;
use crate::film::{Noise, Pixels, Raster, Record, bytes, limits, text};
use exr::meta::attribute::{LevelMode, TileDescription};
use exr::prelude::SampleType;
use std::path::Path;

/// A file whose header has been read and checked.
#[derive(Debug)]
pub(in crate::film) struct ExrFile {
    input: Input,
    header: Header,
}

impl ExrFile {
    /// The magic number has been read already.
    pub(in crate::film) fn open(path: &Path, mut input: Input) -> Result<ExrFile> {
        let header = Header::read(path, &mut input.reader)?;
        if Choice::of(&header.part).is_none() {
            let names: Vec<String> = header
                .part
                .channels
                .iter()
                .map(|c| c.name.clone())
                .collect();
            let names = listed("channel", &names).unwrap_or_default();
            let reason = format!("neither R, G and B nor Y are among its channels: it has {names}");
            return Err(bytes::data(path, reason));
        }
        let part = &header.part;
        let pixels = part.pixels() as u64;
        let decoded = pixels * part.bytes_per_pixel() as u64;
        limits::refuse_bomb(path, input.size, decoded, pixels * 12)?;
        Ok(ExrFile { input, header })
    }

    pub(in crate::film) fn size(&self) -> [u32; 2] {
        [self.header.part.width, self.header.part.height]
    }

    pub(in crate::film) fn origin(&self) -> [i32; 2] {
        self.header.part.origin
    }

    pub(in crate::film) fn read(mut self, path: &Path) -> Result<Raster> {
        let header = &self.header;
        let part = &header.part;
        let Some(choice) = Choice::of(part) else {
            return Err(bytes::data(path, "there is no picture in it"));
        };
        let mut left_aside = left_aside(header, &choice);
        let record = record(path, part, &mut left_aside)?;
        let mut wanted = Wanted {
            triples: vec![[0, 1, 2].map(|value| choice.rgb[value].as_str())],
            singles: Vec::new(),
        };
        if choice.noise {
            wanted.triples.push(VARIANCE);
            wanted.singles.push(SAMPLES);
        }
        let mut planes = read_planes(path, &mut self.input.reader, header, &wanted)?;
        let samples = planes.singles.pop();
        let variance = samples.is_some().then(|| planes.triples.pop()).flatten();
        Ok(Raster {
            width: part.width,
            height: part.height,
            origin: part.origin,
            pixels: Pixels::Linear(planes.triples.pop().unwrap_or_default()),
            noise: variance
                .zip(samples)
                .map(|(variance, samples)| Noise { variance, samples }),
            record,
            format: format(part, &choice),
            left_aside,
        })
    }
}

/// A record of another size is of a picture that this one was cut out of.
fn record(path: &Path, part: &Part, left_aside: &mut Vec<String>) -> Result<Option<Record>> {
    let Some(json) = part.record.as_deref() else {
        return Ok(None);
    };
    let record = text::parse_record(path, Some(json))?;
    Ok(text::of_size(record, part.width, part.height, left_aside))
}

fn format(part: &Part, choice: &Choice) -> String {
    let red = part.channels.iter().find(|c| c.name == choice.rgb[0]);
    let samples = match red.map(|channel| channel.samples) {
        Some(SampleType::F16) => "half",
        Some(SampleType::U32) => "uint",
        _ => "float",
    };
    let mut words = vec!["EXR", samples, compression_name(part.compression)];
    words.extend(part.tiling.map(|_| "tiles"));
    words.extend(choice.layer.as_deref());
    words.join(", ")
}

fn left_aside(header: &Header, choice: &Choice) -> Vec<String> {
    let alpha = choice.alpha.then(|| "alpha".into());
    let many = |tiling: &TileDescription| tiling.level_mode != LevelMode::Singular;
    let levels = header.part.tiling.filter(many);
    let notes = [
        alpha,
        listed("channel", &choice.others),
        listed("part", &header.others),
        levels.map(|_| "smaller levels".into()),
    ];
    notes.into_iter().flatten().collect()
}
