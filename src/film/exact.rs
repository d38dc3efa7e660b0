//! Sums that do not depend on the order of what is added.

use serde::{Deserialize, Serialize};

/// Words of a sum: 384 bits, of which the lowest is worth 2^-149, the smallest f32 that there is. The largest, added
/// 2^59 times, fits: that is 2^31 samples of 2^28 pixels.
const WORDS: usize = 6;
const LOWEST: i32 = -149;

/// A sum of numbers from 0 up, each a whole multiple of 2^-149, as sums of f32 in f64 are; nothing is rounded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Exact([u64; WORDS]);

impl Exact {
    /// Adds a number; one that is not finite, or below zero, adds nothing.
    pub fn add(&mut self, value: f64) {
        if !(value.is_finite() && value > 0.0) {
            return;
        }
        let bits = value.to_bits();
        let exponent = (bits >> 52) as i32;
        let fraction = bits & ((1 << 52) - 1);
        // Of multiples of 2^-149 none is so small that f64 has it without its leading bit.
        let shift = (exponent - 1075 - LOWEST).max(-52);
        let whole = u128::from(fraction | 1 << 52);
        let (word, wide) = match u32::try_from(shift) {
            Ok(shift) => ((shift / 64) as usize, whole << (shift % 64)),
            Err(_) => (0, whole >> shift.unsigned_abs()),
        };
        self.carry(word, wide);
    }

    /// Adds two words at a place; what is too large for all of them is lost.
    fn carry(&mut self, word: usize, wide: u128) {
        let mut rest = wide;
        for place in self.0.iter_mut().skip(word) {
            let sum = u128::from(*place) + (rest & u128::from(u64::MAX));
            *place = sum as u64;
            rest = (rest >> 64) + (sum >> 64);
        }
    }

    pub fn add_sum(&mut self, other: &Exact) {
        for (word, value) in other.0.into_iter().enumerate() {
            self.carry(word, u128::from(value));
        }
    }

    /// The sum, to f64's precision.
    pub fn value(&self) -> f64 {
        let worth = |word: usize| ((64 * word as i32 + LOWEST) as f64).exp2();
        let words = self.0.iter().enumerate().rev();
        words.map(|(word, &value)| value as f64 * worth(word)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(values: &[f64]) -> Exact {
        let mut sum = Exact::default();
        values.iter().for_each(|value| sum.add(*value));
        sum
    }

    #[test]
    fn what_is_added_comes_back() {
        let smallest = f64::from(f32::from_bits(1));
        for value in [0.0_f32, 1.0, 0.1, 1e-30, 12345.678, f32::MAX].map(f64::from) {
            assert_eq!(sum(&[value]).value(), value);
        }
        assert_eq!(sum(&[smallest]).value(), smallest);
        assert_eq!(sum(&[1.0; 1000]).value(), 1000.0);
        assert_eq!(sum(&[smallest; 7]).value(), 7.0 * smallest);
        assert_eq!(sum(&[f64::INFINITY, f64::NAN, -1.0, 2.0]).value(), 2.0);
    }

    #[test]
    fn order_and_grouping_change_no_bit() {
        let values: Vec<f64> = (0..999u32)
            .map(|n| f64::from(f32::from_bits(n.wrapping_mul(2_145_678) % 0x7f00_0000)))
            .collect();
        let forward = sum(&values);
        let backward = sum(&values.iter().rev().copied().collect::<Vec<_>>());
        let mut parts = sum(&values[..400]);
        parts.add_sum(&sum(&values[400..]));
        assert_eq!(forward, backward);
        assert_eq!(forward, parts);
        // Sums in f64 do depend on it: this test could tell.
        let plain: f64 = values.iter().sum();
        assert_ne!(plain, values.iter().rev().sum::<f64>());
    }
}
