//! The values of channels, sorted out of the blocks.

use super::layout::Area;
use super::part::Part;
use exr::prelude::{SampleType, f16};

/// Names of the channels to read, all of which are in the part.
#[derive(Default)]
pub(super) struct Wanted<'a> {
    /// One name may stand three times.
    pub triples: Vec<[&'a str; 3]>,
    pub singles: Vec<&'a str>,
}

/// A pixel has a value in each plane; planes are in the order in which they were wanted.
pub(super) struct Planes {
    pub triples: Vec<Vec<[f32; 3]>>,
    pub singles: Vec<Vec<f32>>,
    /// In the order of the file; also what is not wanted has to be stepped over.
    channels: Vec<(SampleType, Vec<Slot>)>,
    width: usize,
}

/// Where the values of a channel go.
enum Slot {
    /// Number of the triple, and which of its values.
    Of(usize, usize),
    Single(usize),
}

impl Planes {
    /// Zeros, for which memory is taken only as it is filled.
    pub(super) fn new(part: &Part, wanted: &Wanted) -> Planes {
        let channels = part.channels.iter();
        Planes {
            triples: wanted
                .triples
                .iter()
                .map(|_| vec![[0.0; 3]; part.pixels()])
                .collect(),
            singles: wanted
                .singles
                .iter()
                .map(|_| vec![0.0; part.pixels()])
                .collect(),
            channels: channels
                .map(|channel| (channel.samples, slots(wanted, &channel.name)))
                .collect(),
            width: part.width as usize,
        }
    }

    /// A block holds row after row, and in each of them channel after channel.
    pub(super) fn fill(&mut self, area: Area, mut pixels: &[u8]) {
        let Planes {
            triples,
            singles,
            channels,
            width,
        } = self;
        for row in area.y..area.y + area.height {
            let start = row * *width + area.x;
            let span = start..start + area.width;
            for (samples, slots) in &*channels {
                let (line, rest) = pixels.split_at(area.width * samples.bytes_per_sample());
                pixels = rest;
                for slot in slots {
                    match *slot {
                        Slot::Of(triple, value) => {
                            let pixels = &mut triples[triple][span.clone()];
                            decode(*samples, line, pixels.iter_mut().map(|p| &mut p[value]));
                        }
                        Slot::Single(plane) => {
                            decode(*samples, line, singles[plane][span.clone()].iter_mut());
                        }
                    }
                }
            }
        }
    }
}

fn slots(wanted: &Wanted, name: &str) -> Vec<Slot> {
    let triples = wanted.triples.iter().enumerate().flat_map(|(t, names)| {
        let values = names.iter().enumerate();
        let values = values.filter(|(_, wanted)| **wanted == name);
        values.map(move |(value, _)| Slot::Of(t, value))
    });
    let singles = wanted.singles.iter().enumerate();
    let singles = singles
        .filter(|(_, wanted)| **wanted == name)
        .map(|(plane, _)| Slot::Single(plane));
    triples.chain(singles).collect()
}

/// The decompressors leave values in the order of bytes of this machine.
fn decode<'a>(samples: SampleType, line: &[u8], to: impl Iterator<Item = &'a mut f32>) {
    match samples {
        SampleType::F16 => {
            let (halves, _) = line.as_chunks();
            store(to, halves, |half| f16::from_ne_bytes(half).to_f32());
        }
        SampleType::F32 => store(to, line.as_chunks().0, f32::from_ne_bytes),
        SampleType::U32 => store(to, line.as_chunks().0, |whole| {
            u32::from_ne_bytes(whole) as f32
        }),
    }
}

fn store<'a, const N: usize>(
    to: impl Iterator<Item = &'a mut f32>,
    line: &[[u8; N]],
    value: impl Fn([u8; N]) -> f32,
) {
    for (to, stored) in to.zip(line) {
        *to = value(*stored);
    }
}
