//! Adds pictures of disjoint samples of one render.

use super::moments::{PictureMean, narrow};
use super::{Picture, Record, read_exr, read_record};
use crate::device::DeviceInfo;
use crate::error::{Error, Result};
use std::path::{Path, PathBuf};

/// The knob in which the pictures may differ: how many samples.
const SAMPLES: &str = "render.samples";

/// Reads EXR pictures and adds them up, in the order of their samples, whatever the order of
/// `paths`. With `allow_mixed` they may come from different devices.
///
/// Refused are pictures of different renders, and samples that are in two of them.
pub fn merge<P: AsRef<Path>>(paths: &[P], allow_mixed: bool) -> Result<Picture> {
    let mut parts = Vec::new();
    for path in paths {
        let path = path.as_ref().to_path_buf();
        let (record, _) = read_record(&path)?;
        parts.push(Part { path, record });
    }
    parts.sort_by_key(|part| part.record.ranges());
    let Some((first, others)) = parts.split_first() else {
        return Err(Error::Usage("there is nothing to merge".into()));
    };
    for other in others {
        compare(first, other, allow_mixed)?;
    }
    check_disjoint(&parts)?;

    // One picture at a time: only the sums and one more have to be in memory.
    let mut sum = Sum::new(first.read()?);
    for other in others {
        sum.add(other.read()?)?;
    }
    Ok(sum.finish())
}

/// One of the pictures.
struct Part {
    path: PathBuf,
    record: Record,
}

impl Part {
    fn fail<T>(&self, reason: String) -> Result<T> {
        Err(Error::Data {
            path: self.path.clone(),
            reason,
        })
    }

    fn read(&self) -> Result<Picture> {
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
fn compare(first: &Part, other: &Part, allow_mixed: bool) -> Result<()> {
    let (a, b) = (&first.record, &other.record);
    let fields = [
        ("scene_hash", a.scene_hash.clone(), b.scene_hash.clone()),
        ("shader_hash", a.shader_hash.clone(), b.shader_hash.clone()),
        ("width", a.width.to_string(), b.width.to_string()),
        ("height", a.height.to_string(), b.height.to_string()),
        ("crop", format!("{:?}", a.crop), format!("{:?}", b.crop)),
        ("seed", a.seed.to_string(), b.seed.to_string()),
    ];
    for (field, one, another) in fields {
        if one != another {
            return differ(first, other, field, &one, &another);
        }
    }
    compare_knobs(first, other)?;
    if !allow_mixed && !a.device.is_like(&b.device) {
        let reason = format!(
            "rendered on {}, but {} on {}; --allow-mixed merges them all the same",
            describe(&b.device),
            first.path.display(),
            describe(&a.device)
        );
        return other.fail(reason);
    }
    Ok(())
}

fn compare_knobs(first: &Part, other: &Part) -> Result<()> {
    let (a, b) = (&first.record.knobs, &other.record.knobs);
    let shown =
        |value: Option<&serde_json::Value>| value.map_or("absent".into(), |v| v.to_string());
    for knob in a.keys().chain(b.keys()).filter(|knob| *knob != SAMPLES) {
        let (one, another) = (a.get(knob), b.get(knob));
        if one != another {
            return differ(first, other, knob, &shown(one), &shown(another));
        }
    }
    Ok(())
}

fn differ<T>(first: &Part, other: &Part, what: &str, one: &str, another: &str) -> Result<T> {
    let first = first.path.display();
    other.fail(format!(
        "{what} is {another}, but {one} in {first}: not the same render"
    ))
}

fn describe(device: &DeviceInfo) -> String {
    format!("{} ({} {})", device.name, device.backend, device.driver)
}

/// Refuses two pictures that share a sample.
fn check_disjoint(parts: &[Part]) -> Result<()> {
    let ranges = |part| Part::ranges(part);
    let mut all: Vec<([u64; 2], &Part)> = parts.iter().flat_map(ranges).collect();
    all.sort_by_key(|(range, _)| *range);
    for pair in all.windows(2) {
        let [(one, first), (another, other)] = pair else {
            continue;
        };
        if another[0] < one[1] {
            let first = first.path.display();
            return other.fail(format!(
                "samples {}..{} overlap with {}..{} of {first}",
                another[0], another[1], one[0], one[1]
            ));
        }
    }
    Ok(())
}

impl Part {
    /// The ranges that hold samples, with the picture that they are in.
    fn ranges(&self) -> impl Iterator<Item = ([u64; 2], &Part)> {
        let filled = |range: &[u64; 2]| range[0] < range[1];
        self.record
            .ranges()
            .into_iter()
            .filter(filled)
            .map(move |range| (range, self))
    }
}

/// Moments of one pixel.
#[derive(Clone, Copy)]
struct Moments {
    count: u64,
    mean: [f64; 3],
    /// Sum of the squared distances from the mean.
    squares: [f64; 3],
}

impl Moments {
    fn of(picture: &Picture, pixel: usize) -> Moments {
        let count = picture.count(pixel);
        let freedom = count.saturating_sub(1) as f64;
        Moments {
            count,
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
    }

    fn variance(&self) -> [f64; 3] {
        match self.count {
            0 | 1 => [0.0; 3],
            count => self.squares.map(|squares| squares / (count - 1) as f64),
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
        let devices = devices(&picture.record);
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
        for device in devices(&other.record) {
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
            mean.add(moments.mean, moments.variance(), moments.count);
        }
        let record = &mut picture.record;
        record.mean = mean.mean();
        record.standard_error = mean.standard_error();
        record.devices = if devices.len() > 1 {
            devices
        } else {
            Vec::new()
        };
        record.outputs = Vec::new();
        if let Some(samples) = record.knobs.get_mut(SAMPLES) {
            *samples = record.samples.into();
        }
        set_ranges(record, ranges);
        picture
    }
}

fn devices(record: &Record) -> Vec<DeviceInfo> {
    match record.devices.as_slice() {
        [] => vec![record.device.clone()],
        devices => devices.to_vec(),
    }
}

fn add_record(sum: &mut Record, other: &Record) {
    sum.samples = sum.samples.saturating_add(other.samples);
    sum.paths = sum.paths.saturating_add(other.paths);
    sum.rays = sum.rays.saturating_add(other.rays);
    sum.non_finite = sum.non_finite.saturating_add(other.non_finite);
    sum.seconds.setup += other.seconds.setup;
    sum.seconds.render += other.seconds.render;
    sum.seconds.total += other.seconds.total;
    sum.complete &= other.complete;
    sum.biased |= other.biased;
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
