//! How far a sweep is, and how long the rest takes.

use super::expected::PlannedReference;
use super::plan::Planned;
use std::time::{Duration, Instant};

/// Where a sweep is.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Runs that are finished, those of earlier calls included, and all; of references likewise.
    pub done: usize,
    pub total: usize,
    /// What is in hand.
    pub step: Step<'a>,
    /// Of the paths of this call, those of references included, 0 to 1.
    pub share: f64,
    /// By the speed so far; none before the first run of this call.
    pub left: Option<Duration>,
}

/// One render.
#[derive(Clone, Copy, Debug)]
pub enum Step<'a> {
    Run(&'a Planned),
    Reference(&'a PlannedReference),
}

/// Paths and time of one call.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    started: Instant,
    done: u64,
    all: u64,
}

impl Pace {
    pub fn new(all: u64) -> Self {
        Self {
            started: Instant::now(),
            done: 0,
            all,
        }
    }

    pub fn all(&self) -> u64 {
        self.all
    }

    pub fn add(&mut self, paths: u64) {
        self.done = self.done.saturating_add(paths);
    }

    /// Number, total and kind of the step, and its paths so far.
    pub fn progress<'a>(&self, step: (usize, usize, Step<'a>), paths: u64) -> Progress<'a> {
        let (done, total, step) = step;
        let made = self.done.saturating_add(paths);
        let left = self.all.saturating_sub(made);
        let each = self.started.elapsed().as_secs_f64() / made as f64;
        let seconds = Duration::try_from_secs_f64(each * left as f64).ok();
        Progress {
            done,
            total,
            step,
            share: made as f64 / (made.saturating_add(left)).max(1) as f64,
            left: seconds.filter(|_| made > 0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::{Axis, Base, Grid, Plan};

    #[test]
    fn shares_go_up_to_one_and_time_goes_down() {
        let text = "version = 1\ncamera = { position = [0, 0, 3], look_at = [0, 0, 0] }\n";
        let base = Base {
            name: "s.toml".into(),
            text: text.into(),
            assignments: Vec::new(),
        };
        let grid = Grid {
            axes: vec![Axis::parse("render.samples=1,3").unwrap()],
            ..Grid::default()
        };
        let device = crate::cpu::Cpu::new();
        let plan = Plan::new(&base, &grid, crate::device::Device::info(&device)).unwrap();
        let mut pace = Pace::new(4 * 256 * 256);
        let at = |pace: &Pace, run: usize, paths| {
            let step = (run, 2, Step::Run(&plan.runs[run]));
            let progress = pace.progress(step, paths);
            (progress.share, progress.left)
        };
        assert_eq!(at(&pace, 0, 0), (0.0, None));
        pace.add(plan.runs[0].paths);
        let (share, left) = at(&pace, 1, 256 * 256);
        assert_eq!(share, 0.5);
        std::thread::sleep(Duration::from_millis(20));
        let (share, none) = at(&pace, 1, 3 * 256 * 256);
        assert_eq!((share, none), (1.0, Some(Duration::ZERO)));
        assert!(left.is_some());
    }
}
