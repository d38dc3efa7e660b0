//! What the figures share: pictures for a screen, and numbers made of several groups.

use super::figure::{Pictures, Shown};
use crate::analysis::words::number;
use crate::analysis::{Group, Quantity};
use crate::compare::verdict::two_sided;
use crate::film::Curve;
use crate::knobs::Encoding;
use crate::pack::Rect;
use crate::report::data::Interval;

/// Mean of all runs of a group, with a line under it.
pub fn shown(group: &Group, size: [u32; 2], exposure: f64, note: String) -> Shown {
    picture(&group.maps.mean, size, exposure, note)
}

/// Linear light as a screen shows it, `exposure` in stops.
pub fn picture(pixels: &[[f32; 3]], size: [u32; 2], exposure: f64, note: String) -> Shown {
    let curve = Curve {
        exposure,
        encoding: Encoding::Srgb,
    };
    let byte = |value: &f32| curve.encode(curve.gain() * f64::from(*value));
    Shown {
        note,
        width: size[0],
        height: size[1],
        rgb: pixels.as_flattened().iter().map(byte).collect(),
    }
}

/// Draws a frame just inside a part of a picture, light on dark and dark on light; as thick as is seen where
/// the picture is shown small.
pub fn outline(shown: &mut Shown, rect: Rect) {
    let thick = (shown.width / 128).max(1);
    let edge = |x: u32, y: u32| {
        let reach = [x - rect.x0, rect.x1 - 1 - x, y - rect.y0, rect.y1 - 1 - y];
        reach.iter().any(|away| *away < thick)
    };
    for y in rect.y0..rect.y1 {
        for x in (rect.x0..rect.x1).filter(|x| edge(*x, y)) {
            let pixel = 3 * (y * shown.width + x) as usize;
            let channels = &mut shown.rgb[pixel..pixel + 3];
            let light = channels
                .iter()
                .map(|channel| u32::from(*channel))
                .sum::<u32>()
                / 3;
            channels.fill(if light < 150 { 255 } else { 0 });
        }
    }
}

/// A block without rows.
pub fn pictures(name: &str, caption: &str, columns: &[&str]) -> Pictures {
    Pictures {
        name: name.into(),
        caption: caption.into(),
        columns: columns.iter().map(|text| text.to_string()).collect(),
        rows: Vec::new(),
    }
}

/// a / b of independent numbers, b far from 0: relative errors add in squares.
pub fn ratio(a: Quantity, b: Quantity) -> Quantity {
    let value = a.value / b.value;
    let variance = (a.error / b.value).powi(2) + (value * b.error / b.value).powi(2);
    Quantity::new(value, variance, a.freedom.min(b.freedom))
}

/// a - b of independent numbers.
pub fn difference(a: Quantity, b: Quantity) -> Quantity {
    let variance = a.error.powi(2) + b.error.powi(2);
    Quantity::new(a.value - b.value, variance, a.freedom.min(b.freedom))
}

/// The interval with other ends and value, each by a function that rises.
pub fn map(interval: Interval, f: impl Fn(f64) -> f64) -> Interval {
    Interval {
        value: f(interval.value),
        low: f(interval.low),
        high: f(interval.high),
    }
}

/// A chance, with as many digits as it needs.
pub fn chance(p: f64) -> String {
    if p < 1e-4 {
        format!("{p:.0e}")
    } else {
        number(p)
    }
}

/// Mean squared distance of two groups' expected pictures in a part of them: the squares of the differences D
/// less the noise w of both, which is what is expected of them where the pictures are one. The square of a
/// number with variance w has the variance 4 (D^2 - w) w + 2 w^2; channels rise and fall together.
pub fn squared_distance(a: &Group, b: &Group, width: u32, rect: Rect) -> Quantity {
    let noise = |group: &Group, pixel: usize, channel: usize| {
        let deviation = f64::from(group.maps.deviation[pixel][channel]);
        deviation * deviation / (group.samples * group.runs as f64)
    };
    let (mut sum, mut variance, mut count) = (0.0, 0.0, 0.0);
    for y in rect.y0..rect.y1 {
        for x in rect.x0..rect.x1 {
            let pixel = (y * width + x) as usize;
            let mut error = 0.0;
            for channel in 0..3 {
                let [one, other] = [a, b].map(|group| f64::from(group.maps.mean[pixel][channel]));
                let own = noise(a, pixel, channel) + noise(b, pixel, channel);
                let square = (one - other).powi(2) - own;
                sum += square / 3.0;
                error += (4.0 * square.max(0.0) * own + 2.0 * own * own).sqrt() / 3.0;
            }
            variance += error * error;
            count += 1.0;
        }
    }
    Quantity::new(sum / count, variance / (count * count), f64::INFINITY)
}

