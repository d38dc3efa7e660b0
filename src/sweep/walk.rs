//! In which order a process takes the runs of its plan, so that several of them on one folder share the work.
//!
//! Alone, a process goes from the first to the last, which keeps together the runs of one pipeline. Where it
//! meets another at the same run, the later of the two goes on about half of what is left further, and from
//! there in order again: each pair of processes makes about one run twice for every time they meet.

use std::collections::VecDeque;

#[derive(Debug)]
pub(super) struct Walk {
    /// Places in the plan that this process has not come by yet, in the order in which it will.
    left: VecDeque<usize>,
    leaps: u32,
    process: u32,
}

impl Walk {
    pub fn new(runs: usize) -> Self {
        Self {
            left: (0..runs).collect(),
            leaps: 0,
            process: std::process::id(),
        }
    }

    pub fn next(&mut self) -> Option<usize> {
        self.left.pop_front()
    }

    /// Goes on elsewhere; returns how many places fell away because their runs are finished.
    pub fn leap(&mut self, is_finished: impl Fn(usize) -> bool) -> usize {
        let before = self.left.len();
        self.left.retain(|place| !is_finished(*place));
        self.leaps += 1;
        // Between a quarter and three quarters: two that leap at once land in different places.
        let turn = f64::from(self.process.wrapping_add(self.leaps)) * GOLDEN;
        let share = 0.25 + 0.5 * turn.fract();
        let steps = (self.left.len() as f64 * share) as usize;
        self.left.rotate_left(steps);
        before - self.left.len()
    }
}

/// Its multiples are spread evenly over the parts of 1.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn alone_it_goes_in_order() {
        let mut walk = Walk::new(4);
        let all: Vec<_> = std::iter::from_fn(|| walk.next()).collect();
        assert_eq!(all, [0, 1, 2, 3]);
    }

    #[test]
    fn a_leap_lands_among_what_is_left_and_loses_nothing() {
        let mut walk = Walk::new(100);
        (0..10).for_each(|_| assert!(walk.next().is_some()));
        assert_eq!(walk.leap(|place| place % 2 == 1), 45);
        let all: Vec<_> = std::iter::from_fn(|| walk.next()).collect();
        assert!((30..80).contains(&all[0]), "{}", all[0]);
        assert_eq!(all[1], all[0] + 2);
        let left: HashSet<usize> = all.iter().copied().collect();
        assert_eq!(left, (10..100).filter(|place| place % 2 == 0).collect());
        assert_eq!((all.len(), walk.leap(|_| true)), (45, 0));
    }

    /// Processes in lockstep, each run taking as long: the worst that can be.
    #[test]
    fn two_or_three_make_little_twice() {
        for processes in [2u32, 3] {
            for first in 100..120 {
                let walks = (0..processes).map(|process| Walk {
                    process: first + process,
                    ..Walk::new(240)
                });
                let made = together(walks.collect(), 240);
                assert!(made < 240 + 12 * processes as usize, "{processes}: {made}");
            }
        }
    }

    /// How many runs are made in all.
    fn together(mut walks: Vec<Walk>, runs: usize) -> usize {
        let (mut finished, mut made) = (HashSet::new(), 0);
        while finished.len() < runs {
            // All begin at once and end one after another.
            let hands: Vec<Option<usize>> = walks
                .iter_mut()
                .map(|walk| std::iter::from_fn(|| walk.next()).find(|run| !finished.contains(run)))
                .collect();
            for (walk, run) in walks.iter_mut().zip(hands) {
                let Some(run) = run else { continue };
                made += 1;
                if !finished.insert(run) {
                    walk.leap(|place| finished.contains(&place));
                }
            }
        }
        made
    }
}
