//! Medians with their spread, and ratios of paired measurements.

use serde::{Deserialize, Serialize};

/// What repeated measurements of one thing gave.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    pub median: f64,
    /// The middle half of the values lies between these.
    pub quartiles: [f64; 2],
    /// Smallest and largest.
    pub range: [f64; 2],
    /// All of them, in the order in which they were measured.
    pub values: Vec<f64>,
}

impl Spread {
    /// None of no values.
    pub fn of(values: Vec<f64>) -> Option<Self> {
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        let (first, last) = (*sorted.first()?, *sorted.last()?);
        Some(Self {
            median: quantile(&sorted, 0.5),
            quartiles: [quantile(&sorted, 0.25), quantile(&sorted, 0.75)],
            range: [first, last],
            values,
        })
    }
}

/// Between the two nearest of sorted values, linearly (Hyndman and Fan's definition 7).
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    let below = sorted[place.floor() as usize];
    let above = sorted[place.ceil() as usize];
    below + (above - below) * place.fract()
}

/// The ratio of each turn's two values; turns that lack one give none.
pub fn ratios(over: &[Option<f64>], under: &[Option<f64>]) -> Vec<f64> {
    let pairs = over.iter().zip(under);
    pairs
        .filter_map(|(over, under)| Some((*over)? / (*under)?))
        .filter(|ratio| ratio.is_finite())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_quartiles() {
        assert_eq!(Spread::of(vec![]), None);
        let one = Spread::of(vec![3.0]).unwrap();
        assert_eq!((one.median, one.quartiles), (3.0, [3.0, 3.0]));
        let even = Spread::of(vec![4.0, 1.0, 3.0, 2.0]).unwrap();
        assert_eq!((even.median, even.quartiles), (2.5, [1.75, 3.25]));
        assert_eq!(even.range, [1.0, 4.0]);
        assert_eq!(even.values, [4.0, 1.0, 3.0, 2.0], "as measured");
        let odd = Spread::of(vec![5.0, 1.0, 2.0, 4.0, 30.0]).unwrap();
        assert_eq!((odd.median, odd.quartiles), (4.0, [2.0, 5.0]));
    }

    #[test]
    fn ratios_pair_the_values_of_a_turn() {
        let over = [Some(2.0), None, Some(9.0), Some(1.0)];
        let under = [Some(1.0), Some(1.0), Some(3.0), Some(0.0)];
        assert_eq!(ratios(&over, &under), [2.0, 3.0]);
    }

    /// A clock that halves in the middle of a run moves medians, not paired ratios.
    #[test]
    fn paired_ratios_do_not_see_the_clock() {
        let clock = [1.0, 1.0, 0.5, 0.5];
        let over = clock.map(|speed| Some(3.0 * speed));
        let under = clock.map(|speed| Some(2.0 * speed));
        assert_eq!(ratios(&over, &under), [1.5; 4]);
    }
}
