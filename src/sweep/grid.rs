//! All runs of a sweep: every combination of its axes, or the axes in step, each with so many seeds.

use super::axis::{Axis, MOST_RUNS};
use crate::error::{Error, Result};
use crate::knobs::short;
use crate::scene::Assignment;
use std::collections::HashMap;

/// Each pair of axes is compared.
const MOST_AXES: usize = 1000;
/// Values of all runs together, each of which is kept by every run: a few hundred megabytes of them.
const MOST_VALUES: usize = 4 * MOST_RUNS;

/// Seeds that follow each other are far apart in everything they draw.
const SEED: &str = "render.seed";

/// What is to be rendered.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    pub axes: Vec<Axis>,
    /// Whether the axes go in step rather than in every combination; one of a single value then stays at it.
    pub zip: bool,
    /// Repeats of each point, with the seeds 0, 1, 2, ... after the scene's own.
    pub seeds: u64,
}

/// One combination of values.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Path and value of each axis, in order.
    pub values: Vec<(String, String)>,
    /// Added to the scene's own seed.
    pub repeat: u64,
}

impl Grid {
    /// How many runs there are.
    ///
    /// # Errors
    /// [`Error::Usage`] for axes in step that have different lengths, a knob or a point twice, a seed both as
    /// an axis and by repeats, or too many runs or values.
    pub fn count(&self) -> Result<usize> {
        self.check()?;
        let points = if self.zip {
            self.steps()
        } else {
            let product = |all: usize, axis: &Axis| all.checked_mul(axis.values.len());
            let points = self.axes.iter().try_fold(1, product);
            points
                .filter(|points| *points <= MOST_RUNS)
                .ok_or_else(too_many)?
        };
        let runs = points.checked_mul(self.repeats() as usize);
        let runs = runs
            .filter(|runs| *runs <= MOST_RUNS)
            .ok_or_else(too_many)?;
        // At most a thousand times a million.
        match runs * self.axes.len() {
            0..=MOST_VALUES => Ok(runs),
            values => Err(Error::Usage(format!(
                "{runs} runs of {} swept knobs have {values} values: over {MOST_VALUES}",
                self.axes.len()
            ))),
        }
    }

    /// The axes that have several values; all of them where none has.
    pub fn telling(&self) -> impl Iterator<Item = &Axis> {
        let several = |axis: &&Axis| axis.values.len() > 1;
        let any = self.axes.iter().any(|axis| several(&axis));
        let axes = self.axes.iter();
        axes.filter(move |axis| !any || several(axis))
    }

    fn repeats(&self) -> u64 {
        self.seeds.max(1)
    }

    fn check(&self) -> Result<()> {
        if self.axes.len() > MOST_AXES {
            return Err(Error::Usage(format!("over {MOST_AXES} knobs are swept")));
        }
        for (number, axis) in self.axes.iter().enumerate() {
            if self.axes[..number]
                .iter()
                .any(|other| other.path == axis.path)
            {
                return Err(Error::Usage(format!(
                    "{} is swept twice",
                    short(&axis.path)
                )));
            }
            if axis.path == SEED && self.seeds > 1 {
                return Err(Error::Usage(format!(
                    "{SEED} is swept, and --seeds repeats it: one of the two"
                )));
            }
        }
        match self.zip {
            true => self.check_steps(),
            false => self.check_values(),
        }
    }

    fn check_values(&self) -> Result<()> {
        let mut axes = self.axes.iter();
        match axes.find_map(|axis| Some((axis, axis.repeated()?))) {
            Some((axis, value)) => Err(Error::Usage(format!(
                "--set {}: {} is there twice",
                short(&axis.path),
                short(value)
            ))),
            None => Ok(()),
        }
    }

    fn check_steps(&self) -> Result<()> {
        let steps = self.steps();
        let fits = |axis: &Axis| axis.values.len() == 1 || axis.values.len() == steps;
        if !self.axes.iter().all(fits) {
            let list: Vec<String> = self
                .axes
                .iter()
                .map(|axis| format!("{} has {}", short(&axis.path), axis.values.len()))
                .collect();
            return Err(Error::Usage(format!(
                "--zip takes the values in step, so all must have as many, or one: {}",
                list.join(", ")
            )));
        }
        if steps.saturating_mul(self.axes.len()) > MOST_VALUES {
            // Refused by their number, without comparing them all.
            return Ok(());
        }
        let mut seen = HashMap::with_capacity(steps);
        for step in 0..steps {
            let values: Vec<&str> = self.axes.iter().map(|axis| in_step(axis, step)).collect();
            if let Some(first) = seen.insert(values, step) {
                return Err(Error::Usage(format!(
                    "--zip: steps {} and {} have the same values",
                    first + 1,
                    step + 1
                )));
            }
        }
        Ok(())
    }

    /// How many points axes in step have.
    fn steps(&self) -> usize {
        let lengths = self.axes.iter().map(|axis| axis.values.len());
        lengths.max().unwrap_or(1)
    }

