//! A lamp drawn in one step, whatever the probabilities: a table of slots, each shared by two lamps
//! (Walker, "An efficient method for generating discrete random variables with general distributions",
//! 1977), filled in linear time (Vose, "A linear algorithm for generating random numbers with a given
//! distribution", 1991).
//!
//! There is a power of two of slots, so that the bits of a random word pick one evenly, and thresholds are
//! whole parts of 2^32: what is drawn has, to the last bit, the probabilities that the table states.

use super::choice::ChoiceEntry;

/// Whole of a slot, in what a threshold counts.
const WHOLE: f64 = 4_294_967_296.0;
/// No lamp is drawn more rarely than this share of an even choice: it may be faint, and yet the nearest.
const LEAST: f64 = 1.0 / 4096.0;

/// One slot a lamp, and more up to a power of two.
///
/// `weights` are finite and not negative; where all are zero every lamp is as likely.
pub(super) fn table(weights: &[f64]) -> Vec<ChoiceEntry> {
    let slots = fill(&shares(weights));
    let stated = stated(&slots);
    let entry = |(slot, probability): (&Slot, &f64)| {
        let bits = (*probability as f32).to_bits();
        [slot.threshold, slot.other, bits, 0]
    };
    slots.iter().zip(&stated).map(entry).collect()
}

/// A slot: its own lamp for words below the threshold, else the other.
#[derive(Clone, Copy, Debug)]
struct Slot {
    threshold: u32,
    other: u32,
}

/// The probabilities, which add up to 1.
fn shares(weights: &[f64]) -> Vec<f64> {
    let count = weights.len() as f64;
    let largest = weights.iter().copied().fold(0.0, f64::max);
    // By the largest first: the sum of many of the largest there are need not be finite.
    let scaled = |weight: &f64| if largest > 0.0 { weight / largest } else { 1.0 };
    let sum: f64 = weights.iter().map(scaled).sum();
    let share = |weight| (1.0 - LEAST) * scaled(weight) / sum + LEAST / count;
    weights.iter().map(share).collect()
}

/// Vose's algorithm. Slots past the last lamp have nothing of their own and are filled by others.
fn fill(shares: &[f64]) -> Vec<Slot> {
    let slots = shares.len().next_power_of_two();
    let own = |slot: usize| shares.get(slot).map_or(0.0, |share| share * slots as f64);
    let mut left: Vec<f64> = (0..slots).map(own).collect();
    let mut made: Vec<Slot> = (0..slots as u32)
        .map(|slot| Slot {
            threshold: u32::MAX,
            other: slot,
        })
        .collect();
    let (mut small, mut large): (Vec<_>, Vec<_>) = (0..slots).partition(|slot| left[*slot] < 1.0);
    while let (Some(poor), Some(rich)) = (small.last().copied(), large.last().copied()) {
        small.pop();
        made[poor] = Slot {
            // Rust's conversion saturates.
            threshold: (left[poor] * WHOLE).round() as u32,
            other: rich as u32,
        };
        left[rich] -= 1.0 - left[poor];
        if left[rich] < 1.0 {
            large.pop();
            small.push(rich);
        }
    }
    // What rounding has left over: whole slots, but for those that belong to no lamp.
    let fullest = (0..shares.len()).max_by(|a, b| shares[*a].total_cmp(&shares[*b]));
    for slot in small.into_iter().filter(|slot| *slot >= shares.len()) {
        made[slot] = Slot {
            threshold: 0,
            other: fullest.unwrap_or(0) as u32,
        };
    }
    made
}

/// The probability with which the slots give each lamp, and zeros for those that belong to none.
fn stated(slots: &[Slot]) -> Vec<f64> {
    let mut parts = vec![0.0; slots.len()];
    for (place, slot) in slots.iter().enumerate() {
        parts[place] += f64::from(slot.threshold);
        // A slot that is its own other is whole.
        parts[slot.other as usize] += WHOLE - f64::from(slot.threshold);
    }
    // Sums of whole numbers below 2^52: exact.
    let all = WHOLE * slots.len() as f64;
    parts.into_iter().map(|parts| parts / all).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the slots give, counted in whole numbers.
    fn counted(table: &[ChoiceEntry]) -> Vec<u64> {
        let mut parts = vec![0; table.len()];
        for (place, [threshold, other, ..]) in table.iter().enumerate() {
            parts[place] += u64::from(*threshold);
            parts[*other as usize] += (1 << 32) - u64::from(*threshold);
        }
        parts
    }

    fn check(weights: &[f64]) {
        let table = table(weights);
        let whole = (table.len() as u64) << 32;
        let parts = counted(&table);
        assert_eq!(parts.iter().sum::<u64>(), whole);
        let sum: f64 = weights.iter().map(|x| x / weights[0].max(1e-300)).sum();
        for (lamp, parts) in parts.iter().enumerate() {
            let drawn = *parts as f64 / whole as f64;
            let stated = f32::from_bits(table[lamp][2]);
            assert_eq!(drawn as f32, stated, "lamp {lamp} of {weights:?}");
            let count = weights.len() as f64;
            let wanted = weights.get(lamp).map_or(0.0, |weight| {
                LEAST / count + (1.0 - LEAST) * weight / weights[0].max(1e-300) / sum
            });
            let rounding = 1e-9 * wanted + 1.0 / WHOLE;
            assert!(
                (drawn - wanted).abs() <= rounding,
                "lamp {lamp}: {drawn} {wanted}"
            );
            assert!(lamp >= weights.len() || stated > 0.0);
        }
    }

    #[test]
    fn tables_draw_what_they_state() {
        check(&[1.0]);
        check(&[1.0, 1.0]);
        check(&[1.0, 3.0, 2.0]);
        check(&[1e30, 1e-30]);
        check(&[1e-30, 1e30, 5e29]);
        for count in [5, 64, 1000, 4097] {
            let uneven = |place: usize| 0.01 + (place as f64 * 0.618_034).fract().powi(6);
            check(&(0..count).map(uneven).collect::<Vec<_>>());
            check(&vec![2.5; count]);
        }
    }

    #[test]
    fn lamps_without_power_are_drawn_evenly() {
        for entry in &table(&[0.0; 3])[..3] {
            assert!((f32::from_bits(entry[2]) - 1.0 / 3.0).abs() < 1e-6);
        }
    }

    /// Sums that no float holds.
    #[test]
    fn the_largest_weights_are_shared_out() {
        for entry in table(&[f64::MAX; 4]) {
            assert_eq!(f32::from_bits(entry[2]), 0.25);
        }
    }
}