/// Mean of a over mean of b in a part of two groups' pictures. Runs of equal seeds share paths, so each pixel's
/// a - ratio b, rather than a and b apart, gives the error (the ratio estimate of survey sampling, Cochran 1977).
pub fn paired_ratio(a: &Group, b: &Group, width: u32, rect: Rect) -> Quantity {
    let pixels = || {
        (rect.y0..rect.y1)
            .flat_map(move |y| (rect.x0..rect.x1).map(move |x| (y * width + x) as usize))
    };
    let level = |group: &Group, pixel: usize| {
        let channels = group.maps.mean[pixel];
        channels.iter().map(|value| f64::from(*value)).sum::<f64>() / 3.0
    };
    let sum = |group: &Group| pixels().map(|pixel| level(group, pixel)).sum::<f64>();
    let (top, bottom) = (sum(a), sum(b));
    let ratio = top / bottom;
    let left: Vec<f64> = pixels()
        .map(|pixel| level(a, pixel) - ratio * level(b, pixel))
        .collect();
    let left = mean_of(&left).times(left.len() as f64 / bottom);
    Quantity {
        value: ratio,
        ..left
    }
}

/// The largest of some numbers of standard errors, and the chance of one as large among so many, whatever
/// they share (Bonferroni 1936).
pub fn furthest(z: impl Iterator<Item = f64>) -> (f64, f64) {
    let (mut largest, mut count) = (0.0f64, 0.0);
    for z in z {
        largest = largest.max(z.abs());
        count += 1.0;
    }
    (largest, (count * two_sided(largest)).min(1.0))
}

/// Mean of independent numbers with its standard error.
pub fn mean_of(values: &[f64]) -> Quantity {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let freedom = (count - 1.0).max(1.0);
    Quantity::new(mean, squares / freedom / count, freedom)
}

/// Median of a few numbers that are off upwards now and then, as run times on a busy machine are. Its error is
/// that of the median of normal numbers, their deviation taken from the median distance to it.
pub fn median_of(values: &[f64]) -> Quantity {
    let middle = |values: &mut Vec<f64>| {
        values.sort_by(f64::total_cmp);
        let half = values.len() / 2;
        match values.len() {
            0 => f64::NAN,
            odd if odd % 2 == 1 => values[half],
            _ => 0.5 * (values[half - 1] + values[half]),
        }
    };
    let median = middle(&mut values.to_vec());
    let mut distances = values.iter().map(|value| (value - median).abs()).collect();
    let deviation = 1.4826 * middle(&mut distances);
    let count = values.len() as f64;
    let variance = std::f64::consts::FRAC_PI_2 * deviation * deviation / count;
    Quantity::new(median, variance, count - 1.0)
}

/// A straight line through points by least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    pub offset: f64,
    pub slope: f64,
    /// Share of the points' variance that the line explains.
    pub explained: f64,
}

impl Line {
    pub fn through(points: &[[f64; 2]]) -> Self {
        let count = points.len() as f64;
        let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / count;
        let middle = [mean(0), mean(1)];
        let mixed = |a: usize, b: usize| -> f64 {
            let each = points
                .iter()
                .map(|point| (point[a] - middle[a]) * (point[b] - middle[b]));
            each.sum()
        };
        let slope = mixed(0, 1) / mixed(0, 0);
        Self {
            offset: middle[1] - slope * middle[0],
            slope,
            explained: mixed(0, 1).powi(2) / (mixed(0, 0) * mixed(1, 1)),
        }
    }

    pub fn at(&self, x: f64) -> f64 {
        self.offset + self.slope * x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_through_points() {
        let line = Line::through(&[[1.0, 3.0], [2.0, 5.0], [3.0, 7.0]]);
        assert_eq!((line.offset, line.slope, line.explained), (1.0, 2.0, 1.0));
        assert_eq!(line.at(10.0), 21.0);
        let bent = Line::through(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]);
        assert_eq!((bent.slope, bent.explained), (0.0, 0.0));
    }

    #[test]
    fn a_median_does_not_see_one_slow_run() {
        let found = median_of(&[1.0, 1.1, 0.9, 1.0, 50.0]);
        assert_eq!(found.value, 1.0);
        let expected = 1.4826 * 0.1 * (std::f64::consts::FRAC_PI_2 / 5.0).sqrt();
        assert!((found.error - expected).abs() < 1e-12, "{}", found.error);
        assert_eq!(median_of(&[3.0, 1.0]).value, 2.0);
    }

    #[test]
    fn quotients_and_differences_of_numbers_with_errors() {
        let of = |value, error: f64| Quantity::new(value, error * error, f64::INFINITY);
        let found = ratio(of(6.0, 0.06), of(2.0, 0.02));
        assert!((found.value - 3.0).abs() < 1e-12);
        assert!((found.error - 3.0 * 0.01 * 2f64.sqrt()).abs() < 1e-12);
        let found = difference(of(6.0, 0.3), of(2.0, 0.4));
        assert!((found.value - 4.0).abs() < 1e-12 && (found.error - 0.5).abs() < 1e-12);
    }
}
