//! Light of every stored value, and the sRGB value of any light, computed once rather than for each
//! pixel.

use super::Transfer;
use super::curve::srgb;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Two files of two depths each are more than any command opens.
const KEPT: usize = 4;

struct Table {
    transfer: Transfer,
    light: Arc<[f32]>,
}

/// The tables that were asked for last. They belong to no raster, so that a raster is nothing but
/// what its file holds.
static TABLES: Mutex<Vec<Table>> = Mutex::new(Vec::new());

/// Light of the stored values from 0 to `largest`.
pub(super) fn light(transfer: Transfer, largest: u16) -> Arc<[f32]> {
    // A thread that panicked while it held the tables left whole ones behind.
    let mut tables = TABLES.lock().unwrap_or_else(PoisonError::into_inner);
    let length = usize::from(largest) + 1;
    let same = |table: &&Table| table.transfer == transfer && table.light.len() == length;
    if let Some(table) = tables.iter().find(same) {
        return table.light.clone();
    }
    let scale = 1.0 / f64::from(largest);
    let light: Arc<[f32]> = (0..=largest)
        .map(|stored| transfer.decode(f64::from(stored) * scale) as f32)
        .collect();
    if tables.len() == KEPT {
        tables.remove(0);
    }
    let kept = light.clone();
    tables.push(Table { transfer, light });
    kept
}

/// Up to here sRGB is a straight line, which takes no table.
const STRAIGHT: f32 = 0.003_130_8;
/// The bits of 2^-9, the last power of two below.
const FIRST: u32 = (127 - 9) << 23;
/// Bits of light that are interpolated over; the ten above them and the exponent choose the entry.
const FINE: u32 = 13;

/// sRGB values of light from 2^-9 to just above 1, in steps of 2^-10 of the next lower power of
/// two. Interpolated, they are off by less than 1e-6.
static ENCODED: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let last = (1.0_f32.to_bits() - FIRST) >> FINE;
    let light = |entry: u32| f32::from_bits(FIRST + (entry << FINE));
    (0..=last + 1)
        .map(|entry| srgb(f64::from(light(entry))) as f32)
        .collect()
});

/// What encodes light as sRGB, 0..1 to 0..1. NaN and anything below zero are black, anything above
/// one is white.
pub(super) fn encoder() -> impl Fn(f32) -> f32 {
    let encoded = ENCODED.as_slice();
    move |light| {
        // NaN is not above zero either.
        let light = if light > 0.0 { light.min(1.0) } else { 0.0 };
        if light <= STRAIGHT {
            return 12.92 * light;
        }
        let bits = light.to_bits() - FIRST;
        let entry = (bits >> FINE) as usize;
        let part = (bits & ((1 << FINE) - 1)) as f32 / (1 << FINE) as f32;
        encoded[entry] + part * (encoded[entry + 1] - encoded[entry])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_is_as_good_as_the_curve() {
        let encode = encoder();
        let mut last = 0.0;
        for step in 0..1_000_003 {
            let light = (f64::from(step) / 1_000_002.0).powi(2);
            let found = encode(light as f32);
            assert!((f64::from(found) - srgb(light)).abs() < 1e-6, "{light}");
            assert!(found >= last, "{light}");
            last = found;
        }
        assert_eq!([encode(0.0), encode(1.0), encode(9.0)], [0.0, 1.0, 1.0]);
        assert_eq!([encode(f32::NAN), encode(-1.0)], [0.0; 2]);
    }
}
