//! Texts of the command line that stand for several numbers.

use crate::compare::flip::{self, Exposures};
use crate::error::{Error, Result};
use crate::pack::Rect;

pub(super) fn crop(text: &str) -> Result<Rect> {
    let numbers: Option<Vec<u32>> = text
        .split(',')
        .map(|part| part.trim().parse().ok())
        .collect();
    match numbers.as_deref() {
        Some(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok(Rect { x0, y0, x1, y1 }),
        _ => Err(Error::Usage(format!(
            "--crop {text}: give X0,Y0,X1,Y1 in pixels with X0 < X1 and Y0 < Y1"
        ))),
    }
}

pub(super) fn exposures(text: &str) -> Result<Exposures> {
    let wrong = || {
        Error::Usage(format!(
            "--exposures {text}: give START,STOP,COUNT as an earlier comparison printed them, for example -3.1,4.2,8"
        ))
    };
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let &[start, stop, count] = parts.as_slice() else {
        return Err(wrong());
    };
    let stops = |text: &str| {
        text.parse::<f32>()
            .ok()
            .filter(|stops| stops.abs() <= 100.0)
    };
    match (stops(start), stops(stop), count.parse::<u32>()) {
        (Some(start), Some(stop), Ok(count @ 1..=flip::MAX_EXPOSURES)) if start <= stop => {
            Ok(Exposures { start, stop, count })
        }
        _ => Err(wrong()),
    }
}