    /// Every run, the last axis changing fastest and the seeds faster still.
    ///
    /// # Errors
    /// As [`Grid::count`].
    pub fn points(&self) -> Result<Vec<Point>> {
        let repeats = self.repeats();
        let count = self.count()?;
        let point = |run: usize| {
            let (mut index, repeat) = (run / repeats as usize, (run % repeats as usize) as u64);
            let mut values: Vec<(String, String)> = Vec::new();
            for axis in self.axes.iter().rev() {
                let value = if self.zip {
                    in_step(axis, index)
                } else {
                    let place = index % axis.values.len();
                    index /= axis.values.len();
                    &axis.values[place]
                };
                values.push((axis.path.clone(), value.into()));
            }
            values.reverse();
            Point { values, repeat }
        };
        Ok((0..count).map(point).collect())
    }
}

fn too_many() -> Error {
    Error::Usage(format!("over {MOST_RUNS} runs"))
}

impl Point {
    /// As `--set` has them; the seed is that of the repeat.
    pub fn assignments(&self, scene_seed: u64) -> Vec<Assignment> {
        let set =
            |path: &str, value: &str| Assignment::new(path, value, format!("--set {path}={value}"));
        let mut all: Vec<_> = self
            .values
            .iter()
            .map(|(path, value)| set(path, value))
            .collect();
        if self.repeat > 0 {
            all.push(set(SEED, &scene_seed.wrapping_add(self.repeat).to_string()));
        }
        all
    }
}

/// An axis's value at a step; the only one at every step.
fn in_step(axis: &Axis, step: usize) -> &str {
    match axis.values.as_slice() {
        [only] => only,
        values => &values[step],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(text: &str) -> Axis {
        Axis::parse(text).unwrap_or_else(|error| panic!("{error}"))
    }

    fn words(grid: &Grid) -> Vec<String> {
        let points = grid.points().unwrap_or_else(|error| panic!("{error}"));
        let word = |point: &Point| {
            let values: Vec<_> = point
                .values
                .iter()
                .map(|(_, value)| value.as_str())
                .collect();
            format!("{}#{}", values.join(" "), point.repeat)
        };
        points.iter().map(word).collect()
    }

    #[test]
    fn every_combination_with_every_seed() {
        let grid = Grid {
            axes: vec![axis("a=1,2"), axis("b=x,y")],
            zip: false,
            seeds: 2,
        };
        let all = [
            "1 x#0", "1 x#1", "1 y#0", "1 y#1", "2 x#0", "2 x#1", "2 y#0", "2 y#1",
        ];
        assert_eq!(words(&grid), all);
    }

    #[test]
    fn in_step() {
        let grid = Grid {
            axes: vec![axis("a=1,2,3"), axis("b=x,y,z")],
            zip: true,
            seeds: 1,
        };
        assert_eq!(words(&grid), ["1 x#0", "2 y#0", "3 z#0"]);
        assert_eq!(words(&Grid::default()), ["#0"]);
    }

    #[test]
    fn axes_of_one_value_tell_nothing_unless_all_are() {
        let telling = |axes: &[&str]| {
            let axes = axes.iter().map(|text| axis(text)).collect();
            let grid = Grid {
                axes,
                ..Grid::default()
            };
            let told = grid.telling().map(|axis| axis.path.clone());
            told.collect::<Vec<_>>().join(" ")
        };
        assert_eq!(telling(&["a=1", "b=1,2", "c=x", "d=3,4"]), "b d");
        assert_eq!(telling(&["a=1", "c=x"]), "a c");
        assert_eq!(telling(&[]), "");
    }

    #[test]
    fn in_step_values_may_come_again_and_one_stays() {
        let grid = Grid {
            axes: vec![axis("a=1,2,1"), axis("b=x"), axis("c=u,u,v")],
            zip: true,
            seeds: 1,
        };
        assert_eq!(words(&grid), ["1 x u#0", "2 x u#0", "1 x v#0"]);
    }

    #[test]
    fn what_does_not_fit_together() {
        let refused = |axes: &[&str], zip, seeds| {
            let grid = Grid {
                axes: axes.iter().map(|text| axis(text)).collect(),
                zip,
                seeds,
            };
            grid.count().expect_err("a mistake").to_string()
        };
        assert!(refused(&["a=1,2,3", "b=1,2"], true, 1).contains("a has 3, b has 2"));
        assert!(refused(&["a=1,2,1", "b=3,4,3"], true, 1).contains("steps 1 and 3"));
        assert!(refused(&["a=1,2,1"], false, 1).contains("--set a: 1 is there twice"));
        let endless = format!("a={0},{0}", "\u{7}".repeat(1 << 20));
        let error = refused(&[&endless], false, 1);
        assert!(
            error.len() < 600 && !error.contains(char::is_control),
            "{error}"
        );
        assert!(refused(&["a=1,2", "a=3"], false, 1).contains("twice"));
        assert!(refused(&["render.seed=1,2"], false, 3).contains("one of the two"));
        assert!(refused(&["a=1..1000", "b=1..1000", "c=1..2"], false, 1).contains("over"));
        // Made as points, these would need 80 gigabytes, or a day of comparing.
        let ones: Vec<String> = (0..2000).map(|number| format!("k{number}=1")).collect();
        let mut axes: Vec<&str> = ones.iter().map(String::as_str).collect();
        assert!(refused(&axes, false, 1).contains("over 1000 knobs"));
        axes.truncate(5);
        assert!(refused(&axes, false, 1_000_000).contains("over 4000000"));
        axes.truncate(4);
        let grid = Grid {
            axes: axes.iter().map(|text| axis(text)).collect(),
            zip: false,
            seeds: 1_000_000,
        };
        assert_eq!(grid.count().unwrap(), 1_000_000);
    }
}
