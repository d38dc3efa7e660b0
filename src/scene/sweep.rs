//! `[sweep]`: what a scene asks `lampray sweep` for, where the command line does not.
//!
//! ```toml
//! [sweep]
//! set = ["light.sampler=cone,gaussian", "render.samples=4..64*2"]
//! seeds = 8
//! reference = "auto"
//! [sweep.regions]
//! penumbra = [40, 90, 60, 100]
//! ```
//!
//! Regions are in pixels of the size that the file states, or of the default one where it states none. A
//! picture of another size (`--width`, a swept `image.width`) has them where they are in that one,
//! rounded to whole pixels.

use super::faults::{Faults, Origin};
use super::read::{bad_name, ordered};
use crate::knobs::{a, nearest, short};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A part of the picture with a name, pixels; `x1` and `y1` are exclusive.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    pub name: String,
    /// x0, y0, x1, y1.
    pub rect: [u32; 4],
}

/// The table as it was written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SweepTable {
    /// `PATH=VALUES`, as `--set` takes them.
    pub set: Vec<String>,
    pub zip: bool,
    /// 0 where nothing was written.
    pub seeds: u64,
    /// As `--reference` takes it.
    pub reference: Option<String>,
    pub regions: Vec<Region>,
    /// Width and height that the file states.
    pub size: [u32; 2],
}

impl SweepTable {
    /// The regions, which must be inside the size that the file states, in a picture of another size.
    pub fn regions_in(&self, size: [u32; 2]) -> Vec<Region> {
        let scaled = |region: &Region| {
            let [x0, y0, x1, y1] = region.rect;
            let [x0, x1] = scale([x0, x1], self.size[0], size[0]);
            let [y0, y1] = scale([y0, y1], self.size[1], size[1]);
            Region {
                name: region.name.clone(),
                rect: [x0, y0, x1, y1],
            }
        };
        self.regions.iter().map(scaled).collect()
    }
}

/// An interval inside a side, rounded to the nearest pixels and at least one of them long.
fn scale(ends: [u32; 2], from: u32, to: u32) -> [u32; 2] {
    if from == to {
        return ends;
    }
    let near = |end: u32| {
        let scaled = (f64::from(end) * f64::from(to) / f64::from(from.max(1))).round();
        scaled as u32
    };
    match ends.map(near) {
        [low, high] if low < high => [low, high],
        [low, _] => {
            let low = low.min(to.saturating_sub(1));
            [low, low + 1]
        }
    }
}

const KEYS: [&str; 5] = ["set", "zip", "seeds", "reference", "regions"];

/// Reads the table; what is wrong with it goes to `faults`.
pub(super) fn read(value: &Spanned<DeValue<'_>>, faults: &mut Faults<'_>) -> SweepTable {
    let mut sweep = SweepTable::default();
    let DeValue::Table(table) = value.get_ref() else {
        wrong(value, "sweep", "a table: write [sweep]", faults);
        return sweep;
    };
    for (key, value) in ordered(table) {
        match (key.get_ref().as_ref(), value.get_ref()) {
            ("set", DeValue::Array(items)) => {
                for item in items {
                    match item.get_ref() {
                        DeValue::String(text) => sweep.set.push(text.to_string()),
                        _ => wrong(
                            item,
                            "sweep.set",
                            "texts such as \"light.sampler=cone,gaussian\"",
                            faults,
                        ),
                    }
                }
            }
            ("set", _) => wrong(value, "sweep.set", "a list of texts", faults),
            ("zip", DeValue::Boolean(zip)) => sweep.zip = *zip,
            ("zip", _) => wrong(value, "sweep.zip", "true or false", faults),
            ("seeds", _) => match whole(value).filter(|seeds| (1..=1_000_000).contains(seeds)) {
                Some(seeds) => sweep.seeds = seeds,
                None => wrong(
                    value,
                    "sweep.seeds",
                    "a whole number from 1 to 1000000",
                    faults,
                ),
            },
            ("reference", DeValue::String(text)) => sweep.reference = Some(text.to_string()),
            ("reference", _) => match whole(value) {
                Some(samples) => sweep.reference = Some(samples.to_string()),
                None => wrong(
                    value,
                    "sweep.reference",
                    "\"auto\", \"none\", a number of samples or \"FILE.exr\"",
                    faults,
                ),
            },
            ("regions", DeValue::Table(table)) => sweep.regions = regions(table, faults),
            ("regions", _) => wrong(
                value,
                "sweep.regions",
                "a table of NAME = [x0, y0, x1, y1]",
                faults,
            ),
            (name, _) => faults.add(Origin::File(key.span()), || {
                let note = match nearest(name, KEYS) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("the keys here are {}", KEYS.join(", ")),
                };
                (
                    format!("unknown key `{}` in `sweep`", short(name)),
                    Some(note),
                )
            }),
        }
    }
    sweep
}

/// Each is measured in every picture.
const MOST_REGIONS: usize = 256;

fn regions(table: &DeTable<'_>, faults: &mut Faults<'_>) -> Vec<Region> {
    let mut regions = Vec::new();
    for (number, (key, value)) in ordered(table).into_iter().enumerate() {
        let name = key.get_ref().to_string();
        // No command line has to spell it: an equals sign is fine here.
        if let Some(reason) = bad_name(&name.replace('=', "-")) {
            let message = format!("a region's name {reason}");
            faults.add(Origin::File(key.span()), || (message, None));
        }
        if number == MOST_REGIONS {
            let message = format!("more than {MOST_REGIONS} regions");
            faults.add(Origin::File(key.span()), || (message, None));
            break;
        }
        match rect(value) {
            Some(rect) => regions.push(Region { name, rect }),
            None => {
                let path = format!("sweep.regions.{}", short(&name));
                wrong(
                    value,
                    &path,
                    "[x0, y0, x1, y1] in pixels with x0 < x1 and y0 < y1",
                    faults,
                );
            }
        }
    }
    regions
}

fn rect(value: &Spanned<DeValue<'_>>) -> Option<[u32; 4]> {
    let DeValue::Array(items) = value.get_ref() else {
        return None;
    };
    let numbers: Option<Vec<u32>> = items
        .iter()
        .map(|item| u32::try_from(whole(item)?).ok())
        .collect();
    let rect: [u32; 4] = numbers?.try_into().ok()?;
    let [x0, y0, x1, y1] = rect;
    (x0 < x1 && y0 < y1).then_some(rect)
}

fn whole(value: &Spanned<DeValue<'_>>) -> Option<u64> {
    let number = value.get_ref().as_integer()?;
    u64::from_str_radix(number.as_str(), number.radix()).ok()
}

fn wrong(value: &Spanned<DeValue<'_>>, path: &str, wanted: &str, faults: &mut Faults<'_>) {
    faults.add(Origin::File(value.span()), || {
        let found = a(value.get_ref());
        (format!("`{path}` must be {wanted}, not {found}"), None)
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_keeps_its_place_and_never_vanishes() {
        assert_eq!(scale([40, 60], 256, 256), [40, 60]);
        assert_eq!(scale([40, 60], 256, 128), [20, 30]);
        assert_eq!(scale([40, 60], 256, 1024), [160, 240]);
        assert_eq!(scale([3, 5], 10, 15), [5, 8]);
        assert_eq!(scale([40, 41], 256, 64), [10, 11]);
        assert_eq!(scale([255, 256], 256, 16), [15, 16]);
        assert_eq!(scale([0, 256], 256, 1), [0, 1]);
    }
}
