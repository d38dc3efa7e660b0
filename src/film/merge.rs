//! Adds pictures of disjoint samples of one render.

use super::moments::{PictureMean, narrow};
use super::parts::{Part, SAMPLES, check_disjoint, check_randomisations, compare};
use super::randomisations::count as estimates;
use super::{AdaptiveRecord, Picture, Record};
use crate::device::DeviceInfo;
use crate::error::{Error, Result};
use std::path::Path;

/// Reads EXR pictures and adds them up, in the order of their samples, whatever the order of
/// `paths`. With `allow_mixed` they may come from different devices.
///
/// Refused are pictures of different renders, and samples that are in two of them.
pub fn merge<P: AsRef<Path>>(paths: &[P], allow_mixed: bool) -> Result<Picture> {
    let mut parts = Vec::new();
    for path in paths {
        parts.push(Part::open(path.as_ref())?);
    }
    parts.sort_by_key(|part| part.record.ranges());
    let Some((first, others)) = parts.split_first() else {
        return Err(Error::Usage("there is nothing to merge".into()));
    };
    for other in others {
        compare(first, other, allow_mixed)?;
    }
    check_disjoint(&parts)?;
    check_randomisations(&parts)?;

    // One picture at a time: only the sums and one more have to be in memory.
    let mut sum = Sum::new(first.read()?);
    for other in others {
        sum.add(other.read()?)?;
    }
    Ok(sum.finish())
}

/// Moments of one pixel.
#[derive(Clone, Copy)]
struct Moments {
    count: u64,
    /// Independent estimates that the squares are made of: samples, or randomisations.
    estimates: u64,
    mean: [f64; 3],
    /// Sum of the squared distances from the mean; of randomisations, of their means', times their samples.
    squares: [f64; 3],
}

impl Moments {
    fn of(picture: &Picture, pixel: usize) -> Moments {
        let count = picture.count(pixel);
        let estimates = estimates(count, picture.record.randomisation);
        let freedom = estimates.saturating_sub(1) as f64;
        Moments {
            count,
            estimates,
            mean: picture.mean[pixel].map(f64::from),
            squares: picture.variance[pixel].map(|variance| f64::from(variance) * freedom),
        }
    }

    /// The pairwise rule of Chan, Golub and LeVeque (1979), which is exact.
    fn add(&mut self, other: &Moments) {
        let count = self.count.saturating_add(other.count);
        if other.count == 0 {
            return;
        }
        let (n, m) = (self.count as f64, other.count as f64);
        for channel in 0..3 {
            let distance = other.mean[channel] - self.mean[channel];
            self.mean[channel] += distance * m / (n + m);
            self.squares[channel] += other.squares[channel] + distance * distance * n * m / (n + m);
        }
        self.count = count;
        self.estimates = self.estimates.saturating_add(other.estimates);
    }

    fn variance(&self) -> [f64; 3] {
        match self.estimates {
            0 | 1 => [0.0; 3],
            estimates => self.squares.map(|squares| squares / (estimates - 1) as f64),
        }
    }
}

/// Pictures added up so far.
struct Sum {
    pixels: Vec<Moments>,
    /// Everything but the pixels, which are taken out.
    picture: Picture,
    ranges: Vec<[u64; 2]>,
    devices: Vec<DeviceInfo>,
}

impl Sum {
    fn new(mut picture: Picture) -> Sum {
        let pixels = (0..picture.pixels())
            .map(|pixel| Moments::of(&picture, pixel))
            .collect();
        picture.mean = Vec::new();
        picture.variance = Vec::new();
        picture.samples = Vec::new();
        let ranges = picture.record.ranges();
        let devices = picture.record.all_devices();
        Sum {
            pixels,
            picture,
            ranges,
            devices,
        }
    }

    /// Adds another picture; its size is known to be the same.
    fn add(&mut self, other: Picture) -> Result<()> {
        for (pixel, moments) in self.pixels.iter_mut().enumerate() {
            moments.add(&Moments::of(&other, pixel));
        }
        self.ranges.extend(other.record.ranges());
        for device in other.record.all_devices() {
            if !self.devices.contains(&device) {
                self.devices.push(device);
            }
        }
        let features = self.picture.features.take();
        self.picture.features = features.and_then(|own| own.common(other.features.as_ref()));
        add_record(&mut self.picture.record, &other.record);
        self.picture.scene_text = self.picture.scene_text.take().or(other.scene_text);
        Ok(())
    }

