//! Whether pictures are parts of one render.

use super::same::difference;
use super::{Picture, Record, read_exr, read_record};
use crate::device::DeviceInfo;
use crate::error::{Error, Result};
use crate::knobs::short;
use crate::wording::named;
use std::path::{Path, PathBuf};

/// The knob in which the parts may differ: how many samples.
pub(super) const SAMPLES: &str = "render.samples";

/// One of the pictures, of which only the record is in memory.
pub(super) struct Part {
    path: PathBuf,
    pub(super) record: Record,
}

impl Part {
    pub(super) fn open(path: &Path) -> Result<Part> {
        let (record, _) = read_record(path)?;
        let part = Part {
            path: path.into(),
            record,
        };
        match &part.record.denoised {
            None => Ok(part),
            Some(_) => part.fail(
                "it was denoised, which leaves no sums of samples: merge the pictures beside such ones".into(),
            ),
        }
    }

    fn fail<T>(&self, reason: String) -> Result<T> {
        Err(Error::Data {
            path: self.path.clone(),
            reason,
        })
    }

    /// The ranges that hold samples, with the picture that they are in.
    fn ranges(&self) -> impl Iterator<Item = ([u64; 2], &Part)> {
        let filled = |range: &[u64; 2]| range[0] < range[1];
        self.record
            .ranges()
            .into_iter()
            .filter(filled)
            .map(move |range| (range, self))
    }

    pub(super) fn read(&self) -> Result<Picture> {
        let picture = read_exr(&self.path)?;
        if picture.record != self.record {
            return self.fail("the file was changed while it was read".into());
        }
        let finite =
            |plane: &[[f32; 3]]| plane.as_flattened().iter().all(|value| value.is_finite());
        if !finite(&picture.mean) || !finite(&picture.variance) {
            return self.fail("there are pixels that are not finite".into());
        }
        Ok(picture)
    }
}

/// Refuses two pictures that are not of one render.
pub(super) fn compare(first: &Part, other: &Part, allow_mixed: bool) -> Result<()> {
    // How many samples were planned says how long a randomisation is.
    let ignored = first.record.randomisation.is_none().then_some(SAMPLES);
    if let Some(found) = difference(&first.record, &other.record, ignored) {
        let first = named(&first.path);
        return other.fail(format!(
            "{} is {}, but {} in {first}: not the same render",
            found.what, found.other, found.one
        ));
    }
    if !allow_mixed {
        compare_devices(first, other)?;
    }
    Ok(())
}

/// A picture that was merged from several devices is mixed already.
fn compare_devices(first: &Part, other: &Part) -> Result<()> {
    let device = &first.record.device;
    for part in [first, other] {
        let others = part.record.all_devices();
        if let Some(unlike) = others.iter().find(|other| !other.is_like(device)) {
            return part.fail(format!(
                "rendered on {}, but {} on {}; --allow-mixed merges them all the same",
                describe(unlike),
                named(&first.path),
                describe(device)
            ));
        }
    }
    Ok(())
}

fn describe(device: &DeviceInfo) -> String {
    let [name, backend, driver] =
        [&device.name, &device.backend, &device.driver].map(|word| short(word));
    format!("{name} ({backend} {driver})")
}

/// Refuses pictures whose randomisations are not whole: where only some pixels have a part of one, or where more than
/// the last ends inside one, nobody can tell how many there are.
pub(super) fn check_randomisations(parts: &[Part]) -> Result<()> {
    let ends = parts
        .iter()
        .flat_map(|part| part.record.ranges())
        .map(|[_, end]| end);
    let last = ends.max().unwrap_or(0);
    for part in parts {
        let record = &part.record;
        let Some(length) = record.randomisation else {
            continue;
        };
        let ranges = record.ranges();
        let taken: u64 = ranges
            .iter()
            .map(|[first, end]| end.saturating_sub(*first))
            .sum();
        if length == 0 || taken != record.samples {
            return part.fail("was stopped when some of its pixels had more samples than others, inside a randomisation: render its range to the end".into());
        }
        let cut =
            |&[first, end]: &[u64; 2]| first % length != 0 || (end % length != 0 && end != last);
        if let Some([first, end]) = ranges.into_iter().find(cut) {
            return part.fail(format!(
                "samples {first}..{end} end inside a randomisation of {length} samples: of a merged picture only the last may"
            ));
        }
    }
    Ok(())
}

/// Refuses two pictures that share a sample.
pub(super) fn check_disjoint(parts: &[Part]) -> Result<()> {
    let ranges = |part| Part::ranges(part);
    let mut all: Vec<([u64; 2], &Part)> = parts.iter().flat_map(ranges).collect();
    all.sort_by_key(|(range, _)| *range);
    for pair in all.windows(2) {
        let [(one, first), (another, other)] = pair else {
            continue;
        };
        if another[0] < one[1] {
            let first = named(&first.path);
            return other.fail(format!(
                "samples {}..{} overlap with {}..{} of {first}",
                another[0], another[1], one[0], one[1]
            ));
        }
    }
    Ok(())
}
