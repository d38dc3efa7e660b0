//! Axes of a sweep, one a line; a line `zip` takes them in step, and `seeds N` repeats each point.

use super::support;
use lampray::Error;
use lampray::sweep::{Axis, Grid, MOST_RUNS};

/// Points that are made; of more, only the number is asked for.
const MADE: usize = 1000;

pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    if let Err(error) = grid(text).and_then(|grid| points(&grid)) {
        support::refusal(&error);
        assert!(matches!(error, Error::Usage(_)), "{error}");
    }
}

fn grid(text: &str) -> Result<Grid, Error> {
    let (mut grid, mut axes) = (Grid::default(), Vec::new());
    for line in text.lines() {
        match line.strip_prefix("seeds ") {
            Some(seeds) => grid.seeds = seeds.parse().unwrap_or(u64::MAX),
            None if line == "zip" => grid.zip = true,
            None => axes.push(line),
        }
    }
    grid.axes = Axis::parse_all(&axes)?;
    let values: usize = grid.axes.iter().map(|axis| axis.values.len()).sum();
    assert!(values <= MOST_RUNS);
    Ok(grid)
}

fn points(grid: &Grid) -> Result<(), Error> {
    let count = grid.count()?;
    assert!(count <= MOST_RUNS);
    if count > MADE {
        return Ok(());
    }
    let points = grid.points()?;
    assert_eq!(points.len(), count);
    for (number, point) in points.iter().enumerate() {
        assert_eq!(point.values.len(), grid.axes.len());
        assert!(!points[..number].contains(point), "the same run twice");
        let _ = point.assignments(u64::MAX);
    }
    Ok(())
}