    fn finish(self) -> Picture {
        let Sum {
            pixels,
            mut picture,
            ranges,
            devices,
        } = self;
        picture.mean = pixels
            .iter()
            .map(|moments| moments.mean.map(narrow))
            .collect();
        picture.variance = pixels
            .iter()
            .map(|moments| moments.variance().map(narrow))
            .collect();
        picture.samples = pixels.iter().map(|moments| moments.count as f32).collect();

        let mut mean = PictureMean::default();
        for moments in &pixels {
            let Moments {
                count, estimates, ..
            } = *moments;
            mean.add(moments.mean, moments.variance(), count, estimates);
        }
        let record = &mut picture.record;
        let means = &record.randomisation_means;
        if let Some(length) = record.randomisation.filter(|_| !means.is_empty()) {
            mean.told_by(means, length, record.samples);
        }
        record.mean = mean.mean();
        record.standard_error = mean.standard_error();
        record.devices = if devices.len() > 1 {
            devices
        } else {
            Vec::new()
        };
        record.outputs = Vec::new();
        let planned = record.randomisation.is_none();
        let samples = record.knobs.get_mut(SAMPLES).filter(|_| planned);
        if let Some(samples) = samples {
            *samples = record.samples.into();
        }
        set_ranges(record, ranges);
        picture
    }
}

fn add_record(sum: &mut Record, other: &Record) {
    sum.adaptive = both_adaptive(sum, other);
    sum.samples = sum.samples.saturating_add(other.samples);
    sum.paths = sum.paths.saturating_add(other.paths);
    sum.rays = sum.rays.saturating_add(other.rays);
    sum.non_finite = sum.non_finite.saturating_add(other.non_finite);
    sum.seconds.setup += other.seconds.setup;
    sum.seconds.render += other.seconds.render;
    sum.seconds.total += other.seconds.total;
    sum.seconds.longest_block = sum.seconds.longest_block.max(other.seconds.longest_block);
    sum.complete &= other.complete;
    sum.stopped = sum.stopped.or(other.stopped);
    // One number cannot be said of parts that had several.
    sum.target_error = sum
        .target_error
        .filter(|target| other.target_error == Some(*target));
    sum.biased |= other.biased;
    sum.randomisation_means.extend(&other.randomisation_means);
}

/// What is said of scouts where a part had some. They are no part's samples, so that counts which follow from them
/// are good weights: see `render/adaptive`.
fn both_adaptive(sum: &Record, other: &Record) -> Option<AdaptiveRecord> {
    let either = sum.adaptive.as_ref().or(other.adaptive.as_ref())?;
    // The record of a part that was sampled evenly says what it took, not what it might have taken.
    let allowed = |record: &Record| match &record.adaptive {
        Some(adaptive) => adaptive.allowed.clone(),
        None => record.ranges(),
    };
    let scouts = |of: fn(&AdaptiveRecord) -> u64| {
        let parts = [sum, other].map(|record| record.adaptive.as_ref().map_or(0, of));
        parts[0].saturating_add(parts[1])
    };
    Some(AdaptiveRecord {
        allowed: [allowed(sum), allowed(other)].concat(),
        scout_paths: scouts(|adaptive| adaptive.scout_paths),
        scout_rays: scouts(|adaptive| adaptive.scout_rays),
        scout_non_finite: scouts(|adaptive| adaptive.scout_non_finite),
        ..either.clone()
    })
}

/// Joins ranges that touch; what is left is listed only if there is more than one.
fn set_ranges(record: &mut Record, mut ranges: Vec<[u64; 2]>) {
    ranges.retain(|[first, end]| first < end);
    ranges.sort_unstable();
    let mut joined: Vec<[u64; 2]> = Vec::new();
    for range in ranges {
        match joined.last_mut() {
            Some(last) if range[0] <= last[1] => last[1] = last[1].max(range[1]),
            _ => joined.push(range),
        }
    }
    if let (Some(first), Some(last)) = (joined.first(), joined.last()) {
        record.sample_range = [first[0], last[1]];
    }
    record.sample_ranges = if joined.len() > 1 { joined } else { Vec::new() };
}
