//! What scouts saw of a pixel and of those around it: few samples say little of a variance, and what is noisy in
//! one pixel mostly is so in the next.

/// Pixels on each side that are taken in.
const RADIUS: usize = 2;

/// The mean of each pixel's value and of those around it, as far as there are any; rows of `width`.
pub(super) fn smooth(values: &[f64], width: usize) -> Vec<f64> {
    let rows = values.chunks(width).flat_map(windows);
    let across: Vec<f64> = rows.collect();
    let mut smoothed = vec![0.0; values.len()];
    for x in 0..width {
        let column: Vec<f64> = across.iter().skip(x).step_by(width).copied().collect();
        for (y, value) in windows(&column).into_iter().enumerate() {
            smoothed[y * width + x] = value;
        }
    }
    smoothed
}

/// The means over the windows about each place of a line.
fn windows(line: &[f64]) -> Vec<f64> {
    let about = |place: usize| {
        let window = &line[place.saturating_sub(RADIUS)..(place + RADIUS + 1).min(line.len())];
        window.iter().sum::<f64>() / window.len() as f64
    };
    (0..line.len()).map(about).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lone_value_is_spread_over_its_window() {
        let mut values = vec![0.0; 7 * 6];
        values[3 * 7 + 3] = 25.0;
        let smoothed = smooth(&values, 7);
        // Windows are shorter at the edges.
        let shares = |length: usize| -> Vec<f64> {
            let of = |place: usize| match place.abs_diff(3) > RADIUS {
                true => 0.0,
                false => 1.0 / ((place + 3).min(length) - place.saturating_sub(2)) as f64,
            };
            (0..length).map(of).collect()
        };
        let (columns, rows) = (shares(7), shares(6));
        for (pixel, value) in smoothed.iter().enumerate() {
            let wanted = 25.0 * columns[pixel % 7] * rows[pixel / 7];
            assert!(
                (value - wanted).abs() < 1e-12,
                "{pixel}: {value}, not {wanted}"
            );
        }
    }

    #[test]
    fn what_is_even_stays_so() {
        for (width, height) in [(1, 1), (1, 9), (3, 2), (16, 16)] {
            assert_eq!(
                smooth(&vec![1.5; width * height], width),
                vec![1.5; width * height]
            );
        }
    }
}
