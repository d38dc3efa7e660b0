//! Light of every stored value, computed once rather than for each pixel.

use super::Transfer;
use std::sync::{Arc, Mutex, PoisonError};

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
